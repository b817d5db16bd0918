#include "modelfile/text/format.h"

#include "cli/input.h"
#include "cli/say.h"
#include "result/file.h"

namespace anholon::cli {

int format(const FormatCommand& o) {
  int code = kOk;
  for (const std::string& path : o.files) {
    SourceText source{path, {}};
    std::string why;
    if (!read_file(path, source.text, &why)) {
      say(stderr, "error: cannot read '%s': %s\n", path.c_str(), why.c_str());
      code = kBadInput;
      continue;
    }
    try {
      const std::string text = formatted(source);
      if (o.to_stdout) {
        hand_out(text);
      } else if (text != source.text) {
        say(stdout, "%s\n", path.c_str());
        if (!o.check) {
          if (const std::string trouble = write_whole(path, text); !trouble.empty())
            throw UsageError{"error: " + trouble + "\n"};
        } else if (code == kOk) {
          code = kStopped;
        }
      }
    } catch (const Failure& f) {
      print_diagnostic(f.diagnostic, source);
      code = kBadInput;
    }
  }
  return code;
}

}  // namespace anholon::cli

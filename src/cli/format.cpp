#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "cli/input.h"
#include "spec/format.h"

namespace anholon::cli {

namespace fs = std::filesystem;

// The file is never seen half written.
static void replace_file(const std::string& path, const std::string& text) {
  std::error_code error;
  fs::path target = fs::canonical(path, error);
  if (error) target = path;
  const fs::path beside = target.string() + "." + std::to_string(getpid()) + "~";
  {
    std::ofstream out(beside, std::ios::binary);
    out << text;
    out.close();
    if (!out) error = std::make_error_code(std::errc::io_error);
  }
  if (!error) fs::permissions(beside, fs::status(target, error).permissions(), error);
  if (!error) fs::rename(beside, target, error);
  if (!error) return;
  std::error_code ignored;
  fs::remove(beside, ignored);
  throw UsageError{"error: cannot write '" + path + "': " + error.message() + "\n"};
}

int format(const Options& o) {
  int code = kOk;
  for (const std::string& path : o.files) {
    SourceText source{path, {}};
    std::string why;
    if (!read_file(path, source.text, &why)) {
      std::fprintf(stderr, "error: cannot read '%s': %s\n", path.c_str(), why.c_str());
      code = kBadInput;
      continue;
    }
    try {
      const std::string text = formatted(source);
      if (o.to_stdout) {
        std::fputs(text.c_str(), stdout);
      } else if (text != source.text) {
        std::printf("%s\n", path.c_str());
        if (!o.check_only) replace_file(path, text);
        else if (code == kOk) code = kStopped;
      }
    } catch (const Failure& f) {
      print_diagnostic(f.diagnostic, source);
      code = kBadInput;
    }
  }
  return code;
}

}  // namespace anholon::cli

#include <filesystem>

#include "cli/input.h"
#include "cli/say.h"
#include "result/file.h"

namespace anholon::cli {

int new_model(const NewCommand& o) {
  const std::vector<ShippedFile> list = shipped(Shipped::templates);
  if (o.name.empty()) {
    if (!o.output.empty())
      throw UsageError{"error: which template is to be written to '" + o.output +
                       "'?\nhint: `anholon new` lists them\n"};
    for (const ShippedFile& t : list) say(stdout, "%-12s %s\n", t.name.c_str(), t.title.c_str());
    return kOk;
  }
  std::vector<std::string> known;
  std::string text;
  for (const ShippedFile& t : list) {
    known.push_back(t.name);
    if (t.name == o.name && !read_file(t.path, text)) throw UsageError{"error: cannot read '" + t.path + "'\n"};
  }
  if (text.empty()) {
    const std::string near = did_you_mean(o.name, known);
    throw UsageError{"error: there is no template '" + o.name + "'" +
                     (near.empty() ? "" : "; did you mean '" + near + "'?") + "\nhint: `anholon new` lists them\n"};
  }
  if (o.output.empty()) {
    hand_out(text);
    return kOk;
  }
  // An existing file is not overwritten.
  std::error_code none;
  const auto kind = std::filesystem::symlink_status(o.output, none).type();
  if (kind == std::filesystem::file_type::regular || kind == std::filesystem::file_type::symlink ||
      kind == std::filesystem::file_type::directory)
    throw UsageError{"error: there is a file '" + o.output +
                     "' already\nhint: give another name after -o, or remove it\n"};
  if (const std::string why = write_whole(o.output, text); !why.empty()) throw UsageError{"error: " + why + "\n"};
  say(stderr, "wrote %s\nnext: anholon check %s\n", o.output.c_str(), o.output.c_str());
  return kOk;
}

}  // namespace anholon::cli

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "cli/input.h"

namespace anholon::cli {

int new_model(const Options& o) {
  const std::vector<ShippedModel> list = templates();
  if (o.model.empty()) {
    if (!o.output.empty()) throw UsageError{"error: which template is to be written to '" + o.output + "'?\nhint: `anholon new` lists them\n"};
    for (const ShippedModel& t : list) std::printf("%-12s %s\n", t.name.c_str(), t.title.c_str());
    return kOk;
  }
  std::vector<std::string> known;
  std::string text;
  for (const ShippedModel& t : list) {
    known.push_back(t.name);
    if (t.name == o.model && !read_file(t.path, text)) throw UsageError{"error: cannot read '" + t.path + "'\n"};
  }
  if (text.empty()) {
    const std::string near = did_you_mean(o.model, known);
    throw UsageError{"error: there is no template '" + o.model + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?") + "\nhint: `anholon new` lists them\n"};
  }
  if (o.output.empty()) {
    std::fputs(text.c_str(), stdout);
    return kOk;
  }
  // "x": a file that is there stays as it is.
  std::FILE* file = std::fopen(o.output.c_str(), "wx");
  if (!file && errno == EEXIST) throw UsageError{"error: there is a file '" + o.output + "' already\nhint: give another name after -o, or remove it\n"};
  const bool good = file && std::fputs(text.c_str(), file) >= 0;
  if (!file || std::fclose(file) != 0 || !good) throw UsageError{"error: cannot write '" + o.output + "': " + std::strerror(errno) + "\n"};
  std::fprintf(stderr, "wrote %s\nnext: anholon check %s\n", o.output.c_str(), o.output.c_str());
  return kOk;
}

}  // namespace anholon::cli

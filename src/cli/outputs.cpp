#include "cli/outputs.h"

#include "result/file.h"
#include "result/format.h"

namespace anholon::cli {

namespace fs = std::filesystem;

namespace {

bool is_file(const std::string& path) { return !path.empty() && path != "-"; }

// True if both names are those of one regular file.
bool is_one_file(const std::string& a, const std::string& b) {
  std::error_code none;
  return is_file(a) && is_file(b) && fs::equivalent(a, b, none) && fs::is_regular_file(a, none);
}

// True if both names are those of one file, which need not exist yet.
bool will_be_one_file(const std::string& a, const std::string& b) {
  std::error_code none;
  if (!is_file(a) || !is_file(b) || fs::exists(a, none) || fs::exists(b, none)) return is_one_file(a, b);
  const auto place = [&](const std::string& path) {
    return fs::absolute(target_of_link(path), none).lexically_normal();
  };
  return place(a) == place(b);
}

[[noreturn]] void refuse(const OutputFile& output, const std::string& what) {
  throw UsageError{"error: " + output.option + " " + output.path + ": " + what +
                   "\nhint: give the output another name\n"};
}

}  // namespace

void must_spare_inputs(const ModelCommand& o, const Reader& in, const std::vector<std::string>& read,
                       const std::vector<OutputFile>& outputs) {
  const auto path_of = [](const SourceText& s) { return s.path.empty() ? s.name : s.path; };
  for (const OutputFile& output : outputs) {
    const auto is = [&](const std::string& path) { return is_one_file(output.path, path); };
    if (!format_of(o.model) && (is(o.model) || is(path_of(in.source)))) refuse(output, "this is the file of the model");
    for (const SourceText& s : in.source.others)
      if (is(path_of(s))) refuse(output, "this is a file on which the model is built");
    for (const std::string& table : in.model->table_files)
      if (is(table)) refuse(output, "the model has a table from this file");
    for (const std::string& path : read)
      if (is(path)) refuse(output, "the command reads this file");
    for (const OutputFile& other : outputs)
      if (&other != &output && will_be_one_file(output.path, other.path))
        refuse(output, "this is the file of " + other.option + ", too");
  }
}

}  // namespace anholon::cli

#include <algorithm>
#include <filesystem>

#include "cli/motions/result_file.h"
#include "cli/say.h"

namespace anholon::cli {

// A model has no rows before it is simulated.
static void check_is_no_model(const std::string& path) {
  const auto is = [&](const ShippedFile& model) { return model.name == path; };
  const std::vector<ShippedFile> models = shipped(Shipped::models);
  const bool named = !std::filesystem::exists(path) && std::any_of(models.begin(), models.end(), is);
  if (!named && !path.ends_with(".toml")) return;
  throw UsageError{"error: '" + path + "' is a model, and the command takes a run\nhint: anholon simulate " + path +
                   " --to 10 -o run.h5 writes the run run.h5\n"};
}

RunFile read_result(const std::string& path) {
  check_is_no_model(path);
  SourceText source{path == "-" ? "<standard input>" : path, {}};
  try {
    RunFile run = read_run(path, &source);
    for (const std::string& note : run.notes) say(stderr, "note: %s: %s\n", source.name.c_str(), note.c_str());
    return run;
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, source)};
  }
}

void check_ending(const std::string& output, const std::vector<const ResultFormat*>& formats) {
  std::error_code none;
  const std::filesystem::path path = output;
  const auto kind = std::filesystem::status(path, none).type();
  const bool other = kind != std::filesystem::file_type::regular && kind != std::filesystem::file_type::not_found;
  if (output.empty() || output == "-" || other || !path.has_extension() || format_of(output)) return;
  throw UsageError{"error: the format of '" + output + "' is not known\nhint: a name that ends in " +
                   known_files("", formats) + "\n"};
}

void check_format(const ResultFormat* format) {
  if (format && format->missing)
    throw UsageError{"error: " + std::string(format->missing) + "\nhint: " + format->missing_hint + "\n"};
}

int convert(const ConvertCommand& o) {
  const ResultFormat* format = o.json ? &report_format() : &plain_format();
  if (!o.output.empty() && o.output != "-") {
    format = format_of(o.output);
    if (!format)
      throw UsageError{"error: the format of '" + o.output + "' is not known\nhint: a name that ends in " +
                       known_files("") + "\n"};
    if (o.json && format != &report_format())
      throw UsageError{"error: --json and '" + o.output + "' ask for two formats\nhint: leave out --json\n"};
  }
  check_format(format);
  const RunFile run = read_result(o.run);
  if (const std::string why = format->write(o.output, run); !why.empty()) throw UsageError{"error: " + why + "\n"};
  return kOk;
}

}  // namespace anholon::cli

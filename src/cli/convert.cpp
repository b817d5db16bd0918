#include "cli/result_file.h"
#include "cli/say.h"

namespace anholon::cli {

RunFile read_result(const std::string& path) {
  SourceText source{path == "-" ? "<standard input>" : path, {}};
  try {
    RunFile run = read_run(path, &source);
    for (const std::string& note : run.notes) say(stderr, "note: %s: %s\n", source.name.c_str(), note.c_str());
    return run;
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, source)};
  }
}

int convert(const Options& o) {
  RunFormat format = o.json ? RunFormat::json : RunFormat::csv;
  if (!o.output.empty() && o.output != "-") {
    if (!format_of(o.output, format))
      throw UsageError{"error: the format of '" + o.output +
                       "' is not known\nhint: a name that ends in .h5, .csv or .json\n"};
    if (o.json && format != RunFormat::json)
      throw UsageError{"error: --json and '" + o.output + "' ask for two formats\nhint: leave out --json\n"};
  }
  if (format == RunFormat::hdf5 && !has_hdf5())
    throw UsageError{"error: " + std::string(kNoHdf5) + "\nhint: " + kNoHdf5Hint + "\n"};
  const RunFile run = read_result(o.model);
  if (const std::string why = write_run(o.output, format, run); !why.empty()) throw UsageError{"error: " + why + "\n"};
  return kOk;
}

}  // namespace anholon::cli

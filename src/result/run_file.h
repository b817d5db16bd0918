// The file of a run: its rows, and the data that identify their origin.
//
// The content determines the format. HDF5 holds everything, JSON the rows and the report, CSV the rows.
// (doc/results.md)
#pragma once
#include <map>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "result/rows.h"
#include "result/table.h"

namespace anholon {

// Information about a run before its first row.
struct RunInfo {
  struct File {
    std::string name, text;
  };
  std::string title, command, created_by;
  std::vector<File> model;  // the named file, then its base files, in turn
  // The settings of the run by names of options: "tolerance" -> {"1e-9"}, "set" -> {"m=2", "J=1"}.
  std::map<std::string, std::vector<std::string>> settings;
  std::map<std::string, std::string> units;  // of columns, if they are known
};

struct RunFile : RunInfo {
  RunTable table;
  // the JSON of `simulate` without its columns and rows; empty before the end of the run
  std::string report;
  std::vector<double> steps;       // end times of the accepted steps
  std::vector<std::string> notes;  // the parts that the reader had to omit
};

// Keeps a run in memory.
class RunSink final : public RowSink {
 public:
  explicit RunSink(RunFile& run) : run_(run) {}
  void columns(const std::vector<RunColumn>& columns) override { run_.table.set_columns(names_of(columns)); }
  void row(const Row& row) override { run_.table.add_row(row); }
  void step(double t) override { run_.steps.push_back(t); }

 private:
  RunFile& run_;
};

enum class RunFormat { csv, json, hdf5 };
// The format is determined by the extension of the name.
bool format_of(const std::string& path, RunFormat& format);

// "-" is the standard input. Throws Failure; if its span is a place in the file, `source` gets the text.
RunFile read_run(const std::string& path, SourceText* source = nullptr);
// Returns an empty string, or the reason why the run could not be written. The file is written completely or not
// changed; "-" is the standard output (CSV, JSON).
std::string write_run(const std::string& path, RunFormat format, const RunFile& run);

// The single formats, from and to texts.
RunFile read_csv(std::string_view text);
RunFile read_json_run(std::string_view text);

}  // namespace anholon

// The file of a run: its rows, and what is needed to know where they come from.
//
// Which format a file has is told by its content. HDF5 holds everything, JSON the rows and the report, CSV the rows.  (doc/results.md)
#pragma once
#include <map>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "result/rows.h"
#include "result/table.h"

namespace anholon {

// What is known of a run before its first row.
struct RunInfo {
  struct File {
    std::string name, text;
  };
  std::string title, command, created_by;
  std::vector<File> model;  // the file that was named, then those it builds on, in turn
  // What was asked for, by the names of the options: "tolerance" -> {"1e-9"}, "set" -> {"m=2", "J=1"}.
  std::map<std::string, std::vector<std::string>> settings;
  std::map<std::string, std::string> units;  // of columns, where they are known
};

struct RunFile : RunInfo {
  RunTable table;
  std::string report;              // the JSON of `simulate` without its columns and rows; empty while the run goes on
  std::vector<double> steps;       // when the accepted steps end
  std::vector<std::string> notes;  // what the reader had to leave out
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
// By the end of the name.
bool format_of(const std::string& path, RunFormat& format);

// "-" is the standard input. Throws Failure; where its span is a place in the file, `source` gets the text.
RunFile read_run(const std::string& path, SourceText* source = nullptr);
// Empty, or why it could not be written. The file is there as a whole or stays as it was; "-" is the standard output
// (CSV, JSON).
std::string write_run(const std::string& path, RunFormat format, const RunFile& run);

// The formats one by one, from and to texts.
RunFile read_csv(std::string_view text);
RunFile read_json_run(std::string_view text);

}  // namespace anholon

// A run as it is in a result file: its rows, and the data that identify their origin.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "result/rows.h"
#include "result/table.h"

namespace anholon {

// Information about a run before its first row.
struct RunInfo {
  struct File {
    std::string name, text;
  };
  std::string title, command, created_by;
  std::vector<File> model;  // the named file, then its base files, in their order
  // The settings of the run by names of options: "tolerance" -> {"1e-9"}, "set" -> {"m=2", "J=1"}.
  std::map<std::string, std::vector<std::string>> settings;
  std::map<std::string, std::string> units;  // of columns, if they are known
};

struct RunFile : RunInfo {
  RunTable table;
  // the JSON of `simulate` without its columns and rows; empty before the end of the run
  std::string report;
  std::vector<double> steps;       // end times of the accepted steps
  std::vector<std::string> notes;  // notes on the parts that the reader had to omit
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

}  // namespace anholon

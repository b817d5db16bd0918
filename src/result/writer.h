// Writers of results: one format of a file is behind each of them (result/format.h).
//
// A writer stops at the first failure of its file, which `error` and `close` report.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "result/rows.h"
#include "result/run_file.h"

namespace anholon {

// Writes the rows of a run while its motion is computed.
class RunWriter : public RowSink {
 public:
  // Empty, or the reason why the file cannot be written. Check it before use.
  virtual const std::string& error() const = 0;
  // Call it before `columns`: the file begins with these rows and steps of an earlier part of the run. A writer that
  // does not store the origin of its rows ignores the call.
  virtual void go_on(const RunFile&, std::size_t /*rows*/, std::size_t /*steps*/) {}
  // After this call, the rows so far are in the file, whatever happens to the program.
  virtual void flush() = 0;
  // Ends the file with the report of the run, the JSON of `simulate` without columns and rows; a format that holds rows
  // only ignores the report. Returns an empty string, or the reason why the file could not be written.
  virtual std::string close(const std::string& report) = 0;
  // The path of an unfinished file that holds the rows that could be written; empty if there is none.
  virtual std::string part() const { return {}; }
};

// A sweep before its first case.
struct SweepInfo {
  std::string model, form;
  std::vector<std::string> columns;  // case, varied values, outcome, t, last values
};

// One case of a sweep. A number that the case does not have is NaN.
struct SweepRow {
  std::size_t number = 0;
  std::span<const double> varied;
  const char* outcome = "";
  std::span<const double> last;  // t, then the state there
};

// Writes the cases of a sweep as they end.
class SweepWriter {
 public:
  virtual ~SweepWriter() = default;
  virtual const std::string& error() const = 0;
  virtual void row(const SweepRow& row) = 0;
  // Ends the file with the report of the sweep, a JSON object; a format that holds rows only ignores the report. Returns
  // an empty string, or the reason why the file could not be written.
  virtual std::string close(const std::string& report) = 0;
};

}  // namespace anholon

// Writers of results; each writes one format of files (result/format.h).
//
// A writer stops at the first failure of its file, which `error` and `close` report.
#pragma once
#include <span>
#include <string>
#include <string_view>
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

// A column of a sweep holds numbers, whole numbers or words.
struct SweepColumn {
  enum class Holds : std::uint8_t { numbers, whole_numbers, words };
  std::string name;
  Holds holds = Holds::numbers;
};

// A sweep before its first case.
struct SweepInfo {
  RunInfo origin;  // its title is that of the model
  std::string form;
  std::vector<SweepColumn> columns;
};

// The value of a case in one column: a word, or a number; NaN if it has none.
struct SweepCell {
  double number = 0;
  std::string_view word = {};
};

// A number of a column as it is written.
std::string written_number(const SweepColumn& column, double number);

// Writes the cases of a sweep as they end.
class SweepWriter {
 public:
  virtual ~SweepWriter() = default;
  virtual const std::string& error() const = 0;
  // Writes one cell for each column.
  virtual void row(std::span<const SweepCell> cells) = 0;
  // Ends the file with the report of the sweep, a JSON object; a format that holds rows only ignores the report.
  // Returns an empty string, or the reason why the file could not be written.
  virtual std::string close(const std::string& report) = 0;
};

}  // namespace anholon

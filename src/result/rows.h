// Sinks for the rows of a result, to a file or the standard output: columns once, then rows of numbers. Writing stops
// at the first failure of the file, which `close` reports.
#pragma once
#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "result/columns.h"
#include "result/file.h"

namespace anholon {

// One row of a run: a double for every column. A number wider than a double, or a time that is printed as given, has
// its digits beside it.
struct Row {
  std::span<const double> values;
  // Texts of the first columns; for an empty text, and for every further column, number_text(value) is written.
  std::span<const std::string> texts = {};
};
// Appends the number of column k in its written form.
void append_number(std::string& to, const Row& row, std::size_t k);

class RowSink {
 public:
  virtual ~RowSink() = default;
  // Called once, before the first row.
  virtual void columns(const std::vector<RunColumn>& columns) = 0;
  virtual void row(const Row& row) = 0;
  // Called when an accepted step of the motion ends at t.
  virtual void step(double) {}
};

// CSV with one header row. Rows are written whole: on a terminal one by one, else many together or those of half a
// second.
class CsvSink final : public RowSink {
 public:
  // An empty path or "-" is the standard output. Check `error` before use.
  explicit CsvSink(const std::string& path) : file_(path) {}
  ~CsvSink() override;
  CsvSink(const CsvSink&) = delete;
  CsvSink& operator=(const CsvSink&) = delete;
  void columns(const std::vector<RunColumn>& columns) override;
  void row(const Row& row) override;
  // Writes a line of words and numbers unchanged: a sweep has outcomes among its numbers.
  void cells(const std::vector<std::string>& texts);
  // After this call, the rows so far are in the file, whatever happens to the program.
  void flush();
  // Returns an empty string, or the reason why the file could not be written.
  std::string close();
  const std::string& error() const { return file_.error(); }
  std::string part() const { return file_.part(); }

 private:
  void end_line();

  GrowingFile file_;
  std::string waiting_;
  std::chrono::steady_clock::time_point next_{};
};

// Passes rows to two sinks.
class TwoSinks final : public RowSink {
 public:
  TwoSinks(RowSink& first, RowSink& second) : first_(first), second_(second) {}
  void columns(const std::vector<RunColumn>& columns) override { first_.columns(columns), second_.columns(columns); }
  void row(const Row& row) override { first_.row(row), second_.row(row); }
  void step(double t) override { first_.step(t), second_.step(t); }

 private:
  RowSink &first_, &second_;
};

}  // namespace anholon

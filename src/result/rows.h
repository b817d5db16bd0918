// Rows of a result on their way to a file or to the standard output: columns once, then rows of
// numbers. Writing stops at the first failure of the file, which `close` reports.
#pragma once
#include <chrono>
#include <span>
#include <string>
#include <vector>

#include "result/columns.h"
#include "result/file.h"

namespace anholon {

// One row of a run: a double for every column. A number that is wider than a double, or a time that is to be printed as
// it was given, has its digits beside it.
struct Row {
  std::span<const double> values;
  // Of the first columns; an empty text, and every column beyond, is what number_text(value) writes.
  std::span<const std::string> texts = {};
};
// Appends the number of column k as it is written.
void append_number(std::string& to, const Row& row, std::size_t k);

class RowSink {
 public:
  virtual ~RowSink() = default;
  // Called once, before the first row.
  virtual void columns(const std::vector<RunColumn>& columns) = 0;
  virtual void row(const Row& row) = 0;
  // A step of the motion that was accepted ends at t.
  virtual void step(double) {}
};

// CSV with one header row. Rows go to the file whole: on a terminal one by one, else many together or those of half a
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
  // A line of words and numbers as they stand: a sweep has outcomes among its numbers.
  void cells(const std::vector<std::string>& texts);
  // Puts the rows so far into the file, where they stay whatever happens to the program.
  void flush();
  // Empty, or why the file could not be written.
  std::string close();
  const std::string& error() const { return file_.error(); }
  std::string part() const { return file_.part(); }

 private:
  void end_line();

  GrowingFile file_;
  std::string waiting_;
  std::chrono::steady_clock::time_point next_{};
};

// To two places.
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

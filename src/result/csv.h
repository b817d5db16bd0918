// CSV: one row of names, then numbers. (doc/results.md)
#pragma once
#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include "result/block_file.h"
#include "result/writer.h"

namespace anholon {

// Throws Failure.
RunFile read_csv(std::string_view text);

// The lines of a CSV file. Lines are written whole: on a terminal one by one, otherwise many together, or those of half
// a second.
class CsvLines {
 public:
  // An empty path or "-" is the standard output. Check `error` before use.
  explicit CsvLines(const std::string& path) : file_(path) {}
  // Writes the first line, at once.
  void header(const std::vector<std::string>& names);
  void row(const Row& row);
  // Writes a line of words and numbers unchanged.
  void cells(const std::vector<std::string>& texts);
  void flush();
  std::string close() { return file_.close(); }
  const std::string& error() const { return file_.error(); }
  std::string part() const { return file_.part(); }

 private:
  void end_line();

  BlockFile file_;
  std::chrono::steady_clock::time_point next_{};
};

// The rows of a run as CSV.
class CsvRunWriter final : public RunWriter {
 public:
  explicit CsvRunWriter(const std::string& path) : lines_(path) {}
  const std::string& error() const override { return lines_.error(); }
  void columns(const std::vector<RunColumn>& columns) override { lines_.header(names_of(columns)); }
  void row(const Row& row) override { lines_.row(row); }
  void flush() override { lines_.flush(); }
  std::string close(const std::string&) override { return lines_.close(); }
  std::string part() const override { return lines_.part(); }

 private:
  CsvLines lines_;
};

}  // namespace anholon

// Rows of a result on their way to a file or to the standard output: columns once, then rows of
// numbers as text. Writing stops at the first failure of the file, which `close` reports.
#pragma once
#include <chrono>
#include <string>
#include <vector>

#include "result/file.h"

namespace anholon {

class RowSink {
 public:
  virtual ~RowSink() = default;
  virtual void columns(const std::vector<std::string>& names) = 0;
  virtual void row(const std::vector<std::string>& values) = 0;
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
  void columns(const std::vector<std::string>& names) override;
  void row(const std::vector<std::string>& values) override;
  // The rows so far are in the file, whatever happens to the program.
  void flush();
  // Empty, or why the file could not be written.
  std::string close();
  const std::string& error() const { return file_.error(); }
  std::string part() const { return file_.part(); }

 private:
  GrowingFile file_;
  std::string waiting_;
  std::chrono::steady_clock::time_point next_{};
};

// To two places.
class TwoSinks final : public RowSink {
 public:
  TwoSinks(RowSink& first, RowSink& second) : first_(first), second_(second) {}
  void columns(const std::vector<std::string>& names) override { first_.columns(names), second_.columns(names); }
  void row(const std::vector<std::string>& values) override { first_.row(values), second_.row(values); }
  void step(double t) override { first_.step(t), second_.step(t); }

 private:
  RowSink &first_, &second_;
};

// Keeps the rows, for JSON.
class MemorySink final : public RowSink {
 public:
  void columns(const std::vector<std::string>& names) override { names_ = names; }
  void row(const std::vector<std::string>& values) override { rows_.push_back(values); }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace anholon

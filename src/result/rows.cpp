#include "result/rows.h"

#include <unistd.h>

#include "base/escape.h"

namespace anholon {

CsvSink::~CsvSink() { flush(); }

void CsvSink::columns(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& n : names) quoted.push_back(csv_cell(n));
  row(quoted);
  flush();
}

void CsvSink::row(const std::vector<std::string>& values) {
  if (!file_.stream() || !error().empty()) return;
  bool first = true;
  for (const std::string& v : values) {
    if (!first) waiting_ += ',';
    waiting_ += v;
    first = false;
  }
  waiting_ += '\n';
  constexpr std::size_t kTogether = 1u << 16;
  if (waiting_.size() >= kTogether || std::chrono::steady_clock::now() >= next_) flush();
}

void CsvSink::flush() {
  constexpr auto kPause = std::chrono::milliseconds(500);
  if (!file_.stream()) return;
  file_.write(waiting_);
  file_.flush();
  waiting_.clear();
  next_ = std::chrono::steady_clock::now();
  if (!::isatty(::fileno(file_.stream()))) next_ += kPause;
}

std::string CsvSink::close() {
  flush();
  return file_.close();
}

}  // namespace anholon

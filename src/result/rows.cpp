#include "result/rows.h"

#include <charconv>
#include <cmath>

#include <unistd.h>

#include "base/escape.h"
#include "numeric/number.h"

namespace anholon {

void append_number(std::string& to, const Row& row, std::size_t k) {
  if (k < row.texts.size() && !row.texts[k].empty()) {
    to += row.texts[k];
    return;
  }
  const double value = row.values[k];
  if (!std::isfinite(value)) {
    to += number_text(value);
    return;
  }
  char buffer[32];
  to.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
}

CsvSink::~CsvSink() { flush(); }

void CsvSink::columns(const std::vector<RunColumn>& columns) {
  if (!file_.stream() || !error().empty()) return;
  for (const RunColumn& c : columns) {
    if (&c != columns.data()) waiting_ += ',';
    waiting_ += csv_cell(c.name);
  }
  end_line();
  flush();
}

void CsvSink::row(const Row& row) {
  if (!file_.stream() || !error().empty()) return;
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    if (k > 0) waiting_ += ',';
    append_number(waiting_, row, k);
  }
  end_line();
}

void CsvSink::cells(const std::vector<std::string>& texts) {
  if (!file_.stream() || !error().empty()) return;
  for (const std::string& text : texts) {
    if (&text != texts.data()) waiting_ += ',';
    waiting_ += text;
  }
  end_line();
}

void CsvSink::end_line() {
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

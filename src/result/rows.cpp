#include "result/rows.h"

#include <cerrno>
#include <cstring>

#include "result/table.h"

namespace anholon {

CsvSink::CsvSink(const std::string& path) : path_(path) {
  file_ = path.empty() || path == "-" ? stdout : std::fopen(path.c_str(), "w");
  if (!file_) error_ = "cannot write " + path + ": " + std::strerror(errno);
}

CsvSink::~CsvSink() { close(); }

void CsvSink::columns(const std::vector<std::string>& names) {
  std::vector<std::string> quoted;
  for (const std::string& n : names) quoted.push_back(csv_name(n));
  row(quoted);
}

void CsvSink::row(const std::vector<std::string>& values) {
  if (!file_ || !error_.empty()) return;
  std::string line;
  for (const std::string& v : values) {
    if (!line.empty()) line += ',';
    line += v;
  }
  line += '\n';
  if (std::fwrite(line.data(), 1, line.size(), file_) != line.size())
    error_ = "cannot write " + (path_.empty() ? std::string("the output") : path_) + ": " + std::strerror(errno);
}

void CsvSink::flush() {
  if (file_ && std::fflush(file_) != 0 && error_.empty())
    error_ = "cannot write " + (path_.empty() ? std::string("the output") : path_) + ": " + std::strerror(errno);
}

std::string CsvSink::close() {
  if (!file_) return error_;
  const bool failed = std::fflush(file_) != 0;
  if (failed && error_.empty())
    error_ = "cannot write " + (path_.empty() ? std::string("the output") : path_) + ": " + std::strerror(errno);
  if (file_ != stdout) std::fclose(file_);
  file_ = nullptr;
  return error_;
}

}  // namespace anholon

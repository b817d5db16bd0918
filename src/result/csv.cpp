// Rows from CSV: one row of names, then numbers.
#include <algorithm>

#include "base/diagnostic.h"
#include "base/utf8.h"
#include "result/run_file.h"

namespace anholon {

namespace {

class CsvReader {
 public:
  explicit CsvReader(std::string_view text) : text_(text), text_end_(text.empty() ? '\n' : text.back()) {}

  RunFile read() {
    constexpr std::string_view kMark = "\xEF\xBB\xBF";
    if (text_.substr(0, kMark.size()) == kMark) text_.remove_prefix(kMark.size());
    if (text_.empty())
      throw Failure(Span{}, "the file is empty", "anholon simulate MODEL --to T -o run.csv writes one");
    header(next());
    while (!text_.empty()) {
      const std::string_view line = next();
      // The last line may be empty.
      if (line.empty() && (text_.empty() || table_.columns.size() > 1)) {
        if (text_.find_first_not_of("\r\n") == std::string_view::npos) break;
        fail(line, 0, "an empty line between the rows", "take it out");
      }
      // The file of a killed run ends in the middle of a row.
      const bool cut = text_.empty() && text_end_ != '\n';
      if (cut && std::count(line.begin(), line.end(), ',') + 1 < static_cast<long>(table_.columns.size())) {
        run_.notes.push_back("the file ends in the middle of line " + std::to_string(number_) + ", which is left out");
        break;
      }
      row(line);
      if (cut) run_.notes.push_back("line " + std::to_string(number_) + " has no end: its last number may be cut off");
    }
    run_.table = std::move(table_);
    return std::move(run_);
  }

 private:
  std::string_view next() {
    ++number_;
    const std::size_t end = text_.find('\n');
    std::string_view line = text_.substr(0, end);
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    return line;
  }

  void header(std::string_view line) {
    std::vector<std::string> names = split_csv(line);
    double ignored = 0;
    if (std::all_of(names.begin(), names.end(),
                    [&](const std::string& n) { return n.empty() || parse_number(n, ignored); }))
      fail(line, 0, "the first line has no names of columns", "a line such as t,x,y,x',y' before the numbers");
    table_.set_columns(std::move(names));
    words_.assign(table_.columns.size(), false);
  }

  void row(std::string_view line) {
    const std::size_t columns = table_.columns.size();
    std::size_t column = 0, from = 0;
    for (; column < columns && from <= line.size(); ++column) {
      const std::size_t comma = std::min(line.find(',', from), line.size());
      const std::string_view cell = line.substr(from, comma - from);
      // A column whose first cell is a word is a column of words, like the outcomes of a sweep.
      if (!table_.add(column, cell) && !words_[column]) {
        if (table_.values[column].size() > 1) fail(line, from, "'" + std::string(cell) + "' is not a number", {}, cell);
        words_[column] = true;
      }
      from = comma + 1;
    }
    if (column == columns && from > line.size()) return;
    const auto found = 1 + std::count(line.begin(), line.end(), ',');
    fail(line, from <= line.size() ? from : line.size(),
         "this row has " + std::to_string(found) + (found == 1 ? " entry" : " entries") + ", the first line has " +
             std::to_string(columns) + " names",
         {});
  }

  [[noreturn]] void fail(std::string_view line, std::size_t at, const std::string& message, const std::string& hint,
                         std::string_view marked = {}) const {
    throw Failure(Span{number_, static_cast<std::uint32_t>(utf8_length(line.substr(0, at)) + 1),
                       static_cast<std::uint32_t>(std::max<std::size_t>(1, utf8_length(marked)))},
                  message, hint);
  }

  std::string_view text_;
  char text_end_;
  std::uint32_t number_ = 0;
  RunTable table_;
  RunFile run_;
  std::vector<char> words_;
};

}  // namespace

RunFile read_csv(std::string_view text) { return CsvReader(text).read(); }

}  // namespace anholon

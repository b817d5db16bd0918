#include "result/csv.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/diagnostic.h"
#include "base/escape.h"
#include "base/stop.h"
#include "base/utf8.h"
#include "numeric/number.h"
#include "result/format.h"

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
      if (cut && entries_of(line) < table_.columns.size()) {
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
    empty_.assign(table_.columns.size(), true);
  }

  static std::size_t entries_of(std::string_view line) {
    return line.find('"') == std::string_view::npos
               ? 1 + static_cast<std::size_t>(std::count(line.begin(), line.end(), ','))
               : csv_cells(line).size();
  }

  // Adds a cell at the place `from` of the line.
  void add(std::size_t column, std::string_view cell, std::string_view line, std::size_t from) {
    // A column is a column of words if its first cell that is not empty is a word, as outcomes and events of a sweep
    // are.
    const bool first = empty_[column];
    empty_[column] = first && cell.empty();
    if (table_.add(column, cell) || words_[column]) return;
    if (!first) fail(line, from, "'" + std::string(cell) + "' is not a number", {}, cell);
    words_[column] = true;
  }

  void row(std::string_view line) {
    const std::size_t columns = table_.columns.size();
    if (line.find('"') != std::string_view::npos) {
      const std::vector<std::string> cells = csv_cells(line);
      if (cells.size() != columns) wrong_number(line, line.size());
      for (std::size_t k = 0; k < columns; ++k) add(k, cells[k], line, std::min(line.find(cells[k]), line.size()));
      return;
    }
    std::size_t column = 0, from = 0;
    for (; column < columns && from <= line.size(); ++column) {
      const std::size_t comma = std::min(line.find(',', from), line.size());
      add(column, line.substr(from, comma - from), line, from);
      from = comma + 1;
    }
    if (column == columns && from > line.size()) return;
    wrong_number(line, std::min(from, line.size()));
  }

  [[noreturn]] void wrong_number(std::string_view line, std::size_t at) const {
    const std::size_t found = entries_of(line), columns = table_.columns.size();
    fail(line, at,
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
  std::vector<char> words_, empty_;  // columns of words; those whose cells have been empty so far
};

// Cases have outcomes among their numbers, so their lines are written cell by cell.
class CsvSweepWriter final : public SweepWriter {
 public:
  CsvSweepWriter(const std::string& path, const SweepInfo& info) : lines_(path), columns_(info.columns) {
    std::vector<std::string> names;
    for (const SweepColumn& c : columns_) names.push_back(c.name);
    if (error().empty()) lines_.header(names);
  }
  const std::string& error() const override { return lines_.error(); }
  void row(std::span<const SweepCell> cells) override {
    texts_.resize(cells.size());
    for (std::size_t k = 0; k < cells.size(); ++k)
      texts_[k] = columns_[k].holds == SweepColumn::Holds::words ? csv_cell(cells[k].word)
                  : std::isnan(cells[k].number)                  ? std::string()
                                                                 : written_number(columns_[k], cells[k].number);
    lines_.cells(texts_);
  }
  std::string close(const std::string&) override { return lines_.close(); }

 private:
  CsvLines lines_;
  std::vector<SweepColumn> columns_;
  std::vector<std::string> texts_;
};

std::string header_line(const std::vector<std::string>& names) {
  std::string line;
  for (const std::string& name : names) line += (&name == names.data() ? "" : ",") + csv_cell(name);
  return line;
}

// Writes line by line; returns false at the first failure.
bool write_table(std::FILE* file, const RunTable& table) {
  std::string line = header_line(table.columns) + '\n';
  constexpr std::size_t kBuffer = 1u << 16;
  for (std::size_t i = 0; i < table.rows(); ++i) {
    for (std::size_t j = 0; j < table.columns.size(); ++j) {
      if (j) line += ',';
      line += csv_cell(table.text(i, j));
    }
    line += '\n';
    if (line.size() < kBuffer) continue;
    look_for_stop();
    if (std::fwrite(line.data(), 1, line.size(), file) != line.size()) return false;
    line.clear();
  }
  return std::fwrite(line.data(), 1, line.size(), file) == line.size();
}

}  // namespace

RunFile read_csv(std::string_view text) { return CsvReader(text).read(); }

// Lines that are written together.
static constexpr std::size_t kTogether = 1u << 18;

void CsvLines::header(const std::vector<std::string>& names) {
  if (!file_.open()) return;
  file_.add(header_line(names));
  end_line();
  flush();
}

void CsvLines::row(const Row& row) {
  if (!file_.open()) return;
  char* const begin = file_.room(room_for(row));
  file_.added(static_cast<std::size_t>(write_numbers(begin, row) - begin));
  end_line();
}

void CsvLines::cells(const std::vector<std::string>& texts) {
  if (!file_.open()) return;
  for (const std::string& text : texts) {
    if (&text != texts.data()) file_.add(",");
    file_.add(text);
  }
  end_line();
}

void CsvLines::end_line() {
  file_.add("\n");
  if (file_.waiting() >= kTogether)
    file_.end_block();
  else if (std::chrono::steady_clock::now() >= next_)
    flush();
}

void CsvLines::flush() {
  constexpr auto kPause = std::chrono::milliseconds(500);
  file_.flush();
  next_ = std::chrono::steady_clock::now();
  if (!file_.is_terminal()) next_ += kPause;
}

extern const ResultFormat csv_format;
const ResultFormat csv_format = {
    .name = "CSV",
    .endings = {".csv"},
    .holds = Holds::rows,
    .read_text = read_csv,
    .write =
        [](const std::string& path, const RunFile& run) {
          return write_stream(path, [&](std::FILE* file) { return write_table(file, run.table); });
        },
    .open = [](const std::string& path, const RunInfo&) -> std::unique_ptr<RunWriter> {
      return std::make_unique<CsvRunWriter>(path);
    },
    .open_sweep = [](const std::string& path, const SweepInfo& info) -> std::unique_ptr<SweepWriter> {
      return std::make_unique<CsvSweepWriter>(path, info);
    },
};

}  // namespace anholon

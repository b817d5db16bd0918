#include "ensemble/case_table.h"

#include <algorithm>

#include "result/parquet/table_text.h"
#include "result/table.h"
#include "setup/words/mistake_in_word.h"

namespace anholon {

namespace {

constexpr const char* kTableHint = "a first line of names, m,theta',…, and a line of numbers for each case";

std::string trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t");
  return first == std::string::npos ? std::string() : text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

}  // namespace

std::string text_of_case_table(std::string bytes, const std::string& file) {
  if (!is_parquet(bytes)) return bytes;
  try {
    return table_text_of_parquet(bytes);
  } catch (const Failure& f) {
    throw Failure({}, file + ": " + f.diagnostic.message, f.diagnostic.hint);
  }
}

CaseTable::CaseTable(std::string text, std::string file) : text_(std::move(text)), file_(std::move(file)) {
  constexpr std::string_view kMark = "\xEF\xBB\xBF";  // the byte order mark of UTF-8, which some programs write first
  if (text_.compare(0, kMark.size(), kMark) == 0) text_.erase(0, kMark.size());
  bool header = false;
  std::size_t cells = 0, named_or_not = 0;  // the cells of the first line: without empty ones at its end, and with them
  for (std::size_t at = 0; at < text_.size();) {
    const std::string_view here = line(at);
    const std::size_t begin = at;
    at = std::min(text_.find('\n', at), text_.size() - 1) + 1;
    if (here.find_first_not_of(" \t") == std::string_view::npos) continue;
    const std::vector<std::string> all = split_csv(here);
    std::size_t count = all.size();
    // Commas at the end of a line do not make cells.
    while (count > std::max<std::size_t>(cells, 1) && trimmed(all[count - 1]).empty()) --count;
    if (!header) {
      header_ = begin, header = true, cells = count, named_or_not = all.size();
      continue;
    }
    if (count > cells && count <= named_or_not)
      mistake_at(header_, cells, "this column has no name", "the name of what varies in it, or leave out the column");
    if (count != cells)
      mistake_at(begin, 0,
                 "the line has " + std::to_string(count) + (count == 1 ? " cell" : " cells") + ", the first line " +
                     std::to_string(cells),
                 "a number for each name");
    lines_.push_back(begin);
  }
  if (!header) throw Failure({}, "the table " + file_ + " is empty", kTableHint);
  std::vector<std::string> all = split_csv(line(header_));
  all.resize(cells);
  for (std::string& name : all) name = trimmed(name);
  // In the table of a sweep the results of a case follow what varies.
  all.erase(std::find(all.begin(), all.end(), "outcome"), all.end());
  for (std::size_t k = 0; k < all.size(); ++k) {
    std::string& name = all[k];
    if (name == "case_name")
      mistake_at(header_, k, "a table of cases does not choose scenarios, and 'case_name' names them",
                 "leave out the column; --vary case=a,b computes all lines in each scenario, --case a in one");
    if (name == "case") {
      number_ = k;
      continue;
    }
    // A table of a sweep calls an initial value x(0).
    if (name.ends_with("(0)")) name.erase(name.size() - 3);
    names_.push_back(std::move(name));
    places_.push_back(k);
  }
  if (lines_.empty()) mistake_at(header_, 0, "the table has no cases", kTableHint);
}

void CaseTable::must_number_cases(const std::vector<std::string>& scenarios, bool varies) const {
  if (!number_) return;
  if (varies)
    mistake_at(header_, *number_, "'case' numbers the cases of a table, and the model calls a quantity so",
               "another name in the model, or a table without this column");
  for (const std::size_t begin : lines_) {
    const std::string cell = trimmed(split_csv(line(begin))[*number_]);
    const bool named = std::find(scenarios.begin(), scenarios.end(), cell) != scenarios.end();
    if (!named && (cell.empty() || parse_rational(cell))) continue;
    mistake_at(begin, *number_,
               named ? "'" + cell + "' is a scenario of the model, and the column 'case' of a table numbers its cases"
                     : "the column 'case' of a table numbers its cases, and '" + cell + "' is no number of a case",
               named ? "--vary case=" + cell + " computes all lines in the scenario; a table for each scenario"
                     : "leave out the column");
  }
  if (names_.empty()) mistake_at(header_, 0, "the table names nothing that varies", kTableHint);
}

std::string_view CaseTable::line(std::size_t begin) const {
  std::string_view all = std::string_view(text_).substr(begin);
  all = all.substr(0, all.find('\n'));
  if (!all.empty() && all.back() == '\r') all.remove_suffix(1);
  return all;
}

std::vector<std::string> CaseTable::cells(std::size_t row) const {
  std::vector<std::string> all = split_csv(line(lines_[row])), list;
  for (std::size_t k : places_) list.push_back(std::move(all[k]));
  return list;
}

// The text in the message has this line at its number, after empty lines.
void CaseTable::mistake_at(std::size_t begin, std::size_t cell, const std::string& message,
                           const std::string& hint) const {
  const auto before = std::count(text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(begin), '\n');
  const std::string here(line(begin));
  std::size_t at = 0;
  for (const std::vector<std::string> all = split_csv(here); cell > 0 && cell < all.size(); --cell)
    at = std::min(here.find(',', at), here.size() - 1) + 1;
  const std::size_t length = std::min(here.find(',', at), here.size()) - at;
  Span span;
  span.line = static_cast<decltype(span.line)>(before + 1);
  span.column = static_cast<decltype(span.column)>(at + 1);
  span.length = static_cast<decltype(span.length)>(std::max<std::size_t>(length, 1));
  throw MistakeInWord{
      {Severity::error, span, message, hint}, std::string(static_cast<std::size_t>(before), '\n') + here, file_};
}

void CaseTable::mistake(std::size_t row, std::size_t column, const std::string& message,
                        const std::string& hint) const {
  mistake_at(lines_[row], places_[column], message, hint);
}

void CaseTable::mistake_in_header(std::size_t column, const std::string& message, const std::string& hint) const {
  mistake_at(header_, places_[column], message, hint);
}

}  // namespace anholon

#include "result/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "numeric/number.h"

namespace anholon {

std::string WrittenNumber::text() const { return digits.empty() ? number_text(value) : digits; }

std::string_view digits_beside(const Row& row, std::size_t k) {
  if (k >= row.texts.size() || row.texts[k].empty() || says_all(row.texts[k], row.values[k])) return {};
  return row.texts[k];
}

std::string RunTable::text(std::size_t row, std::size_t column) const {
  if (column < texts.size() && row < texts[column].size() && !texts[column][row].empty()) return texts[column][row];
  const double value = values[column][row];
  return of_cases() && std::isnan(value) ? std::string() : number_text(value);
}

bool RunTable::holds_words(std::size_t column) const { return of_cases() && is_column_of_words(columns[column]); }

bool is_column_of_words(std::string_view name) { return name == "outcome" || name == "event" || name == "case_name"; }

void RunTable::set_columns(std::vector<std::string> names) {
  columns = std::move(names);
  values.reset(columns.size());
  texts.assign(columns.size(), {});
}

bool RunTable::add(std::size_t column, std::string_view written) {
  double value = std::numeric_limits<double>::quiet_NaN();
  // Other programs leave an empty cell for a missing number.
  const bool number = written.empty() || parse_number(written, value);
  std::vector<std::string>& own = texts[column];
  if (!own.empty() || (!written.empty() && !says_all(written, value))) {
    own.resize(values[column].size());
    own.emplace_back(says_all(written, value) ? std::string_view() : written);
  }
  values.growing(column).push_back(value);
  return number;
}

void RunTable::add_row(const Row& row) {
  for (std::size_t k = 0; k < row.values.size(); ++k) {
    const std::string_view digits = digits_beside(row, k);
    std::vector<std::string>& own = texts[k];
    if (!own.empty() || !digits.empty()) {
      own.resize(values[k].size());
      own.emplace_back(digits);
    }
    values.growing(k).push_back(row.values[k]);
  }
}

std::size_t RunTable::find(std::string_view name) const {
  return static_cast<std::size_t>(std::find(columns.begin(), columns.end(), name) - columns.begin());
}

bool parse_number(std::string_view written, double& value) {
  const char* end = written.data() + written.size();
  const auto r = std::from_chars(written.data(), end, value);
  if (r.ptr == end && r.ec == std::errc()) return true;
  // A number beyond the range of a double becomes 0 or infinity.
  if (r.ptr == end && r.ec == std::errc::result_out_of_range) {
    value = std::strtod(std::string(written).c_str(), nullptr);
    return true;
  }
  value = std::numeric_limits<double>::quiet_NaN();
  const auto fraction = parse_rational(written);
  if (fraction) value = from_rational<double>(*fraction);
  return fraction.has_value();
}

bool says_all(std::string_view written, double value) {
  if (!std::isfinite(value)) return written == number_text(value);
  char buffer[64];
  const auto r = std::to_chars(buffer, buffer + sizeof buffer, value);
  return written == std::string_view(buffer, static_cast<std::size_t>(r.ptr - buffer));
}

std::string json_number(std::string_view written) {
  std::size_t at = 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < written.size() && written[at] >= '0' && written[at] <= '9') ++at;
    return at - begin;
  };
  const auto take = [&](std::string_view any) {
    return at < written.size() && any.find(written[at]) != std::string_view::npos && ++at > 0;
  };
  take("-");
  const bool zero = at < written.size() && written[at] == '0';
  const std::size_t whole = digits();
  bool valid = whole == 1 || (whole > 1 && !zero);
  if (take(".")) valid = valid && digits() > 0;
  if (take("eE")) take("+-"), valid = valid && digits() > 0;
  if (valid && at == written.size()) return std::string(written);
  double value = 0;
  parse_number(written, value);
  return number_text(value);
}

static std::vector<std::string> split_at_commas(std::string_view line, bool brackets) {
  std::vector<std::string> names(1);
  int depth = 0;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (quoted) {
      if (c != '"')
        names.back() += c;
      else if (i + 1 < line.size() && line[i + 1] == '"')
        names.back() += c, ++i;
      else
        quoted = false;
    } else if (c == '"' && names.back().empty()) {
      quoted = true;
    } else if (c == ',' && depth <= 0) {
      names.emplace_back();
      depth = 0;
    } else {
      if (brackets && (c == '(' || c == '[')) ++depth;
      if (brackets && (c == ')' || c == ']')) --depth;
      names.back() += c;
    }
  }
  return names;
}

std::vector<std::string> split_csv(std::string_view line) { return split_at_commas(line, true); }

std::vector<std::string> csv_cells(std::string_view line) { return split_at_commas(line, false); }

}  // namespace anholon

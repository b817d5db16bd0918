// A table of numbers with names, column by column.
//
// A number is held as a double. Where the digits it was written with are more, or others, than the shortest ones that
// read back to that double (30-digit runs, times printed as they were given), they are kept beside it: no table loses
// anything on its way through formats.
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "result/rows.h"

namespace anholon {

// A number as a double, and its digits where these say more than the double: of a run in wider numbers.
struct WrittenNumber {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string digits;
  std::string text() const;
};

struct RunTable {
  std::vector<std::string> columns;
  std::vector<std::vector<double>> values;  // one vector per column
  std::vector<std::vector<std::string>>
      texts;  // per column: nothing, or one per row, empty where the number says it all

  std::size_t rows() const { return values.empty() ? 0 : values[0].size(); }
  // The number as it was written.
  std::string text(std::size_t row, std::size_t column) const;
  void set_columns(std::vector<std::string> names);
  // Adds a number at the end of a column as it was written; false if it is none: then it is kept as a text beside a
  // NaN.
  bool add(std::size_t column, std::string_view written);
  // Adds a row that has a number for every column.
  void add_row(const Row& row);
  // The place of a column, or columns.size().
  std::size_t find(std::string_view name) const;
};

// A written number as a double: decimals, fractions such as 1/3, nan, inf. False if it is none of these.
bool parse_number(std::string_view written, double& value);
// Whether `written` is what a double with this value is written as.
bool says_all(std::string_view written, double value);
// The digits of column k, where they say more than its double; else empty.
std::string_view digits_beside(const Row& row, std::size_t k);
// The same number as JSON has it: .5 and 1/3 are none there.
std::string json_number(std::string_view written);

// The names in the first row of a CSV file. A comma in brackets or quotes belongs to a name: P[1,2], D(x,4).
std::vector<std::string> split_csv(std::string_view line);
}  // namespace anholon

// A table of numbers with names, column by column.
//
// A number is stored as a double. If its written digits differ from the shortest ones that read back to that double
// (30-digit runs, times printed as given), they are stored beside it, so conversion between formats loses nothing.
#pragma once
#include <cstddef>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "result/number_columns.h"
#include "result/rows.h"

namespace anholon {

// A number as a double, and its digits if they contain more than the double: in a run with wider numbers.
struct WrittenNumber {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string digits;
  std::string text() const;
};

struct RunTable {
  std::vector<std::string> columns;
  NumberColumns values;
  std::vector<std::vector<std::string>>
      texts;  // per column: empty, or one text per row, which is empty if the number's own text suffices

  std::size_t rows() const { return values.rows(); }
  // True for a table of cases, as of a sweep: its first column is `case`, that of a run is `t`. Its cells may be empty.
  bool of_cases() const { return !columns.empty() && columns.front() == "case"; }
  // True for a column of a table of cases that holds words, even if all of them are empty.
  bool holds_words(std::size_t column) const;
  // The number in its written form; of a cell without a number "nan", in a table of cases an empty text.
  std::string text(std::size_t row, std::size_t column) const;
  void set_columns(std::vector<std::string> names);
  // Adds a written number at the end of a column; returns false if it is not a number: it is then kept as a text beside
  // a NaN.
  bool add(std::size_t column, std::string_view written);
  // Adds a row that has a number for every column.
  void add_row(const Row& row);
  // The index of a column, or columns.size().
  std::size_t find(std::string_view name) const;
};

// True for the columns of a table of cases that hold words: outcome, event, case_name.
bool is_column_of_words(std::string_view name);

// Converts a written number to a double: decimals, fractions such as 1/3, nan, inf. Returns false for other texts.
bool parse_number(std::string_view written, double& value);
// True if `written` is the text of a double with this value.
bool says_all(std::string_view written, double value);
// The digits of column k if they contain more than its double; otherwise empty.
std::string_view digits_beside(const Row& row, std::size_t k);
// The number in JSON's syntax, which has neither .5 nor 1/3.
std::string json_number(std::string_view written);

// The names in the first row of a CSV file. A comma in brackets or quotes belongs to a name: P[1,2], D(x,4).
std::vector<std::string> split_csv(std::string_view line);
// The cells of a further row: only a comma in quotes belongs to a cell (RFC 4180).
std::vector<std::string> csv_cells(std::string_view line);

}  // namespace anholon

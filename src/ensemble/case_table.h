// A table of cases: the names of what varies in its first line, a case in each further one.
//
// The text is kept as it was read, and a cell becomes a number when its case is computed, so many rows need little
// memory.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "numeric/rational.h"

namespace anholon {

class CaseTable {
 public:
  // `text`: the text of a CSV file. `file` names the table in messages. Empty lines are skipped. Throws MistakeInWord
  // if there is no header, no row, or a line whose number of cells differs from that of the header.
  //
  // The text may be the table of a sweep: the columns from "outcome" on are the results of its cases and are left out,
  // and "(0)" after the name of an initial value, too. Throws MistakeInWord if there is a column "case_name".
  CaseTable(std::string text, std::string file);

  // Checks the column "case", which numbers the cases in the table of a sweep and varies nothing. Throws
  // MistakeInWord if a cell of the column is not a whole number or is one of these names of scenarios, if the model
  // gives the name "case" to something that may vary (`varies`), and if the table has no other column.
  void must_number_cases(const std::vector<std::string>& scenarios, bool varies) const;
  const std::vector<std::string>& names() const { return names_; }
  std::size_t rows() const { return lines_.size(); }
  // The cells of a row, in the order of the names.
  std::vector<std::string> cells(std::size_t row) const;
  // Throws MistakeInWord that marks a cell of a row, or of the header, by its place among the names.
  [[noreturn]] void mistake(std::size_t row, std::size_t column, const std::string& message,
                            const std::string& hint) const;
  [[noreturn]] void mistake_in_header(std::size_t column, const std::string& message, const std::string& hint) const;

 private:
  std::string_view line(std::size_t begin) const;
  [[noreturn]] void mistake_at(std::size_t begin, std::size_t cell, const std::string& message,
                               const std::string& hint) const;

  std::string text_, file_;
  std::size_t header_ = 0;          // the begin of the line of the header
  std::vector<std::size_t> lines_;  // the begins of the lines of the rows
  std::vector<std::string> names_;
  std::vector<std::size_t> places_;    // the places of the names among the cells of a line
  std::optional<std::size_t> number_;  // the place of a column "case"
};

// Returns the text of a table from the bytes of its file, CSV or Parquet. Throws Failure without a place, which names
// the file, if the table of a Parquet file cannot be read.
std::string text_of_case_table(std::string bytes, const std::string& file);

}  // namespace anholon

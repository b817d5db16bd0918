// Rows of numbers, and the interface that takes them: the columns once, then row by row.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "result/columns.h"

namespace anholon {

// One row of a run: a double for every column. A number wider than a double, or a time that is printed as given, has
// its digits beside it.
struct Row {
  std::span<const double> values;
  // Texts of the first columns; for an empty text, and for every further column, number_text(value) is written.
  std::span<const std::string> texts = {};
};
// Appends the number of column k in its written form.
void append_number(std::string& to, const Row& row, std::size_t k);
// Writes the numbers with a comma between two of them to `to`, which has room for `room_for(row)` characters; returns
// the end of the text.
std::size_t room_for(const Row& row);
char* write_numbers(char* to, const Row& row);

class RowSink {
 public:
  virtual ~RowSink() = default;
  // Called once, before the first row.
  virtual void columns(const std::vector<RunColumn>& columns) = 0;
  virtual void row(const Row& row) = 0;
  // Called when an accepted step of the motion ends at t.
  virtual void step(double) {}
};

// Passes rows to two sinks.
class TwoSinks final : public RowSink {
 public:
  TwoSinks(RowSink& first, RowSink& second) : first_(first), second_(second) {}
  void columns(const std::vector<RunColumn>& columns) override { first_.columns(columns), second_.columns(columns); }
  void row(const Row& row) override { first_.row(row), second_.row(row); }
  void step(double t) override { first_.step(t), second_.step(t); }

 private:
  RowSink &first_, &second_;
};

}  // namespace anholon

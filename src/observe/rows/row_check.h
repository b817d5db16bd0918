// Whether the numbers that a kernel writes into rows are those of the state solved for again in long double, but for
// round-off: at the rows at which the residual report looks.
//
// The difference of a column is measured by the greatest number of its kind so far; those of accelerations, multipliers,
// inputs and reactions, which come from one linear system, by the greatest of all of them, times what Newton's law loses
// by cancellation. Noise of doubles is no difference, nor is what the round-off of the state makes of a column: the
// direction of a slip that is about to vanish, for example.  (theory: certificate)
#pragma once
#include <map>
#include <optional>

#include "observe/rows/row_values.h"

namespace anholon {

struct RowDifference {
  std::string column;
  double difference = 0, t = 0;  // in relation to the measure of the column; when it was met
};

// A row by the kernel and by the reference.
struct RowTwice {
  double t = 0;
  std::vector<double> written;      // the numbers of the columns after t
  std::vector<long double> solved;  // those of the reference
  double cancellation = 1;          // the size of what the terms of Newton's law are made of, by their own
  std::vector<double> made_of;      // the same of each monitor, not divided
};

class RowCheck {
 public:
  explicit RowCheck(std::vector<RunColumn> columns) : columns_(std::move(columns)) {}

  // Returns whether a difference of the row is larger than round-off; the numbers that follow are measured by its, too.
  bool doubts(const RowTwice& row);
  // Counts the differences of a row. `of_state`: by how much the round-off of the state changes each column, infinite
  // if the column may lose its value; empty if it does not.
  void count(const RowTwice& row, const std::vector<double>& of_state);
  // The largest difference, if it is no round-off.
  std::optional<RowDifference> found() const;

 private:
  double difference(const RowTwice& row, std::size_t column) const;

  std::vector<RunColumn> columns_;
  std::map<ColumnKind, double> greatest_;  // of a kind; of all that is solved for under the kind of accelerations
  struct {
    double difference = 0, t = 0;
    std::size_t column = 0;
  } worst_;
};

}  // namespace anholon

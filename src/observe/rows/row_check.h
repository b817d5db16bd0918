// Checks whether the numbers that a kernel writes into rows agree, up to round-off, with those of the state solved for
// again in long double, at the rows that the residual report uses.
//
// The difference of a column is relative to the greatest number of its kind so far; for accelerations, multipliers,
// inputs and reactions, which come from one linear system, relative to the greatest of all of them, times the
// cancellation in Newton's law. The noise of doubles does not count, and neither does the effect of the state's
// round-off on a column: for example on the direction of a slip that is about to vanish (theory: certificate).
#pragma once
#include <map>
#include <optional>

#include "observe/rows/row_values.h"

namespace anholon {

struct RowDifference {
  std::string column;
  double difference = 0, t = 0;  // relative to the measure of the column; the time of the difference
};

// A row by the kernel and by the reference.
struct RowTwice {
  double t = 0;
  std::vector<double> written;      // the numbers of the columns after t
  std::vector<long double> solved;  // those of the reference
  double cancellation = 1;          // the size of what the terms of Newton's law are made of, relative to the terms
  std::vector<double> made_of;      // the size of what each monitor is made of
};

class RowCheck {
 public:
  explicit RowCheck(std::vector<RunColumn> columns) : columns_(std::move(columns)) {}

  // Returns true if a difference of the row is larger than round-off; the row's numbers also become part of the
  // measure.
  bool doubts(const RowTwice& row);
  // Counts the differences of a row. `of_state`: the change of each column by the state's round-off, infinite if the
  // column may lose its value; empty if that has no effect.
  void count(const RowTwice& row, const std::vector<double>& of_state);
  // The largest difference; nullopt if it is round-off.
  std::optional<RowDifference> found() const;

 private:
  double difference(const RowTwice& row, std::size_t column) const;

  std::vector<RunColumn> columns_;
  std::map<ColumnKind, double> greatest_;  // of a kind; all solved numbers belong to the kind of accelerations
  struct {
    double difference = 0, t = 0;
    std::size_t column = 0;
  } worst_;
};

}  // namespace anholon

// Whether the numbers that a kernel writes into rows are those of the state solved for again in long double, but for
// round-off: at the rows at which the residual report looks.
//
// The difference of a column is measured by the greatest number of its kind so far; those of accelerations, multipliers,
// inputs and reactions, which come from one linear system, by the greatest of all of them, times what Newton's law loses
// by cancellation. Noise of doubles is no difference.  (theory: certificate)
#pragma once
#include <map>
#include <optional>

#include "observe/rows/row_values.h"

namespace anholon {

struct RowDifference {
  std::string column;
  double difference = 0, t = 0;  // in relation to the measure of the column; when it was met
};

class RowCheck {
 public:
  explicit RowCheck(std::vector<RunColumn> columns) : columns_(std::move(columns)) {}

  // `written`: the numbers of the columns after t; `solved`: those of the reference. `cancellation`: the size of what
  // the terms of Newton's law are made of, by their own; made_of(i): the same of monitor i, not divided.
  template <class MadeOf>
  void see(double t, const std::vector<double>& written, const std::vector<long double>& solved, double cancellation,
           MadeOf made_of) {
    learn(solved);
    for (std::size_t j = 0; j < columns_.size(); ++j) {
      const double own = columns_[j].kind == ColumnKind::monitor ? made_of(columns_[j].index) : 0;
      compare(t, j, written[j], solved[j], cancellation, own);
    }
  }
  // The largest difference, if it is no round-off.
  std::optional<RowDifference> found() const;

 private:
  void learn(const std::vector<long double>& solved);
  void compare(double t, std::size_t column, double written, long double solved, double cancellation, double own);

  std::vector<RunColumn> columns_;
  std::map<ColumnKind, double> greatest_;  // of a kind; of all that is solved for under the kind of accelerations
  struct {
    double difference = 0, t = 0;
    std::size_t column = 0;
  } worst_;
};

}  // namespace anholon

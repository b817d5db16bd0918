// A row of a run in long double, computed again from its state in quadruple precision.
//
// Where terms of a formula cancel, the round-off of long double may exceed that of a double. Two runs that compute such a
// formula in long double at the same time round its terms alike, so their difference does not show it.
#pragma once
#include "observe/rows/row_values.h"

namespace anholon {

class QuadRow {
 public:
  // `stages`: the number of orders beyond the leading derivatives that rows show. `highest`: see columns_after_time().
  QuadRow(Workspace& scenario, int highest, int stages);
  // Solves the equations at the state of a point, which has been prepared and solved; false if they have no solution
  // there.
  bool solve(const Expansion<long double>& point);
  // Then the numbers of the columns after t; false, and no numbers, if they have no values.
  bool values(std::vector<long double>& values);
  // By how much the leading derivative of each unknown is another one than at the point.
  const std::vector<double>& leading_differences() const { return differences_; }

 private:
  Workspace& s_;
  int highest_, stages_;
  std::vector<Quad> parameters_;
  std::optional<Expansion<Quad>> here_;
  std::vector<double> differences_;
  std::optional<RowOutputs<Quad>> outputs_;
};

}  // namespace anholon

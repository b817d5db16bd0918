// A row of a run in long double, computed again from its state in quadruple precision.
//
// If terms of a formula cancel, the round-off of long double may exceed that of a double. Two runs that compute such a
// formula in long double at the same time round its terms alike, so their difference does not show the round-off.
#pragma once
#include "observe/rows/row_values.h"

namespace anholon {

class QuadRow {
 public:
  // `stages`: the number of orders beyond the leading derivatives in rows. `highest`: see columns_after_time().
  QuadRow(Workspace& scenario, int highest, int stages);
  // Solves the equations at the state of a point, which has been prepared and solved. Returns false if they have no
  // solution there.
  bool solve(const Expansion<long double>& point);
  // Computes the numbers of the columns after t. Returns false, without numbers, if they have no values. REQUIRES:
  // solve() has succeeded.
  bool values(std::vector<long double>& values);
  // The differences of the leading derivatives from those at the point, for each unknown.
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

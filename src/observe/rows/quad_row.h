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
  // The numbers of the columns after t at the state of a point; false, and no numbers, if the equations have no
  // solution there.
  bool see(const Expansion<long double>& point, std::vector<long double>& values);

 private:
  Workspace& s_;
  int highest_, stages_;
  RowOutputs<Quad> outputs_;
};

}  // namespace anholon

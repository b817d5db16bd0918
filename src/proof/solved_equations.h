// Equations that are solved one after the other for one of some symbols, and expressions with the solutions
// substituted.
#pragma once
#include <optional>

#include "expr/diff.h"

namespace anholon {

class SolvedEquations {
 public:
  // Solves psi = 0, with the solutions so far substituted, for one of `open` in which it is affine or quadratic, and
  // removes this symbol from `open`. Returns false if this is impossible, or if there are too many branches.
  bool add(Expr psi, Column& open);
  bool empty() const { return symbols_.empty(); }
  // Returns the number of nodes of the solutions.
  std::size_t size() const { return reachable(values_).size(); }
  // Returns e with the solutions substituted, on each branch of the quadratic equations; empty if they have no value.
  Column branches(Expr e) const;

 private:
  Column symbols_, values_;  // the solutions
  Column signs_;             // symbols in the values that represent 1 or -1
};

}  // namespace anholon

// Equations that are solved one after the other for one of some symbols, and expressions with the solutions put in.
#pragma once
#include <optional>

#include "expr/diff.h"

namespace anholon {

class SolvedEquations {
 public:
  // Solves psi = 0, with the solutions so far put in, for one of `open`, in which it is affine or quadratic, and takes this one out
  // of `open`. Returns false if it cannot, or if there are too many branches.
  bool add(Expr psi, Column& open);
  bool empty() const { return symbols_.empty(); }
  // e with the solutions put in, on each branch of the quadratic equations; none if they have no value.
  Column branches(Expr e) const;

 private:
  Column symbols_, values_;  // the solutions
  Column signs_;             // symbols in the values that stand for 1 or -1
};

}  // namespace anholon

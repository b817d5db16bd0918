// Groups sums of monomials: searches for the shortest arrangement with common factors in front, factors from FLINT, and
// equal coefficients gathered.
#pragma once
#include "expr/monomial_sums.h"
#include "print/print.h"

namespace anholon::arrangement {

struct Grouped {
  Expr e;
  std::size_t length;  // an estimate, in print
};
Grouped grouped(const Written& w, const SymbolNames& names);

}  // namespace anholon::arrangement

// Monomials: the terms of polynomials over Q, without the ring in which they are computed.
#pragma once
#include <vector>

#include "numeric/rational.h"

namespace anholon {

// A sum of monomials c g1^e1 g2^e2 … in generators (symbols, functions, roots).
struct Monomial {
  Rational coefficient;
  std::vector<unsigned long> exponents;
};
using Monomials = std::vector<Monomial>;

}  // namespace anholon

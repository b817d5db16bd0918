// The exact zero test: an expression is brought to a fraction of polynomials over Q in
//   symbols, sin and cos (tan = sin/cos) of independent angles, roots, exponentials and other functions,
// reduced by sin^2 + cos^2 = 1 and root^2 = radicand. Angle sums and multiples are expanded.
//
// "Zero" is a proof: each step is an identity wherever all parts of the expression are defined.
// "Not shown" says nothing; a fraction that stays may still vanish by a relation that is not known
// here (or the polynomials grew beyond the term limit).
#pragma once
#include <optional>

#include "expr/expr.h"

namespace anholon {

bool proved_zero(Expr e);

// The same expression written out as a reduced sum of monomials (over a denominator, where it has
// one); nothing if that leads beyond the term limit. Equal to e wherever e is defined.
std::optional<Expr> expanded(Expr e);

// A product of polynomials with more terms than this ends the test without a result.
inline constexpr long kNormalTermLimit = 2'000'000;

}  // namespace anholon

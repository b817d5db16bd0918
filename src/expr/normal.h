// The exact zero test: an expression is brought to a fraction of polynomials over Q in
//   symbols, sin and cos (tan = sin/cos) of independent angles, roots, exponentials and other functions,
// reduced by sin^2 + cos^2 = 1 and root^2 = radicand. Angle sums and multiples are expanded.
//
// "Zero" is a proof: each step is an identity wherever all parts of the expression are defined. "Not shown" proves
// nothing: a fraction that remains may still vanish by a relation that is not known here, or the polynomials exceeded
// the term limit.
#pragma once
#include <optional>
#include <unordered_map>

#include "expr/expr.h"
#include "expr/monomial.h"

namespace anholon {

bool proved_zero(Expr e);

// Writes e as a reduced sum of monomials (over a denominator, if it has one). Returns nullopt if that exceeds the term
// limit or `most_work` products of terms. Equal to e wherever e is defined.
std::optional<Expr> expanded(Expr e);
std::optional<Expr> expanded(Expr e, long most_work);

struct NormalForm {
  std::vector<Expr> generators;                             // the expression of each generator
  std::vector<std::pair<std::size_t, std::size_t>> angles;  // generators that are sine and cosine of one angle
  Monomials numerator, denominator;                         // in lowest terms, if short
};

// The subexpressions that stay as the user wrote them: sines of sums (and tangents), denominators, named
// subexpressions.
struct Whole {
  bool angles = false, fractions = false;
  const std::unordered_map<NodeId, std::string>* names = nullptr;
};

// Returns the expression as a fraction; nullopt if that takes more than `most_work` products of terms.
std::optional<NormalForm> normal_form(Expr e, const Whole& whole, long most_work);

Expr expression(const Monomials& terms, const std::vector<Expr>& generators);
// Returns the fraction as an expression; nullopt if it is too long to be read.
std::optional<Expr> expression(const NormalForm& f);

}  // namespace anholon

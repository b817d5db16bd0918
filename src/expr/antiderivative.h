// Elementary antiderivatives, for integrals of constraints: a small table and the rule "the derivative divides".
//
//   of each term c w^k w' :    c w^(k+1)/(k+1),  c log w
//   of each term c f(u)^k u' : the table of elementary functions f
//   of c/(a z^2 + b) :         the arc tangent
//   of z^n g(z) :              by parts, if g is in the table
//
// Each result is differentiated again and proved equal. nullopt means that the integral is not in the table; it may
// exist nevertheless.
#pragma once
#include <optional>

#include "expr/diff.h"

namespace anholon {

// Returns F with dF/dz = e, all other symbols held.
std::optional<Expr> antiderivative(Expr e, Expr z);

// Returns f with df/dz_a = form_a for all a; nullopt if there is none (the form is not closed) or f is not elementary.
std::optional<Expr> potential(const Column& form, const Column& z);

// Returns exp(e), with logarithms in e turned into powers: exp(2*log(x) - y) is x^2*exp(-y).
Expr exponential(Expr e);

}  // namespace anholon

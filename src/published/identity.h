// Identities: equations that hold for every motion, such as definitions of quantities: T_r = m/2*x'^2, acc(P,
// inertial).x = x'' - w^2*x.
//
// A change that turns a false equation into an identity is the misprint only if the equation was meant as one. m*x'' =
// m*a, with x'' for a, is an identity without content. An equation is meant as an identity if
//   it contains a quantity that is derived from the model (a word of the vocabulary, a velocity, a vector, a definition), or
//   it contains neither accelerations nor multipliers, the unknowns of equations of motion;
// and its sides are neither literally equal, nor names of two forces that are both zero.
#pragma once
#include "published/vocabulary.h"
#include "tape/point.h"

namespace anholon {

// Returns a divisor in s that is 0 at these points of the motion, as written; empty if there is none.
std::string vanishing_divisor(const Syntax& s, Vocabulary& words, std::vector<PointValues>& points);

bool speaks_of_quantities(const Syntax& s, Vocabulary& words);
// True if both sides are equal once rates replace the derivatives of states, and not before.
bool holds_by_rates(const Syntax& left, const Syntax& right, Vocabulary& words);
// True if an equation is meant to hold for every motion.
bool meant_as_identity(const Syntax& left, const Syntax& right, Vocabulary& words);

}  // namespace anholon

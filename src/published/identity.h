// Equations that hold whatever the motion, as those say what a quantity is: T_r = m/2*x'^2, acc(P, inertial).x = x'' -
// w^2*x.
//
// A change that turns a false equation into an identity is the misprint only if the equation was meant as one. m*x'' =
// m*a, with x'' for a, is an identity, and says nothing. An equation is meant as an identity if
//   a quantity that is derived from the model stands in it (a word of the vocabulary, a velocity, a vector, a definition), or
//   neither accelerations nor multipliers stand in it: these are what equations of motion are about;
// and its sides are not the same word for word, nor words for two forces that are both zero.
#pragma once
#include "published/vocabulary.h"

namespace anholon {

bool speaks_of_quantities(const Syntax& s, Vocabulary& words);
// Of an equation that holds whatever the motion.
bool meant_as_identity(const Syntax& left, const Syntax& right, Vocabulary& words);

}  // namespace anholon

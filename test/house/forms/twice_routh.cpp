// A form that only a test adds: Routh's equations, both sides doubled.
#include "formulation/formulation.h"

namespace anholon::forms {

static Equations equations(const Mechanics& M, const Elimination&) {
  return {Rational(2) * lagrange_operator(M), Rational(2) * right_side(M)};
}

extern const Formulation twice_routh;
const Formulation twice_routh{
    "twice-routh", "Routh's equations, doubled", "", "a test", Unknowns::multipliers, no_obstacle, equations};

}  // namespace anholon::forms

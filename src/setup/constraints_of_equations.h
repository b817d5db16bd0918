// The constraints that take part in equations that are derived and compared, but not integrated.
//
// Rows of dphi/dq^(m) that are independent at a generic point may be dependent on the manifold of the constraints, as
// those of a platform on three parallel legs. A point of the manifold decides: the consistent start of the model.
#pragma once
#include "setup/eliminate.h"

namespace anholon {

struct ConstraintsOfEquations {
  std::vector<std::size_t> taken;     // ascending, independent
  std::vector<std::size_t> left_out;  // ascending; they follow from `taken` on the manifold near the state
  FullRank full_rank = FullRank::here;
};

// Chooses among `all`. If their rows are dependent at the state, the same ones are left out as in a motion, provided
// that they follow from the others at all states near it. At a singular state, and for constraints that are dependent
// everywhere, rows that are independent at a generic point take part. `state`: consistent, or empty if the model has no
// consistent start.
ConstraintsOfEquations constraints_of_equations(const Mechanics& mechanics, const std::vector<std::size_t>& all,
                                                const std::vector<double>& parameters,
                                                const InitialState<double>& state);

}  // namespace anholon

// Which coordinates are eliminated, and which quasi-velocities take their place (theory: elimination).
#pragma once
#include "formulation/formulation.h"
#include "structure/consistent.h"

namespace anholon {

// Values of symbols at the state; what the state does not say (higher derivatives, multipliers) is pseudo-random.
PointValues values_near(const Model& model, const std::vector<double>& parameters, const InitialState<double>& state);

// Those of the constraints that are independent at the point; at a singular state those that are elsewhere.
std::vector<std::size_t> independent_rows(const Mechanics& mechanics, const std::vector<std::size_t>& constraints,
                                          PointValues& at);

// The dependent coordinates: those asked for, or those of the model, or those whose columns of dphi/dq^(m), in the
// metric of the masses, are the best pivots at the point. The quasi-velocities: those of the model, completed by
// velocities of coordinates where they are fewer than n - s. Throws Failure if the coordinates asked for cannot be
// eliminated, or the quasi-velocities are too many or dependent.
EliminationChoice choose_elimination(const Mechanics& mechanics, const std::vector<std::size_t>& constraints,
                                     Unknowns unknowns, const std::vector<std::size_t>& wanted, PointValues& at);

// The elimination that a form wants, for its equations alone, near the state in which a motion starts. It does not need
// a consistent state. `m`: the order asked for, no less than that of any constraint or quasi-velocity; 0: the highest of these.
Elimination elimination_for(const Mechanics& mechanics, Unknowns unknowns, const std::vector<StateOverride>& overrides,
                            const std::vector<std::size_t>& wanted, bool solve = true, unsigned m = 0);
// One by coordinates, of the constraints that ideal reactions keep: their multipliers follow from the equations of its
// dependent coordinates.
Elimination elimination_of_reactions(const Mechanics& mechanics, const std::vector<StateOverride>& overrides,
                                     const std::vector<std::size_t>& wanted);

}  // namespace anholon

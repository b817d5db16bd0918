// The choice of the coordinates that are eliminated, and of the quasi-velocities that replace them (theory:
// elimination).
#pragma once
#include "formulation/formulation.h"
#include "structure/consistent.h"

namespace anholon {

// Returns values of symbols at the state; values that the state lacks (higher derivatives, multipliers) are
// pseudo-random. Inputs whose formula is a number have this value.
PointValues values_near(const Model& model, const std::vector<double>& parameters, const InitialState<double>& state);
// Returns the function behind `values_near`.
std::function<double(const Node&)> symbol_near(const Model& model, const std::vector<double>& parameters,
                                               const InitialState<double>& state);

// Returns dphi/dq^(m) of these constraints.
Matrix<double> constraint_matrix(const Mechanics& mechanics, const std::vector<std::size_t>& constraints,
                                 PointValues& at);

// Returns the constraints that are independent at the point; at a singular state, those that are independent elsewhere.
std::vector<std::size_t> independent_rows(const Mechanics& mechanics, const std::vector<std::size_t>& constraints,
                                          PointValues& at);

// Returns the dependent coordinates: the wanted ones, else those of the model, else those whose columns of dphi/dq^(m),
// in the metric of the masses, are the best pivots at the point; and the quasi-velocities: those of the model,
// completed by velocities of coordinates if they are fewer than n - s. Throws Failure if the wanted coordinates cannot
// be eliminated, or the quasi-velocities are too many or dependent.
EliminationChoice choose_elimination(const Mechanics& mechanics, const std::vector<std::size_t>& constraints,
                                     Unknowns unknowns, const std::vector<std::size_t>& wanted, PointValues& at);

// Returns the elimination that a form needs, for equations that are not integrated, near the state in which a motion
// starts. The state need not be consistent. `m`: the requested order, no less than that of any constraint or
// quasi-velocity; 0: the highest of these. `starting`: the model whose initial state is taken, if inputs of the
// mechanics' own model are open; the models differ in nothing else.
Elimination elimination_for(const Mechanics& mechanics, Unknowns unknowns, const std::vector<StateOverride>& overrides,
                            const std::vector<std::size_t>& wanted, bool solve = true, unsigned m = 0,
                            const Model* starting = nullptr);
// Returns an elimination by coordinates, of the constraints that ideal reactions keep: their multipliers follow from
// the equations of its dependent coordinates.
Elimination elimination_of_reactions(const Mechanics& mechanics, const std::vector<StateOverride>& overrides,
                                     const std::vector<std::size_t>& wanted);

}  // namespace anholon

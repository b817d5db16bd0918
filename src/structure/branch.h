// The leading derivatives at a state in which they enter nonlinearly: all solutions found from several starts.
#pragma once
#include <functional>

#include "structure/stage.h"
#include "structure/structure.h"

namespace anholon {

// True if a constraint of order 2 or more is nonlinear in its highest derivatives: its equations may have several
// solutions.
bool may_branch(const Mechanics& m, const System& s, std::size_t constraint);
// Returns the leading derivatives of coordinates in which a given force is nonlinear: the equations of motion may have
// several solutions for them. `d`: the orders of the leading derivatives, 2 for a coordinate with inertia.
Column nonlinear_in_forces(const Mechanics& m, const std::vector<int>& d);
// True if there is such a constraint or such a force.
bool may_branch(const Mechanics& m, const System& s, const Structure& t);

template <Number N>
struct LeadingSolutions {
  // x_j^(d_j) in the order of the system's variables. Solutions are sorted by their distance from the guess: in the mass
  // norm, or, where forces alone are nonlinear, in the derivatives in which they are. Of two equally near solutions the
  // one with the larger multipliers comes first.
  std::vector<std::vector<N>> found;
  bool singular = false;  // a start led to a point at which the equations do not determine the motion
};

// Returns equation i of the system, differentiated k times.
StageEquation law(const System& s, std::size_t i, unsigned k);
// True for a state of the model of which the structure asks for a derivative beyond its rate. The start holds none: it
// follows from the formula of the rate, which is substituted.
bool leads_beyond_rate(const System& s, const Structure& t, std::size_t variable);
// These return the equations of motion, constraints and rates of states, each differentiated as often as the structure
// requires, and the unknowns for which they are solved.
std::vector<StageEquation> leading_equations(const System& s, const Structure& t);
Column leading_unknowns(const System& s, const Structure& t);

// Tells whether a solution is acceptable.
template <Number N>
using MayBeTaken = std::function<bool(const std::vector<N>&)>;

// Solves for the leading derivatives. `state` holds the state and, as leading derivatives, a guess: that of the user,
// or zeros. Zeros are replaced by the accelerations without the nonlinear constraints, if these are of order 2. The
// search tries more starts as long as it has found no solution that is `wanted`.
template <Number N>
LeadingSolutions<N> leading_solutions(const Mechanics& m, const System& s, const Structure& t,
                                      const std::vector<N>& parameters, InitialState<N> state,
                                      const MayBeTaken<N>& wanted);

}  // namespace anholon

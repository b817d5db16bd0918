// The accelerations of bodies whose contacts touch, by Gauss' principle of least constraint with friction (theory:
// contact, (co.2)).
//
// If the loads N are known, those accelerations minimize
//   1/2 (x - x0)^T A (x - x0) + sum mu N |t x + t0|,
// a convex function, in which x0 are the accelerations without friction. So they are found without trying modes, even
// if many contacts begin to slip, and slowly. The loads that follow from the accelerations are inserted until they do
// not change.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Returns the modes of contacts of which these touch and the others are open: which contacts stick, and which slip,
// with their directions. The modes are near a solution and have to be judged like others. Returns nullopt if fewer than
// two contacts at rest have friction, if the loads do not settle, or if one of them pulls.
std::optional<ContactModes> modes_of_least_constraint(const ContactProblem& problem, const std::vector<bool>& touches);

}  // namespace anholon

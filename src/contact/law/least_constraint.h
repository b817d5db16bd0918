// The accelerations of bodies whose contacts touch, by Gauss' principle of least constraint with friction (theory: contact,
// (co.2)).
//
// Where the loads N are known, those accelerations are the least of
//   1/2 (x - x0)^T A (x - x0) + sum mu N |t x + t0|,
// a convex function, in which x0 are the accelerations without friction. So they are found without trying modes, however many
// contacts begin to slip, and however slowly. The loads that follow from them are put in until they no longer change.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// The modes of contacts of which these touch and the others are open: what sticks, and with its direction what slips. They are
// near a solution and are to be judged as others are. Returns nullopt if fewer than two contacts at rest have friction, if the
// loads do not settle, or if one of them pulls.
std::optional<ContactModes> modes_of_least_constraint(const ContactProblem& problem, const std::vector<bool>& touches);

}  // namespace anholon

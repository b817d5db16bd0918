// Finds the directions of slips that begin, in two components.
#pragma once
#include "contact/law/mode_equations.h"
#include "contact/law/rows.h"

namespace anholon {

// The rate of a slip velocity with these accelerations.
std::array<long double, 2> slip_rate(const ContactRows& rows, const ContactNumbers& x);

// Returns the solution of modes in which the directions of slips that begin are those of the slip rates that follow
// from them: a fixed point. `free`: the size of the accelerations without contacts; a rate that is round-off of this
// size has no direction, and the first guess stays. Returns nullopt if no directions are found.
std::optional<ContactSolution> with_directions(const ContactProblem& problem, ContactModes modes, long double free);

}  // namespace anholon

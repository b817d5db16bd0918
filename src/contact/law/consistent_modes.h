// Finds the modes of the contacts that are consistent at a state, for accelerations or for impulses (theory: contact).
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Returns the consistent modes with different motions. Of modes that give the same x, one is returned.
std::vector<ContactSolution> consistent_modes(const ContactProblem& problem);
// Returns the solution of these modes, whether or not there are others; nullopt if they are not consistent.
std::optional<ContactSolution> consistent_in(const ContactProblem& problem, const ContactModes& modes);

}  // namespace anholon

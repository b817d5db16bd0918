// Which modes of the contacts are consistent at a state, on the level of accelerations or of impulses (theory: contact).
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// The consistent modes whose accelerations differ. Modes that give the same x are one; the first of them touches most.
std::vector<ContactSolution> consistent_modes(const ContactProblem& problem);

}  // namespace anholon

// Divides contacts into groups that have no effect on each other, as those of bodies that nothing joins.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Returns a number for each contact. Contacts with different numbers act on coordinates that neither masses nor
// constraints nor further contacts join.
std::vector<std::size_t> contact_groups(const ContactProblem& problem);

}  // namespace anholon

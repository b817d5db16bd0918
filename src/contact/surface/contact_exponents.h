// Whole exponents in the formulas of contacts.
#pragma once
#include "modelfile/contacts.h"
#include "setup/scenario.h"

namespace anholon {

// Returns the contacts with formulas in the graph of a workspace. Exponents of parameters that are whole numbers are
// replaced by their values, as in the equations (model/exponents.h).
std::vector<Contact> with_whole_exponents(Workspace& workspace, const std::vector<Contact>& contacts);
// Fails if a gap touches zero and does not pass it with the values of the parameters, for which the reader does not look.
Outcome all_pass_zero(const Model& model, const std::vector<Contact>& contacts);

}  // namespace anholon

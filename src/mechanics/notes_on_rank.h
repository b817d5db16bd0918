// What a reader of equations needs to know about the constraints that they use.
#pragma once
#include "mechanics/elimination.h"

namespace anholon {

// Returns sentences about constraints that an elimination leaves out, and about a rank that is not known to be full;
// empty if there is nothing to tell.
std::vector<std::string> notes_on_rank(const Model& model, const Elimination& e);

}  // namespace anholon

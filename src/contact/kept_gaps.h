// Finds closed contacts whose gaps the constraints of the model keep as they are: such a contact never opens, and it
// carries nothing, because the constraints exert the force in its place.
//
//   d gap/dt = sum c_r phi_r'   for all velocities, with phi_r itself for constraints of velocities
//
// The rows of both sides are compared at the start, and at other places and times that satisfy the geometric
// constraints; each row has a column for the time, so that motions which constraints prescribe open a gap.
#pragma once
#include "base/outcome.h"
#include "contact/touching_bodies.h"

namespace anholon {

// Fails at the start of a motion with such a contact. `bodies` has been looked at.
Outcome kept_by_constraints(Workspace& s, const TouchingBodies& bodies);
// The same for the contacts of a model, at the start of its motions. Models whose motions with contacts are refused for
// other reasons are not examined.
Outcome kept_by_constraints(const Scenario& s, const std::vector<Contact>& contacts);

}  // namespace anholon

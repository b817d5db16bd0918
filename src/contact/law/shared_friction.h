// Friction of contacts at rest on bodies that join them: two feet of a block, the wheels of an axle.
//
// Their slip velocities depend on each other, so that the motion determines the sum of their friction and not each part
// (theory: contact). They stick as long as some distribution lies in all cones |T| <= mu N. The one that is taken is
// that of equal creep, T proportional to mu N where all would slip alike; where it leaves a cone, it is the one that spares
// most of them.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Whether the gaps of contacts that may touch depend on each other in these coordinates: then the loads of each, which bound
// its friction, are not determined.
bool loads_undetermined(const ContactProblem& problem);

// Marks the components of friction whose slip velocities follow from the constraints, the gaps and the components before
// them, and gives each its part of the forces that hold (ContactMode::shares).
void share_friction(const ContactProblem& problem, ContactModes& modes);

// The solution of modes that share friction with the distribution above, and what it spares. Returns nullopt if the
// equations are singular.
std::optional<ContactSolution> distributed(const ContactProblem& problem, const ContactSolution& equal);

}  // namespace anholon

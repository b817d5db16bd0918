// Friction of contacts at rest on bodies that join them: two feet of a block, the wheels of an axle.
//
// Their slip velocities depend on each other, so that the motion determines the sum of their friction and not each part
// (theory: contact). They stick as long as some distribution lies in all cones |T| <= mu N. The one that is taken is
// that of equal creep, T proportional to mu N where all would slip alike; where it leaves a cone, it is the one that spares
// most of them.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Marks the gaps and the components of friction whose rates follow from the constraints and from those before them, and gives
// each its part of the forces that hold: to gaps the least loads, to friction its part by equal creep.
void share_forces(const ContactProblem& problem, ContactModes& modes);

// The solution of modes that share friction with the distribution above, and what it spares. Returns nullopt if the
// equations are singular.
std::optional<ContactSolution> distributed(const ContactProblem& problem, const ContactSolution& equal);

}  // namespace anholon

// Forces of contacts on bodies that join them: four feet of a box, two feet of a block, the wheels of an axle.
//
// Where their gaps depend on each other, the motion determines sums of loads and not each load; the least ones are taken.
// Where the slip velocities of contacts at rest do, the same holds for their friction (theory: contact, (co.3)). They stick as
// long as some distribution lies in all cones |T| <= mu N. The one that is taken is that of equal creep,
// T proportional to mu N where all would slip alike; where it leaves a cone, it is the one that spares most of them.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Marks the gaps and the components of friction whose rates follow from the constraints and from those before them, and gives
// each its part of the forces that hold: to gaps the least loads, to friction its part by equal creep.
void share_forces(const ContactProblem& problem, ContactModes& modes);

// The size of the part of the loads of these contacts that exerts nothing along their gaps, which is zero for the least loads.
long double load_without_effect(const ContactProblem& problem, const std::vector<std::size_t>& contacts,
                                const ContactSolution& solution);

// The solution of modes that share friction with the distribution above, and what it spares. Returns nullopt if the
// equations are singular.
std::optional<ContactSolution> distributed(const ContactProblem& problem, const ContactSolution& equal);

}  // namespace anholon

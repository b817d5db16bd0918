// Distributes forces of contacts on bodies that they join: four feet of a box, two feet of a block, the wheels of an
// axle.
//
// If gaps depend on each other, the motion determines sums of loads and not each load; the least loads are taken. If
// the slip velocities of contacts at rest depend on each other, the same holds for their friction (theory: contact,
// (co.3)). They stick as long as some distribution lies in all cones |T| <= mu N. The distribution taken is that of
// equal creep, T proportional to mu N if all would slip alike; if it leaves a cone, it is the one with the largest
// spare part in all cones.
#pragma once
#include "contact/law/mode_equations.h"

namespace anholon {

// Marks the gaps and the components of friction whose rates follow from the constraints and from those before them, and
// gives each its share of the holding forces: to gaps the least loads, to friction its share by equal creep.
void share_forces(const ContactProblem& problem, ContactModes& modes);

// True if the constraints, the closed gaps and the contacts that stick keep the gap of an open contact.
bool others_keep_gap(const ContactProblem& problem, const ContactModes& modes, std::size_t contact);

// The size of the part of these contacts' loads that has no effect along their gaps; it is zero for the least loads.
long double load_without_effect(const ContactProblem& problem, const std::vector<std::size_t>& contacts,
                                const ContactSolution& solution);

// Returns the solution of modes that share friction with the distribution above, and its spare part. Returns nullopt if
// the equations are singular.
std::optional<ContactSolution> distributed(const ContactProblem& problem, const ContactSolution& equal);

}  // namespace anholon

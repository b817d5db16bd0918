// Refuses slip velocities that are not tangential to a contact.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

// Throws Failure, at the place of `along`, if a direction is known to have a part along the normal. A part that depends
// on parameters alone becomes an identity.
void check_tangential(const std::vector<Vector>& directions, const Vector& normal, const Model& model, Span along,
                      std::vector<Identity>& identities);

// Checks the same for the gap of a point with the velocity v: its normal is known if it is a fixed direction along
// which v opens the gap.
void check_tangential(std::vector<Vector> directions, Expr gap, const Vector& v, const Model& model, Span along,
                      std::vector<Identity>& identities);

// Throws Failure if a component of a slip velocity is not linear in the velocities, or is known to be along the normal.
// It is that if it is a multiple of the velocity of the gap by a constant, or by any factor if the bodies move along
// fixed directions. Warns if a component is that of bodies which move together without turning, along a direction with a part
// along the normal of a plane. The rows of gap and slip alone do not determine the angle between them: if bodies turn,
// the rows need not be at right angles, for example those of the tip of a rod.
void check_slips(Expr gap, const std::vector<Expr>& slip, const std::string& contact, Span place, const Model& model,
                 Diagnostics& diagnostics);

}  // namespace anholon

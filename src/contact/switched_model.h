// The model of given modes, in which a constraint with active = "…" either holds or is left out.
#pragma once
#include "contact/mode_model.h"

namespace anholon {

// Whether each of the constraints with `active` holds, by the values of the modes in the model: contacts[c].held.
std::vector<bool> constraints_that_hold(const Model& model, const std::vector<Contact>& contacts);

// Gives the modes of the model these values, one for each parameter of which those of modes count. The constraints that
// hold then stand behind all others; formulas with their forces have the multipliers, or zeros. Throws Failure if `active`
// has no value.
void put_modes(Model& model, const std::vector<Contact>& contacts, const std::vector<Rational>& modes);

}  // namespace anholon

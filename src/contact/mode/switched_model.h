// Makes the model of given modes, in which a constraint with active = "…" either holds or is left out.
#pragma once
#include "contact/mode/mode_model.h"

namespace anholon {

// Tells for each constraint with `active` whether it holds, by the values of the modes in the model: contacts[c].held.
std::vector<bool> constraints_that_hold(const Model& model, const std::vector<Contact>& contacts);

// Returns the parameters and modes whose values decide, by `active`, which constraints hold: those of the formulas, and
// those from which these follow.
std::vector<std::size_t> switching_parameters(const Model& model, const std::vector<Contact>& contacts);

// Puts the constraints that hold with the parameters of the model in place of those that it has: they come after all
// others; formulas with their forces get the multipliers, or zeros. Throws Failure if `active` has no value.
void put_constraints_that_hold(Model& model, const std::vector<Contact>& contacts);

// Sets the modes of the model to these values, one for each parameter, of which only those of modes count, and puts the
// constraints that hold then. Throws Failure if `active` has no value.
void put_modes(Model& model, const std::vector<Contact>& contacts, const std::vector<Rational>& modes);

}  // namespace anholon

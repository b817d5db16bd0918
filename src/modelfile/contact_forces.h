// The forces of contacts in formulas of a model.
#pragma once
#include <functional>

#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Substitutes the forces of contacts in a formula. If a quotient by a force that is zero has no value, the formula has
// none either: it is not a number.
Expr with_contact_forces(Graph& g, Expr formula, const std::function<Expr(const Node&)>& force);

// Finds the forces that monitors, outputs, rates of states and events contain, and replaces them by zeros in the model.
// Errors, also those of conditions, rates and values that contain a force, go to the diagnostics.
void settle_contact_forces(const Scope& scope, Model& model, std::vector<Contact>& contacts, Diagnostics& diagnostics);

}  // namespace anholon

// Sweeps of models with contacts: simulate_with_contacts computes each case separately.
#pragma once
#include "ensemble/case.h"
#include "modelfile/contacts.h"

namespace anholon {

// Makes the cases move with these contacts, if there are any; call it when all other options are set. Throws Failure
// for options that contacts do not support. The contacts have to outlive the options.
void move_with(const std::vector<Contact>& contacts, const Scenario& scenario, EnsembleOptions& options);

// Lets varied parameters switch constraints with `active`: each case has those that hold with its numbers. `model` is
// the one to which formulas of reductions belong. The contacts have to outlive the options.
void switch_with(const std::vector<Contact>& contacts, const Model& model, EnsembleOptions& options);

}  // namespace anholon

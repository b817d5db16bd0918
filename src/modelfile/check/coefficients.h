// Finds coefficients and sizes of contacts that have no meaning.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Reports coefficients that are negative, restitutions above 1, static friction below sliding friction, and sizes of
// shapes that are not positive, at the values of the parameters of the model; sizes that the corners of a box share are
// reported once. Throws Failure if a coefficient has no value.
std::vector<Diagnostic> wrong_coefficients(const std::vector<Contact>& contacts, const Model& model);

}  // namespace anholon

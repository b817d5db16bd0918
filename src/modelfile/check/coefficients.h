// Coefficients and sizes of contacts that have no meaning.
#pragma once
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// Coefficients that are negative, restitutions above 1, and sizes of shapes that are not positive, at the values of the
// parameters of the model; the corners of a box have theirs once. Throws Failure if a coefficient has no value.
std::vector<Diagnostic> wrong_coefficients(const std::vector<Contact>& contacts, const Model& model);

}  // namespace anholon

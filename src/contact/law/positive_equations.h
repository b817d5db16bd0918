// Linear equations with a matrix that is symmetric and positive, but for directions in which it is zero.
#pragma once
#include "contact/law/rows.h"

namespace anholon {

// The solution of H x = g whose components are zero where H, but for round-off, is.
ContactNumbers solve_positive(std::vector<ContactNumbers> H, ContactNumbers g);

}  // namespace anholon

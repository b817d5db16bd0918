// Linear equations with a positive semidefinite symmetric matrix.
#pragma once
#include "contact/law/rows.h"

namespace anholon {

// Returns the solution of H x = g whose components are zero in the directions in which H is zero up to round-off.
ContactNumbers solve_positive(std::vector<ContactNumbers> H, ContactNumbers g);

}  // namespace anholon

// [observer]: every accepted way of giving the moving frame, reduced to its spin omega and the
// inertial acceleration a0 of its origin, both in moving components (theory: forces).
#pragma once
#include <optional>

#include "modelfile/names/names.h"

namespace anholon {

void read_observer(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics);

// A function of t whose derivative is e (sums of constants, powers of t, and sin, cos, exp of arguments linear in t,
// times constants); nullopt if e is of another kind.
std::optional<Expr> antiderivative(Expr e);

}  // namespace anholon

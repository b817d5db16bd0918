// [observer]: every accepted way of giving the moving frame, reduced to its spin omega and the
// inertial acceleration a0 of its origin, both in moving components (theory: forces).
#pragma once
#include <optional>

#include "modelfile/names/names.h"

namespace anholon {

// A formula of the observer's motion. The inertial forces contain its derivative of order `derivative`.
struct ObserverFormula {
  Expr value;
  int derivative;
  Span span;
};

// Returns the formulas that the file gives.
std::vector<ObserverFormula> read_observer(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics);
// Checks that inputs and states in the formulas are functions of t, and that they do not jump. REQUIRES: events are
// read.
void check_observer(const std::vector<ObserverFormula>& formulas, const Model& model, Diagnostics& diagnostics);

// Returns a function of t whose derivative is e (sums of constants, powers of t, and sin, cos, exp of arguments linear
// in t, times constants); nullopt if e is of another kind.
std::optional<Expr> antiderivative(Expr e);

}  // namespace anholon

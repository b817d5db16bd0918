// Where an expression jumps: a sign, a choice between two formulas, a table that holds its values, an angle atan2 at its
// branch cut.
//
// Let s be what decides, with the expression f+ for s > 0 and f- for s < 0. f is continuous where s changes its sign if
// f+ - f- is zero; or a multiple of s: (f+ - f-)/s, in lowest terms, has no denominator that f+ - f- does not have; or
// zero where s = 0, with the coordinate put in that makes it so. Choices that are left there are made by the parameters.
#pragma once
#include <functional>

#include "model/model.h"

namespace anholon {

// Tells of what decides between two formulas whether it counts; empty if all do.
using Decides = std::function<bool(Expr)>;

// Whether e may jump along a motion with the parameters of the model; false if it is proved continuous wherever all its
// parts have values.
bool may_jump(const Model& model, Expr e, const Decides& counts = {});
// Whether a point is found at which e jumps. Jumps of tables and of atan2 are not looked for.
bool jumps_at_a_point(const Model& model, Expr e, const Decides& counts = {});
// Whether the node may be where an expression jumps or has a kink.
bool may_switch(const Node& n);
bool holds_coordinates(Expr e);
bool holds_time(Expr e);

}  // namespace anholon

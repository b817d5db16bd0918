// Finds where an expression jumps: at a sign, a choice between two formulas, a table that holds its values, an angle
// atan2 at its branch cut.
//
// Let s be the condition of a choice, whose expression is f+ for s > 0 and f- for s < 0. f is continuous where s
// changes its sign in three cases: f+ - f- is zero; or it is a multiple of s, which means that (f+ - f-)/s, in lowest
// terms, has no denominator that f+ - f- does not have; or it is zero where s = 0, with the value substituted of a
// symbol that makes s zero. The parameters decide choices that do not depend on the motion.
#pragma once
#include <functional>

#include "model/model.h"

namespace anholon {

// Tells whether the condition of a choice counts. If the function is empty, all conditions count.
using Decides = std::function<bool(Expr)>;

// True if e may jump along a motion with the parameters of the model; false if e is proved continuous wherever all its
// parts have values.
bool may_jump(const Model& model, Expr e, const Decides& counts = {});
// True if a point is found at which e jumps. Jumps of tables and of atan2 are not searched for.
bool jumps_at_a_point(const Model& model, Expr e, const Decides& counts = {});
// True if the node may be a place at which an expression jumps or has a kink.
bool may_switch(const Node& n);
bool holds_coordinates(Expr e);
bool holds_time(Expr e);

}  // namespace anholon

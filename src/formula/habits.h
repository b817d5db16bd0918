// Hints that replace the notation of other systems by that of formulas. Each hint can be pasted.
#pragma once
#include <functional>
#include <string>

#include "formula/formula.h"

namespace anholon {

// Returns the hint for a function that does not exist ("a derivative by time is written x'"); empty if no hint is
// known.
std::string habit_of_call(const Syntax& call);
// Returns the hint for a member that does not exist: x.dt.
std::string habit_of_member(const Syntax& member);
// Returns the hint for a name that does not exist: xdot. `varies` tells which names have derivatives.
std::string habit_of_name(const std::string& name, const std::function<bool(const std::string&)>& varies);
// The same for names that look like a derivative by time only: xdot, vx, dx/dt.
std::string habit_of_derivative(const std::string& name, const std::function<bool(const std::string&)>& varies);
// Returns the unit that is meant by a word that is no unit: s for sec, N*m for Nm; empty if none is known.
std::string habit_of_unit(const std::string& name);
// Returns the hint for a sign without meaning: &, °, √.
std::string habit_of_sign(const std::string& sign);

// Returns the derivative of order `times` in the notation of formulas: x'', (x*y)'.
std::string primed(const Syntax& s, int times);

}  // namespace anholon

// Notation of other systems and its replacement here. Each answer can be pasted.
#pragma once
#include <functional>
#include <string>

#include "formula/formula.h"

namespace anholon {

// The hint for a function that does not exist ("a derivative by time is written x'"); empty if none is known.
std::string habit_of_call(const Syntax& call);
// The hint for a member that does not exist: x.dt.
std::string habit_of_member(const Syntax& member);
// The hint for a name that does not exist: xdot. `varies` tells which names have derivatives.
std::string habit_of_name(const std::string& name, const std::function<bool(const std::string&)>& varies);
// The hint for a sign without meaning: &, °, √.
std::string habit_of_sign(const std::string& sign);

// The k-th derivative in the notation of formulas: x'', (x*y)'.
std::string primed(const Syntax& s, int times);

}  // namespace anholon

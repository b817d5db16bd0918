// What people write who come from other systems, and what is written here in its place: each answer can be pasted.
#pragma once
#include <functional>
#include <string>

#include "formula/formula.h"

namespace anholon {

// Of a function that does not exist: "a derivative by time is written x'"; empty where nothing is known of it.
std::string habit_of_call(const Syntax& call);
// Of a member that does not exist: x.dt.
std::string habit_of_member(const Syntax& member);
// Of a name that does not exist: xdot. `varies` tells the names that have derivatives.
std::string habit_of_name(const std::string& name, const std::function<bool(const std::string&)>& varies);
// Of a sign that means nothing: &, °, √.
std::string habit_of_sign(const std::string& sign);

// The k-th derivative as it is written: x'', (x*y)'.
std::string primed(const Syntax& s, int times);

}  // namespace anholon

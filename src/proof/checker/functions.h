// The functions of certificates, one row for each, from which the checker takes their rules.
//
// Derivatives are written here again, and not taken from expr/elementary.def, because the checker does not trust the
// simplifier.
#pragma once
#include <string>
#include <vector>

#include "numeric/ball.h"

namespace anholon::verification {

// The rule by which a function is evaluated.
enum class Family : std::uint8_t {
  keyed,        // equal arguments have equal values
  odd,          // keyed, and the value of -u is that of u with the other sign
  complement,   // acos u = pi/2 - asin u
  branch,       // abs, sign: they depend on whether u is a square
  circle,       // a rational function of a point of the circle group
  exponential,  // a rational function of a square that is not 0
};

struct KnownFunction {
  const char* name;
  Family family;
  Ball (*value)(const Ball& u);
  Ball (*derivative)(const Ball& u, const Ball& v);  // v = value(u)
};
// Returns the functions in the order in which certificates count them.
const std::vector<KnownFunction>& functions();
// REQUIRES: there is a function of that name.
const KnownFunction& function(const std::string& name);

}  // namespace anholon::verification

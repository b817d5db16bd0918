// Writes exp(n*log(x)) as pow(x, n), which has a value for x <= 0 if n is a whole number.
#include "emit/straight_line.h"
#include "emit/text.h"

namespace anholon::emit {

std::string StraightLine::power_of(const std::string& base, const Coefficient& exponent) {
  if (exponent.empty()) return "1.0";
  const bool literal = exponent.size() == 1 && exponent.begin()->first.empty();
  const std::string n = literal ? number(exponent.begin()->second) : place_of(exponent);
  const std::string name = named((language_ == Language::python ? "np.power(" : "pow(") + base + ", " + n + ")");
  powers_.try_emplace(name, base, exponent);
  return name;
}

// Returns the slot of a logarithm that varies, and its factor.
std::optional<std::pair<std::uint32_t, StraightLine::Coefficient>> StraightLine::logarithm(std::uint32_t s) const {
  const Instruction& in = tape_.code[s];
  std::uint32_t varying = in.a;
  Coefficient factor = kOne;
  switch (in.op) {
  case Op::function:
    return static_cast<Function>(in.index) == Function::log && uses_[s].varies ? std::optional(std::pair{s, kOne})
                                                                               : std::nullopt;
  case Op::linear:
    if (in.count != 1) return std::nullopt;
    varying = tape_.linear_terms[in.first].slot;
    factor = {{{}, tape_.rationals[tape_.linear_terms[in.first].coefficient]}};
    break;
  case Op::multiply:
  case Op::scale:
    if (uses_[in.a].varies == uses_[in.b].varies) return std::nullopt;
    varying = uses_[in.a].varies ? in.a : in.b;
    factor = constant(uses_[in.a].varies ? in.b : in.a);
    break;
  default:
    return std::nullopt;
  }
  auto found = logarithm(varying);
  if (found) found->second = product(found->second, factor);
  return found;
}

std::optional<std::string> StraightLine::general_power(const Instruction& in) {
  if (static_cast<Function>(in.index) != Function::exp) return std::nullopt;
  const auto found = logarithm(in.a);
  if (!found || (found->second.size() == 1 && found->second.begin()->first.empty())) return std::nullopt;
  return power_of(operand(tape_.code[found->first].a), found->second);
}

}  // namespace anholon::emit

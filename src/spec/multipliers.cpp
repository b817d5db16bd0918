#include "spec/multipliers.h"

#include <algorithm>

namespace anholon {

// "rolling.x" of lambda.rolling.x; empty for other members.
static std::string multiplier(const Syntax& s) {
  const Syntax& object = s.args[0];
  if (object.op == Syntax::Op::name) return object.text == "lambda" ? s.text : "";
  if (object.op != Syntax::Op::member) return "";
  const std::string inner = multiplier(object);
  return inner.empty() ? "" : inner + "." + s.text;
}

Value WithMultipliers::name(const std::string& name, Span span) {
  if (name == "lambda") return InertialName{};  // means something with a member only
  return scope_.name(name, span);
}

Value WithMultipliers::member(const Value& object, const Syntax& s) {
  const std::string path = multiplier(s);
  if (path.empty()) return scope_.member(object, s);
  const std::vector<std::string>& names = model_.names.multipliers;
  if (const auto it = std::find(names.begin(), names.end(), path); it != names.end())
    return graph().multiplier(static_cast<std::uint32_t>(it - names.begin()), 0);
  for (const std::string& n : names)
    if (n.rfind(path + ".", 0) == 0) return InertialName{};  // of a vector equation: a component follows
  const std::string near = did_you_mean(path, names);
  throw Failure(s.span, "there is no constraint '" + path + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

}  // namespace anholon

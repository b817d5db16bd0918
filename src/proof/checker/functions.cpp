#include "proof/checker/functions.h"

#include <map>

namespace anholon::verification {

static const Rational kMinusHalf(-1, 2);

const std::vector<KnownFunction>& functions() {
  static const std::vector<KnownFunction> all{
      {"sin", Family::circle, [](const Ball& u) { return sin(u); }, [](const Ball& u, const Ball&) { return cos(u); }},
      {"cos", Family::circle, [](const Ball& u) { return cos(u); }, [](const Ball& u, const Ball&) { return -sin(u); }},
      {"tan", Family::circle, [](const Ball& u) { return tan(u); },
       [](const Ball&, const Ball& v) { return Ball(1) + v * v; }},
      {"asin", Family::odd, [](const Ball& u) { return asin(u); },
       [](const Ball& u, const Ball&) { return pow(Ball(1) - u * u, kMinusHalf); }},
      {"acos", Family::complement, [](const Ball& u) { return acos(u); },
       [](const Ball& u, const Ball&) { return -pow(Ball(1) - u * u, kMinusHalf); }},
      {"atan", Family::odd, [](const Ball& u) { return atan(u); },
       [](const Ball& u, const Ball&) { return Ball(1) / (Ball(1) + u * u); }},
      {"sinh", Family::exponential, [](const Ball& u) { return sinh(u); },
       [](const Ball& u, const Ball&) { return cosh(u); }},
      {"cosh", Family::exponential, [](const Ball& u) { return cosh(u); },
       [](const Ball& u, const Ball&) { return sinh(u); }},
      {"tanh", Family::exponential, [](const Ball& u) { return tanh(u); },
       [](const Ball&, const Ball& v) { return Ball(1) - v * v; }},
      {"asinh", Family::odd, [](const Ball& u) { return asinh(u); },
       [](const Ball& u, const Ball&) { return pow(Ball(1) + u * u, kMinusHalf); }},
      {"acosh", Family::keyed, [](const Ball& u) { return acosh(u); },
       [](const Ball& u, const Ball&) { return pow(u * u - Ball(1), kMinusHalf); }},
      {"atanh", Family::odd, [](const Ball& u) { return atanh(u); },
       [](const Ball& u, const Ball&) { return Ball(1) / (Ball(1) - u * u); }},
      {"exp", Family::exponential, [](const Ball& u) { return exp(u); }, [](const Ball&, const Ball& v) { return v; }},
      {"log", Family::keyed, [](const Ball& u) { return log(u); },
       [](const Ball& u, const Ball&) { return Ball(1) / u; }},
      // abs and sign have no derivative at the edge itself.
      {"abs", Family::branch, [](const Ball& u) { return abs(u); },
       [](const Ball& u, const Ball&) { return u.contains_zero() ? Ball::unknown() : sign(u); }},
      {"sign", Family::branch, [](const Ball& u) { return sign(u); },
       [](const Ball& u, const Ball&) { return u.contains_zero() ? Ball::unknown() : Ball(0); }},
  };
  return all;
}

const KnownFunction& function(const std::string& name) {
  static const std::map<std::string, const KnownFunction*> by_name = [] {
    std::map<std::string, const KnownFunction*> rows;
    for (const KnownFunction& f : functions()) rows[f.name] = &f;
    return rows;
  }();
  return *by_name.at(name);
}

}  // namespace anholon::verification

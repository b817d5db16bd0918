#include "kernel/plan/plan.h"

namespace anholon {

// The double on the other side of x; x itself if a double holds it.
static double other_side(long double x) {
  const double nearest = static_cast<double>(x);
  const long double rest = x - nearest;
  return rest == 0 || !std::isfinite(nearest) ? nearest : std::nextafter(nearest, rest > 0 ? HUGE_VAL : -HUGE_VAL);
}

std::vector<double> coefficient_values(const Plan& plan, const Program& program,
                                       const std::vector<long double>& parameters, Rounding rounding) {
  const Machine<long double> machine(program.tape, 0, parameters);
  std::vector<double> values;
  for (const Coefficient& c : plan.coefficients) {
    long double v = from_rational<long double>(c.rational);
    for (std::uint32_t s : c.slots) {
      const long double x = machine.series(s & ~Coefficient::kReciprocal)[0];
      v = s & Coefficient::kReciprocal ? v / x : v * x;
    }
    values.push_back(rounding == Rounding::nearest ? static_cast<double>(v) : other_side(v));
  }
  return values;
}

double Plan::work() const {
  const double orders = stages + 1, convolution = orders * orders / 2;
  double w = 0;
  for (const std::vector<Step>* list : {&stage, &after})
    for (const Step& s : *list) switch (s.act) {
      case Act::linear:
        w += orders * s.count;
        break;
      case Act::multiply:
      case Act::divide:
      case Act::function:
        w += convolution;
        break;
      case Act::square:
      case Act::square_root:
        w += convolution / 2;
        break;
      case Act::power:
      case Act::sine_cosine:
      case Act::arctan2:
        w += 2 * convolution;
        break;
      case Act::input:
      case Act::weigh:
      case Act::select:
      case Act::lookup:
        w += orders;
        break;
      case Act::beyond:
        break;  // once only
      }
  return w;
}

}  // namespace anholon

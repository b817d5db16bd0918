#include "kernel/plan/plan.h"

namespace anholon {

// The double on the other side of x; x itself if a double holds it.
static double other_side(long double x) {
  const double nearest = static_cast<double>(x);
  const long double rest = x - nearest;
  return rest == 0 || !std::isfinite(nearest) ? nearest : std::nextafter(nearest, rest > 0 ? HUGE_VAL : -HUGE_VAL);
}

CoefficientValues::CoefficientValues(const Plan& plan, const Program& program,
                                     const std::vector<long double>& parameters)
    : plan_(&plan), slots_(program.tape, 0, parameters) {
  for (const Coefficient& c : plan.coefficients) rationals_.push_back(from_rational<long double>(c.rational));
}

std::vector<double> CoefficientValues::rounded(Rounding rounding) const {
  std::vector<double> values;
  for (std::size_t i = 0; i < rationals_.size(); ++i) {
    long double v = rationals_[i];
    for (std::uint32_t s : plan_->coefficients[i].slots) {
      const long double x = slots_.series(s & ~Coefficient::kReciprocal)[0];
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

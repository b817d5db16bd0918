// Errors of long motions grow as the root of the number of steps. A Taylor recurrence divides by the same whole numbers
// at every step: if their reciprocals were rounded, errors would grow in proportion to the number of steps.
#include <cmath>

#include <gtest/gtest.h>

#include "integrate/stepper.h"
#include "kernel/kernel.h"
#include "structure/consistent.h"
#include "support/models.h"

namespace anholon::round_off_test {
namespace {

using State = std::vector<long double>;  // x, x', y, y'

// A particle of mass 1 in the plane.
struct Conservative {
  const char *name, *potential;
  State (*start)(long double);                         // of one of many motions, by a number from 0 to 1
  long double (*value)(long double x, long double y);  // of the potential
  double bound;                                        // of the error of one step
};

// Each kind of function whose coefficients are divided by their order: powers, sines, functions given by their
// derivative, angles.
const Conservative kSystems[] = {
    {"kepler", "-(x^2 + y^2)^(-1/2)",
     [](long double u) { return State{1 - u / 2, 0, 0, std::sqrt((1 + u / 2) / (1 - u / 2))}; },
     [](long double x, long double y) { return -1 / std::sqrt(x * x + y * y); }, 0.4},
    {"cube roots", "(1 + x^2 + 2*y^2)^(1/3)", [](long double u) { return State{1 + u, 0, 0.5L, 1}; },
     [](long double x, long double y) { return std::cbrt(1 + x * x + 2 * y * y); }, 0.07},
    {"sines", "-2*cos(x) - cos(y) - cos(x - y)", [](long double u) { return State{0.5L + u, 0, 0, 0.75L}; },
     [](long double x, long double y) { return -2 * std::cos(x) - std::cos(y) - std::cos(x - y); }, 0.3},
    {"exponentials", "exp(x - y) + exp(y) + exp(-x)", [](long double u) { return State{u, 1, 0, 0}; },
     [](long double x, long double y) { return std::exp(x - y) + std::exp(y) + std::exp(-x); }, 0.25},
    {"angles", "(x^2 + 2*y^2)/2 + atan2(y, 4 + x)^2", [](long double u) { return State{1 + u, 0, 0, 1}; },
     [](long double x, long double y) { return (x * x + 2 * y * y) / 2 + std::pow(std::atan2(y, 4 + x), 2.0L); }, 0.4},
};

long double energy(const Conservative& system, const State& s) {
  return (s[1] * s[1] + s[3] * s[3]) / 2 + system.value(s[0], s[2]);
}

struct Motion {
  std::shared_ptr<const Model> model;
  Mechanics m;
  System system;
  Structure structure;
  std::shared_ptr<const Program> stepping;

  explicit Motion(const Conservative& c)
      : model(test::model_of("coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + "
                             "y*ey\"}]\npotential.V = \"" +
                             std::string(c.potential) + "\"\n")),
        m(mechanics(*model)), system(implicit_system(model, m, *find_formulation("routh"), {})) {
    const Outcome o = analyse(system, {}, {}, structure);
    if (!o.ok()) throw std::runtime_error(o.message);
    stepping = std::make_shared<const Program>(program(system, structure));
  }
};

// The root of the mean square of the change of energy over some motions with `steps` steps, in round-offs (2^-53) of
// the size of the energy's terms.
double change(const Conservative& c, std::size_t steps) {
  constexpr int kMotions = 6;
  const Motion motion(c);
  StepSettings settings;
  settings.log_tolerance = std::log(1e-16);
  long double sum = 0;
  for (int k = 0; k < kMotions; ++k) {
    const State start = c.start((static_cast<long double>(k) + 0.5L) / kMotions);
    Stepper<double> stepper(*motion.stepping, {}, {}, settings);
    const auto plan = KernelPlan::make(motion.stepping, taylor_order(settings.log_tolerance) - 1, {}, 0,
                                       {start.begin(), start.end()});
    if (!plan) throw std::runtime_error("no kernel");
    stepper.accelerate(plan);
    if (const Outcome o = stepper.start(0, start); !o.ok()) throw std::runtime_error(o.message);
    while (stepper.steps() < steps)
      if (const Outcome o = stepper.step(1e6L); !o.ok()) throw std::runtime_error(o.message);
    const long double before = energy(c, start), off = (energy(c, stepper.state()) - before) / (1 + std::abs(before));
    sum += off * off;
  }
  return static_cast<double>(std::sqrt(sum / kMotions) / 0x1p-53L);
}

class RoundOff : public testing::TestWithParam<int> {};

// The errors are a third of the bounds. With rounded reciprocals of whole numbers they would be 4 to 18 times the
// bounds, 1.6 times for the cube roots.
TEST_P(RoundOff, OfTheEnergyGrowsAsTheRootOfTheSteps) {
  const Conservative& c = kSystems[GetParam()];
  constexpr std::size_t kSteps = 16000;
  EXPECT_LT(change(c, kSteps), c.bound * std::sqrt(static_cast<double>(kSteps)));
}

INSTANTIATE_TEST_SUITE_P(Functions, RoundOff, testing::Range(0, static_cast<int>(std::size(kSystems))),
                         [](const auto& of) { return test::test_name(kSystems[of.param].name); });

}  // namespace
}  // namespace anholon::round_off_test

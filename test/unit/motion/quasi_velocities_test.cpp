// Velocities in which the kinetic energy is a sum of squares: which are found, and that they have this property.
// representation_test.cpp and all tests of motions show that motions in them are the motions of Routh's equations.
#include <random>

#include <gtest/gtest.h>

#include "expr/normal.h"
#include "kernel/state_map.h"
#include "lowering/quasi_velocities.h"
#include "motion/representation.h"
#include "print/print.h"
#include "setup/scenario.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::quasi_velocities_test {
namespace {

struct Found {
  explicit Found(const std::shared_ptr<const Model>& model) {
    if (!make_scenario(model, *find_formulation("routh"), {}, prepared).ok()) return;
    scenario.emplace(prepared);
    if (!initial_state(*scenario, {}, start).ok()) return;
    const System& s = scenario->system;
    if (s.constraints.empty()) return;
    parameters = parameter_values<long double>(*scenario->model);
    // Any fixed point is suitable, since only the choice of pivots depends on it.
    const auto symbol = [&](const Node& n) {
      if (n.kind == Kind::time) return static_cast<double>(start.t);
      if (n.kind == Kind::parameter) return static_cast<double>(parameters[n.index]);
      return n.kind == Kind::jet && n.order < 2 ? static_cast<double>(start.state[2 * n.index + n.order]) : 0.0;
    };
    q = quasi_velocities(s, *scenario->mechanics, {}, symbol, why);
  }
  std::vector<std::string> of_state() const { return print(q->of_state, q->system.model->names, Format::text); }

  Scenario prepared;
  std::optional<Workspace> scenario;
  Start<long double> start;
  std::vector<long double> parameters;
  std::optional<QuasiVelocities> q;
  std::string why;  // the reason why there are none
};

using Texts = std::vector<std::string>;

TEST(QuasiVelocities, AreThoseOfTheBooks) {
  const Found disc(test::shipped("zoo/disc"));
  ASSERT_TRUE(disc.q);
  EXPECT_EQ(disc.of_state(), (Texts{"theta'", "psi'*cos(theta) + phi'", "psi'*sin(theta)"}));
  EXPECT_EQ(print(disc.q->determinant, disc.q->system.model->names, Format::text), "R^2*m*sin(theta)^2/4");
  // No tangent and no root occur: the first velocity is the speed along the blade.
  const Found sleigh(test::shipped("zoo/chaplygin-sleigh"));
  ASSERT_TRUE(sleigh.q);
  EXPECT_EQ(sleigh.of_state(), (Texts{"y'*sin(th) + x'*cos(th)", "th'"}));
  EXPECT_EQ(print(sleigh.q->velocities, sleigh.q->system.model->names, Format::text),
            (Texts{"p1*cos(th)", "p1*sin(th)", "p2"}));
  EXPECT_TRUE(is_number(sleigh.q->determinant)) << "never singular";
}

// A blade with a given slip, alone and joined to another body: again the speed along the blade, and no poles.
TEST(QuasiVelocities, HaveNoPolesWhereAConstraintHasAPartWithoutVelocities) {
  const std::string sleigh = R"toml(coordinates = ["x", "y", "th", "be"]
parameters = {m = 2, J = 0.4, w = 0.1}
point.P = "x*ex + y*ey"
frame.B = "rotz(th + be)"
body = [{name = "front", mass = "m", inertia = "J", center = "P", orientation = "B"},
        {name = "rear", mass = "m", inertia = "J", center = "P - ROD", orientation = "rotz(th)"}]
constraint = [{name = "blade", equation = "dot(vel(ARM), B.y) = w*cos(t)"}]
initial = {be = 0.3, "th'" = 1, "x'" = 1}
)toml";
  const auto of = [&](const std::string& rod, const std::string& arm) {
    std::string text = sleigh;
    text.replace(text.find("ROD"), 3, rod);
    return Found(test::model_of(text.replace(text.find("ARM"), 3, arm)));
  };
  for (const Found& f : {of("0.5*(cos(th)*ex + sin(th)*ey)", "P"), of("0*ex", "P + cos(th)*ex + sin(th)*ey")}) {
    ASSERT_TRUE(f.q) << f.why;
    for (const std::string& v : print(f.q->velocities, f.q->system.model->names, Format::text)) {
      EXPECT_EQ(v.find("/cos"), std::string::npos) << v;
      EXPECT_EQ(v.find("/sin"), std::string::npos) << v;
    }
  }
}

TEST(QuasiVelocities, TellWhyThereAreNone) {
  EXPECT_EQ(Found(test::shipped("zoo/disc")).why, "");
  for (const auto& [name, why] :
       {std::pair{"zoo/double-pendulum-cartesian", "the constraint 'rod2' is of order 0"},
        {"asked/perpendicular-velocities", "the constraint 'square' is not linear in the velocities"}}) {
    const Found none(test::shipped(name));
    EXPECT_FALSE(none.q) << name;
    EXPECT_EQ(none.why, why);
  }
}

ExpansionWork work_in_quasi_velocities(const std::string& model, const Overrides& overrides = {}) {
  Scenario prepared;
  if (!make_scenario(test::model_of(test::shipped_text(model), overrides), *find_formulation("routh"), {}, prepared)
           .ok())
    return {};
  Workspace s(prepared);
  Start<long double> start;
  if (!initial_state(s, {}, start).ok()) return {};
  const std::vector<long double> parameters = parameter_values<long double>(*s.model);
  const std::vector<double> state(start.state.begin(), start.state.end());
  const double t = static_cast<double>(start.t);
  const auto derived =
      KernelPlan::make(std::make_shared<const Program>(program(s.system, s.structure)), 14, parameters, t, state);
  for (const Representation& r :
       representations({derived, s.structure, {}, parameters, t, state, s.mechanics.get()}, WritingEffort::at_once))
    if (r.writing == Writing::quasi) return work_of(*r.plan);
  return {};
}

// The count of products is at most that of the same systems reduced by hand (bench/peers/reduced_systems.h); sine and
// cosine together count as one product.
TEST(QuasiVelocities, AreAsShortAsByHand) {
  EXPECT_EQ(work_in_quasi_velocities("zoo/chaplygin-sleigh").products, 5U);
  EXPECT_EQ(work_in_quasi_velocities("zoo/disc").products, 12U);
  EXPECT_LE(work_in_quasi_velocities("zoo/snakeboard").products, 14U);
}

// The products that one more trailer adds do not depend on the number of trailers.
TEST(QuasiVelocities, GrowWithTheTrailers) {
  std::size_t products[3], i = 0;
  for (const char* n : {"4", "5", "10"})
    products[i++] = work_in_quasi_velocities("zoo/trailers", {{{"n", n}}}).products;
  EXPECT_LE(products[1] - products[0], 6U);
  EXPECT_EQ(products[2] - products[1], 5 * (products[1] - products[0]));
}

std::vector<std::string> with_quasi_velocities() {
  std::vector<std::string> names;
  for (const std::string& name : test::moving_models())
    if (Found f(test::shipped(name)); f.q) names.push_back(name);
  return names;
}

// In any state T(p) is 1/2 sum I p^2, the constraints hold, and the map to p and back is the identity.
TEST(QuasiVelocities, MakeTheEnergyASumOfSquares) {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<long double>(random() >> 8) / 0x1p23L - 1; };
  std::size_t models = 0;
  for (const std::string& name : with_quasi_velocities()) {
    ++models;
    const Found f(test::shipped(name));
    const Mechanics& m = *f.scenario->mechanics;
    const std::size_t n = m.q.size(), l = f.q->count, others = f.q->system.size() - l;
    const StateMap map(*f.q);
    StateReader reader(map, f.parameters);
    const auto value = [&](Expr e, const std::vector<long double>& state) {
      PointValues at([&](const Node& s) {
        if (s.kind == Kind::time) return static_cast<double>(f.start.t);
        if (s.kind == Kind::parameter) return static_cast<double>(f.parameters[s.index]);
        return static_cast<double>(s.kind == Kind::jet ? state[2 * s.index + s.order] : state[2 * n + s.index]);
      });
      return at(put_masses(*f.scenario->model, e));
    };
    for (int sample = 0; sample < 3; ++sample) {
      std::vector<long double> own(map.own_size()), state, back;
      for (long double& x : own) x = number();
      // The state is near the start, where formulas have values.
      for (std::size_t a = 0; a < n; ++a) own[a] = f.start.state[2 * a] + 0.05L * own[a];
      const auto energy = [&](const std::vector<std::pair<std::size_t, long double>>& p) {
        std::vector<long double> at = own;
        std::fill(at.begin() + static_cast<std::ptrdiff_t>(others), at.end(), 0);
        for (const auto& [i, x] : p) at[others + i] = x;
        reader.motion(f.start.t, at, state);
        return value(m.T, state);
      };
      const double none = energy({});
      for (std::size_t i = 0; i < l; ++i) {
        const double inertia = value(f.q->inertia[i], f.start.state),
                     square = energy({{i, 1}}) + energy({{i, -1}}) - 2 * none;
        EXPECT_NEAR(square, inertia, 1e-12 * (1 + std::abs(inertia))) << name << " " << i;
        for (std::size_t j = 0; j < i; ++j) {
          const double mixed = energy({{i, 1}, {j, 1}}) - energy({{i, 1}}) - energy({{j, 1}}) + none;
          EXPECT_NEAR(mixed, 0, 1e-12 * (1 + std::abs(inertia))) << name << " " << i << " " << j;
        }
      }
      reader.motion(f.start.t, own, state);
      for (std::size_t c : f.scenario->system.constraints)
        EXPECT_NEAR(value(m.phi[c], state), 0, 1e-12) << name << " " << c;
      reader.own(f.start.t, state, back);
      for (std::size_t i = 0; i < own.size(); ++i)
        EXPECT_NEAR(static_cast<double>(back[i]), static_cast<double>(own[i]), 1e-14) << name << " " << i;
    }
  }
  EXPECT_GE(models, 12U);
}

std::string particle(const std::string& more) {
  return "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 2\nposition = \"x*ex + y*ey + "
         "z*ez\"\n[[force]]\nname = \"f\"\non = \"p\"\n"
         "vector = \"-x*ex - 2*y*ey + sin(t)*ez\"\n" +
         more;
}

std::string constraint(const std::string& equation) {
  return "[[constraint]]\nname = \"c\"\nequation = \"" + equation +
         "\"\n[initial]\nx = 1\ny = 0.5\nz = 0.25\n\"y'\" = 0.5\n";
}

// Rheonomic and affine constraints, a turning observer, states and forces on velocities have quasi-velocities;
// holonomic, nonlinear and higher constraints have none.
TEST(QuasiVelocities, OfOtherConstraints) {
  const auto distance = [](const std::string& text) {
    const auto run = [&](Precision precision) {
      Scenario s;
      EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
      SimulationOptions o;
      o.to = 2;
      o.tolerance = Rational(1, mpz_class("1000000000000"));
      o.precision = precision;
      test::TextRows sink;
      EXPECT_TRUE(simulate(s, o, sink).outcome.ok());
      return sink.rows().back();
    };
    const auto real = run(Precision::real), wide = run(Precision::long_real);
    double worst = 0;
    for (std::size_t i = 0; i < real.size(); ++i)
      worst = std::max(worst, std::abs(std::stod(real[i]) - std::stod(wide[i])));
    return worst;
  };
  for (const std::string& text :
       {particle(constraint("z' - y*x' = 0")), particle(constraint("z' - y*x' - sin(t)*x = 0")),
        particle(constraint("cos(t)*x' + sin(y)*y' + x*z' = t")),
        particle("[observer]\nspin = \"cos(t)*ez\"\n" + constraint("z' - y*x' = 0")),
        particle("[state]\nw = {rate = \"x' - w\", initial = 0.5}\n[[force]]\nname = \"g\"\non = \"p\"\nvector = "
                 "\"w*ey - y'*ey\"\n" +
                 constraint("z' - y*x' = 0"))}) {
    EXPECT_TRUE(Found(test::model_of(text)).q) << text;
    EXPECT_LE(distance(text), 1e-10) << text;
  }
  for (const std::string& text :
       {particle(constraint("x^2 + y^2 + z^2 = 1.3125")), particle(constraint("x'^2 + y'^2 - z'^2 = 0.5")),
        particle(constraint("x'' - z = 0"))})
    EXPECT_FALSE(Found(test::model_of(text)).q) << text;
}

// The quasi-velocities of the sweep's start divide by c. For c = 0 the kernel has no value, and the reference continues
// from the state before.
TEST(QuasiVelocities, WithoutAValueNothingIsLost) {
  const std::string text =
      particle(constraint("c*z' - (1 + y^2)*x' - (2 + z^2)*y' = 0")) + "\"x'\" = 0.5\n[parameters]\nc = 1\n";
  Scenario prepared;
  ASSERT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, prepared).ok());
  Workspace s(prepared);
  const std::vector<long double> one = parameter_values<long double>(*s.model);
  Start<long double> start;
  ASSERT_TRUE(initial_state(s, {}, start).ok());
  const Program p = program(s.system, s.structure);
  const std::vector<double> state(start.state.begin(), start.state.end());
  const auto derived = KernelPlan::make(std::make_shared<const Program>(p), 14, one, 0, state);
  std::shared_ptr<const KernelPlan> plan;
  for (const Representation& r :
       representations({derived, s.structure, {}, one, 0, state, s.mechanics.get()}, WritingEffort::at_once))
    if (r.writing == Writing::quasi) plan = r.plan;
  ASSERT_TRUE(plan);
  // With c = 0: x' = 0.5 and the y' that satisfies the constraint.
  const std::vector<long double> zero(one.size(), 0);
  std::vector<long double> at = start.state;
  at[5] = 0;
  at[3] = -at[1] * (1 + at[2] * at[2]) / (2 + at[4] * at[4]);
  const auto end = [&](bool kernel) {
    Stepper<double> stepper(p, {zero.begin(), zero.end()}, zero, {});
    if (kernel) stepper.accelerate(plan);
    EXPECT_TRUE(stepper.start(0, at).ok());
    while (stepper.time() < 1) {
      const Outcome o = stepper.step(1);
      EXPECT_TRUE(o.ok()) << o.message;
      if (!o.ok()) break;
    }
    EXPECT_EQ(stepper.expansions_by_kernel(), 0U);
    return stepper.state();
  };
  const auto with = end(true), without = end(false);
  for (std::size_t i = 0; i < with.size(); ++i)
    EXPECT_NEAR(static_cast<double>(with[i]), static_cast<double>(without[i]), 1e-12) << i;
}

}  // namespace
}  // namespace anholon::quasi_velocities_test

// Laws that hold at every point of the jet space, for every shipped model and every formulation; no equation of motion
// is solved here. The reference evaluator computes the values with 40 digits.
#include <gtest/gtest.h>

#include "formulation/formulation.h"
#include "support/model_point.h"
#include "support/models.h"

namespace anholon::forms_test {
namespace {

// 40 digits, terms up to 1e3 and some hundred operations.
constexpr double kExact = 1e-30;
// A mutant must miss by much more than kExact.
constexpr double kRefuted = 1e-6;
constexpr int kPoints = 3;

struct System {
  std::shared_ptr<const Model> model;
  Mechanics m;
  explicit System(const std::string& name) : model(test::shipped(name)), m(mechanics(*model)) {}
  Graph& g() const { return *model->graph; }
  Column put(const Column& c) const { return put_masses(*model, c); }
};

std::vector<std::shared_ptr<System>> all_systems() {
  static std::vector<std::shared_ptr<System>> systems;
  if (systems.empty())
    for (const std::string& name : test::shipped_models()) systems.push_back(std::make_shared<System>(name));
  return systems;
}

Column given_forces(const Mechanics& m) {
  return m.Q + m.QR + m.QD + m.Qomega + m.minus_dVO + m.minus_dVomega + m.Gamma;
}

// The largest |value| of the column at some random points, in units of the largest value of `scale` there.
double size_of(const System& s, const Column& column, const Column& scale) {
  const PrecisionScope precision(40);
  double worst = 0;
  for (std::uint64_t seed = 1; seed <= kPoints; ++seed) {
    const test::Point at = test::random_point(*s.model, seed);
    double largest = 1;
    for (const Multi& v : test::values(scale, at)) largest = std::max(largest, std::abs(to_double(v)));
    for (const Multi& v : test::values(column, at)) {
      const double miss = std::abs(to_double(v)) / largest;
      if (!(miss <= worst)) worst = miss == miss ? miss : 1e300;
    }
  }
  return worst;
}

// (left - right) - (E - G - N): zero for every multiplier form, whatever the jets.
double form_error(const System& s, const Equations& e) {
  const Column inertia = newton_left_side(s.m), forces = s.put(given_forces(s.m) + s.m.N);
  return size_of(s, s.put(e.left - e.right) - (inertia - forces), inertia);
}

class Forms : public testing::TestWithParam<std::string> {};

TEST_P(Forms, AreNewtonsLawWithIdealReactions) {
  const System s(GetParam());
  int applied = 0;
  for (const Formulation* form : formulations()) {
    if (!form->obstacle(s.m).empty()) continue;
    if (form->unknowns != Unknowns::multipliers) continue;  // forms without multipliers have laws of their own
    const Equations e = form->equations(s.m, Elimination());
    ++applied;
    EXPECT_LE(form_error(s, e), kExact) << form->name;
  }
  EXPECT_GT(applied, 0);
}

// dh/dt = power without constraints + P_c + q'.(E - G - N)  (theory: certificate), on and off the solutions.
Column energy_terms(const System& s, const Power& p) {
  Graph& g = s.g();
  Expr virtual_power = g.zero();
  const Column miss = newton_left_side(s.m) - s.put(given_forces(s.m) + s.m.N);
  for (std::size_t a = 0; a < miss.size(); ++a) virtual_power += s.m.qd[a] * miss[a];
  return {p.dh_dt - p.noncons - p.constraint - virtual_power};
}

TEST_P(Forms, EnergyIdentity) {
  const System s(GetParam());
  const Power p = power(s.m);
  EXPECT_LE(size_of(s, energy_terms(s, p), {p.dh_dt, p.noncons}), kExact);
}

INSTANTIATE_TEST_SUITE_P(Model, Forms, testing::ValuesIn(test::shipped_models()),
                         [](const auto& p) { return test::test_name(p.param); });

// ---- mutants: the same checks must refute the mistakes under "What goes wrong easily" in doc/theory/

// The number of shipped models that refute Routh's equations with the given mistake.
int refuted_by(const std::function<Equations(const System&)>& mutant) {
  int models = 0;
  for (const auto& s : all_systems()) models += form_error(*s, mutant(*s)) > kRefuted;
  return models;
}

Column routh_left(const Mechanics& m) { return total_derivative(gradient(m.T, m.qd)) - gradient(m.T, m.q); }

TEST(Mutants, NoMistakeIsRefutedByNoModel) {
  EXPECT_EQ(refuted_by([](const System& s) { return Equations{routh_left(s.m), given_forces(s.m) + s.m.N}; }), 0);
}

TEST(Mutants, DifferentiatingTheMassInsideT) {
  EXPECT_GE(refuted_by([](const System& s) {
              const Expr T = put_masses(*s.model, s.m.T);
              return Equations{total_derivative(gradient(T, s.m.qd)) - gradient(T, s.m.q), given_forces(s.m) + s.m.N};
            }),
            5);
}

TEST(Mutants, CountingTheCentrifugalForceTwice) {
  EXPECT_GE(refuted_by([](const System& s) {
              return Equations{routh_left(s.m), given_forces(s.m) + s.m.minus_dVomega + s.m.N};
            }),
            4);
}

TEST(Mutants, LosingTheDotOfTheReactiveForce) {
  EXPECT_GE(refuted_by([](const System& s) {
              Column right = given_forces(s.m) - s.m.QR + s.m.N;
              for (const Body& b : s.model->bodies) {
                if (!b.expelled_velocity) continue;
                const Vector thrust = b.mass * *b.expelled_velocity;  // as printed: m u
                const Expr outputs[] = {b.exit_point.x, b.exit_point.y, b.exit_point.z},
                           seeds[] = {thrust.x, thrust.y, thrust.z};
                right = right + pullback(outputs, seeds, s.m.q);
              }
              return Equations{routh_left(s.m), right};
            }),
            5);
}

TEST(Mutants, LeavingOutCoriolis) {
  EXPECT_GE(
      refuted_by([](const System& s) { return Equations{routh_left(s.m), given_forces(s.m) - s.m.Gamma + s.m.N}; }), 4);
}

TEST(Mutants, LettingTheAccelerationOfTheOriginPullOnTheAxes) {
  EXPECT_GE(refuted_by([](const System& s) {
              Expr pull = s.g().zero();
              for (const WeightedPoint& p : s.m.points)
                if (!p.uniform_field) pull += p.weight * dot(s.model->observer.origin_acceleration, p.place);
              return Equations{routh_left(s.m), given_forces(s.m) - gradient(pull, s.m.q) + s.m.N};
            }),
            1);
}

TEST(Mutants, ALagrangianSignOfTheReaction) {
  EXPECT_GE(refuted_by([](const System& s) { return Equations{routh_left(s.m), given_forces(s.m) - s.m.N}; }), 15);
}

TEST(Mutants, AnEnergyRateWithoutTheMassTermIsRefuted) {
  int models = 0;
  for (const auto& s : all_systems()) {
    Power p = power(s->m);
    Expr missing = s->g().zero();
    for (std::size_t i = 0; i < s->model->masses.size(); ++i)
      missing += total_derivative(s->model->masses[i].value) *
                 put_masses(*s->model, partial(s->m.T, s->g().mass(static_cast<std::uint32_t>(i))));
    p.noncons = p.noncons - missing;
    models += size_of(*s, energy_terms(*s, p), {p.dh_dt}) > kRefuted;
  }
  EXPECT_GE(models, 5);
}

}  // namespace
}  // namespace anholon::forms_test

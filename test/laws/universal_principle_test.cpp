// The universal principle of d'Alembert of order m [N 2.1] (theory: universal-principle): on a motion,
//
//   sum_i (F_i - m_i a_i) . delta r_i^(m) = 0,   delta r_i = … = delta r_i^(m-1) = delta t = 0
//
// with delta q^(m) in the kernel of dphi/dq^(m). delta r^(m) is computed by differences of r^(m), which is a function
// of all jets. F holds the reactive forces and those of the moving observer. The last part puts [N 5.2] into the
// reduced equations [N 5.3].
#include <gtest/gtest.h>

#include "support/identity.h"
#include "support/least_norm.h"
#include "support/motion_point.h"
#include "support/particle_system.h"

namespace anholon::universal_principle_test {
namespace {

constexpr double kDifferences = 1e-24;  // the error of a step of 1e-15 is its square
constexpr double kExact = 1e-26;
constexpr double kRefuted = 1e-6;

using Vectors = std::vector<Multi>;

struct Choice {
  unsigned order, m;  // of the constraints, of the principle
};
void PrintTo(const Choice& c, std::ostream* out) { *out << "order " << c.order << ", m = " << c.m; }

class UniversalPrinciple : public testing::TestWithParam<Choice> {
 protected:
  PrecisionScope precision{60};
  unsigned order = GetParam().order, m = GetParam().m;
  std::shared_ptr<const Model> model;
  Mechanics mech;
  Column places, places_m, miss;  // r, r^(m), F - m a
  Column phi_m;                   // phi lifted to m
  std::vector<test::Point> points;

  void SetUp() override {
    const test::ParticleSystem system({4, 2, order, 2, order % 2 == 1}, 100 + order);
    model = test::model_of(system.text());
    mech = mechanics(*model);
    // By Newton's law, F - m a is the negative reaction on the particle.
    for (const Load& load : reactions(*model))
      for (int c = 0; c < 3; ++c) miss.push_back(-load.force[c]);
    for (const Body& b : model->bodies)
      for (int c = 0; c < 3; ++c) places.push_back(b.center[c]);
    for (Expr r : places) places_m.push_back(total_derivative(r, m));
    for (Expr phi : mech.phi) phi_m.push_back(total_derivative(phi, m - order));
    const Elimination e = elimination_for(mech, Unknowns::coordinates, {}, {}, false);
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
      if (auto at = test::motion_point(mech, e.dependent, m, seed)) points.push_back(*at);
    ASSERT_EQ(points.size(), 2U) << system.text();
  }

  // A delta q^(m) that the constraints allow or, unless `allowed`, any.
  Vectors displacement(const test::Point& at, std::uint64_t seed, bool allowed = true) const {
    Vectors any;
    for (std::size_t a = 0; a < mech.q.size(); ++a)
      any.push_back(test::Point(seed)(*model->graph, model->graph->given(static_cast<std::uint32_t>(a), 9).id));
    Rows rows;
    for (Expr phi : phi_m) rows.push_back(gradient(phi, jets(*model, m)));
    return allowed ? test::in_kernel(test::values_of(rows, at), any) : any;
  }

  // The variation of es if q^(k) alone is varied, by delta.
  Vectors variation(const Column& es, const test::Point& at, unsigned k, const Vectors& delta) const {
    const Multi h = test::raise(Multi(10), Rational(-15));
    test::Point more = at, less = at;
    const Column q = jets(*model, k);
    for (std::size_t a = 0; a < q.size(); ++a) {
      more.set(q[a], test::value(q[a], at) + h * delta[a]);
      less.set(q[a], test::value(q[a], at) - h * delta[a]);
    }
    Vectors out = test::plus(test::values(es, more), test::values(es, less), -1);
    for (Multi& x : out) x /= Multi(2) * h;
    return out;
  }

  double work(const test::Point& at, const Vectors& delta_r) const {
    const Vectors force = test::values(miss, at);
    return std::abs(to_double(test::product(force, delta_r))) / test::largest(force) / test::largest(delta_r);
  }
};

TEST_P(UniversalPrinciple, HoldsOnEveryMotion) {  // [N 2.1]
  for (const test::Point& at : points)
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      const Vectors delta = displacement(at, seed), delta_r = variation(places_m, at, m, delta);
      EXPECT_LE(work(at, delta_r), kDifferences);
      // delta r^(m) = dr/dq delta q^(m)  [N 2.5, 2.8]
      Rows by_q;
      for (Expr r : places) by_q.push_back(gradient(r, mech.q));
      EXPECT_LE(test::largest(test::plus(delta_r, test::times(test::values_of(by_q, at), delta), -1)), kDifferences);
    }
}

TEST_P(UniversalPrinciple, NeedsTheKernelAndTheLowerVariationsZero) {
  for (const test::Point& at : points) {
    EXPECT_GT(work(at, variation(places_m, at, m, displacement(at, 1, false))), kRefuted) << "any delta q^(m)";
    if (m == 0) continue;
    const Vectors delta = displacement(at, 1);
    const Vectors both =
        test::plus(variation(places_m, at, m, delta), variation(places_m, at, m - 1, displacement(at, 2)));
    EXPECT_GT(work(at, both), kRefuted) << "delta r^(m-1) is not zero";
  }
}

// m = 2: the compulsion sum 1/(2 m) |F - m a|^2 is stationary (Gauss).
class PrincipleOfGauss : public UniversalPrinciple {};
TEST_P(PrincipleOfGauss, SaysThatTheCompulsionIsStationary) {
  Expr Z = model->graph->zero();
  for (std::size_t i = 0; i < miss.size(); ++i)
    Z += pow(miss[i], Rational(2)) / (2 * put_masses(*model, model->bodies[i / 3].mass));
  for (const test::Point& at : points) {
    const double size = 1 + std::abs(to_double(test::value(Z, at)));
    EXPECT_LE(test::largest(variation({Z}, at, 2, displacement(at, 1))) / size, kDifferences);
    EXPECT_GT(test::largest(variation({Z}, at, 2, displacement(at, 1, false))) / size, kRefuted);
  }
}

// [N 5.2] on a motion, with the given forces in place of E: the reactions of each coordinate are missing.
class RelationOnAMotion : public UniversalPrinciple {};  // m >= 1
TEST_P(RelationOnAMotion, TheForcesDoNotReplaceTheInertiaCoordinateByCoordinate) {
  const auto put = [&](const Column& c) { return put_masses(*model, c); };
  const Rational part = Rational(static_cast<int>(m) - 1) / Rational(static_cast<int>(m));
  const Column below = gradient(T(mech, m - 1), jets(*model, m - 1));
  const Column of_T = gradient(mech.T, mech.q) - Rational(1, m) * below;
  const Column with_forces = put(of_T + part * forces(mech)), with_inertia = put(of_T + part * lagrange_operator(mech)),
               N = put(part * mech.N);
  for (const test::Point& at : points) {
    const double size = 1 + test::largest(test::values(put(below), at));
    EXPECT_LE(test::largest(test::values(with_inertia, at)) / size, kExact);
    EXPECT_LE(test::largest(test::plus(test::values(with_forces, at), test::values(N, at))) / size, kExact);
    if (m > 1) {
      EXPECT_GT(test::largest(test::values(with_forces, at)) / size, kRefuted);
    }
  }
}

std::string case_name(const testing::TestParamInfo<Choice>& p) {
  return "Constraints" + std::to_string(p.param.order) + "Principle" + std::to_string(p.param.m);
}
const auto of_order_zero = testing::Values(Choice{0, 0});
const auto of_higher_order = testing::Values(Choice{0, 1}, Choice{0, 2}, Choice{1, 1}, Choice{1, 2}, Choice{1, 3},
                                             Choice{2, 2}, Choice{2, 3}, Choice{3, 3}, Choice{3, 4});
INSTANTIATE_TEST_SUITE_P(OrderZero, UniversalPrinciple, of_order_zero, case_name);
INSTANTIATE_TEST_SUITE_P(Order, UniversalPrinciple, of_higher_order, case_name);
INSTANTIATE_TEST_SUITE_P(Order, PrincipleOfGauss, testing::Values(Choice{0, 2}, Choice{1, 2}, Choice{2, 2}), case_name);
INSTANTIATE_TEST_SUITE_P(Order, RelationOnAMotion, of_higher_order, case_name);

// ---- [N 5.3]
// ------------------------------------------------------------------------------------------------------------------

class PutIntoTheReducedEquations : public testing::TestWithParam<unsigned> {
 protected:
  // The left side of [N 5.3]: [N 3.16] with dT/dq from [N 5.2], in which X stands for E.
  static test::Terms left(const test::System& s, const Elimination& e, const Column& X) {
    const Rational part = Rational(static_cast<int>(e.m) - 1) / Rational(static_cast<int>(e.m));
    const Expr before = T(s.m, e.m - 1);
    const Column p = e.on(e.D(s.by(e.m, before))), r = e.on(s.by(e.m - 1, before)),
                 by_5_2 = Rational(1, e.m) * r - part * e.on(X);
    const auto turned = e.f_rate_by_u(), f_by = e.f_by(e.m - 1), f_by_u = e.f_by_u();
    return {e.by_u(T(s.m, e.m)), -e.I(e.by(e.m - 1, before)), -e.I(by_5_2), -(p * (turned - f_by)),
            -((e.D(r) + e.D(by_5_2)) * f_by_u)};
  }
  static Column residual(const char* form, const test::System& s, const Elimination& e) {
    const Equations q = find_formulation(form)->equations(s.m, e);
    return q.left - q.right;
  }
};

TEST_P(PutIntoTheReducedEquations, SaysTheSameWithTheForcesContracted) {  // [N 5.3]
  const unsigned m = GetParam();
  for (const auto shape : {test::Shape::linear, test::Shape::nonlinear}) {
    const test::System& s = *test::generic(m, shape);
    const Elimination e = elimination_for(s.m, Unknowns::coordinates, {}, {}, shape == test::Shape::linear);
    const Column reduced = find_formulation("micevic-rusov-reduced")->equations(s.m, e).left, G = forces(s.m);
    // With E for X it is the left side of [N 3.16] itself.
    test::Terms with_E = left(s, e, lagrange_operator(s.m));
    with_E.push_back(-reduced);
    EXPECT_LE(test::miss(s, e, with_E), kExact);
    // With the forces for X it is an equation of motion: an m-th part of [N 3.16]; m times it are the generalized
    // Nielsen equations.
    test::Terms with_G = left(s, e, G);
    with_G.push_back(-e.contract(G));
    test::Terms part = with_G, nielsen = with_G;
    part.push_back(-(Rational(1, m) * residual("micevic-rusov-reduced", s, e)));
    EXPECT_LE(test::miss(s, e, part), kExact);
    for (Column& c : nielsen) c = Rational(m) * c;
    nielsen.push_back(-residual("nielsen-reduced", s, e));
    EXPECT_LE(test::miss(s, e, nielsen), kExact);
    // Mutants: the forces equal the inertia identically; another factor of [N 5.2].
    test::Terms not_equal = left(s, e, G);
    not_equal.push_back(-reduced);
    if (m > 1) {
      EXPECT_GT(test::miss(s, e, not_equal), kRefuted);
    }
    test::Terms other = with_G;
    other.push_back(-(Rational(1, m + 1) * residual("micevic-rusov-reduced", s, e)));
    EXPECT_GT(test::miss(s, e, other), kRefuted);
  }
}

INSTANTIATE_TEST_SUITE_P(Order, PutIntoTheReducedEquations, testing::Values(1U, 2U, 3U),
                         [](const auto& p) { return "m" + std::to_string(p.param); });

}  // namespace
}  // namespace anholon::universal_principle_test

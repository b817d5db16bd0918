// The identities on which the forms rest, each at random points in 40 digits and, if that is cheap, by exact algebra.
// Identities of T are tested at any jets, those with eliminated quantities at points on the manifold of the
// constraints, which are found numerically. The operators of an Elimination are compared with differences along the
// manifold.
#include <map>

#include <gtest/gtest.h>

#include "expr/normal.h"
#include "setup/eliminate.h"
#include "support/identity.h"

namespace anholon::identities_test {
namespace {

constexpr double kExact = 1e-28;   // 40 digits, terms up to 1e4 in units of their largest
constexpr double kRefuted = 1e-6;  // a mutant misses by much more

using test::Shape;
using test::Speeds;

using test::generic;
using test::miss;
using test::proved;
using test::rheonomic;
using test::System;
using test::Terms;

Rational binomial(unsigned n, int k) {
  if (k < 0 || k > static_cast<int>(n)) return 0;
  Rational b(1);
  for (int i = 1; i <= k; ++i) b = b * Rational(static_cast<int>(n) - i + 1) / Rational(i);
  return b;
}

Column derivative(Column c, int times) {
  for (; times > 0; --times) c = total_derivative(c);
  return c;
}

// ---- identities of T and of places, in all jets
// -----------------------------------------------------------------------------

// d F^(k)/dq^(j) = C(k, j) (dF/dq)^(k-j) + C(k, j-1) (dF/dq')^(k-j+1)  (theory: derivatives);
// `other` replaces C(k, j-1).
Terms commutation(const System& s, Expr F, unsigned k, unsigned j, std::optional<Rational> other = {}) {
  const Rational first = binomial(k, static_cast<int>(j)),
                 second = other.value_or(binomial(k, static_cast<int>(j) - 1));
  return {s.by(j, total_derivative(F, k)), -(first * derivative(s.by(0, F), static_cast<int>(k) - static_cast<int>(j))),
          -(second * derivative(s.by(1, F), static_cast<int>(k) - static_cast<int>(j) + 1))};
}

// m D/Dt dT^(m-1)/dq^(m) - dT^(m-1)/dq^(m-1) = D/Dt dT/dq' - dT/dq  [L 3.10]; `factor` stands for m.
Terms nielsen(const System& s, unsigned m, const Rational& factor) {
  const Expr before = total_derivative(s.m.T, m - 1);
  return {factor * total_derivative(s.by(m, before)), -s.by(m - 1, before), -total_derivative(s.by(1, s.m.T)),
          s.by(0, s.m.T)};
}

// dT^(m)/dq^(m) - dT^(m-1)/dq^(m-1) - dT/dq = D/Dt dT/dq' - dT/dq  [N 2.10]; `factor` multiplies dT/dq on the left.
Terms micevic_rusov(const System& s, unsigned m, const Rational& factor) {
  return {s.by(m, total_derivative(s.m.T, m)), -s.by(m - 1, total_derivative(s.m.T, m - 1)), -(factor * s.by(0, s.m.T)),
          -total_derivative(s.by(1, s.m.T)), s.by(0, s.m.T)};
}

// 1/m [dT^(m)/dq^(m) - (m+1) dT/dq] = D/Dt dT/dq' - dT/dq  [N 5.1]; `factor` stands for m + 1.
Terms mangeron(const System& s, unsigned m, const Rational& factor) {
  return {Rational(1, m) * s.by(m, total_derivative(s.m.T, m)), -(factor / Rational(m) * s.by(0, s.m.T)),
          -total_derivative(s.by(1, s.m.T)), s.by(0, s.m.T)};
}

// dT/dq = 1/m dT^(m-1)/dq^(m-1) - (m-1)/m E, with E in place of Q  [N 5.2]; `factor` stands for m - 1.
Terms energy_of_lower_order(const System& s, unsigned m, const Rational& factor) {
  return {s.by(0, s.m.T), Rational(-1, m) * s.by(m - 1, total_derivative(s.m.T, m - 1)),
          factor / Rational(m) * lagrange_operator(s.m)};
}

// d/dt dr^(k)/dq^(k) = 1/(k+1) dr^(k+1)/dq^(k)  and  dr^(k+1)/dq^(k+1) = dr^(k)/dq^(k)  [L 3.17]
std::pair<Terms, Terms> places(const System& s, unsigned k, const Rational& factor) {
  std::pair<Terms, Terms> all{{{}, {}}, {{}, {}}};
  const auto append = [](Column& to, const Column& c) { to.insert(to.end(), c.begin(), c.end()); };
  for (const WeightedPoint& p : s.m.points)
    for (int i = 0; i < 3; ++i) {
      const Expr r = total_derivative(p.place[i], k), next = total_derivative(r);
      append(all.first[0], total_derivative(s.by(k, r)));
      append(all.first[1], -(factor * s.by(k, next)));
      append(all.second[0], s.by(k + 1, next));
      append(all.second[1], -s.by(k, r));
    }
  return all;
}

// -2 sum m (omega x v) . dr/dq_a = -2 omega . {sum_k (sum m dr/dq_k x dr/dq_a) q_k' + sum m dr/dt x dr/dq_a}  [L 2.1],
// the generalized Coriolis force; `with_time` keeps the last sum, -1 for `sign` reverses the cross products.
Terms coriolis(const System& s, bool with_time = true, int sign = 1) {
  const Vector& omega = s.model->observer.spin;
  Column bilinear(s.m.q.size(), s.g().zero());
  for (const WeightedPoint& p : s.m.points) {
    std::vector<Vector> by_q(s.m.q.size());
    Vector by_t;
    for (int i = 0; i < 3; ++i) {
      const Column row = gradient(p.place[i], s.m.q);
      for (std::size_t a = 0; a < row.size(); ++a) by_q[a][i] = row[a];
      by_t[i] = partial(p.place[i], s.g().time());
    }
    for (std::size_t a = 0; a < bilinear.size(); ++a) {
      for (std::size_t k = 0; k < bilinear.size(); ++k)
        bilinear[a] += p.weight * dot(omega, cross(by_q[k], by_q[a])) * s.m.qd[k];
      if (with_time) bilinear[a] += p.weight * dot(omega, cross(by_t, by_q[a]));
    }
  }
  return {s.m.Gamma, Rational(2 * sign) * bilinear};
}

class Jets : public testing::TestWithParam<unsigned> {  // m
 protected:
  unsigned m = GetParam();
  std::vector<std::shared_ptr<const System>> systems() const {
    std::vector<std::shared_ptr<const System>> list = rheonomic();
    list.push_back(generic(m, Shape::linear));
    return list;
  }
};

TEST_P(Jets, CommutationRule) {
  for (const auto& s : {rheonomic()[0], generic(1, Shape::linear)})
    for (unsigned j = 0; j <= m + 2; ++j)
      EXPECT_LE(miss(*s, commutation(*s, s->m.T, m, j)), kExact) << "k = " << m << ", j = " << j;
  const System& s = *generic(1, Shape::linear);
  for (unsigned j = 0; j <= m + 1; ++j) {
    EXPECT_TRUE(proved(commutation(s, s.m.T, m, j))) << "k = " << m << ", j = " << j;
    if (j == m + 1 || j == 0) continue;  // one of the two terms vanishes
    EXPECT_GT(miss(s, commutation(s, s.m.T, m, j, binomial(m + 1, static_cast<int>(j)))), kRefuted)
        << "k = " << m << ", j = " << j;
  }
}

TEST_P(Jets, NielsensOperator) {
  for (const auto& s : systems()) {
    EXPECT_LE(miss(*s, nielsen(*s, m, Rational(m))), kExact);
    EXPECT_GT(miss(*s, nielsen(*s, m, Rational(m + 1))), kRefuted);
  }
  EXPECT_TRUE(proved(nielsen(*generic(1, Shape::linear), m, Rational(m))));
  EXPECT_TRUE(proved(nielsen(*rheonomic()[0], m, Rational(m))));
  EXPECT_FALSE(proved(nielsen(*generic(1, Shape::linear), m, Rational(m + 1))));
}

TEST_P(Jets, OperatorOfMicevicAndRusov) {
  for (const auto& s : systems()) {
    EXPECT_LE(miss(*s, micevic_rusov(*s, m, 1)), kExact);
    EXPECT_GT(miss(*s, micevic_rusov(*s, m, 2)), kRefuted);
  }
  EXPECT_TRUE(proved(micevic_rusov(*generic(1, Shape::linear), m, 1)));
  EXPECT_TRUE(proved(micevic_rusov(*rheonomic()[0], m, 1)));
  EXPECT_FALSE(proved(micevic_rusov(*generic(1, Shape::linear), m, 2)));
}

TEST_P(Jets, OperatorOfMangeronAndDeleanu) {
  for (const auto& s : systems()) {
    EXPECT_LE(miss(*s, mangeron(*s, m, Rational(m + 1))), kExact);
    EXPECT_GT(miss(*s, mangeron(*s, m, Rational(m))), kRefuted);
    EXPECT_LE(miss(*s, energy_of_lower_order(*s, m, Rational(m) - 1)), kExact);
    EXPECT_GT(miss(*s, energy_of_lower_order(*s, m, Rational(m))), kRefuted);
  }
  EXPECT_TRUE(proved(mangeron(*generic(1, Shape::linear), m, Rational(m + 1))));
}

TEST_P(Jets, DerivativesOfPlaces) {
  const unsigned k = m - 1;  // 0, 1, 2
  for (const auto& s : systems()) {
    const auto right = places(*s, k, Rational(1, k + 1));
    EXPECT_LE(miss(*s, right.first), kExact);
    EXPECT_LE(miss(*s, right.second), kExact);
    EXPECT_TRUE(proved(right.first));
    EXPECT_TRUE(proved(right.second));
    EXPECT_GT(miss(*s, places(*s, k, Rational(1, k + 2)).first), kRefuted);
  }
}

TEST(CoriolisForce, IsBilinearInVelocities) {
  int turning = 0, moving = 0;
  for (const std::string& name : test::shipped_models()) {
    const System s(test::shipped(name));
    if (is_zero(s.model->observer.spin.x) && is_zero(s.model->observer.spin.y) && is_zero(s.model->observer.spin.z))
      continue;
    EXPECT_LE(miss(s, coriolis(s)), kExact) << name;
    turning += miss(s, coriolis(s, true, -1)) > kRefuted;
    moving += miss(s, coriolis(s, false)) > kRefuted;
  }
  EXPECT_GE(turning, 2);
  EXPECT_GE(moving, 1);
}

INSTANTIATE_TEST_SUITE_P(Order, Jets, testing::Values(1U, 2U, 3U),
                         [](const auto& p) { return "m" + std::to_string(p.param); });

// ---- identities of eliminated energies, on the manifold
// ---------------------------------------------------------------------

struct Case {
  unsigned m;
  Shape shape;
  Speeds speeds;
  bool solve, shipped;
};

std::string case_name(const testing::TestParamInfo<Case>& p) {
  const Case& c = p.param;
  return "m" + std::to_string(c.m) +
         (c.shipped                  ? "Rheonomic"
          : c.shape == Shape::affine ? "Affine"
          : c.shape == Shape::linear ? "Linear"
                                     : "Nonlinear") +
         (c.speeds == Speeds::none     ? ""
          : c.speeds == Speeds::linear ? "WithQuasiVelocities"
                                       : "WithNonlinearQuasiVelocities") +
         (c.solve ? "Solved" : "Unsolved");
}

std::vector<Case> cases(bool quasi) {
  std::vector<Case> list;
  for (unsigned m = 1; m <= 3; ++m) {
    const Speeds speeds = quasi ? Speeds::linear : Speeds::none;
    // If the constraints hold x^(m)^2, the quasi-velocities cannot be solved for q^(m).
    list.push_back({m, quasi ? Shape::affine : Shape::linear, speeds, true, false});
    list.push_back({m, Shape::linear, speeds, false, false});
    list.push_back({m, Shape::nonlinear, quasi ? Speeds::nonlinear : speeds, false, false});
    list.push_back({m, Shape::linear, Speeds::none, m > 1, true});
  }
  return list;
}

class Manifold : public testing::TestWithParam<Case> {
 protected:
  std::shared_ptr<const System> system =
      GetParam().shipped ? rheonomic()[GetParam().m - 1] : generic(GetParam().m, GetParam().shape, GetParam().speeds);
  const System& s = *system;
  Elimination e;
  Expr before, T_m;  // T^(m-1), T^(m)
  void eliminate(Unknowns unknowns) {
    const Case& c = GetParam();
    static std::map<std::tuple<Unknowns, unsigned, Shape, Speeds, bool, bool>, Elimination> known;
    const auto [it, fresh] = known.try_emplace({unknowns, c.m, c.shape, c.speeds, c.solve, c.shipped});
    if (fresh) it->second = elimination_for(s.m, unknowns, {}, {}, c.solve);
    e = it->second;
    ASSERT_EQ(e.m, GetParam().m);
    before = total_derivative(s.m.T, e.m - 1);
    T_m = total_derivative(s.m.T, e.m);
  }
  // df_b/dq_c^(m-1), b and c dependent.
  Rows f_by_dependent() const {
    Rows out;
    for (std::size_t b : e.dependent) out.push_back(e.D(e.g_by(e.m - 1)[b]));
    return out;
  }
  static void expect(const System& s, const Elimination& e, const Terms& right, const char* what) {
    EXPECT_LE(miss(s, e, right), kExact) << what;
  }
  static void refute(const System& s, const Elimination& e, const Terms& wrong, const char* what) {
    EXPECT_GT(miss(s, e, wrong), kRefuted) << what;
  }
};

class Reduced : public Manifold {
 protected:
  void SetUp() override { eliminate(Unknowns::coordinates); }
};

// The chain rule for T~^(m-1).
TEST_P(Reduced, ChainRules) {  // [L 3.12]
  const Column p = e.on(e.D(s.by(e.m, before)));
  const Terms top = {e.by_u(before), -e.on(e.I(s.by(e.m, before))), -(p * e.f_by_u())};
  const Terms below = {e.I(e.by(e.m - 1, before)), -e.on(e.I(s.by(e.m - 1, before))), -(p * e.f_by(e.m - 1))};
  expect(s, e, top, "by q^(m)");
  expect(s, e, below, "by q^(m-1)");
  EXPECT_TRUE(proved(top));
  EXPECT_TRUE(proved(below));
  refute(s, e, {top[0], top[1]}, "f forgotten");
  refute(s, e, {below[0], below[1], -(p * e.f_by_u())}, "f by q^(m) in place of q^(m-1), as printed");
}

// The rate of T~^(m-1) along the manifold.
TEST_P(Reduced, RateOfTheReducedEnergy) {  // [L 3.14]
  const Column r_tilde = e.D(e.by(e.m - 1, before)), r = e.on(e.D(s.by(e.m - 1, before)));
  const Terms right = {e.by_u(T_m), -e.rate(e.by_u(before)), -e.I(e.by(e.m - 1, before)), -(r_tilde * e.f_by_u())};
  expect(s, e, right, "[L 3.14]");
  refute(s, e, {right[0], right[1], -e.on(e.I(s.by(e.m - 1, before))), right[3]}, "no tilde on T by q_nu^(m-1)");
  refute(s, e, {right[0], right[1], right[2]}, "non-Chaplygin terms forgotten");
  if (GetParam().solve) {
    EXPECT_TRUE(proved(right));  // else q_D^(m+1) stands for its value, and the terms cancel on the manifold only
  }
  if (GetParam().shipped) return;  // its f does not hold q_b^(m-1), to which the tilde in the last sum refers
  const Terms printed = {right[0], right[1], right[2], -(r * e.f_by_u())};
  refute(s, e, printed, "no tilde in the last sum");
  EXPECT_FALSE(proved(printed));
}

// df'_b/dq_nu^(m) = d/dt f_b,nu + df_b/dq_nu^(m-1) + sum_c df_b/dq_c^(m-1) f_c,nu
TEST_P(Reduced, RateOfTheSolvedConstraints) {
  const auto flat = [](const Rows& rows) {
    Column all;
    for (const Column& row : rows) all.insert(all.end(), row.begin(), row.end());
    return all;
  };
  Rows last;
  for (const Column& row : f_by_dependent()) last.push_back(row * e.f_by_u());
  const Terms right = {flat(e.f_rate_by_u()), -flat(e.rate(e.f_by_u())), -flat(e.f_by(e.m - 1)), -flat(last)};
  expect(s, e, right, "df'/dq^(m)");
  refute(s, e, {flat(e.f_by_u()), right[1], right[2], right[3]}, "f in place of f' on the left, as printed");
  if (GetParam().shipped) return;
  refute(s, e, {right[0], right[1], right[2]}, "non-Chaplygin terms forgotten");
  refute(s, e, {right[0], right[1], right[2], -right[3]}, "their sign");
}

INSTANTIATE_TEST_SUITE_P(Case, Reduced, testing::ValuesIn(cases(false)), case_name);

// Appell's equations in the reduced energy of accelerations; as printed they have S~ itself for every m
// [L 3.20, 3.21].
TEST_P(Reduced, EnergyOfAccelerations) {
  const Column E = lagrange_operator(s.m), contracted = e.contract(E);
  expect(s, e, {find_formulation("appell-reduced")->equations(s.m, e).left, -contracted}, "[L 3.21]");
  // S with q_D^(m) = f alone: for m = 1, q'' holds no f; for m = 3, S holds no q^(m).
  const Column literal = e.m == 1 ? e.on(e.I(gradient(s.m.S, s.m.qdd))) : e.by_u(s.m.S);
  if (e.m == 2)
    expect(s, e, {literal, -contracted}, "as printed, m = 2");
  else
    refute(s, e, {literal, -contracted}, "as printed, m = 1 and 3");
}

class Quasi : public Manifold {
 protected:
  void SetUp() override { eliminate(Unknowns::quasi_velocities); }
  Rows g_by_pi() const {  // dg_s/dpi_a^(m-1), an operator by definition
    Rows rows;
    for (const Column& row : e.g_by(e.m - 1)) rows.push_back(e.contract(row));
    return rows;
  }
};

TEST_P(Quasi, StarredEnergyByPiBelow) {  // [N 4.9]
  const Column p = e.on(s.by(e.m, before));
  const Terms right = {e.contract(e.by(e.m - 1, before)), -e.contract(s.by(e.m - 1, before)), -(p * g_by_pi())};
  expect(s, e, right, "[N 4.9]");
  EXPECT_TRUE(!GetParam().shipped || proved(right));  // the other systems hold the inverse of a 4 x 4 matrix
  refute(s, e, {right[0], right[1], -right[2]}, "the sign of the sum");
  refute(s, e, {right[0], right[1]}, "the sum forgotten");
}

TEST_P(Quasi, StarredEnergyByPi) {  // [N 4.10]
  const Terms right = {e.by_u(T_m), -e.contract(s.by(e.m, T_m)), -(e.on(s.by(e.m + 1, T_m)) * e.g_rate_by_u())};
  expect(s, e, right, "[N 4.10]");
  EXPECT_TRUE(!GetParam().shipped || proved(right));
  refute(s, e, {right[0], right[1]}, "q^(m+1) = g' not put in");
  refute(s, e, {right[0], right[1], -(e.on(s.by(e.m + 1, T_m)) * g_by_pi())}, "g in place of g'");
}

// dg'_s/dpi_a^(m) = d/dt B_sa + sum_r dg_s/dq_r^(m-1) B_ra
TEST_P(Quasi, RateOfTheTangents) {
  const auto flat = [](const Rows& rows) {
    Column all;
    for (const Column& row : rows) all.insert(all.end(), row.begin(), row.end());
    return all;
  };
  const Terms right = {flat(e.g_rate_by_u()), -flat(e.rate(e.g_by_u())), -flat(g_by_pi())};
  expect(s, e, right, "dg'/dpi");
  refute(s, e, {right[0], right[1], -right[2]}, "the sign of the sum");
}

INSTANTIATE_TEST_SUITE_P(Case, Quasi, testing::ValuesIn(cases(true)), case_name);

// ---- what the operators mean: differences along the manifold
// ----------------------------------------------------------------

// Points of the manifold: free quantities and their rates have given values, lower derivatives are those of a point,
// and q^(m) and q^(m+1) follow.
struct Along {
  const System& s;
  const Elimination& e;
  Column w, w_rate;  // u and phi, and their rates
  Column top, next;

  Along(const System& system, const Elimination& elimination)
      : s(system), e(elimination), top(jets(*s.model, e.m)), next(jets(*s.model, e.m + 1)) {
    w = e.in_coordinates(
        e.quasi ? Column(e.quasi->w.begin(), e.quasi->w.end() - static_cast<std::ptrdiff_t>(e.phi.size())) : e.I(top));
    w.insert(w.end(), e.phi.begin(), e.phi.end());
    w_rate = total_derivative(w);
  }
  // Returns `at` with the q^(m) and q^(m+1) at which w and w_rate have the given values.
  test::Point solved(test::Point at, const std::vector<Multi>& value, const std::vector<Multi>& rate) const {
    const auto less = [&](const Column& es, const std::vector<Multi>& v) {
      Column out;
      for (std::size_t i = 0; i < es.size(); ++i) {
        const Expr target = s.g().given(static_cast<std::uint32_t>(i), 0);  // a symbol that stands for the number
        at.set(target, v[i]);
        out.push_back(es[i] - target);
      }
      return out;
    };
    EXPECT_TRUE(test::solve_for(at, less(w, value), top));
    EXPECT_TRUE(test::solve_for(at, less(w_rate, rate), next));
    return at;
  }
};

// The error of by_u and by_u_rate, or of by(k) if k is given, against central differences of X between points of the
// manifold.
double operator_error(const System& s, const Elimination& e, Expr X, std::optional<unsigned> k = {}) {
  const PrecisionScope precision(60);
  const Multi h = test::raise(Multi(10), Rational(-15));
  const Along along(s, e);
  const std::optional<test::Point> found = test::manifold_point(*s.model, e, 5);
  if (!found) return 1e300;
  test::Point at = *found;
  for (std::uint32_t i = 0; i < s.model->masses.size(); ++i)
    at.set(s.g().mass(i), test::value(s.model->masses[i].value, at));  // frozen
  const std::vector<Multi> value = test::values(along.w, at), rate = test::values(along.w_rate, at);
  double worst = 0;
  const auto compare = [&](Expr symbolic, const test::Point& plus, const test::Point& minus) {
    const Multi numeric = (test::value(X, plus) - test::value(X, minus)) / (Multi(2) * h);
    worst = std::max(worst, test::distance(test::value(e.in_coordinates({symbolic})[0], at), numeric));
  };
  if (k) {
    const Column by_lower = e.by(*k, X);
    for (std::uint32_t a = 0; a < s.m.q.size(); ++a) {
      const Expr q = s.g().jet(a, *k);
      test::Point plus = at, minus = at;
      plus.set(q, test::value(q, at) + h);
      minus.set(q, test::value(q, at) - h);
      compare(by_lower[a], along.solved(plus, value, rate), along.solved(minus, value, rate));
    }
    return worst;
  }
  const auto shifted = [](std::vector<Multi> v, std::size_t i, const Multi& by) {
    v[i] += by;
    return v;
  };
  const Column by_u = e.by_u(X), by_rate = e.by_u_rate(X);
  for (std::size_t a = 0; a < e.free.names.size(); ++a) {
    compare(by_u[a], along.solved(at, shifted(value, a, h), rate), along.solved(at, shifted(value, a, -h), rate));
    compare(by_rate[a], along.solved(at, value, shifted(rate, a, h)), along.solved(at, value, shifted(rate, a, -h)));
  }
  return worst;
}

constexpr double kDifferences = 1e-24;  // the error of a step of 1e-15 is its square

TEST_P(Reduced, OperatorsAreDerivativesAlongTheManifold) {
  EXPECT_LE(operator_error(s, e, before), kDifferences);
  EXPECT_LE(operator_error(s, e, before, e.m - 1), kDifferences);
  EXPECT_LE(miss(s, e, {e.rate(Column{before}), -Column{T_m}}), kExact);
  // T^(m) holds q^(m+1) too, so the operators differentiate by both q^(m) and q^(m+1).
  EXPECT_LE(operator_error(s, e, T_m), kDifferences);
}

TEST_P(Quasi, OperatorsAreDerivativesAlongTheManifold) {
  EXPECT_LE(operator_error(s, e, before), kDifferences);
  EXPECT_LE(operator_error(s, e, before, e.m - 1), kDifferences);
  EXPECT_LE(operator_error(s, e, T_m), kDifferences);
}

TEST(OperatorsMutant, ADerivativeWithDependentOnesHeldIsRefuted) {
  const System& s = *generic(2, Shape::linear);
  const Elimination right = elimination_for(s.m, Unknowns::coordinates, {}, {}, false);
  const Expr before = total_derivative(s.m.T);
  EXPECT_GT(miss(s, right, {right.by_u(before), -right.I(s.by(2, before))}), kRefuted);
}

}  // namespace
}  // namespace anholon::identities_test

// The relation on which the Mac-Millan equations rest [Q 7, 13] (theory: classics), and the limits of the paper's
// "holonomic, hence the bracket vanishes".
#include <gtest/gtest.h>

#include "mechanics/integrability.h"
#include "support/identity.h"

namespace anholon::mac_millan_test {
namespace {

constexpr double kExact = 1e-28;
constexpr double kRefuted = 1e-6;

using test::System;

// d(v_i)/dq_nu' = dr_i/dq_nu + sum_b dr_i/dq_b dq_b'/dq_nu'  [Q 7]
TEST(MacMillan, DerivativesOfTheReducedVelocities) {
  for (const auto shape : {test::Shape::linear, test::Shape::nonlinear}) {
    const System& s = *test::generic(1, shape);
    const Elimination e = elimination_for(s.m, Unknowns::coordinates, {}, {}, shape == test::Shape::linear);
    Column by_velocity, contracted, independent;
    const auto append = [](Column& to, const Column& c) { to.insert(to.end(), c.begin(), c.end()); };
    for (const WeightedPoint& p : s.m.points)
      for (int i = 0; i < 3; ++i) {
        const Column by_q = gradient(p.place[i], s.m.q);
        append(by_velocity, e.by_u(total_derivative(p.place[i])));
        append(contracted, e.on(e.I(by_q)) + e.on(e.D(by_q)) * e.f_by_u());
        append(independent, e.on(e.I(by_q)));
      }
    EXPECT_LE(test::miss(s, e, {by_velocity, -contracted}), kExact);
    EXPECT_TRUE(test::proved({by_velocity, -contracted}));
    EXPECT_GT(test::miss(s, e, {by_velocity, -independent}), kRefuted) << "the sum forgotten";
  }
}

// Two coordinates of one particle of mass 2 in a turning frame, with a constraint that is integrable: q2 = C exp(q1).
System bound_by(const std::string& equation) {
  return System(test::model_of(
      "coordinates = [\"q1\", \"q2\"]\nparameters = {m = 2}\n[functions]\nw = {}\n[observer]\nspin = \"w*ez\"\n"
      "[[particle]]\nname = \"p\"\nmass = \"m\"\nposition = [\"q1\", \"q2\", 0]\n[[constraint]]\nname = "
      "\"c\"\nequation = \"" +
      equation + "\"\n[initial]\nq2 = 1\n\"q1'\" = 1\n"));
}

Expr bracket(const System& s, const Elimination& e) {
  for (const Quantity& q : find_formulation("mac-millan")->quantities(s.m, e))
    if (q.name.text.rfind("bracket.", 0) == 0) return q.value;
  throw std::runtime_error("no bracket is listed");
}

TEST(MacMillan, TheBracketOfAnIntegrableConstraintInVelocityFormStays) {
  const System s = bound_by("q2' = q2*q1'");
  const Elimination e = elimination_for(s.m, Unknowns::coordinates, {}, {1});
  const Expr m = put_masses(*s.model, s.m.points[0].weight), q2 = s.m.q[1], rate = s.m.qd[0];
  const Expr expected = m * pow(q2, Rational(2)) * pow(rate, Rational(2));
  EXPECT_TRUE(proved_zero(put_masses(*s.model, bracket(s, e)) - expected));
  // The constraint is integrable nevertheless.
  PointValues near([](const Node&) { return 0.7; });
  EXPECT_EQ(integrability(s.m, {0}, near).integrable(), 1);
  // The equations with the bracket are those of Maggi; without the bracket they are not.
  const Equations with = find_formulation("mac-millan")->equations(s.m, e),
                  maggi = find_formulation("maggi")->equations(s.m, e);
  EXPECT_TRUE(test::proved({with.left, -with.right, -maggi.left, maggi.right}));
  EXPECT_FALSE(test::proved({with.left, -with.right, {bracket(s, e)}, -maggi.left, maggi.right}));
  EXPECT_GT(test::miss(s, e, {with.left, -with.right, {bracket(s, e)}, -maggi.left, maggi.right}), kRefuted);
}

// If a holonomic constraint is solved for a coordinate, f holds independent coordinates only, and the bracket vanishes.
TEST(MacMillan, TheBracketOfAHolonomicConstraintVanishes) {
  for (const char* equation : {"q2 = exp(q1)", "q2 = q1^2*sin(t)"}) {
    const System s = bound_by(equation);
    const Elimination e = elimination_for(s.m, Unknowns::coordinates, {}, {1});
    EXPECT_TRUE(proved_zero(bracket(s, e))) << equation;
  }
  // The bracket stays if the lifted constraint still holds the dependent coordinate.
  const System s = bound_by("q2^2 = exp(2*q1)");
  const Elimination e = elimination_for(s.m, Unknowns::coordinates, {}, {1});
  EXPECT_GT(test::miss(s, e, {{bracket(s, e)}}), kRefuted);
}

}  // namespace
}  // namespace anholon::mac_millan_test

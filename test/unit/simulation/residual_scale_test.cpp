// The residuals have a meaningful scale: motions at rest are no worse than others, and a wrong equation is noticed,
// however small its forces are.
#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::residual_scale_test {
namespace {

Scenario scenario(const std::string& text) {
  Scenario s;
  const Outcome made = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  EXPECT_TRUE(made.ok()) << made.message;
  return s;
}

SimulationReport report(const Scenario& scenario, const Rational& to, const Rational& every = 0) {
  Workspace s(scenario);
  SimulationOptions o;
  o.to = to;
  if (every > 0) o.every = every;
  o.conserved = conserved(*s.mechanics);
  test::TextRows rows;
  SimulationReport r = simulate(s, o, rows);
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  return r;
}

constexpr double kRoundoff = 1e-16;  // of long double, with room

// All velocities are round-off of forces in balance.
TEST(ResidualScale, AHangingChainAtRest) {
  const SimulationReport r = report(scenario(R"toml(coordinates = ["x[i]", "y[i]"]
index.i = "1..4"
particle = [{name = "p[i]", mass = 1, position = "x[i]*ex + y[i]*ey"}]
gravity.field = "-9.81*ey"
constraint = [
  {name = "c1", equation = "x[1]^2 + y[1]^2 = 0.01"},
  {name = "c2", equation = "(x[2] - x[1])^2 + (y[2] - y[1])^2 = 0.01"},
  {name = "c3", equation = "(x[3] - x[2])^2 + (y[3] - y[2])^2 = 0.01"},
  {name = "c4", equation = "(x[4] - x[3])^2 + (y[4] - y[3])^2 = 0.01"},
]
[initial]
"x[i]" = 0
guess = {"y[1]" = -0.1, "y[2]" = -0.2, "y[3]" = -0.3, "y[4]" = -0.4}
)toml"),
                                    5);
  EXPECT_LT(r.constraints_kept, kRoundoff);
  EXPECT_LT(r.newton, kRoundoff);
  EXPECT_LT(r.projected, kRoundoff);
  EXPECT_LT(r.power, kRoundoff);
}

// A rod without freedom, beside a mass that swings.
TEST(ResidualScale, WhatCannotMoveBesideWhatMoves) {
  const SimulationReport r = report(scenario(R"toml(coordinates = ["x", "y", "th", "z"]
body = [{name = "rod", mass = 1, inertia = "1/12", center = "x*ex + y*ey", angle = "th"}]
particle = [{name = "p", mass = 1, position = "z*ex"}]
gravity.field = "-9.81*ey"
force = [{on = "p", vector = "-z*ex"}]
constraint = [
  {name = "a", equation = "x - cos(th)/2 = 0"},
  {name = "b", equation = "y - sin(th)/2 = 0"},
  {name = "e", equation = "(x + cos(th)/2 - 0.3)^2 + (y + sin(th)/2)^2 = 1"},
]
initial = {z = 0.1, guess = {x = 0.5, th = 1}}
)toml"),
                                    5);
  EXPECT_LT(r.constraints_kept, kRoundoff);
  EXPECT_LT(r.newton, kRoundoff);
  for (const ConstraintReport& c : r.constraints_each)
    for (const double x : c.residuals) EXPECT_LT(x, kRoundoff) << c.name;
}

// On level ground z, pitch and their derivatives are round-off of the wheels' motion.
TEST(ResidualScale, ACartThatStaysLevel) {
  const SimulationReport r = report(scenario(R"toml(coordinates = ["x", "y", "z", "psi", "pitch", "roll", "phi"]
frame.B = "rotz(psi)*roty(pitch)*rotx(roll)"
point.A = "x*ex + y*ey + z*ez"
gravity.field = "-9.81*ez"
body = [
  {name = "cart", mass = 6, inertia = [0.12, 0.12, 0.12], center = "A + 0.05*B.x + 0.04*B.z", orientation = "B"},
  {name = "wheel", mass = 0.5, shape = "disc(0.08)", center = "A - 0.18*B.y", orientation = "B*rotx(-pi/2)*rotz(phi)"},
]
constraint = [
  {name = "roll", equation = "vel(wheel, A - 0.18*B.y - 0.08*ez) = 0", along = ["rotz(psi).x", "rotz(psi).y"]},
  {name = "right", equation = "(A - 0.18*B.y).z = 0.08"},
  {name = "left", equation = "(A + 0.18*B.y).z = 0.08"},
  {name = "back", equation = "(A - 0.25*B.x).z = 0.08"},
]
force = [{on = "wheel", from = "cart", torque = "(0.3 - 0.02*phi')*B.y"}]
initial = {z = 0.08, "psi'" = 0.7}
)toml"),
                                    5, Rational(1, 20));
  EXPECT_LT(r.constraints_kept, kRoundoff);
  for (const ConstraintReport& c : r.constraints_each)
    for (const double x : c.residuals) EXPECT_LT(x, kRoundoff) << c.name;
}

// The sled turns over 10^7 joules and comes to rest.
TEST(ResidualScale, ASledThatHasComeToRest) {
  const SimulationReport r = report(scenario(R"toml(coordinates = ["s"]
particle = [{name = "sled", mass = 100, position = "s*ex"}]
force = [{on = "sled", vector = "-0.25*s'*abs(s')*ex - 50*sign(s')*ex"}]
event = [{name = "rest", when = "s'", direction = "down", stop = true}]
initial = {"s'" = 400}
)toml"),
                                    600);
  EXPECT_LT(r.power, 1e-12);
}

// A particle in balance on a slope: gravity and the slope do opposite work on the round-off of its path.
TEST(ResidualScale, AParticleInBalance) {
  const SimulationReport r = report(scenario(R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
gravity.field = "0.981*ex - 9.81*ey"
constraint = [{name = "c", equation = "y = 1.3*x*sin(x) + 0.1*x"}]
initial = {x = 0}
)toml"),
                                    5);
  EXPECT_LT(r.power, 1e-6);
}

std::string pendulum(const char* mass) {
  return std::string("coordinates = [\"x\", \"y\"]\nparameters = {g = 9.81}\nparticle = [{name = \"p\", mass = \"") +
         mass +
         "\", position = \"x*ex + y*ey\"}]\ngravity.field = \"-g*ey\"\nconstraint = [{name = \"rod\", equation = \"x^2 "
         "+ y^2 = 1\"}]\n"
         "initial = {x = 0.6, guess = {y = -0.8}}\n";
}

// The mutant: the integrated equations have gravity with the wrong sign. Newton's law and the balance of energy show it
// in any units.
TEST(ResidualScale, AWrongSignIsReportedLarge) {
  for (const char* mass : {"1", "1/1000000000", "1000000000"}) {
    Workspace s(scenario(pendulum(mass)));
    const SimulationReport right = report(s, 1, Rational(1, 10));
    EXPECT_LT(right.newton, kRoundoff) << mass;
    EXPECT_LT(right.power, 1e-10) << mass;
    Graph& g = *s.model->graph;
    s.system.equations = substitute(
        s.system.equations, [&](NodeId id) { return g.node(id).kind == Kind::parameter ? -Expr{&g, id} : Expr{}; });
    const SimulationReport wrong = report(s, 1, Rational(1, 10));
    EXPECT_GT(wrong.newton, 0.1) << mass;
    EXPECT_GT(wrong.projected, 0.1) << mass;
    EXPECT_GT(wrong.power, 0.1) << mass;
  }
}

}  // namespace
}  // namespace anholon::residual_scale_test

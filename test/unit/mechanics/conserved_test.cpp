// Integrals of the motion: which are found, that they are proved, and mutants for which nothing may be found.
#include <algorithm>

#include <gtest/gtest.h>

#include "expr/normal.h"
#include "mechanics/conserved.h"
#include "support/models.h"

namespace anholon::conserved_test {
namespace {

std::vector<std::string> names_of(const std::shared_ptr<const Model>& model) {
  const Mechanics m = mechanics(*model);
  std::vector<std::string> names;
  for (const Conserved& c : conserved(m)) names.push_back(c.name);
  return names;
}
using Names = std::vector<std::string>;

const std::string kPlane = R"toml(coordinates = ["x", "y"]
[parameters]
m = 2
k = 3
[[particle]]
name = "P"
mass = "m"
position = ["x", "y", "0"]
[potential]
spring = "k/2*(x^2 + y^2)"
)toml";

TEST(Conserved, CentralForceKeepsEnergyAndAngularMomentum) {
  const Names both = {"energy", "momentum along -y*d/dx + x*d/dy"};
  const Names found = names_of(test::model_of(kPlane));
  EXPECT_EQ(found, both);
}

TEST(Conserved, NotWhereTheForceTurnsTheMutantAway) {
  // The system has no symmetry, but a potential.
  EXPECT_EQ(names_of(test::model_of(test::replaced(kPlane, "(x^2 + y^2)", "(x^2 + 2*y^2)"))), Names{"energy"});
  // A damper leaves no energy; its force turns with the plane, but changes the momentum.
  EXPECT_EQ(names_of(test::model_of(kPlane + "[[force]]\non = \"P\"\nvector = \"-vel(P.center)\"\n")), Names{});
  // Time occurs explicitly.
  EXPECT_EQ(names_of(test::model_of(test::replaced(kPlane, "k/2*(x^2 + y^2)", "sin(t)*x"))), Names{"momentum of y"});
  // The mass varies: expelled mass takes its momentum along, and mass that joins at rest brings none.
  EXPECT_EQ(names_of(test::model_of(test::replaced(kPlane, "mass = \"m\"", "mass = \"m + t\""))), Names{});
  EXPECT_EQ(names_of(test::model_of(test::replaced(kPlane, "mass = \"m\"",
                                                   "mass = \"m + t\"\nexpelled_velocity = \"-vel(P.center)\"")))
                .size(),
            1U);
  // A rheonomic constraint does work; one that touches both coordinates keeps only the energy.
  EXPECT_EQ(names_of(test::model_of(kPlane + "[[constraint]]\nname = \"drive\"\nequation = \"y' = x + t\"\n")),
            Names{});
  EXPECT_EQ(names_of(test::model_of(kPlane + "[[constraint]]\nname = \"blade\"\nequation = \"y' = x*x'\"\n")),
            Names{"energy"});
}

TEST(Conserved, AConstraintOnACyclicCoordinateEndsItsMomentum) {
  const std::string free = R"toml(coordinates = ["x", "y", "th"]
[parameters]
m = 2
J = 3
[[body]]
name = "B"
mass = "m"
inertia = "J"
center = ["x", "y", "0"]
angle = "th"
)toml";
  const Names all = names_of(test::model_of(free));
  for (const char* name : {"energy", "momentum of x", "momentum of y", "momentum of th"})
    EXPECT_NE(std::find(all.begin(), all.end(), name), all.end()) << name;
  EXPECT_EQ(
      names_of(test::model_of(free + "[[constraint]]\nname = \"blade\"\nequation = \"y'*cos(th) = x'*sin(th)\"\n")),
      (Names{"energy", "momentum of th"}));
  // The blade is away from the mass centre: the plane may turn as a whole, but the blade prevents it.
  EXPECT_EQ(names_of(test::model_of(
                free + "[[constraint]]\nname = \"blade\"\nequation = \"y'*cos(th) = x'*sin(th) + th'\"\n")),
            Names{"energy"});
}

TEST(Conserved, TwoBodiesKeepWhatTheyShare) {
  const std::string two = R"toml(coordinates = ["x1", "x2"]
[parameters]
m1 = 2
m2 = 3
k = 1
[[particle]]
name = "A"
mass = "m1"
position = ["x1", "0", "0"]
[[particle]]
name = "B"
mass = "m2"
position = ["x2", "0", "0"]
[potential]
spring = "k/2*(x1 - x2)^2"
)toml";
  EXPECT_EQ(names_of(test::model_of(two)), (Names{"energy", "momentum along d/dx1 + d/dx2"}));
  EXPECT_EQ(names_of(test::model_of(test::replaced(two, "(x1 - x2)^2", "(x1 - 2*x2)^2"))),
            (Names{"energy", "momentum along d/dx1 + 1/2*d/dx2"}));
  EXPECT_EQ(names_of(test::model_of(two + "[[force]]\non = \"A\"\nvector = [\"x1*x2\", \"0\", \"0\"]\n")), Names{});
}

TEST(Conserved, GravityFrameAndDrivenPlaces) {
  const std::string fall = R"toml(coordinates = ["x", "y", "z"]
[parameters]
m = 2
mu = 3
w = 2
g = 10
[[particle]]
name = "P"
mass = "m"
position = ["x", "y", "z"]
[gravity]
field = "-mu/norm(here)^3*here"
)toml";
  const Names newton = names_of(test::model_of(fall));
  ASSERT_EQ(newton.size(), 4U) << "energy and three angular momenta";
  EXPECT_EQ(newton[0], "energy");
  EXPECT_EQ(names_of(test::model_of(test::replaced(fall, "norm(here)^3", "norm(here)^4"))).size(), 3U)
      << "no potential of that power is tried";
  // In a turning frame: the Jacobi integral, and the angular momentum about its axis; with omega(t) only the latter.
  const Names turning = names_of(test::model_of(fall + "[observer]\nspin = \"w*ez\"\n"));
  ASSERT_EQ(turning.size(), 2U);
  EXPECT_EQ(turning[0], "Jacobi integral");
  EXPECT_EQ(names_of(test::model_of(fall + "[observer]\nspin = \"w*t*ez\"\n")), Names{turning[1]});
}

// The proofs hold where formulas have derivatives: h + U keeps its value if U is continuous, and not if U jumps.
TEST(Conserved, IsMarkedWhereItsFormulaJumps) {
  const auto jumps = [](const std::string& potential, const std::string& more = "") {
    const auto model = test::model_of(
        "coordinates = [\"x\", \"y\"]\nparameters = {k = 3, l = 1}\n" + more +
        "[[particle]]\nname = \"P\"\nmass = 2\nposition = \"x*ex + y*ey\"\n[potential]\nU = \"" + potential + "\"\n");
    const Mechanics m = mechanics(*model);
    const std::vector<Conserved> list = conserved(m);
    EXPECT_FALSE(list.empty()) << potential;
    if (list.empty()) return false;
    EXPECT_EQ(list.front().name, "energy") << potential;
    // Only a jump of the potential changes a momentum.
    for (std::size_t i = 1; i < list.size() && !list.front().jumps; ++i) EXPECT_FALSE(list[i].jumps) << list[i].name;
    return list.front().jumps;
  };
  for (const char* potential :
       {"k*sign(x - l/2)", "piecewise(x > 0.5, k*x^2, k*x)", "k*atan2(y, x)", "abs(x) + sign(x)", "x^2*choose(x, 1, 2)",
        "piecewise(x > 1, 1, x > 0, x^2, x)*sign(y)"})
    EXPECT_TRUE(jumps(potential)) << potential;
  for (const char* potential :
       {"k*abs(x)", "k*max(x, l)^2", "piecewise(x > 0.5, k*x^2, k*x/2)", "k*x*sign(x)", "k*x^2*sign(x)*sign(y)*y",
        "piecewise(x > l, k*(x - l)^2, x < -l, k*(x + l)^2, 0)", "piecewise(x > 1, x, x < -1, -x, 1)",
        "k/2*max(sqrt(x^2 + y^2) - l, 0)^2", "x^2*choose(k, 1, 2)"})
    EXPECT_FALSE(jumps(potential)) << potential;
}

TEST(Conserved, SpringsGivenAsTensions) {
  const std::string spring = R"toml(coordinates = ["x", "y"]
[parameters]
m = 2
k = 3
l = 1
[[particle]]
name = "A"
mass = "m"
position = ["x", "0", "0"]
[[particle]]
name = "B"
mass = "2*m"
position = ["0", "y", "1"]
[[force]]
on = "A"
from = "B"
tension = "k*(norm(A.center - B.center) - l)"
)toml";
  EXPECT_EQ(names_of(test::model_of(spring)), Names{"energy"});
  EXPECT_EQ(names_of(test::model_of(test::replaced(spring, "- l)", "- l) + x'"))), Names{});
}

// The power identity proves again, in time, each integral that is found for a shipped model.
class OfShipped : public testing::TestWithParam<std::string> {};

TEST_P(OfShipped, HasAnEnergyOnlyWhereThePowerIdentitySaysSo) {
  const auto model = test::shipped(GetParam());
  const Mechanics m = mechanics(*model);
  for (const Conserved& c : conserved(m)) {
    EXPECT_EQ(c.value, sum(c.terms));
    if (c.name.rfind("momentum", 0) == 0) continue;
    // d(h + U)/dt = noncons + dU/dt, where U is the sum of all terms but the first.
    Expr rate = power(m).noncons;
    for (std::size_t k = 1; k < c.terms.size(); ++k) rate += total_derivative(c.terms[k]);
    EXPECT_TRUE(proved_zero(rate)) << c.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Models, OfShipped, testing::ValuesIn(test::shipped_models()),
                         [](const auto& p) { return test::test_name(p.param); });

// A step of a potential exerts a force when the motion meets it, and a step of a constraint makes velocities jump.
TEST(Conserved, JumpsOfPotentialsAndConstraintsAreMarked) {
  const auto marked = [](const std::string& text) {
    const auto model = test::model_of(text);
    const Mechanics m = mechanics(*model);
    Names list;
    for (const Conserved& c : conserved(m)) list.push_back(c.name + (c.jumps ? " jumps" : ""));
    return list;
  };
  const auto potential = [](const std::string& v) { return test::replaced(kPlane, "k/2*(x^2 + y^2)", v); };
  const auto constraint = [&](const std::string& equation) {
    return potential("3") + "[[constraint]]\nname = \"c\"\nequation = \"" + equation + "\"\n";
  };
  const auto has = [](const Names& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  const Names step = marked(potential("piecewise(x > 1, 3, 0) + piecewise(t < 1, 0, 5)"));
  EXPECT_TRUE(has(step, "momentum of x jumps") && has(step, "momentum of y"));
  const Names in_time = marked(potential("piecewise(t < 1, 0, 5)"));
  EXPECT_TRUE(has(in_time, "momentum of x") && has(in_time, "momentum of y"));
  const Names kink = marked(potential("abs(x)"));
  EXPECT_TRUE(has(kink, "energy") && has(kink, "momentum of y"));
  EXPECT_TRUE(has(marked(constraint("y' = sign(x - 1/2)*x'")), "energy jumps"));
  EXPECT_TRUE(has(marked(constraint("y = abs(x)")), "energy jumps"));
  EXPECT_TRUE(has(marked(constraint("y' = 2*x'")), "energy"));
  EXPECT_NO_THROW(marked(constraint("y' = abs(x')^(1/2)"))) << "its derivative has no value where x' = 0";
}

}  // namespace
}  // namespace anholon::conserved_test

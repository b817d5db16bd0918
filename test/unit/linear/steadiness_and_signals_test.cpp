// Which motions are steady, and how inputs and outputs enter linear models.
#include <gtest/gtest.h>

#include "linear/study.h"
#include "support/models.h"

namespace anholon::steadiness_and_signals_test {
namespace {

constexpr double kExact = 1e-15;

LinearModel linear(const std::string& text) {
  LinearRequest request;
  request.form = find_formulation("routh");
  const LinearStudy study(test::model_of(text), request);
  const PrecisionScope precision(study.working_digits());
  const Linearization l = study.compute();
  EXPECT_TRUE(l.results[0].outcome.ok()) << l.results[0].outcome.message;
  return l.results[0].model;
}

// Excitations of many frequencies, and roads of many wavelengths.
TEST(Steadiness, AnExcitationIsNoEquilibrium) {
  for (const char* f : {"4/3", "4", "24", "50", "60", "61", "100", "1/7", "1000", "1e6"}) {
    const LinearModel m = linear(std::string("coordinates = [\"x\"]\nparameters.f = \"") + f +
                                 "\"\nparticle = [{name = \"a\", mass = 1, position = \"x*ex\"}]\n"
                                 "force = [{on = \"a\", vector = \"(sin(2*pi*f*t) - 20*x)*ex\"}]\n");
    EXPECT_EQ(m.motion, LinearModel::Motion::unsteady) << f;
  }
  for (const char* k : {"1", "2/5", "8/3", "16/5"}) {
    const LinearModel m = linear(std::string("coordinates = [\"x\", \"y\"]\nparameters.k = \"") + k +
                                 "\"\nparticle = [{name = \"a\", mass = 1, position = \"x*ex + y*ey\"}]\n"
                                 "force = [{on = \"a\", vector = \"(sin(2*pi*k*x)^3 - 20*y)*ey\"}]\n"
                                 "initial = {\"x'\" = 1}\n");
    EXPECT_EQ(m.motion, LinearModel::Motion::unsteady) << k;
  }
}

// A coordinate that only counts does not make a steady motion unsteady.
TEST(Steadiness, AnOdometerHasNoInfluence) {
  const auto text = [](const std::string& force) {
    return "coordinates = [\"x\", \"y\"]\nparticle = [{name = \"a\", mass = 1, position = \"x*ex + y*ey\"}]\n"
           "force = [{on = \"a\", vector = \"" +
           force +
           "\"}]\nstate.odometer = {rate = \"x'\", initial = 0}\nstate.clock = {rate = 1, initial = 0}\n"
           "initial = {\"x'\" = 1}\n";
  };
  const LinearModel m = linear(text("(1 - x')*ex - 4*y*ey"));
  EXPECT_EQ(m.motion, LinearModel::Motion::steady);
  EXPECT_EQ(m.cyclic.size(), 3U);
  EXPECT_EQ(linear(text("(1 - x')*ex - (4 + odometer)*y*ey")).motion, LinearModel::Motion::unsteady);
}

// A disc rolls on a circle; its radius makes the velocity of the point of contact an independent one.
const std::string kDisc = R"toml(coordinates = ["phi", "x", "psi", "y", "th"]
parameters = {R = 3}
gravity.field = "-9.81*ez"
frame.f = "rotz(psi)*rotx(th)"
point.P = "x*ex + y*ey"
body = [{name = "disc", mass = 1, inertia = ["R^2/4", "R^2/2", "R^2/4"], center = "P + R*f.z", orientation = "f*roty(phi)"}]
constraint = [{name = "rolls", equation = "vel(disc, P) = 0", along = ["rotz(psi).x", "rotz(psi).y"]}]
initial.th = 0.2
initial."phi'" = 5
)toml";
TEST(Steadiness, CoordinatesWithoutWhichATurnIsSteady) {
  const std::string steady = "initial.conditions = [\"th' = 0\", \"th'' = 0\"]\n";
  const LinearModel m = linear(kDisc + steady);
  EXPECT_EQ(m.motion, LinearModel::Motion::unsteady);
  EXPECT_EQ(m.eliminate, (std::vector<std::string>{"x", "y"}));
  const LinearModel falls = linear(kDisc + "initial.conditions = [\"th' = 0\", \"psi' = 0.3\"]\n");
  EXPECT_EQ(falls.motion, LinearModel::Motion::unsteady);
  EXPECT_TRUE(falls.eliminate.empty());
  // An equation holds x, so the turn is steady in no choice of velocities.
  const LinearModel pulled = linear(kDisc + steady + "force = [{on = \"disc\", vector = \"-x*ex/1000\"}]\n");
  EXPECT_EQ(pulled.motion, LinearModel::Motion::unsteady);
  EXPECT_TRUE(pulled.eliminate.empty());
}

// u = 8 (ref - x) - 4 x' and m x'' = u: the input ref acts through u.
TEST(Signals, AnInputActsInOtherInputs) {
  const LinearModel m = linear(R"(coordinates = ["x"]
particle = [{name = "p", mass = 2, position = "x*ex"}]
input.ref = "0"
input.u = "8*(ref - x) - 4*x' + twice"
input.twice = "2*ref"
force = [{on = "p", vector = "u*ex"}]
output.place = "x"
output.effort = "u"
)");
  ASSERT_EQ(m.inputs, (std::vector<std::string>{"ref", "u", "twice"}));
  const double A[2] = {-4, -2}, B[3] = {5, 0.5, 0.5}, C[2] = {-8, -4}, D[3] = {10, 1, 1};
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_NEAR(to_double(m.A(1, k)), A[k], kExact);
    EXPECT_NEAR(to_double(m.C(1, k)), C[k], kExact);
  }
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(to_double(m.B(1, k)), B[k], kExact);
    EXPECT_NEAR(to_double(m.D(0, k)), 0, kExact);
    EXPECT_NEAR(to_double(m.D(1, k)), D[k], kExact);
  }
}

// The formula of u is in the potential from the reading on.
TEST(Signals, AnInputThatIsPutInBringsOthers) {
  const LinearModel m = linear(R"(coordinates = ["x"]
particle = [{name = "p", mass = 2, position = "x*ex"}]
input.ref = "0"
input.far = "ref"
input.u = "far - x"
potential.V = "u*x/2"
)");
  ASSERT_EQ(m.notes.size(), 1U);
  EXPECT_NE(m.notes[0].find("the input 'u' is put into the potential 'V'"), std::string::npos) << m.notes[0];
  EXPECT_NE(m.notes[0].find("nor what 'far', 'ref' does by it"), std::string::npos) << m.notes[0];
}

TEST(Signals, AnOutputIsInTheUnitOfItsColumn) {
  const LinearModel m = linear(R"T(coordinates = ["x"]
particle = [{name = "p", mass = 2, position = "x*ex"}]
input.u = "0"
force = [{on = "p", vector = "u*ex"}]
output.place = {value = "x", unit = "mm"}
output.angle = {value = "x/(1 m)", unit = "deg"}
output.force = {value = "(u + u/2)*ex", unit = "kN"}
)T");
  EXPECT_NEAR(to_double(m.C(0, 0)), 1000, 1000 * kExact);
  EXPECT_NEAR(to_double(m.C(1, 0)), 180 / M_PI, 100 * kExact);
  EXPECT_NEAR(to_double(m.D(2, 0)), 0.0015, kExact);
}

// th'' = -9 th - u'': B holds the effect of u only, not of its rate; an input in a force acts by itself.
TEST(Signals, TheRateOfAnInputIsNamed) {
  const auto text = [](const std::string& position, const std::string& force, const std::string& output) {
    return "coordinates = [\"th\"]\ninput.u = \"0\"\nparticle = [{name = \"p\", mass = 2, position = \"" + position +
           "\"}]\ngravity.field = \"-9*ez\"\nforce = [{on = \"p\", vector = \"" + force + "\"}]\noutput.y = \"" +
           output + "\"\n";
  };
  const std::string arm = "sin(th)*ex - cos(th)*ez";
  const LinearModel m = linear(text("u*ex + " + arm, "0*ex", "th"));
  ASSERT_EQ(m.notes.size(), 1U);
  EXPECT_NE(m.notes[0].find("the rate of the input 'u'"), std::string::npos);
  EXPECT_EQ(linear(text(arm, "u*ex", "u'")).notes.size(), 1U);
  EXPECT_TRUE(linear(text(arm, "u*ex", "u")).notes.empty());
}

// A speed does not follow a force at once: its entries of D are 0, also where solutions of linear equations make them.
TEST(Signals, AnOutputThatAnInputDoesNotMoveHasZeros) {
  LinearRequest request;
  request.form = find_formulation("routh");
  request.choice.eliminate = {0, 1};
  const auto car = test::model_of(R"toml(
coordinates = ["x", "y", "th", "ph"]
parameters = {v = 2, L = 1.5, m = 800, J = 500, ref = 0.2}
frame = {B = "rotz(th)", F = "B*rotz(ph)"}
point.A = "x*ex + y*ey"
body = [{name = "car", mass = "m", inertia = "J", center = "A + L/2*B.x", orientation = "B"},
        {name = "front", inertia = 5, center = "A + L*B.x", orientation = "F"}]
constraint = [{name = "c0", equation = "dot(vel(A), B.y) = 0"}, {name = "cf", equation = "dot(vel(A + L*B.x), F.y) = 0"}]
input = {tau = "-200*(ph - ref) - 60*ph'", drive = "500*(v - dot(vel(A), B.x))"}
force = [{on = "front", from = "car", torque = "tau*ez"}, {on = "car", vector = "drive*B.x"}]
output.speed = "dot(vel(A), B.x)"
initial = {ph = 0.2, "ph'" = 0, conditions = ["dot(vel(A), B.x) = v"]}
)toml");
  const LinearStudy study(car, request);
  const PrecisionScope precision(study.working_digits());
  const Linearization l = study.compute();
  ASSERT_TRUE(l.results[0].outcome.ok()) << l.results[0].outcome.message;
  const LinearModel& m = l.results[0].model;
  ASSERT_EQ(m.D.cols, 2U);
  EXPECT_TRUE(m.D(0, 0) == Multi(0) && m.D(0, 1) == Multi(0)) << to_double(m.D(0, 0)) << ", " << to_double(m.D(0, 1));
}

}  // namespace
}  // namespace anholon::steadiness_and_signals_test

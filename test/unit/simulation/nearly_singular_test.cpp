// Motions whose equations are nearly singular, or whose unknowns have very different sizes: there the steps of Newton's
// iteration for the leading derivatives do not shrink, though the equations hold to round-off.
#include <cmath>
#include <cstdlib>
#include <regex>

#include <gtest/gtest.h>

#include "support/motion.h"
#include "support/oracle.h"

namespace anholon::nearly_singular_test {
namespace {

using Result = test::Motion;

Result run(const std::string& text, const Rational& to, Precision numbers = Precision::real,
           const char* tolerance = "1000000000000", int digits = 16) {
  Result r;
  Scenario s;
  const Outcome made = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  EXPECT_TRUE(made.ok()) << made.message;
  SimulationOptions o;
  o.to = to;
  o.precision = numbers;
  o.digits = digits;
  o.tolerance = Rational(1, mpz_class(tolerance));
  r.report = simulate(s, o, r.rows);
  return r;
}

// The model of the reference data, with its expressions as they are written there.
std::string as_written(const nlohmann::json& data) {
  const auto formula = [](std::string text) {
    text = std::regex_replace(text, std::regex("\\*\\*"), "^");
    return "\"" + std::regex_replace(text, std::regex("\\b(x|y|ps|th|ph)_1\\b"), "$1'") + "\"";
  };
  const auto vector = [&](const nlohmann::json& v) {
    return "[" + formula(v[0]) + ", " + formula(v[1]) + ", " + formula(v[2]) + "]";
  };
  const nlohmann::json& body = data["bodies"][0];
  std::string text = "coordinates = [\"x\", \"y\", \"ps\", \"th\", \"ph\"]\n[parameters]\n", axes, initial;
  for (const auto& [name, value] : data["params"].items())
    text += name + " = " + formula(value.get<std::string>()) + "\n";
  for (const nlohmann::json& a : body["axes"])
    axes += (axes.empty() ? "" : ", ") + ("{weight = " + formula(a[0]) + ", vector = " + vector(a[1]) + "}");
  text += "[[body]]\nname = \"b\"\nmass = " + formula(body["m"]) + "\ncenter = " + vector(body["r"]) + "\naxes = [" +
          axes + "]\n";
  text += "[[force]]\non = \"b\"\nvector = " + vector(body["F"]) + "\n";
  for (const nlohmann::json& c : data["constraints"])
    text += "[[constraint]]\nequation = \"" + formula(c["expr"]).substr(1, formula(c["expr"]).size() - 2) + " = 0\"\n";
  text += "[initial]\n";
  for (const auto& [symbol, value] : data["trajectory"]["initial_state"].items()) {
    const auto [name, order] = test::split_order(symbol);
    text += "\"" + name + std::string(order, '\'') + "\" = " + value.get<std::string>() + "\n";
  }
  return text;
}

// Accelerations do not depend on the unit of mass: a sleigh of a micrometre and 1e-18 kg, or with the mass of a planet,
// moves as one of a metre and 1 kg, and its equations are as regular.
TEST(Units, MassesOfAnySizeHaveOneMotion) {
  const auto sleigh = [](const std::string& mass, const std::string& length) {
    return "coordinates = [\"x\", \"y\", \"th\"]\nparameters = {M = " + mass + ", L = " + length + R"toml(}
frame.S = "rotz(th)"
body = [{name = "b", mass = "M", inertia = "0.4*M*L^2", center = "x*ex + y*ey + 0.3*L*S.x", orientation = "S"}]
constraint = [{name = "blade", equation = "dot(vel(x*ex + y*ey), S.y) = 0"}]
initial = {x = "L", y = "L/2", th = 0.3, "x'" = "L", "th'" = 0.7}
)toml";
  };
  const Result usual = run(sleigh("1", "1"), 3);
  ASSERT_TRUE(usual.report.outcome.ok()) << usual.report.outcome.message;
  for (const auto& [mass, length] : {std::pair("1e-18", "1"), std::pair("1e-18", "1e-6"), std::pair("1e-8", "1"),
                                     std::pair("1e15", "1"), std::pair("1e24", "1")}) {
    const Result other = run(sleigh(mass, length), 3);
    ASSERT_TRUE(other.report.outcome.ok()) << mass << other.report.outcome.message;
    EXPECT_NEAR(other.last("th"), usual.last("th"), 1e-11) << mass;
    EXPECT_NEAR(other.last("x") / std::stod(length), usual.last("x"), 1e-11) << mass;
    EXPECT_GT(other.report.smallest_sigma, 0.1) << mass;
    EXPECT_TRUE(other.report.warnings.empty()) << other.report.warnings.front().message;
  }
  // The mutant: no mass follows the coordinate y.
  Scenario s;
  EXPECT_EQ(make_scenario(test::model_of(test::replaced(sleigh("1e-18", "1"), "y*ey + 0.3*L*S.x", "0.3*L*ex")),
                          *find_formulation("routh"), {}, s)
                    .ok() &&
                run(test::replaced(sleigh("1e-18", "1"), "y*ey + 0.3*L*S.x", "0.3*L*ex"), 3).report.outcome.ok(),
            false);
}

// Euler's angles pass near theta = 0, where J has condition 1/theta^2. The shipped model writes the same motion in
// other formulas.
TEST(NearlySingular, ARattlebackAsItsFormulasAreWritten) {
  const nlohmann::json data = test::oracle_data("s07_rattleback"), &there = data["trajectory"];
  const std::string text = as_written(data);
  struct Case {
    Precision numbers;
    const char* tolerance;
    double error;
  };
  for (const Case& c :
       {Case{Precision::real, "1000000000000", 1e-10}, Case{Precision::real, "1000000000000000", 1e-11},
        Case{Precision::long_real, "1000000000000000", 1e-11}, Case{Precision::quad, "100000000000000000000", 1e-14},
        Case{Precision::multi, "100000000000000000000", 1e-14}}) {
    // Multiple precision takes longer than all others together: ./dev long.
    if (c.numbers == Precision::multi && !std::getenv("ANHOLON_LONG")) continue;
    const Result r = run(text, 1, c.numbers, c.tolerance, c.numbers == Precision::multi ? 24 : 16);
    ASSERT_TRUE(r.report.outcome.ok()) << name(r.report.outcome.kind) << ": " << r.report.outcome.message
                                       << ", tolerance 1/" << c.tolerance;
    ASSERT_EQ(std::stod(there["times"].back().get<std::string>()), 1);
    for (const char* q : {"x", "y", "ps", "th", "ph"})
      EXPECT_NEAR(r.last(q), std::stod(there["states"].back()[q].get<std::string>()), c.error)
          << q << ", tolerance 1/" << c.tolerance;
  }
}

// Friction lays a disc ever flatter: theta falls below 0.01, and J with theta^2. From 2.4 s on, steps of Newton's
// iteration do not shrink.
TEST(NearlySingular, ADiscLaidFlatGoesOn) {
  const std::string disc = R"toml(coordinates = ["x", "y", "psi", "theta", "phi"]
parameters = {m = 1, R = 0.1, g = 9.81, k = 0.005}
frame.lean = "rotz(psi)*rotx(theta)"
point.contact = "x*ex + y*ey"
gravity.field = "-g*ez"
body = [{name = "disc", mass = "m", inertia = ["m*R^2/4", "m*R^2/4", "m*R^2/2"], center = "contact + R*lean.y", orientation = "lean*rotz(phi)"}]
constraint = [{name = "rolling", equation = "vel(disc, contact) = 0"}]
force = [{on = "disc", torque = "-k*psi'*ez"}]
initial = {theta = 0.2, "psi'" = 40, "phi'" = -39.2}
)toml";
  const Result r = run(disc, 5);
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_LT(r.last("theta"), 1e-2);
  EXPECT_LT(r.report.newton, 1e-12);
  EXPECT_LT(r.report.power, 1e-10);
}

std::string three_masses(const char* least, const char* greatest) {
  return std::string(
             "coordinates = [\"x1\", \"y1\", \"x2\", \"y2\", \"x3\", \"y3\"]\nparticle = [{name = \"a\", mass = ") +
         least +
         ", position = \"x1*ex + y1*ey\"}, {name = \"b\", mass = 1, position = \"x2*ex + y2*ey\"}, {name = \"c\", mass "
         "= " +
         greatest +
         ", position = \"x3*ex + y3*ey\"}]\ngravity.field = \"-9.81*ey\"\nconstraint = [{name = \"r1\", equation = "
         "\"x1^2 + y1^2 = 1\"}, {name = \"r2\", equation = "
         "\"(x1 - x2)^2 + (y1 - y2)^2 = 1\"}, {name = \"r3\", equation = \"(x3 - x2)^2 + (y3 - y2)^2 = 1\"}]\n"
         "initial = {x1 = 0.6, y1 = -0.8, x2 = 1.2, y2 = -1.6, x3 = 1.5, guess = {y3 = -2.5}}\n";
}

TEST(NearlySingular, MassesOfVeryDifferentSize) {
  for (const auto& [least, greatest] : {std::pair("1e-4", "1e4"), std::pair("1e-6", "1e6"), std::pair("1e-9", "1")})
    for (const Precision numbers : {Precision::real, Precision::long_real, Precision::quad, Precision::multi}) {
      const Result r = run(three_masses(least, greatest), Rational(1, 200), numbers, "1000000000000", 20);
      ASSERT_TRUE(r.report.outcome.ok()) << least << ": " << r.report.outcome.message;
      EXPECT_LT(r.report.newton, 1e-15) << least;
      EXPECT_LT(r.report.constraints_kept, 1e-15) << least;
    }
}

// (x + away) y'' - away y'' is x y'' in a factor, so the terms that are rounded are no terms of the equation.
TEST(NearlySingular, TermsThatVanishWithinAFactor) {
  const auto text = [](const std::string& product) {
    return "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex + y*ey + "
           "z*ez\"\n"
           "[[force]]\non = \"p\"\nvector = \"-x*ex - 2*y*ey - 3*(z - 1)*ez\"\n[[constraint]]\nname = \"c\"\nequation "
           "= \"z*(" +
           product +
           ") + x'' = -0.3*x - 0.1\"\n"
           "[initial]\nx = 0.7\ny = 0.3\nz = 1.1\n\"x'\" = 0\n\"y'\" = 0\n";
  };
  const Result far = run(text("(x + 1e8)*y'' - 1e8*y''"), 1), plain = run(text("x*y''"), 1);
  ASSERT_TRUE(far.report.outcome.ok()) << far.report.outcome.message;
  for (const char* q : {"x", "y", "z"}) EXPECT_NEAR(far.last(q), plain.last(q), 1e-8) << q;
}

// Bars that come to lie on one line make the constraints dependent, and the outcome names this.
TEST(NearlySingular, WindowsThatFoldFlatStopWithTheirNames) {
  const std::string windows = R"toml(coordinates = ["a[i]", "c[k]"]
index = {n = 2, i = "0..n", k = "1..n"}
point."A[i]" = "i*ex"
point."B[i]" = "A[i] + cos(a[i])*ey + sin(a[i])*ex"
gravity.field = "-9.81*ey"
body = [
  {name = "leg[i]", mass = 1, inertia = "1/12", center = "(A[i] + B[i])/2", angle = "-a[i]"},
  {name = "top[k]", mass = 1, inertia = "1/12", center = "B[k-1] + (cos(c[k])*ex + sin(c[k])*ey)/2", angle = "c[k]"},
]
constraint = [{name = "window[k]", equation = "B[k-1] + cos(c[k])*ex + sin(c[k])*ey = B[k]"}]
[initial]
"a[i]" = 0
"c[k]" = 0
"a[0]'" = 1
)toml";
  for (const Precision numbers : {Precision::real, Precision::long_real, Precision::quad}) {
    const Result r = run(windows, 10, numbers);
    EXPECT_EQ(r.report.outcome.kind, OutcomeKind::singular);
    const std::string& said = r.report.outcome.message;
    EXPECT_NE(said.find("window[1].x"), std::string::npos) << said;
    EXPECT_NE(said.find("a[0] = 1.5"), std::string::npos) << said;
    EXPECT_EQ(r.report.outcome.hint.find("branch"), std::string::npos) << r.report.outcome.hint;
  }
}

// The branch z''^2 = x ends at x = 0, and no state beyond is taken for a solution.
TEST(NearlySingular, ABranchThatEndsIsNoRoundOff) {
  const Result r = run(
      "coordinates = [\"x\", \"z\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + z*ez\"}]\n"
      "constraint = [{name = \"c\", equation = \"z''^2 = x\"}]\n[initial]\nx = 1\n\"x'\" = -1\nguess = {\"z''\" = 1}\n",
      3);
  EXPECT_FALSE(r.report.outcome.ok());
  EXPECT_LT(r.last("t"), 1.001);
}

}  // namespace
}  // namespace anholon::nearly_singular_test

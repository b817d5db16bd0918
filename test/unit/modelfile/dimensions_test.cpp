// Units that fit together are accepted, others are refused; a file without units is never refused.
#include <gtest/gtest.h>

#include "modelfile/text/shipped.h"
#include "support/models.h"

namespace anholon::dimensions_test {
namespace {

const std::string kCar = R"toml(coordinates = ["x", "y", "th"]
point.P = "x*ex + y*ey"
frame.T = "rotz(th)"
[parameters]
m  = "2 t"
L  = {value = 30, unit = "cm"}
k  = 250
l0 = "20 cm"
g  = 9.81
T0 = "3 s"
c  = "5 N*s/m"
[define]
speed = "norm(vel(P))"
[functions]
"rho(h)" = "1.225*exp(-h/8500)"
[[body]]
name = "car"
mass = "m"
inertia = "m*L^2/12"
center = "P"
orientation = "T"
[[force]]
on = "car"
vector = "-k*(x - l0)*ex - c*vel(P)"
[[force]]
name = "steer"
generalized = {th = "-k*L^2*th"}
[gravity]
field = "-g*ey"
[potential]
spring = "k/2*(norm(P) - l0)^2"
[dissipation]
air = "rho(y)*speed^3*L^2"
[[constraint]]
name = "blade"
equation = "dot(vel(P), T.y) = L*th'"
[initial]
x = "3 ft"
th = "30 deg"
conditions = ["dot(vel(P), T.x) = 36 km/h"]
[simulate]
to = "2 min"
)toml";

std::vector<Diagnostic> found(const std::string& text, const Overrides& overrides = {}) {
  Diagnostics d;
  read_model(SourceText{"test.toml", text}, d, overrides);
  return d.list();
}

std::string messages(const std::vector<Diagnostic>& list) {
  std::string out;
  for (const Diagnostic& d : list) out += std::to_string(d.span.line) + ": " + d.message + "\n";
  return out;
}

TEST(DimensionsOfAModel, ThatFitAreFoundAndNamed) {
  const auto model = test::model_of(kCar);
  EXPECT_EQ(model->coordinate_units, (std::vector<std::string>{"m", "m", "1"}));
  EXPECT_EQ(model->parameter_units, (std::vector<std::string>{"kg", "m", "N/m", "m", "m/s^2", "s", "kg/s"}));
  EXPECT_EQ(number_value(model->parameters[0].value), 2000);
  EXPECT_EQ(number_value(model->parameters[1].value), Rational(3, 10));
  EXPECT_EQ(number_value(model->initial.given[0].value), Rational(1143, 1250));
  EXPECT_EQ(*model->simulate.to, 120);
}

struct Clash {
  const char* from;
  const char* to;
  unsigned line;
  const char* message;
};

TEST(DimensionsOfAModel, ThatClashAreReportedWhereTheyMeet) {
  ASSERT_EQ(messages(found(kCar)), "");
  const Clash clashes[] = {
      {"(x - l0)", "(x - T0)", 24, "a length (m) minus a time (s)"},
      {"x*ex + y*ey", "x*ex + th*ey", 3, "a pure number is expected here, this is a length (m)"},
      {"mass = \"m\"", "mass = \"l0\"", 18, "a mass (kg) is expected here, this is a length (m)"},
      {"inertia = \"m*L^2/12\"", "inertia = \"m*L/12 + m*l0\"", 19,
       "a moment of inertia (kg*m^2) is expected here, this is a quantity in kg*m"},
      {"-k*(x - l0)*ex - c*vel(P)", "c*P", 24, "a force (N) is expected here, this is a momentum (N*s)"},
      {"\"-k*L^2*th\"", "\"c*x\"", 27, "a torque or energy (N*m) is expected here"},
      {"-g*ey", "-speed*ey", 29, "an acceleration (m/s^2) is expected here, this is a velocity (m/s)"},
      {"k/2*(norm(P) - l0)^2", "c*L*l0", 31,
       "a torque or energy (N*m) is expected here, this is an angular momentum (N*m*s)"},
      {"rho(y)*speed^3*L^2", "c*speed", 33, "a power (W) is expected here, this is a force (N)"},
      {"= L*th'", "= L*L*th'", 36, "a velocity (m/s) on the left side, a quantity in m^2/s on the right side"},
      {"3 ft", "3 s", 38, "a length (m) is expected here, this is a time (s)"},
      {"30 deg", "30 m", 39, "a pure number is expected here, this is a length (m)"},
      {"36 km/h", "36 km", 40, "a velocity (m/s) on the left side, a length (m) on the right side"},
      {"2 min", "2 N", 42, "a time (s) is expected here, this is a force (N)"},
      {"\"rotz(th)\"", "\"rotz(x)*rotz(l0)\"", 3, "a pure number is expected here, this is a length (m)"},
      {"exp(-h/8500)", "exp(-h)", 15, "a pure number is expected here, this is a length (m)"},
      {"\"20 cm\"", "\"20 kmm\"", 8, "'kmm' is no unit; did you mean"},
      {"unit = \"cm\"", "unit = \"cmm\"", 6, "'cmm' is no unit; did you mean"},
      {"value = 30,", "value = \"30 m\",", 6, "the unit is given twice"},
      {"value = 30,", "value = [\"30 m\", 0, 0],", 6, "the unit is given twice"},
  };
  for (const Clash& c : clashes) {
    const std::vector<Diagnostic> list = found(test::replaced(kCar, c.from, c.to));
    ASSERT_FALSE(list.empty()) << c.to;
    const bool there = std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) {
      return d.span.line == c.line && d.message.rfind(c.message, 0) == 0;
    });
    EXPECT_TRUE(there) << c.to << "\n" << messages(list);
  }
}

TEST(DimensionsOfAModel, AreSetFromOutside) {
  const auto L = [](const char* value) {
    return number_value(test::model_of(kCar, {{"L", value}})->parameters[1].value);
  };
  EXPECT_EQ(L("50"), Rational(1, 2)) << "a bare number has the parameter's unit";
  EXPECT_EQ(L("2 m"), 2);
  const std::vector<Diagnostic> list = found(kCar, {{"l0", "3 s"}});
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(messages(found(kCar, {{"l0", "3"}})), "");
  EXPECT_NE(messages(found(kCar, {{"L", "3 s"}})), "") << "not the unit that it was declared with";
}

// A number that is a term of a sum of lengths is named; 0, factors, exponents and terms without a unit are not.
TEST(DimensionsOfAModel, BareTermsOfASumAreNamed) {
  const auto warned = [](const char* to) {
    const std::vector<Diagnostic> list = found(test::replaced(kCar, "(x - l0)", to));
    for (const Diagnostic& d : list) EXPECT_EQ(d.severity, Severity::warning) << to;
    return messages(list);
  };
  EXPECT_EQ(warned("(x - 2)"), "24: 2 without a unit stands beside a length (m)\n");
  EXPECT_EQ(warned("(2 + x)"), "24: 2 without a unit stands beside a length (m)\n");
  EXPECT_EQ(warned("(-0.5 + x)"), "24: 0.5 without a unit stands beside a length (m)\n");
  EXPECT_EQ(warned("(x - l0 + (1 + l0) + 3)"),
            "24: 1 without a unit stands beside a length (m)\n24: 3 without a unit stands beside a length (m)\n");
  for (const char* right : {"(x - 2 m)", "(x - 0)", "(x - 1*2)", "(x*(1 + th) - l0)", "(x - l0*(1 - cos(th)))",
                            "(x - l0^2/(1 m))", "(x - l0*(2 - t/T0))"})
    EXPECT_EQ(warned(right), "") << right;
  // The hint works when it is pasted.
  const std::vector<Diagnostic> list = found(test::replaced(kCar, "(x - l0)", "(x - 2)"));
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].hint, "2 m, or 1*2 where the number has its unit in SI");
  EXPECT_EQ(list[0].span.column, std::string("vector = \"-k*(x - ").size() + 1);
  // A file without units is not checked, and a value from outside is no term of the file.
  EXPECT_EQ(messages(found("coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"(2 + x)*ex\"\n")),
            "");
  EXPECT_EQ(messages(found(kCar, {{"l0", "1 + 2"}})), "");
}

// Each shipped model names the units of its terms.
TEST(DimensionsOfAModel, NoShippedModelHasABareTerm) {
  std::size_t read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::source_dir() / "models")) {
    if (entry.path().extension() != ".toml") continue;
    Diagnostics d;
    open_model(model_text(entry.path().string()), d);
    EXPECT_EQ(messages(d.list()), "") << entry.path();
    ++read;
  }
  EXPECT_GT(read, 60U);
}

// An axis by itself is 1 along it, in any unit; with a factor it is a direction.
TEST(DimensionsOfAModel, OfAnAxisAloneAreFree) {
  EXPECT_EQ(messages(found(test::replaced(kCar, "dot(vel(P), T.x) = 36 km/h", "vel(P) = T.x"))), "");
  EXPECT_EQ(messages(found(test::replaced(kCar, "-g*ey", "-ey"))), "");
  EXPECT_EQ(messages(found(test::replaced(kCar, "x*ex + y*ey", "x*ex + y*ey + ez"))), "");
  EXPECT_NE(messages(found(test::replaced(kCar, "-g*ey", "-sin(th)*ey"))), "");
}

// The same mistakes without units are consistent with some choice of units, or are not checked.
TEST(DimensionsOfAModel, AreNotRefusedWithoutUnits) {
  EXPECT_EQ(messages(found("coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = \"1 + 2\"\nposition = "
                           "\"sin(x)*ex\"\n[gravity]\nfield = \"x*ey - vel([x, 0, 0])\"\n")),
            "");
  const std::string pendulum =
      "coordinates = [\"th\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"sin(th)*ex\"\n[initial]\nth = ";
  EXPECT_EQ(messages(found(pendulum + "\"30 deg\"\n")), "") << "an angle has no dimension";
  EXPECT_NE(messages(found(pendulum + "\"30 deg\"\n\"th'\" = \"2 s^-1\"\n")), "")
      << "the length of the pendulum is missing";
}

// Coordinates and states of one dimension have one scale, with units and without.
TEST(DimensionsOfAModel, GiveTheScalesOfUnknowns) {
  const auto scales = [](const std::string& radius, const std::string& rate) {
    return test::model_of("coordinates = [\"x\", \"th\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = "
                          "\"x*ex + (y + (" +
                          radius + ")*sin(th))*ey\"}]\nstate.s = {rate = \"" + rate + "\", initial = 0}\n")
        ->scales;
  };
  using Scales = std::vector<std::uint32_t>;
  EXPECT_EQ(scales("2 m", "x'"), (Scales{0, 1, 0, 0}));
  EXPECT_EQ(scales("2", "x'"), (Scales{0, 1, 0, 0}));
  EXPECT_EQ(scales("2", "th'"), (Scales{0, 1, 0, 1}));
  EXPECT_EQ(scales("2", "x"), (Scales{0, 1, 0, 2})) << "metres times seconds";
  // Formulas that contradict one another give no scales, nor does a single dimension.
  EXPECT_EQ(scales("x*y", "x'"), Scales{});
  EXPECT_EQ(
      test::model_of("coordinates = [\"x\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex\"}]\n")->scales,
      Scales{});
}

// A multiplier times a derivative of its constraint is a force.
TEST(DimensionsOfAModel, OfReactionsAndMultipliers) {
  const auto with = [](const std::string& monitor) {
    return messages(
        found("coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = \"2 kg\", position = [\"x\", \"y\", "
              "\"0\"]}]\nconstraint = [{name = \"c\", equation = \"y' = x/(1 s)\"}, {name = \"d\", equation = "
              "\"x*y' = 2\"}]\ninitial = {x = \"1 m\"}\nmonitor.q = \"" +
              monitor + "\"\n"));
  };
  EXPECT_EQ(with("norm(reaction(p)) + lambda.c - 3 N"), "");
  EXPECT_EQ(with("lambda.d*x + lambda.c"), "");
  for (const char* wrong : {"norm(reaction(p)) + x", "lambda.c + x", "lambda.d + lambda.c", "lambda.c - 3 m",
                            "norm(reaction_torque(p)) + norm(reaction(p))", "sin(norm(reaction(p)))"})
    EXPECT_NE(with(wrong), "") << wrong;
}

}  // namespace
}  // namespace anholon::dimensions_test

// The meaning of names and kinematic functions in a model file.
#include <gtest/gtest.h>

#include "support/model_point.h"
#include "support/models.h"

namespace anholon::names_test {
namespace {

// left - right, read as part of a constraint of third order.
Expr difference(const std::string& left, const std::string& right, const std::string& more = {}) {
  const auto model = test::model_of(R"toml(coordinates = ["x", "y", "th", "q"]
[parameters]
R = 0.5
w = 2
[functions]
m = "1 + t^2"
"sq(s)" = "s^2"
)toml" + more + R"toml([observer]
spin = "w*ez"
origin_velocity = ["t", "0", "1"]
[frame]
e1 = "rotz(th)"
[point]
P = "x*ex + y*ey"
[[body]]
name = "disc"
mass = "m"
inertia = ["1", "1", "2"]
center = "P + R*ez"
orientation = "e1*roty(q)"
[[particle]]
name = "grain"
mass = 1
position = "P"
[[constraint]]
name = "c"
equation = "(x''' + )toml" + left + ") - (" +
                                    right + ") = 0\"\n");
  const Expr phi = model->constraints.at(0).phi - model->graph->jet(0, 3);
  static std::vector<std::shared_ptr<const Model>> kept;  // the graph lives as long as the expression is used
  kept.push_back(model);
  return phi;
}

double size(Expr e) {
  const PrecisionScope precision(40);
  test::Point p(3);
  p.set_parameters({Multi(0.5), Multi(2)});
  return std::abs(to_double(test::value(e, p)));
}

struct Meaning {
  const char* left;
  const char* right;
};

TEST(Meaning, KinematicFunctionsAreWhatTheirNamesSay) {
  const Meaning meanings[] = {
      {"vel(P).x", "x'"},
      {"acc(P).y", "y''"},
      {"vel(disc, P).x", "x' - R*q'*cos(th)"},  // rolling: the material point at the contact
      {"vel(disc, P).y", "y' - R*q'*sin(th)"},
      {"vel(disc, disc.center).x", "x'"},
      {"vel(P, disc).x", "R*q'*cos(th)"},  // P as seen from the disc
      {"vel(grain, disc).x", "R*q'*cos(th)"},
      {"angvel(disc).z", "th'"},
      {"angvel(disc).x", "-q'*sin(th)"},
      {"angvel(e1).z", "th'"},
      {"angvel(disc, e1).y", "q'*cos(th)"},
      {"angvel(disc, inertial).z", "th' + w"},
      {"vel(P, inertial).x", "x' - w*y + t"},
      {"vel(P, inertial).z", "1"},
      {"acc(P, inertial).x", "x'' - 2*w*y' - w^2*x + 1"},  // a0 = v* + w x v = (1, w t, 0)
      {"acc(P, inertial).y", "y'' + 2*w*x' - w^2*y + w*t"},
      {"D(x*y, 2)", "x''*y + 2*x'*y' + x*y''"},
      {"dot(disc.x, e1.x)", "cos(q)"},
      {"disc.center.z", "R"},
      {"e1(1, 2, 0).x", "cos(th) - 2*sin(th)"},
      {"disc(0, 3, 0).x", "-3*sin(th)"},
      {"sq(x + 1)", "x^2 + 2*x + 1"},
      {"m(t)", "m"},
      {"m(2*t)", "1 + 4*t^2"},
      {"m'", "2*t"},
      {"norm2(vel(P))", "x'^2 + y'^2"},
      {"max(x, y)", "(x + y + abs(x - y))/2"},
  };
  for (const Meaning& m : meanings) {
    EXPECT_LE(size(difference(m.left, m.right)), 1e-36) << m.left << " = " << m.right;
    EXPECT_GT(size(difference(m.left, std::string(m.right) + " + q/7")), 1e-3) << "mutant of " << m.left;
  }
}

TEST(Meaning, NamesAreLookedUpInAnyOrderOfDeclaration) {
  const auto model = test::model_of("coordinates = [\"x\"]\n[define]\nb = \"2*a\"\na = \"x + c\"\n[parameters]\nc = "
                                    "\"d/3\"\nd = 1\n[[particle]]\nname = \"p\"\nmass = 1\n"
                                    "position = \"b*ex\"\n");
  EXPECT_EQ(model->bodies[0].center.x, 2 * (model->graph->jet(0, 0) + model->graph->parameter(0)));
}

TEST(Meaning, GreekLettersAreTheirNames) {
  const auto model = test::model_of(
      "coordinates = [\"θ\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"sin(theta)*ex + θ*ey\"\n");
  EXPECT_EQ(model->coordinates[0].name, "theta");
}

TEST(Meaning, ComponentsThatVanishAreDroppedAndNoted) {
  const auto model = test::model_of("coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = "
                                    "\"x*ex + y*ey\"\n[[constraint]]\nname = \"still\"\n"
                                    "equation = \"vel(p.position) = 0\"\n");
  ASSERT_EQ(model->constraints.size(), 2U);
  EXPECT_EQ(model->constraints[1].name, "still.y");
  ASSERT_EQ(model->notes.size(), 1U);
}

TEST(Meaning, TheOrderOfAConstraintIsItsTrueOne) {
  const auto order = [](const std::string& equation) {
    return test::model_of("coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex + "
                          "y*ey\"\n[[constraint]]\nname = \"c\"\nequation = \"" +
                          equation + "\"\n")
        ->constraints[0]
        .order;
  };
  EXPECT_EQ(order("x = y^2"), 0);
  EXPECT_EQ(order("x' = y'"), 1);
  EXPECT_EQ(order("x''*(sin(y)^2 + cos(y)^2 - 1) + y' = 0"), 1) << "x'' does not truly occur";
  EXPECT_EQ(order("(x''+1)^2 - x''^2 - 2*x'' + y' = 0"), 1);
  EXPECT_EQ(order("D(x, 4) = y"), 4);
}

}  // namespace
}  // namespace anholon::names_test

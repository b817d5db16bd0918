// Contacts given by the shape of a body move as those whose gap and slip velocity are written as formulas.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"

namespace anholon {
namespace shapes_test {

using test::contact_motion;

// True if two motions have the same coordinates and velocities at the end.
bool same(const test::Motion& a, const test::Motion& b, const std::vector<std::string>& coordinates) {
  EXPECT_TRUE(a.report.outcome.ok()) << a.report.outcome.message;
  EXPECT_TRUE(b.report.outcome.ok()) << b.report.outcome.message;
  double worst = 0;
  for (const std::string& x : coordinates)
    for (const std::string& column : {x, x + "'"}) worst = std::max(worst, std::abs(a.last(column) - b.last(column)));
  return worst < 1e-9;
}

std::string box(const std::string& contact) {
  return R"toml(coordinates = ["x", "z", "th"]
parameters = {m = 1, a = 0.3, b = 0.2, g = 9.81}
frame.B = "roty(th)"
point.C = "x*ex + z*ez"
point.L = "C - a*B.x - b*B.z"
point.Q = "C + a*B.x - b*B.z"
point.S = "C - a*B.x + b*B.z"
point.T = "C + a*B.x + b*B.z"
gravity.field = "-g*ez"
[[body]]
name = "box"
mass = "m"
inertia = ["m*(a^2+b^2)/3", "m*(a^2+b^2)/3", "m*(a^2+b^2)/3"]
center = "C"
orientation = "B"
[initial]
z = 0.8
th = 0.4
"x'" = 1
"th'" = 1
)toml" + contact;
}

std::string corner(const std::string& p) {
  return "[[contact]]\nname = \"" + p + "\"\ngap = \"" + p + ".z\"\nslip = \"vel(box, " + p +
         ").x\"\nfriction = 0.3\nrestitution = 0.3\n";
}

TEST(Shapes, BoxTouchesWithItsCorners) {
  const auto shape = [](const std::string& s) {
    return contact_motion(box("[[contact]]\nname = \"c\"\nbody = \"box\"\nshape = \"box(" + s +
                              ")\"\nfriction = 0.3\nrestitution = 0.3\n"),
                          Rational(4, 5));
  };
  const auto formulas = contact_motion(box(corner("L") + corner("Q") + corner("S") + corner("T")), Rational(4, 5));
  EXPECT_GT(formulas.report.events.size(), 4U);
  EXPECT_TRUE(same(shape("2*a, 1, 2*b"), formulas, {"x", "z", "th"}));
  EXPECT_FALSE(same(shape("2.1*a, 1, 2*b"), formulas, {"x", "z", "th"}));  // the mutant
}

std::string coin(const std::string& contact) {
  return R"toml(coordinates = ["x", "y", "z", "ps", "th", "ph"]
parameters = {m = 1, R = 0.2, g = 9.81}
gravity.field = "-g*ez"
point.C = "x*ex + y*ey + z*ez"
frame.N = "rotz(ps)*rotx(th)"
[[body]]
name = "coin"
mass = "m"
shape = "disc(R)"
center = "C"
orientation = "N*rotz(ph)"
[initial]
th = 1.3
z = "R*sin(1.3)"
"ph'" = 15
"x'" = 1
[[contact]]
name = "floor"
friction = 0.4
)toml" + contact;
}

TEST(Shapes, CoinTouchesWithItsRim) {
  const auto shape = contact_motion(coin("body = \"coin\"\n"), Rational(3, 10));
  const std::string formula = "gap = \"z - R*sin(th)\"\nslip = \"vel(coin, C - R*N.y)\"\nalong = [\"ex\", \"ey\"]\n";
  const std::vector<std::string> all = {"x", "y", "z", "ps", "th", "ph"};
  EXPECT_TRUE(same(shape, contact_motion(coin(formula), Rational(3, 10)), all));
  EXPECT_FALSE(same(contact_motion(coin("body = \"coin\"\nshape = \"disc(0.99*R)\"\n"), Rational(3, 10)),
                    contact_motion(coin(formula), Rational(3, 10)), all));  // the mutant
}

// Euler's disc, 8 cm wide and nearly flat.
test::Motion eulers_disc(const std::string& initial, const Rational& to) {
  return contact_motion(R"toml(coordinates = ["x", "y", "z", "psi", "theta", "phi"]
parameters = {m = 0.4, R = 0.04, g = 9.81}
gravity.field = "-g*ez"
frame.B = "rotz(psi)*rotx(theta)*rotz(phi)"
[[body]]
name = "disc"
mass = "m"
shape = "disc(R)"
center = "x*ex + y*ey + z*ez"
orientation = "B"
[[contact]]
name = "table"
body = "disc"
friction = 0.5
rolling_resistance = "R/200"
[initial]
)toml" + initial,
                        to);
}

// Steady rolling at a small lean, with the spin 4g/(R sin(lean)) = Omega^2.
std::string rolling(const std::string& lean) {
  return "theta = " + lean + "\nz = \"R*sin(" + lean + ")\"\n\"psi'\" = \"sqrt(4*g/(R*sin(" + lean +
         ")))\"\n\"phi'\" = \"-sqrt(4*g/(R*sin(" + lean + ")))*cos(" + lean + ")\"\n";
}

// Rolling takes the power delta m g Omega sin(theta) from the disc, so theta falls as (t_f - t)^2 with t_f = 3/2
// sqrt(theta_0) R/delta sqrt(R/g). The angles of the disc are singular when it lies flat; this is no paradox of
// friction.
TEST(Shapes, EulersDiscEndsWhereItsAnglesAreSingular) {
  const double lean = 3e-5, end = 1.5 * std::sqrt(lean) * 200 * std::sqrt(0.04 / 9.81);
  const auto m = eulers_disc(rolling("3e-5"), 1);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << m.report.outcome.message;
  EXPECT_LT(m.last("theta"), 2e-6);
  const double left = 1 - m.last("t") / end;
  EXPECT_NEAR(m.last("theta") / (lean * left * left), 1, 1e-2);
}

TEST(Shapes, FlatDiscNamesItsContact) {
  const auto m = eulers_disc(rolling("1e-6"), 1);
  EXPECT_EQ(m.report.outcome.kind, OutcomeKind::singular) << m.report.outcome.message;
  EXPECT_NE(m.report.outcome.message.find("contact 'table'"), std::string::npos) << m.report.outcome.message;
}

// The disc sticks, and begins to slip against the friction that held it. The resistance to rolling turns this friction:
// a direction found without the resistance leads to no consistent mode.
TEST(Shapes, EulersDiscBeginsToSlipAgainstItsFriction) {
  const auto m = eulers_disc(R"toml(psi = 569.875976
theta = 0.000106676556
phi = -568.724833
z = "R*sin(0.000106676556)"
"x'" = 0.000465357443
"y'" = 0.0013898546
"psi'" = 3022.32943
"theta'" = -0.000451497456
"phi'" = -3022.29277
"z'" = "R*cos(0.000106676556)*(-0.000451497456)"
)toml",
                             Rational(182, 10000));
  EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_GT(test::times(m, "table.slips").size(), 0U);
}

// A disc on a smooth floor rocks from one side of its rim to the other. In between it lies nearly flat, and its gap
// needs all digits. Its energy and its spins about the vertical and about its axis are constant.
TEST(Shapes, DiscRocksAlmostFlatOnASmoothFloor) {
  const auto changes = [](const char* mu, const Rational& to) {
    const auto m = contact_motion(R"toml(coordinates = ["x", "y", "z", "ps", "th", "ph"]
parameters = {mu = 0}
gravity.field = "-9.81*ez"
frame.B = "rotz(ps)*rotx(th)*rotz(ph)"
[[body]]
name = "disc"
mass = 1
shape = "disc(0.5)"
center = "x*ex + y*ey + z*ez"
orientation = "B"
[[contact]]
name = "f"
body = "disc"
friction = "mu"
restitution = 0.5
[initial]
th = 0.6617610898010806
z = 0.3072535738723125
"ps'" = -0.7802690007115247
"th'" = 0.08845845059190371
"x'" = 0.5
"z'" = 0.03489293355475757
[monitor]
energy = "norm2(vel(disc.center))/2 + norm2(angvel(disc))/32 + dot(angvel(disc), B.z)^2/32 + 9.81*z"
spin = "dot(angvel(disc), B.z)"
)toml",
                                  to, {{"mu", mu}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    std::array<double, 3> found{};  // changes of energy and spin, least inclination
    found[2] = m.number(0, "th");
    for (std::size_t k = 0; k < m.rows.rows().size(); ++k) {
      found[0] = std::max(found[0], std::abs(m.number(k, "energy") - m.number(0, "energy")));
      found[1] = std::max(found[1], std::abs(m.number(k, "spin") - m.number(0, "spin")));
      found[2] = std::min(found[2], m.number(k, "th"));
    }
    return found;
  };
  const auto smooth = changes("0", 3);
  EXPECT_LT(smooth[0], 1e-9);
  EXPECT_LT(smooth[1], 1e-9);
  EXPECT_LT(smooth[2], 0.01);
  EXPECT_GT(changes("0.1", Rational(1, 5))[0], 1e-4);  // the mutant
}

// A disc that falls flat has no lowest point of its rim, and does not fall through the floor.
TEST(Shapes, ADiscThatLandsFlatEndsTheMotion) {
  const auto falls = [](const char* tilt) {
    return contact_motion(R"toml(coordinates = ["z", "e0", "e1"]
parameters = {tilt = 0}
gravity.field = "-9.81*ez"
[[body]]
name = "disc"
mass = 1
shape = "disc(0.5)"
center = "z*ez"
orientation = "quat(e0, e1, 0, 0)"
[[contact]]
name = "f"
body = "disc"
restitution = 0.5
[initial]
z = 1
e0 = "cos(tilt/2)"
e1 = "sin(tilt/2)"
)toml",
                          Rational(1, 2), {{"tilt", tilt}})
        .report.outcome;
  };
  const Outcome flat = falls("0");
  EXPECT_EQ(flat.kind, OutcomeKind::singular);
  EXPECT_TRUE(flat.message.starts_with("the gap of contact 'f' has no derivatives at t = 0.45")) << flat.message;
  EXPECT_TRUE(falls("0.1").ok()) << falls("0.1").message;  // the mutant
}

// A wheel with a thick tyre that sticks to the road moves as a wheel whose lowest point a constraint lets roll.
TEST(Shapes, TorusRollsAsByAConstraint) {
  const auto wheel = [](const std::string& contact) {
    return contact_motion(R"toml(coordinates = ["x", "y", "z", "psi", "theta", "phi"]
parameters = {m = 8, R = 0.3, r = 0.05, g = 9.81}
frame.lean = "rotz(psi)*rotx(theta)"
point.low = "x*ex + y*ey + z*ez"
gravity.field = "-g*ez"
[[body]]
name = "wheel"
mass = "m"
shape = "torus(0.3, 0.05)"
center = "low + r*ez + R*lean.y"
orientation = "lean*rotz(phi)"
[initial]
theta = 1.3
"phi'" = 10
"psi'" = 0.2
"x'" = "-(R + r*sin(1.3))*10"
)toml" + contact,
                          2);
  };
  const std::string torus = "[[contact]]\nname = \"road\"\nbody = \"wheel\"\nfriction = 2\nshape = ";
  const auto touching = wheel(torus + "\"torus(R, r)\"\n");
  const auto rolling = wheel("[[constraint]]\nname = \"rolling\"\nequation = \"vel(wheel, low) = 0\"\n");
  EXPECT_EQ(touching.last("road.mode"), 2);
  EXPECT_TRUE(same(touching, rolling, {"x", "y", "z", "psi", "theta", "phi"}));
  // The mutant: a disc of the same height moves otherwise.
  EXPECT_FALSE(same(wheel(torus + "\"disc(R + r)\"\nthrough = \"(r - r*sin(1.3))*ez\"\n"), rolling, {"psi"}));
}

std::string ball(const std::string& contact, const std::string& start) {
  return R"toml(coordinates = ["x", "z", "phi"]
parameters = {m = 1, r = 0.1, g = 9.81}
gravity.field = "-g*ez"
define.d = "sqrt(x^2 + z^2)"
point.C = "x*ex + z*ez"
[[body]]
name = "ball"
mass = "m"
shape = "ball(r)"
center = "C"
orientation = "roty(phi)"
[[contact]]
name = "c"
friction = 0.5
)toml" + contact +
         "[initial]\nx = 0.3\n" + start;
}

TEST(Shapes, BallInABowlAndOnABall) {
  const std::vector<std::string> all = {"x", "z", "phi"};
  const std::string low = "guess = {z = -0.8}\nconditions = [\"d = 1 - r\"]\n",
                    high = "guess = {z = 1}\nconditions = [\"d = 1 + r\"]\n";
  const auto slip = [](const char* sign) {
    const std::string q = std::string("vel(ball, C ") + sign + " r*C/d)";
    return "slip = \"(z*" + q + ".x - x*" + q + ".z)/d\"\n";
  };
  const auto bowl = contact_motion(ball("body = \"ball\"\non = \"bowl(1)\"\n", low), 2);
  EXPECT_TRUE(same(bowl, contact_motion(ball("gap = \"1 - r - d\"\n" + slip("+"), low), 2), all));
  EXPECT_FALSE(same(bowl, contact_motion(ball("gap = \"1 - r - d\"\n" + slip("-"), low), 2), all));  // the mutant
  const auto top = contact_motion(ball("body = \"ball\"\non = \"ball(1)\"\n", high), 1);
  EXPECT_TRUE(same(top, contact_motion(ball("gap = \"d - 1 - r\"\n" + slip("-"), high), 1), all));
  // A ball on an inclined plane rolls with 5/7 of the acceleration of a point.
  const auto slope =
      contact_motion(ball("body = \"ball\"\nnormal = [\"sin(0.2)\", 0, \"cos(0.2)\"]\nthrough = \"-r*ez\"\n",
                          "z = \"r*(1/cos(0.2) - 1) - 0.3*tan(0.2)\"\n"),
                     1);
  EXPECT_NEAR(std::hypot(slope.last("x'"), slope.last("z'")), 5.0 / 7 * 9.81 * std::sin(0.2), 1e-12);
}

TEST(Shapes, MistakesHavePlaces) {
  const auto refused = [](const std::string& contact) {
    try {
      contact_motion(ball(contact, "z = 3\n"), 1);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  const auto says = [&](const std::string& contact, const std::string& text) {
    EXPECT_NE(refused(contact).find(text), std::string::npos) << refused(contact);
  };
  says("body = \"bal\"\n", "did you mean 'ball'?");
  says("body = \"ball\"\ngap = \"z\"\n", "gap and slip velocity follow from the body");
  says("body = \"ball\"\nshape = \"rod(2)\"\n", "and this is a rod");
  says("body = \"ball\"\non = \"bowle(1)\"\n", "a contact is on a ball or in a bowl");
  says("body = \"ball\"\non = \"ball\"\n", "a body does not touch itself");
  says("body = \"ball\"\nnormal = \"sin(t)*ex + cos(t)*ez\"\n", "the normal of a plane does not turn");
  says("gap = \"z\"\nnormal = \"ez\"\n", "'normal' goes with 'body'");
}

}  // namespace shapes_test
}  // namespace anholon

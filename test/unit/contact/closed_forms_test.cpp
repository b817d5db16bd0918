// Motions with contacts that have closed forms. Each test has a mutant, a model with other constants, whose motion
// differs.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "support/contact_motion.h"
#include "support/models.h"

namespace anholon {
namespace closed_forms_test {

using test::contact_motion;
using test::times;

const char* const kBody = R"toml(
gravity.field = "-g*ez"
point.C = "x*ex + z*ez"
frame.B = "roty(phi)"
[[body]]
name = "body"
mass = "m"
inertia = ["J", "J", "J"]
center = "C"
orientation = "B"
)toml";

void expect_near(double a, double b, double relative) { EXPECT_LE(std::abs(a - b), relative * std::abs(b)) << a << b; }

std::string backspin(const std::string& inertia) {
  return "coordinates = [\"x\", \"z\", \"phi\"]\nparameters = {m = 2, R = 0.11, g = 9.81, mu = 0.2, J = \"" + inertia +
         "\"}\n" + kBody + R"toml(
[[contact]]
name = "floor"
gap = "z - R"
slip = "vel(body, C - R*ez)"
along = ["ex"]
friction = "mu"
[initial]
z = "R"
"x'" = 3
"phi'" = -10
)toml";
}

TEST(ClosedForms, BallWithBackSpinRolls) {
  const auto rolls = [](const std::string& inertia) {
    const auto m = contact_motion(backspin(inertia), 4);
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const auto list = times(m, "floor.sticks");
    EXPECT_EQ(list.size(), 1U);
    // Rolling keeps the velocity to the bits of x' = R phi'.
    expect_near(m.last("x'"), 0.11 * m.last("phi'"), 1e-14);
    return std::pair{list.at(0), m.last("x'")};
  };
  const double slip = 3 + 10 * 0.11, mu_g = 0.2 * 9.81;
  const auto [t, v] = rolls("2/5*m*R^2");
  expect_near(t, 2 * slip / (7 * mu_g), 1e-12);
  expect_near(v, 3 - 2.0 / 7 * slip, 1e-12);
  // The mutant: a hollow ball rolls from the time 2 v/(5 mu g) on.
  const double hollow = rolls("2/3*m*R^2").first;
  expect_near(hollow, 2 * slip / (5 * mu_g), 1e-12);
  EXPECT_GT(std::abs(hollow - t), 0.1);
}

std::string belt(double friction) {
  return "coordinates = [\"x\", \"z\"]\nparameters = {m = 1, k = 40, g = 9.81, mus = 0.4, V = 0.3, muk = " +
         std::to_string(friction) + R"toml(}
particle = [{name = "block", mass = "m", position = "x*ex + z*ez"}]
gravity.field = "-g*ez"
potential.spring = "k*x^2/2"
[[contact]]
name = "belt"
gap = "z"
slip = "x' - V"
friction = "muk"
static_friction = "mus"
[initial]
"x'" = 0.3
)toml";
}

// The block sticks up to the stretch mus m g/k; it slips about the stretch muk m g/k until it has the velocity of the
// belt again.
TEST(ClosedForms, PeriodOfStickAndSlip) {
  const auto period = [](double friction) {
    const auto m = contact_motion(belt(friction), 10);
    const auto slips = times(m, "belt.slips");
    EXPECT_GT(slips.size(), 5U);
    for (std::size_t k = 2; k < slips.size(); ++k) EXPECT_NEAR(slips[k] - slips[k - 1], slips[1] - slips[0], 1e-12);
    return slips.at(1) - slips.at(0);
  };
  const auto formula = [](double friction) {
    const double w = std::sqrt(40.0), d = (0.4 - friction) * 9.81 / 40, V = 0.3;
    return 2 * d / V + 2 * (M_PI - std::atan(w * d / V)) / w;
  };
  expect_near(period(0.25), formula(0.25), 1e-12);
  EXPECT_GT(std::abs(period(0.2) - formula(0.25)), 1e-2);  // the mutant
}

// A block on a spring turns back every pi seconds, each time 2 mu g nearer to the middle. It sticks when the pull of
// the spring is less than friction.
TEST(ClosedForms, BlockOnASpringReversesAndSticksAtLast) {
  const auto block = [](const std::string& friction) {
    return contact_motion(R"toml(coordinates = ["x", "z"]
gravity.field = "-10*ez"
potential.spring = "x^2/2"
particle = [{name = "block", mass = 1, position = "x*ex + z*ez"}]
initial = {x = 12, "x'" = 6}
contact = [{name = "floor", gap = "z", slip = "x'", friction = )toml" +
                              friction + "}]\n",
                          30);
  };
  const auto m = block("0.1");
  const auto reverses = times(m, "floor.reverses"), sticks = times(m, "floor.sticks");
  ASSERT_EQ(reverses.size(), 7U);
  ASSERT_EQ(sticks.size(), 1U);
  for (std::size_t k = 0; k < reverses.size(); ++k)
    EXPECT_NEAR(reverses[k], std::atan(6.0 / 13) + static_cast<double>(k) * M_PI, 1e-13);
  EXPECT_NEAR(sticks[0], std::atan(6.0 / 13) + 7 * M_PI, 1e-13);
  expect_near(m.last("x"), 15 - std::sqrt(205), 1e-13);
  EXPECT_EQ(m.last("floor.mode"), 2);
  EXPECT_EQ(times(block("0.2"), "floor.reverses").size(), 3U);  // the mutant
}

TEST(ClosedForms, NothingCreepsWhereItSticks) {
  std::vector<Rational> at;
  for (int k = 0; k <= 200; ++k) at.emplace_back(k, 10);
  const std::string slope = R"toml(coordinates = ["x", "z"]
parameters = {mu = 0.3}
particle = [{name = "block", mass = 3, position = "x*ex + z*ez"}]
force = [{on = "block", vector = "-30*ez + (3 + 5*sin(7*t))*ex"}]
contact = [{name = "floor", gap = "z", slip = "x'", friction = "mu"}]
initial = {x = 0.1}
)toml";
  const auto sticks = contact_motion(slope, 20, {}, at);
  ASSERT_TRUE(sticks.report.outcome.ok()) << sticks.report.outcome.message;
  ASSERT_EQ(sticks.rows.rows().size(), at.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    EXPECT_EQ(sticks.number(k, "x"), 0.1);
    EXPECT_EQ(sticks.number(k, "x'"), 0);
    EXPECT_EQ(sticks.number(k, "z'"), 0);
  }
  EXPECT_GT(contact_motion(slope, 20, {{"mu", "0.2"}}).last("x"), 0.11);  // the mutant
}

// The block slips from the instant at which the pushing force passes the friction; its acceleration is zero then.
TEST(ClosedForms, BlockThatIsPushedEverHarderSlips) {
  const std::string push = R"toml(coordinates = ["x", "z"]
parameters = {F = 0}
particle = [{name = "block", mass = 1, position = "x*ex + z*ez"}]
force = [{on = "block", vector = "-ez + (F + t)*ex"}]
contact = [{name = "floor", gap = "z", slip = "x'", friction = 0.3}]
)toml";
  for (const double F : {0.0, 0.3, 0.1}) {
    const auto m = contact_motion(push, 3, {{"F", std::to_string(F)}});
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const double begin = 0.3 - F;
    const auto slips = times(m, "floor.slips");
    ASSERT_EQ(slips.size(), 1U);
    EXPECT_NEAR(slips[0], begin, 2e-12);
    expect_near(m.last("x"), std::pow(3 - begin, 3) / 6, 1e-11);
  }
}

// The normal force is zero at the start and its rate decides: a block that is pressed touches, a block that is lifted
// leaves.
TEST(ClosedForms, RateOfTheNormalForceDecidesWhereItIsZero) {
  const auto height = [](const std::string& force) {
    const auto m = contact_motion(R"toml(coordinates = ["z"]
particle = [{name = "block", mass = 1, position = "z*ez"}]
contact = [{name = "floor", gap = "z"}]
force = [{on = "block", vector = ")toml" +
                                      force + "*ez\"}]\n",
                                  2);
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    return m.last("z");
  };
  expect_near(height("t"), 8.0 / 6, 1e-11);
  expect_near(height("t^3"), 32.0 / 20, 1e-11);
  EXPECT_EQ(height("-t"), 0);
  EXPECT_EQ(height("-t^2"), 0);
}

// A ball on a sphere. `keys` belong to the contact, whose slip velocity is `slip`; `more` holds further sections.
std::string sphere(const std::string& keys, const std::string& more) {
  return "coordinates = [\"x\", \"z\", \"phi\"]\nparameters = {m = 1, R = 1, r = 0.25, g = 9.81, J = \"2/5*m*r^2\"}\n"
         "define.d = \"sqrt(x^2 + z^2)\"\ndefine.slip = \"(z*vel(body, C - r*C/d).x - x*vel(body, C - r*C/d).z)/d\"\n" +
         std::string(kBody) + "[[contact]]\nname = \"sphere\"\ngap = \"d - R - r\"\n" + keys + R"toml(
[initial]
x = 0.02
guess = {z = 1.25}
conditions = ["x^2 + z^2 = (R+r)^2"]
)toml" + more;
}

TEST(ClosedForms, BallLeavesASphere) {
  // The cosine of the angle at which the ball leaves, divided by the cosine at the start.
  const auto leaves = [&](const std::string& keys, const std::string& more) {
    const auto m = contact_motion(sphere(keys, more), 3);
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    const auto list = times(m, "sphere.leaves");
    EXPECT_EQ(list.size(), 1U);
    for (std::size_t k = 1; k < m.rows.rows().size(); ++k)
      if (m.number(k, "sphere.mode") == 0) {
        EXPECT_EQ(m.number(k, "t"), list.at(0));
        return m.number(k, "z") / m.number(0, "z");
      }
    return 0.0;
  };
  EXPECT_NEAR(leaves("", ""), 2.0 / 3, 1e-12);
  EXPECT_NEAR(leaves("", "[[constraint]]\nequation = \"slip = 0\"\n"), 10.0 / 17, 1e-12);
  // Friction holds the ball until the normal force is small: the excess is of the order of 1/mu.
  EXPECT_NEAR(leaves("slip = \"slip\"\nfriction = 1e6\n", ""), 10.0 / 17, 1e-6);
  EXPECT_GT(std::abs(leaves("slip = \"slip\"\nfriction = 0.5\n", "") - 10.0 / 17), 1e-3);  // the mutant
}

TEST(ClosedForms, TimesOfABouncingBall) {
  const std::string text = R"toml(coordinates = ["x"]
parameters = {e = 0.7, g = 9.81, h = 2}
particle = [{name = "ball", mass = 1, position = "x*ex"}]
gravity.field = "-g*ex"
contact = [{name = "floor", gap = "x", restitution = "e"}]
initial = {x = "h"}
)toml";
  const double e = 0.7, fall = std::sqrt(2 * 2 / 9.81);
  const auto misfit = [&](const test::Motion& m) {
    EXPECT_TRUE(m.report.outcome.ok());
    const auto hits = times(m, "floor.hits"), rests = times(m, "floor.rests");
    EXPECT_GT(hits.size(), 30U);
    EXPECT_EQ(rests.size(), 1U);
    double t = fall, flight = 2 * e * fall, worst = 0;
    for (const double hit : hits) {
      worst = std::max(worst, std::abs(hit - t));
      t += flight, flight *= e;
    }
    EXPECT_EQ(m.last("x"), 0);
    EXPECT_EQ(m.last("x'"), 0);
    return std::max(worst, std::abs(rests.at(0) - fall * (1 + e) / (1 - e)));
  };
  EXPECT_LT(misfit(contact_motion(text, 5)), 1e-12 * fall * (1 + e) / (1 - e));
  EXPECT_GT(misfit(contact_motion(text, 5, {{"e", "0.71"}})), 1e-3);  // the mutant
}

// A sliding body loses mu times the impulses of all impacts, also of those that are summed up: (1 + e)/(1 - e) times
// its first velocity. A body that slides in two directions keeps its direction.
TEST(ClosedForms, FrictionOfImpactsThatAddUp) {
  const std::string text = R"toml(coordinates = ["x", "y", "z"]
parameters = {e = 0.5, mu = 0.2, g = 9.81}
particle = [{name = "puck", mass = 2, position = ["x", "y", "z"]}]
gravity.field = "-g*ez"
contact = [{name = "floor", gap = "z", slip = "SLIP", along = ALONG, friction = "mu", restitution = "e"}]
initial = {z = 1, "x'" = 4, "y'" = 3}
)toml";
  const double e = 0.5, mu = 0.2, g = 9.81, first = std::sqrt(2 * g), fall = first / g;
  const auto misfit = [&](const std::string& slip, const std::string& along, double speed, double share,
                          const char* friction) {
    const auto m =
        contact_motion(test::replaced(test::replaced(text, "SLIP", slip), "ALONG", along), 2, {{"mu", friction}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    // The impulses of the floor together carry the weight from the start to the end.
    const double lost = mu * g * 2;
    EXPECT_GT(2, fall * (1 + e) / (1 - e));
    return std::abs(m.last("x'") - share * (speed - lost));
  };
  EXPECT_LT(misfit("x'*ex", "[\"ex\"]", 4, 1, "0.2"), 1e-14);
  EXPECT_LT(misfit("x'*ex + y'*ey", "[\"ex\", \"ey\"]", 5, 0.8, "0.2"), 1e-14);
  EXPECT_GT(misfit("x'*ex", "[\"ex\"]", 4, 1, "0.20001"), 1e-5);  // the mutant
}

// In other units, with times scaled by T, the same motion has the same numbers of impacts and the same places.
TEST(ClosedForms, ImpactsThatAddUpDoNotDependOnTheUnitOfTime) {
  const auto falls = [](const char* T, const Rational& to) {
    const auto m = contact_motion(R"toml(coordinates = ["x", "z"]
parameters = {T = 1}
particle = [{name = "puck", mass = 2, position = ["x", "0", "z"]}]
gravity.field = "-9.81/T^2*ez"
contact = [{name = "floor", gap = "z", slip = "x'*ex", along = ["ex"], friction = 0.2, restitution = 0.5}]
initial = {z = 1, "x'" = "4/T"}
)toml",
                                  to, {{"T", T}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    return std::pair(m.last("x"), times(m, "floor.hits").size());
  };
  const auto seconds = falls("1", 2), fast = falls("1e-6", Rational(2, 1'000'000)), slow = falls("1e6", 2'000'000);
  EXPECT_EQ(seconds.second, fast.second);
  EXPECT_EQ(seconds.second, slow.second);
  EXPECT_NEAR(seconds.first, fast.first, 1e-13);
  EXPECT_NEAR(seconds.first, slow.first, 1e-13);
}

// A box that rocks from corner to corner without rebound (Housner 1963): at each impact the spin changes by the factor
// r = 1 - 3 b^2/(2 (a^2 + b^2)) with the half width b, and half a swing lasts twice the time in which the box falls
// back.
TEST(ClosedForms, RockingBoxComesToRest) {
  const std::string text = R"toml(coordinates = ["x", "z", "phi"]
parameters = {m = 1, b = 0.2, a = 0.3, g = 9.81, J = "m*(a^2 + b^2)/3", w = 0.05}
)toml" + std::string(kBody) +
                           R"toml(
[[contact]]
name = "floor"
body = "body"
shape = "box(2*b, 1, 2*a)"
friction = 5
[initial]
conditions = ["(C + b*B.x - a*B.z).z = 0", "vel(body, C + b*B.x - a*B.z).x = 0", "vel(body, C + b*B.x - a*B.z).z = 0"]
guess = {z = 0.3}
phi = 0
"phi'" = "w"
)toml";
  const auto hits_of = [&](const char* width) {
    const auto m = contact_motion(text, 2, {{"b", width}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_EQ(m.last("phi'"), 0);
    EXPECT_LT(std::abs(m.last("phi")), 1e-13);
    std::vector<double> hits, rests;
    for (const EventReport& e : m.report.events) {
      if (e.name.find(".hits") != std::string::npos) hits.push_back(e.t.value);
      if (e.name.find(".rests") != std::string::npos) rests.push_back(e.t.value);
    }
    EXPECT_GT(hits.size(), 10U);
    EXPECT_FALSE(rests.empty());
    return std::pair{hits, rests.empty() ? 0 : rests[0]};
  };
  // About a corner phi'' = -3 g (b cos phi - a sin phi)/(4 (a^2 + b^2)), for the small angles of the last swings
  // linear.
  const auto ratio = [](const std::vector<double>& hits) {
    const std::size_t n = hits.size() - 3;
    return (hits[n] - hits[n - 1]) / (hits[n - 1] - hits[n - 2]);
  };
  const double r = 1 - 3 * 0.04 / (2 * 0.13);
  const auto [hits, rest] = hits_of("0.2");
  EXPECT_NEAR(ratio(hits), r, 1e-4);
  // The times after an impact are a geometric series, up to the angles of the swings.
  const std::size_t n = hits.size() - 3;
  EXPECT_NEAR(rest, hits[n] + (hits[n] - hits[n - 1]) * r / (1 - r), 1e-7);
  EXPECT_GT(std::abs(ratio(hits_of("0.22").first) - r), 1e-2);  // the mutant
}

// Every requested time has exactly one row, also if the motion changes its mode or ends there.
TEST(ClosedForms, RowsAtTheTimesOfEvents) {
  const std::string text = R"toml(coordinates = ["x"]
parameters = {h = 5}
particle = [{name = "ball", mass = 1, position = "x*ex"}]
gravity.field = "-10*ex"
contact = [{name = "floor", gap = "x", restitution = 0.3}]
initial = {x = "h"}
)toml";
  std::vector<Rational> at;
  for (int k = 0; k <= 40; ++k) at.emplace_back(k, 10);
  for (const char* h : {"5", "0.45", "0.05", "0.2"}) {
    const auto m = contact_motion(text, 4, {{"h", h}}, at);
    ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    ASSERT_EQ(m.rows.rows().size(), at.size()) << h;
    for (std::size_t k = 0; k < at.size(); ++k) EXPECT_EQ(m.number(k, "t"), static_cast<double>(k) / 10);
  }
  const auto ends = contact_motion(text + "[[event]]\nname = \"top\"\nwhen = \"t - 0.3\"\nstop = true\n", 4, {}, at);
  ASSERT_EQ(ends.rows.rows().size(), 4U);
  EXPECT_EQ(ends.last("t"), 0.3);
}

std::string rod(double angle, double spin) {
  return "coordinates = [\"x\", \"z\", \"phi\"]\nparameters = {m = 1, l = 1, g = 9.81, mu = 1.4, J = \"m*l^2/3\"}\n" +
         std::string(kBody) + R"toml(
[[contact]]
name = "tip"
gap = "(C + l*B.x).z"
slip = "vel(body, C + l*B.x).x"
friction = "mu"
[initial]
conditions = ["(C + l*B.x).z = 0", "vel(body, C + l*B.x).x = 30", "vel(body, C + l*B.x).z = 0"]
phi = )toml" +
         std::to_string(angle) + "\n\"phi'\" = " + std::to_string(spin) + "\n";
}

// The effective mass 1/m (1 + 3 c^2 - 3 mu s c) of the tip vanishes at the critical angle, which exists from mu = 4/3
// on (Génot and Brogliato 1999).
TEST(ClosedForms, PainleveRodEndsByName) {
  const double mu = 1.4;
  const auto factor = [mu](double a) { return 1 + 3 * std::cos(a) * std::cos(a) - 3 * mu * std::sin(a) * std::cos(a); };
  // The critical angle is a root of 4 - 3 mu tan + tan^2.
  const double root = std::atan((3 * mu - std::sqrt(9 * mu * mu - 16)) / 2);
  ASSERT_NEAR(factor(root), 0, 1e-14);
  for (const double off : {-1e-3, 1e-3}) {
    const auto m = contact_motion(rod(root + off, 0), Rational(1, 10000));
    EXPECT_EQ(m.report.outcome.ok(), off < 0) << off << m.report.outcome.message;
    const bool named = m.report.outcome.message.find("Painlev") != std::string::npos;
    EXPECT_EQ(named, off > 0);
  }
}

// The centre of mass of a tippe top lies below the middle of its sphere at the start and above it at the end.
TEST(ClosedForms, TippeTopTurnsOver) {
  const std::string text = R"toml(coordinates = ["x", "y", "z", "psi", "theta", "phi"]
parameters = {m = 0.006, R = 0.015, a = 0.006, I1 = 8e-7, I3 = 7e-7, g = 9.81, mu = 0.03}
frame.B = "rotz(psi)*rotx(theta)*rotz(phi)"
gravity.field = "-g*ez"
point.C = "x*ex + y*ey + z*ez"
point.O = "C + a*B.z"
define.L = "I1*angvel(B) + (I3 - I1)*dot(angvel(B), B.z)*B.z"
[[body]]
name = "top"
mass = "m"
inertia = ["I1", "I1", "I3"]
center = "C"
orientation = "B"
[[contact]]
name = "floor"
gap = "O.z - R"
slip = "vel(top, O - R*ez)"
along = ["ex", "ey"]
friction = "mu"
[monitor]
jellett = "dot(L, R*ez - a*B.z)"
energy = "1/2*m*dot(vel(C), vel(C)) + 1/2*dot(L, angvel(B)) + m*g*C.z"
[initial]
theta = 1.5
guess = {z = 0.015}
"phi'" = 200
conditions = ["O.z = R"]
)toml";
  const auto turn = [&](const std::string& friction) {
    const auto m = contact_motion(text, Rational(447, 100), {{"mu", friction}});
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    EXPECT_LT(m.report.power, 1e-10);
    double most = 0;
    for (std::size_t k = 0; k < m.rows.rows().size(); ++k) {
      most = std::max(most, m.number(k, "theta"));
      EXPECT_NEAR(m.number(k, "jellett"), m.number(0, "jellett"), 1e-11 * std::abs(m.number(0, "jellett")));
      const double before = m.number(k > 0 ? k - 1 : 0, "energy");
      EXPECT_LE(m.number(k, "energy"), before * (1 + 1e-10));
    }
    return most;
  };
  EXPECT_GT(turn("0.03"), 2.9);
  EXPECT_LT(turn("0"), 2.9);  // the mutant
}

// Round-off determines the direction of a slip with two components at its end. The rows up to the end are continuous,
// and no note calls a row wrong.
TEST(ClosedForms, RowsUpToTheEndOfASlip) {
  const std::string hoop = R"toml(
coordinates = ["x", "y", "z", "psi", "theta", "phi"]
gravity.field = "-9.81*ez"
frame.lean = "rotz(psi)*rotx(theta)"
body = [{name = "hoop", mass = 0.3, shape = "ring(0.2)", center = "x*ex + y*ey + z*ez", orientation = "lean*rotz(phi)"}]
contact = [{name = "floor", body = "hoop", friction = 0.25}]
[initial]
z = "0.2*sin(1.3)"
theta = 1.3
"theta'" = 0
)toml";
  for (const char* velocities : {"\"x'\" = 0.423\n\"y'\" = -0.0906\n\"psi'\" = -1.42\n\"phi'\" = -1.57\n",
                                 "\"x'\" = 0.856\n\"y'\" = 0.866\n\"psi'\" = -2.01\n\"phi'\" = -13.9\n"}) {
    const auto m = contact_motion(hoop + velocities, Rational(7, 10));
    EXPECT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
    for (const Warning& w : m.report.warnings) EXPECT_EQ(w.message.find("rows differ"), std::string::npos) << w.message;
    const std::vector<double> ends = times(m, "floor.sticks");
    ASSERT_FALSE(ends.empty());
    std::vector<std::array<double, 2>> seen;  // time and acceleration of the rows with slip
    for (std::size_t k = 0; k < m.rows.rows().size() && m.number(k, "t") <= ends[0]; ++k)
      if (m.number(k, "floor.mode") == 1) seen.push_back({m.number(k, "t"), m.number(k, "x''")});
    ASSERT_GT(seen.size(), 3U);
    const auto step = [&](std::size_t k) { return std::abs(seen[k][1] - seen[k - 1][1]); };
    EXPECT_LT(step(seen.size() - 1), 3 * step(seen.size() - 2));
  }
}

// The body strikes at t = 1 and 2 with the speeds 1 and 1/2, at z = 0, where the table ends; x'' = 2 z.
TEST(ClosedForms, ABodyBouncesWhereATableEnds) {
  const std::string text = R"toml(
coordinates = ["x", "z"]
table = [{name = "wind", x = [0, 1, 2], y = [0, 2, -1], outside = "error"}]
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
gravity.field = "-ez"
force = [{on = "p", vector = "wind(z)*ex"}]
contact = [{name = "floor", gap = "z", restitution = 0.5}]
initial = {z = 0.5}
)toml";
  const auto m = contact_motion(text, Rational(3, 2), {}, {Rational(3, 2)});
  ASSERT_TRUE(m.report.outcome.ok()) << m.report.outcome.message;
  EXPECT_NEAR(m.last("z"), 1 / 8.0, 1e-11);
  EXPECT_NEAR(m.last("x'"), 2 / 3.0 + 1 / 12.0, 1e-11);
}

// Varying gravity lets the ratio of intervals vary; the limit is computed by the recursion in 40 digits.
TEST(ClosedForms, ImpactsUnderVaryingGravityAddUpToTheirLimit) {
  const auto m = contact_motion(R"toml(coordinates = ["z"]
parameters = {m = 1, e = 0.8}
gravity.field = "-10*(1 + 0.5*sin(3*t))*ez"
particle = [{name = "ball", mass = "m", position = "z*ez"}]
contact = [{name = "f", gap = "z", restitution = "e"}]
initial = {z = 0.2}
)toml",
                                3);
  ASSERT_EQ(times(m, "f.rests").size(), 1U);
  // From 1e-7 of the time before the limit on, the ratio counts as constant: its changes are of the same size and alter
  // a sum of 1e-7.
  EXPECT_NEAR(times(m, "f.rests")[0], 1.8021113327077998, 1e-12);
}

// A slip without friction reverses at zero, also if an event stops the motion there.
TEST(ClosedForms, SlipWithoutFrictionReversesWhereItEndsTheMotion) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "z"]
parameters = {m = 1, g = 10, mu = 0}
gravity.field = "-g*ez + 2*ex"
particle = [{name = "block", mass = "m", position = "x*ex + z*ez"}]
contact = [{name = "floor", gap = "z", slip = "x'", friction = "mu"}]
event = [{name = "turns", when = "x'", stop = true}]
[initial]
"x'" = -1
)toml",
                                3);
  EXPECT_EQ(times(m, "floor.reverses"), std::vector<double>{0.5});
  EXPECT_TRUE(times(m, "floor.sticks").empty());
}

// m g b = F t h unloads the front wheel, which a constraint holds, beside a rear wheel that is a contact.
TEST(ClosedForms, ConstraintThatPullsIsToldBesideContacts) {
  const std::string text = R"toml(coordinates = ["x", "z", "p"]
parameters = {m = 90, J = 12, a = 0.6, b = 0.5, h = 1.1, g = 9.81, F = 600}
gravity.field = "-g*ez"
point.G = "x*ex + z*ez"
frame.B = "roty(p)"
point.front = "G + a*B.x - h*B.z"
point.rear = "G - b*B.x - h*B.z"
body = [{name = "bike", mass = "m", inertia = ["J","J","J"], center = "G", orientation = "B"}]
constraint = [{name = "front", equation = "front.z = 0"}]
contact = [{name = "rear", gap = "rear.z"}]
force = [{on = {body = "bike", at = "rear"}, vector = "F*t*ex"}]
initial = {z = "h"}
)toml";
  const auto m = contact_motion(text, 1);
  ASSERT_EQ(m.report.notes.size(), 1U);
  EXPECT_EQ(m.report.notes[0].find("constraint 'front' looks like a floor and pulls down from t = 0.668864 on:"), 0U)
      << m.report.notes[0];
  EXPECT_TRUE(contact_motion(text, Rational(1, 2)).report.notes.empty());
}

// A wheel that spins in the corner of a floor and a wall comes to rest in both contacts; one of them bears no load
// then.
TEST(ClosedForms, WheelInACornerSticksAtFloorAndWall) {
  const auto m = contact_motion(R"toml(coordinates = ["x", "z", "p"]
parameters = {m = 2, R = 0.2, g = 9.81, mu1 = 0.25, mu2 = 0.4, w0 = -60}
gravity.field = "-g*ez"
body = [{name = "wheel", mass = "m", shape = "cylinder(R, 0.1)", center = "x*ex + z*ez", orientation = "roty(p)*rotx(pi/2)"}]
contact = [{name = "floor", gap = "z - R", slip = "x' - R*p'", friction = "mu1"}, {name = "wall", gap = "x - R", slip = "z' + R*p'", friction = "mu2"}]
initial = {x = "R", z = "R", "p'" = "w0"}
)toml",
                                3);
  // Floor and wall bear N1 + mu2 N2 = m g and N2 = mu1 N1, and the moment R (mu1 N1 + mu2 N2) stops m R^2/2 w.
  const double n1 = 2 * 9.81 / (1 + 0.25 * 0.4), stop = 0.2 * 60 / ((0.25 + 0.4 * 0.25) * n1);
  for (const char* name : {"floor.sticks", "wall.sticks"}) {
    ASSERT_EQ(times(m, name).size(), 1U) << name;
    EXPECT_NEAR(times(m, name)[0], stop, 1e-13);
  }
  EXPECT_TRUE(times(m, "wall.reverses").empty());
  EXPECT_EQ(m.last("wall.mode"), 2);
  EXPECT_EQ(m.last("floor.mode"), 2);
}

}  // namespace closed_forms_test
}  // namespace anholon

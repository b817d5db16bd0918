// The multiplier of a surface passes zero at the place where a carried body leaves it, in any coordinates.
//
// From the top of a sphere of radius R with the speed v, a particle leaves at cos(theta) = (2 + w)/3, w = v^2/(g R); a
// ball that rolls, whose centre is R from that of the sphere, at cos(theta) = (10 + 7 w)/17.
#include <gtest/gtest.h>

#include "simulation/first_pull.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::leaving_test {
namespace {

constexpr double kRadius = 1.5, kSpeed = 0.6, kGravity = 9.81, kW = kSpeed * kSpeed / (kGravity * kRadius);

const std::string kHead = "parameters = {m = 2, R = 1.5, a = 0.1, g = 9.81, v = 0.6}\ngravity.field = \"-g*ez\"\n";

std::string constraint(const std::string& name, const std::string& equation) {
  return "[[constraint]]\nname = \"" + name + "\"\nequation = \"" + equation + "\"\n";
}

// The particle on a plane curve, in space, and in polar coordinates.
const std::string kParticles[3] = {
    "coordinates = [\"x\", \"z\"]\n" + kHead +
        "[[particle]]\nname = \"bead\"\nmass = \"m\"\nposition = \"x*ex + z*ez\"\n" +
        constraint("sphere", "x^2 + z^2 = R^2") + "[initial]\nz = \"R\"\n\"x'\" = \"v\"\n",
    "coordinates = [\"x\", \"y\", \"z\"]\n" + kHead +
        "[[particle]]\nname = \"bead\"\nmass = \"m\"\nposition = \"x*ex + y*ey + z*ez\"\n" +
        constraint("sphere", "R = norm(bead)") + "[initial]\nz = \"R\"\n\"x'\" = \"0.6*v\"\n\"y'\" = \"0.8*v\"\n",
    "coordinates = [\"r\", \"u\"]\n" + kHead +
        "[[particle]]\nname = \"bead\"\nmass = \"m\"\nposition = \"r*sin(u)*ex + r*cos(u)*ez\"\n" +
        constraint("sphere", "r = R") + "[initial]\nr = \"R\"\n\"u'\" = \"v/R\"\n"};

// `inertia`: moment of inertia of the ball, in m a^2.
std::string ball(const std::string& inertia) {
  return "coordinates = [\"x\", \"z\", \"phi\"]\n" + kHead +
         "point.C = \"x*ex + z*ez\"\n[[body]]\nname = \"bead\"\nmass = \"m\"\ninertia = [\"" + inertia + "\", \"" +
         inertia + "\", \"" + inertia + "\"]\ncenter = \"C\"\norientation = \"roty(phi)\"\n" +
         constraint("sphere", "norm(C) = R") + constraint("rolling", "dot(vel(bead, (1 - a/R)*C), z*ex - x*ez) = 0") +
         "[initial]\nz = \"R\"\n\"x'\" = \"v\"\n";
}

struct Left {
  double height = 0;  // in units of R
  std::string note;
};

Left leaves(const std::string& text) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  SimulationOptions o;
  o.to = Rational(2);
  o.every = Rational(1, 2);
  o.tolerance = Rational(1, 1000000000000000);
  test::TextRows rows;
  const SimulationReport r = simulate(s, o, rows);
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  Left left;
  if (r.notes.size() == 1) left.note = r.notes[0];
  const std::vector<Support> supports = carriers(s, {});
  EXPECT_EQ(supports.size(), 1u);
  if (supports.size() != 1) return left;
  const Follow follow = [](const Scenario& own, const SimulationOptions& options, RowSink& to) {
    return simulate(own, options, to);
  };
  const auto begin = first_pull(s, o, supports[0], 2, follow);
  EXPECT_TRUE(begin && begin->carries && begin->t);
  if (!begin || !begin->t) return left;
  EXPECT_NE(left.note.find("constraint 'sphere' carries 'bead' at the start, and its force is turned round from t = " +
                           number_text(*begin->t, 6) + " on"),
            std::string::npos)
      << left.note;
  o.every.reset();
  o.at = {Rational(*begin->t)};
  test::TextRows there;
  simulate(s, o, there);
  const bool polar = s.model->coordinates[0].name == "r";
  const std::string name = polar ? "u" : "z";
  for (std::size_t k = 0; k < there.names().size(); ++k)
    if (there.names()[k] == name) {
      const double value = std::stod(there.rows()[0][k]);
      left.height = polar ? std::cos(value) : value / kRadius;
    }
  return left;
}

TEST(Leaving, OfAParticleIsAtTwoThirds) {
  for (const std::string& text : kParticles) EXPECT_NEAR(leaves(text).height, (2 + kW) / 3, 1e-13);
}

TEST(Leaving, OfABallThatRollsIsAtTenSeventeenths) {
  const Left left = leaves(ball("2*m*a^2/5"));
  EXPECT_NEAR(left.height, (10 + 7 * kW) / 17, 1e-13);
  EXPECT_NE(left.note.find("a [[contact]] with its gap and slip in place of the constraints 'sphere', 'rolling'"),
            std::string::npos)
      << left.note;
  // A hollow ball, whose moment of inertia is 2 m a^2/3, leaves elsewhere.
  EXPECT_GT(std::abs(leaves(ball("2*m*a^2/3")).height - (10 + 7 * kW) / 17), 1e-3);
}

// A form without multipliers reports the same time, which is not the time of a row.
TEST(Leaving, IsLocatedInAllForms) {
  const auto note = [](const char* form) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::model_of(kParticles[0]), *find_formulation(form), {}, s).ok());
    SimulationOptions o;
    o.to = Rational(2);
    o.every = Rational(1, 2);
    test::TextRows rows;
    const SimulationReport r = simulate(s, o, rows);
    EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
    return r.notes.empty() ? "" : r.notes.back();
  };
  EXPECT_NE(note("routh").find("is turned round from t = "), std::string::npos);
  EXPECT_EQ(note("maggi"), note("routh"));
}

// No note is made on a motion that stays on the surface, nor on a pendulum that swings.
TEST(Leaving, IsNotToldOfWhatStays) {
  const auto notes = [](const std::string& text) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
    SimulationOptions o;
    o.to = Rational(3);
    test::TextRows rows;
    const SimulationReport r = simulate(s, o, rows);
    EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
    return r.notes;
  };
  const std::string hangs = test::replaced(kParticles[0], "z = \"R\"", "z = \"-R\"");
  // The pendulum swings up to 90 degrees at v^2 = 2 g R and passes the top at v^2 = 5 g R; between these speeds its rod
  // is pressed.
  EXPECT_TRUE(notes(test::replaced(hangs, "v = 0.6", "v = 5.4")).empty());
  EXPECT_EQ(notes(test::replaced(hangs, "v = 0.6", "v = 5.5")).size(), 1u);
  EXPECT_EQ(notes(test::replaced(hangs, "v = 0.6", "v = 8.5")).size(), 1u);
  EXPECT_TRUE(notes(test::replaced(hangs, "v = 0.6", "v = 8.6")).empty());
  // A pendulum that is released with its rod level starts without a force.
  EXPECT_TRUE(notes(test::replaced(kParticles[0], "z = \"R\"\n\"x'\" = \"v\"", "x = \"R\"")).empty());
}

}  // namespace
}  // namespace anholon::leaving_test

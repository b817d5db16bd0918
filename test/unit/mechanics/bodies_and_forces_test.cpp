// A shape equals a set of mass points with the same moments. Forces at places, dissipation functions and varying fields
// equal forces at points. A quaternion body on norm 1 is a rigid body.
#include <gtest/gtest.h>

#include "mechanics/conserved.h"
#include "mechanics/mechanics.h"
#include "support/model_point.h"
#include "support/models.h"

namespace anholon::bodies_and_forces_test {
namespace {

constexpr double kRounding = 1e-33;  // 40 digits, hundreds of operations

const std::string kHead = R"toml(coordinates = ["x", "y", "ps", "th", "ph"]
[parameters]
R = "3/10"
h = "7/10"
[frame]
stone = "rotz(ps)*rotx(th)*rotz(ph + t^2/5)"
[observer]
spin = ["t/2", "cos(t)", "1/3"]
origin_acceleration = ["sin(t)", "t", "2"]
[point]
O = "x*ex + y*cos(t)*ey + x*y*ez"
)toml";

std::vector<Multi> quantities(const std::string& text, std::uint64_t seed) {
  const auto model = test::model_of(text);
  const Mechanics m = mechanics(*model);
  Column all = {m.T, m.S, m.V_O, m.V_omega, power(m).h, power(m).dh_dt};
  for (const Column* c : {&m.Q, &m.Qomega, &m.minus_dVO, &m.minus_dVomega, &m.Gamma})
    all.insert(all.end(), c->begin(), c->end());
  for (const Column& row : mass_matrix(m)) all.insert(all.end(), row.begin(), row.end());
  return test::values(put_masses(*model, all), test::random_point(*model, seed));
}

double gap(const std::string& a, const std::string& b) {
  const PrecisionScope precision(40);
  double worst = 0;
  for (std::uint64_t seed : {1, 2, 3}) {
    const std::vector<Multi> u = quantities(a, seed), v = quantities(b, seed);
    for (std::size_t i = 0; i < u.size(); ++i) worst = std::max(worst, test::distance(u[i], v[i]));
  }
  return worst;
}

std::string body(const std::string& extra, const std::string& mass = "3") {
  return kHead + "[[body]]\nname = \"b\"\nmass = \"" + mass + "\"\ncenter = \"O\"\norientation = \"stone\"\n" + extra;
}

// Puts equal parts of the mass at the given places of the body: a rule that integrates second powers over the solid
// exactly.
std::string cloud(const std::vector<std::string>& places, const std::string& mass = "3") {
  std::string out = kHead;
  for (std::size_t k = 0; k < places.size(); ++k)
    out += "[[particle]]\nname = \"p" + std::to_string(k) + "\"\nmass = \"(" + mass + ")/" +
           std::to_string(places.size()) + "\"\nposition = \"O + stone(" + places[k] + ")\"\n";
  return out;
}

std::vector<std::string> all_signs(const std::string& a, const std::string& b, const std::string& c) {
  std::vector<std::string> out;
  for (const char* i : {"", "-"})
    for (const char* j : {"", "-"})
      for (const char* k : {"", "-"}) out.push_back(i + a + ", " + j + b + ", " + k + c);
  return out;
}

struct Solid {
  const char* shape;
  std::vector<std::string> places;
};

// The mean of r^2 is R^2/2 over a disc and 3/5 R^2 over a ball; the mean of x^2 over a length l is l^2/12.
std::vector<Solid> solids() {
  const std::vector<std::string> cross = {"R, 0, 0", "-R, 0, 0", "0, R, 0", "0, -R, 0"};
  std::vector<std::string> disc, ball, shell, cylinder;
  for (const std::string& p : cross) {
    disc.push_back(test::replaced(p, "R", "R/sqrt(2)"));
    for (const char* z : {"h/sqrt(12)", "-h/sqrt(12)"})
      cylinder.push_back(disc.back().substr(0, disc.back().rfind(',')) + ", " + z);
  }
  for (const char* p : {"R, 0, 0", "-R, 0, 0", "0, R, 0", "0, -R, 0", "0, 0, R", "0, 0, -R"}) {
    shell.push_back(p);
    ball.push_back(test::replaced(p, "R", "R*sqrt(3/5)"));
  }
  return {{"disc(R)", disc},
          {"ring(R)", cross},
          {"ball(R)", ball},
          {"shell(R)", shell},
          {"rod(h)", {"h/sqrt(12), 0, 0", "-h/sqrt(12), 0, 0"}},
          {"box(R, h, R + h)", all_signs("R/sqrt(12)", "h/sqrt(12)", "(R + h)/sqrt(12)")},
          {"cylinder(R, h)", cylinder}};
}

TEST(Shape, IsTheMassPointsWithItsMoments) {
  for (const Solid& s : solids()) {
    const std::string shape = s.shape;
    EXPECT_LE(gap(body("shape = \"" + shape + "\"\n"), cloud(s.places)), kRounding) << shape;
    const std::string larger = test::replaced(shape, shape.find('R') == std::string::npos ? "h" : "R", "1.01*1");
    EXPECT_GT(gap(body("shape = \"" + larger + "\"\n"), cloud(s.places)), 1e-6) << "mutant: " << larger;
  }
}

TEST(Shape, OfVaryingMassIsFrozenAsItsPointsAre) {
  for (const Solid& s : solids())
    EXPECT_LE(
        gap(body("shape = \"" + std::string(s.shape) + "\"\n", "3 - t/4 + x^2/9"), cloud(s.places, "3 - t/4 + x^2/9")),
        kRounding)
        << s.shape;
}

TEST(Shape, GivesWayToAnInertiaAndStaysAsAPicture) {
  EXPECT_LE(gap(body("shape = \"ball(R)\"\ninertia = [1, 2, 2]\n"), body("inertia = [1, 2, 2]\n")), kRounding);
  const auto model = test::model_of(body("shape = \"box(R, h, 2)\"\ninertia = [1, 2, 2]\n"));
  ASSERT_TRUE(model->bodies[0].shape);
  EXPECT_EQ(model->bodies[0].shape->kind, "box");
  EXPECT_EQ(model->bodies[0].shape->sizes.size(), 3U);
}

TEST(Shape, InThePlaneCountsAboutTheNormal) {
  const auto plane = [](const std::string& inertia) {
    return "coordinates = [\"x\", \"th\"]\n[[body]]\nname = \"b\"\nmass = 2\ncenter = \"x*ex\"\nangle = \"th\"\n" +
           inertia;
  };
  EXPECT_LE(gap(plane("shape = \"rod(3)\"\n"), plane("inertia = \"2*9/12\"\n")), kRounding);
  EXPECT_LE(gap(plane("shape = \"disc(3)\"\n"), plane("inertia = 9\n")), kRounding);
  EXPECT_GT(gap(plane("shape = \"ring(3)\"\n"), plane("inertia = 9\n")), 1e-3);
}

TEST(Massless, CarriersGiveNothingAndRotorsTheirTurning) {
  const std::string carrier =
      "[[body]]\nname = \"table\"\ncenter = \"x*ex\"\norientation = \"rotz(x*ps)\"\nshape = \"box(1, 2, 3)\"\n";
  EXPECT_LE(gap(body("shape = \"disc(R)\"\n") + carrier, body("shape = \"disc(R)\"\n")), kRounding);
  const auto rotor = test::model_of("coordinates = [\"x\", \"th\"]\n[[body]]\nname = \"b\"\ninertia = \"1/3\"\ncenter "
                                    "= \"x*ex\"\nangle = \"th + x^2\"\n");
  const Mechanics m = mechanics(*rotor);
  const Expr turning = total_derivative(m.q[1] + pow(m.q[0], 2));
  EXPECT_TRUE(is_zero(m.T - Rational(1, 6) * pow(turning, 2)));
}

// A force at a place that runs along the body acts on the material point there: Q = F . dvel(B, P)/dq', with no work
// along s itself.
TEST(ForceAtAMovingPlace, WorksThroughTheMaterialVelocity) {
  const PrecisionScope precision(40);
  const auto model = test::model_of(R"toml(coordinates = ["x", "y", "th", "s"]
[[body]]
name = "beam"
mass = 2
inertia = "1/3"
center = "x*ex + y*ey"
angle = "th"
[[particle]]
name = "mouse"
mass = "1/10"
position = "P"
[point]
P = "beam.center + beam(s, s^2/3, 0)"
[[force]]
on = {body = "beam", at = "P"}
vector = ["sin(t)", "x - s", "0"]
[monitor]
material = "dot([sin(t), x - s, 0], vel(beam, P))"
of_the_place = "dot([sin(t), x - s, 0], vel(P))"
)toml");
  const Mechanics m = mechanics(*model);
  const test::Point at = test::random_point(*model, 4);
  const std::vector<Multi> Q = test::values(m.Q, at),
                           material = test::values(gradient(model->monitors[0].value, m.qd), at),
                           wrong = test::values(gradient(model->monitors[1].value, m.qd), at);
  for (std::size_t a = 0; a < Q.size(); ++a) EXPECT_LE(test::distance(Q[a], material[a]), kRounding) << a;
  EXPECT_TRUE(is_zero(m.Q[3]));
  EXPECT_GT(test::distance(Q[3], wrong[3]), 1e-3) << "mutant: through the velocity of the place";
}

TEST(Dissipation, IsTheForceThatItStandsFor) {
  const PrecisionScope precision(40);
  const auto rayleigh = test::model_of(body("shape = \"disc(R)\"\n") +
                                       "[dissipation]\noil = \"2/7*norm2(vel(O))/2\"\nair = \"norm(vel(O))^3/3\"\n");
  const auto force = test::model_of(body("shape = \"disc(R)\"\n") +
                                    "[[force]]\non = \"b\"\nvector = \"-(2/7 + norm(vel(O)))*vel(O)\"\n");
  const auto mutant = test::model_of(body("shape = \"disc(R)\"\n") +
                                     "[[force]]\non = \"b\"\nvector = \"-(2/7 + norm(vel(O))/3)*vel(O)\"\n");
  const Mechanics a = mechanics(*rayleigh), b = mechanics(*force), c = mechanics(*mutant);
  double worst = 0, missed = 0;
  for (std::uint64_t seed : {1, 2, 3}) {
    const test::Point p = test::random_point(*rayleigh, seed);
    const std::vector<Multi> u = test::values(a.QD, p), v = test::values(b.Q, test::random_point(*force, seed)),
                             w = test::values(c.Q, test::random_point(*mutant, seed));
    for (std::size_t k = 0; k < u.size(); ++k)
      worst = std::max(worst, test::distance(u[k], v[k])), missed = std::max(missed, test::distance(u[k], w[k]));
    EXPECT_LE(test::distance(test::value(power(a).noncons, p),
                             test::value(power(b).noncons, test::random_point(*force, seed))),
              kRounding);
  }
  EXPECT_LE(worst, kRounding);
  EXPECT_GT(missed, 1e-3);
  EXPECT_TRUE(is_zero(sum(a.Q))) << "it is a column of its own";
}

// In a field that is linear in the place, force and torque of the body are exactly those of its points.
TEST(GravityGradient, IsTheTorqueOnThePointsOfTheBody) {
  const std::string field =
      "[gravity]\nfield = [\"here.x*3 - here.y*here.x*0\", \"here.y - 2\", \"-4*here.z + here.y\"]\n";
  const std::vector<std::string> places = all_signs("R/sqrt(12)", "h/sqrt(12)", "2/sqrt(12)");
  const std::string box = body("shape = \"box(R, h, 2)\"\n") + field;
  EXPECT_LE(gap(box + "gradient = true\n", cloud(places) + field), kRounding);
  EXPECT_GT(gap(box + "gradient = false\n", cloud(places) + field), 1e-3) << "mutant: without";
  EXPECT_LE(gap(body("shape = \"box(R, h, 2)\"\n") + "[gravity]\nfield = \"-9.81*ez\"\ngradient = true\n",
                body("shape = \"box(R, h, 2)\"\n") + "[gravity]\nfield = \"-9.81*ez\"\n"),
            kRounding);
}

bool energy_is_claimed(const std::string& text) {
  const auto model = test::model_of(text);
  for (const Conserved& c : conserved(mechanics(*model)))
    if (c.name == "energy") return true;
  return false;
}

TEST(Energy, IsNotClaimedWhereItIsLost) {
  const std::string bob = "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex + "
                          "y*ey\"\n[potential]\nV = \"x^2\"\n[dissipation]\n";
  EXPECT_TRUE(energy_is_claimed(bob));
  EXPECT_FALSE(energy_is_claimed(bob + "R = \"x'^2/1000\"\n"));
  EXPECT_TRUE(energy_is_claimed(bob + "R = \"x*x' - x*x'^2/2 + x*(x' - 1)^2/2\"\n"))
      << "x/2: no velocity is left in it";
  const std::string stone = "coordinates = [\"x\", \"ps\", \"th\"]\n[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 2, "
                            "2]\norientation = \"rotz(ps)*rotx(th)\"\n[gravity]\n"
                            "field = \"-here/norm(here)^3\"\n";
  const auto held = [&](const std::string& center) {
    return test::replaced(stone, "mass = 1", "mass = 1\ncenter = " + center);
  };
  EXPECT_TRUE(energy_is_claimed(held("[\"x\", 2, 1]")));
  EXPECT_TRUE(energy_is_claimed(held("[2, 2, 1]") + "gradient = true\n"));
  EXPECT_FALSE(energy_is_claimed(held("[\"x\", 2, 1]") + "gradient = true\n"))
      << "the force of second order is left out";
}

// On norm 1: T = 1/2 sum J_k (omega . B_k)^2.
TEST(QuaternionBody, HasTheKineticEnergyOfARigidBodyOnNormOne) {
  const PrecisionScope precision(40);
  const auto model = test::model_of(R"toml(coordinates = ["e0", "e1", "e2", "e3"]
[[body]]
name = "b"
mass = 1
inertia = [2, 3, 4]
center = [0, 0, 0]
orientation = "quat(e0, e1, e2, e3)"
[monitor]
rigid = "dot(angvel(b), b.x)^2 + 3/2*dot(angvel(b), b.y)^2 + 2*dot(angvel(b), b.z)^2"
)toml");
  const Mechanics m = mechanics(*model);
  Graph& g = *model->graph;
  test::Point at = test::random_point(*model, 1);
  const int e[] = {2, 3, 6, 0}, rate[] = {3, -2, 0, 5};  // orthogonal
  for (std::uint32_t k = 0; k < 4; ++k) at.set(g.jet(k, 0), Multi(e[k]) / Multi(7)).set(g.jet(k, 1), Multi(rate[k]));
  EXPECT_LE(test::distance(test::value(m.T, at), test::value(model->monitors[0].value, at)), kRounding);
  EXPECT_GT(to_double(test::value(m.T, at)), 1);
  at.set(g.jet(0, 0), Multi(1));
  EXPECT_GT(test::distance(test::value(m.T, at), test::value(model->monitors[0].value, at)), 1e-3)
      << "off the sphere it is no rotation";
}

}  // namespace
}  // namespace anholon::bodies_and_forces_test

// A rigid body equals its particles: T, S and every generalized force of a body given by mass and inertia are compared
// with those of the particles that form it, at random points of the jet space, with a tumbling and shaking observer and
// moving guides.
#include <gtest/gtest.h>

#include "mechanics/mechanics.h"
#include "support/model_point.h"
#include "support/models.h"

namespace anholon::mechanics_test {
namespace {

constexpr double kRounding = 1e-33;  // 40 digits, hundreds of operations

// A body of four particles with masses 1/2, 1, 3/2, 2 at (1, 0, 0), (0, 1, 1/2), (-1, 1/3, 0), (0, 0, -1) of a turned
// frame; all its products of inertia differ from zero.
const int kParticles = 4;
const Rational kMass[] = {Rational(1, 2), 1, Rational(3, 2), 2};
const Rational kPlace[][3] = {{1, 0, 0}, {0, 1, Rational(1, 2)}, {-1, Rational(1, 3), 0}, {0, 0, -1}};

const std::string kHead = R"toml(coordinates = ["x", "y", "ps", "th", "ph"]
[parameters]
g = 9.81
[frame]
stone = "rotz(ps)*rotx(th)*rotz(ph + t^2/5)"
[observer]
spin = ["t/2", "cos(t)", "1/3"]
origin_acceleration = ["sin(t)", "t", "2"]
[gravity]
field = ["0.3*g", "0", "-g"]
[point]
O = "x*ex + y*cos(t)*ey + x*y*ez"
)toml";

std::string text(const Rational& r) { return r.get_str(); }

std::string particles() {
  std::string out = kHead;
  for (int i = 0; i < kParticles; ++i)
    out += "[[particle]]\nname = \"p" + std::to_string(i) + "\"\nmass = \"" + text(kMass[i]) +
           "\"\nposition = \"O + stone(" + text(kPlace[i][0]) + ", " + text(kPlace[i][1]) + ", " + text(kPlace[i][2]) +
           ")\"\n";
  return out;
}

struct Moments {
  Rational mass = 0, center[3] = {0, 0, 0}, second[3][3];  // second: about the mass centre, sum m x_k x_l
};

Moments moments() {
  Moments m;
  for (int i = 0; i < kParticles; ++i) m.mass += kMass[i];
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < kParticles; ++i) m.center[k] += kMass[i] * kPlace[i][k];
    m.center[k] /= m.mass;
  }
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) {
      m.second[k][l] = 0;
      for (int i = 0; i < kParticles; ++i)
        m.second[k][l] += kMass[i] * (kPlace[i][k] - m.center[k]) * (kPlace[i][l] - m.center[l]);
    }
  return m;
}

std::string body(const std::string& inertia_or_axes) {
  const Moments m = moments();
  return kHead + "[[body]]\nname = \"stone\"\nmass = \"" + text(m.mass) + "\"\ncenter = \"O + stone(" +
         text(m.center[0]) + ", " + text(m.center[1]) + ", " + text(m.center[2]) + ")\"\norientation = \"stone\"\n" +
         inertia_or_axes;
}

std::string matrix(const Rational& mistake) {
  const Moments m = moments();
  const Rational trace = m.second[0][0] + m.second[1][1] + m.second[2][2];
  std::string rows;
  for (int k = 0; k < 3; ++k) {
    rows += k ? ", [" : "[";
    for (int l = 0; l < 3; ++l) {
      Rational j = k == l ? Rational(trace - m.second[k][k]) : Rational(-m.second[k][l]);
      if (k == l && l == 0) j += mistake;
      rows += std::string(l ? ", " : "") + "\"" + text(j) + "\"";
    }
    rows += "]";
  }
  return "inertia = [" + rows + "]\n";
}

// The same second moments as axes: completing squares gives E = sum e_k x_k x_k^T with x_k that are not orthonormal.
std::string axes() {
  const Moments m = moments();
  Rational e[3][3];
  for (int k = 0; k < 3; ++k)
    for (int l = 0; l < 3; ++l) e[k][l] = m.second[k][l];
  std::string list;
  for (int p = 0; p < 3; ++p) {
    Rational v[3];
    for (int k = 0; k < 3; ++k) v[k] = e[k][p] / e[p][p];
    list += std::string(p ? ", " : "") + "{weight = \"" + text(e[p][p]) + "\", vector = \"stone(" + text(v[0]) + ", " +
            text(v[1]) + ", " + text(v[2]) + ")\"}";
    const Rational pivot = e[p][p];
    for (int k = 0; k < 3; ++k)
      for (int l = 0; l < 3; ++l) e[k][l] -= pivot * v[k] * v[l];
  }
  return "axes = [" + list + "]\n";
}

// All kinetic quantities and inertial forces in one column.
std::vector<Multi> quantities(const std::string& model_text, std::uint64_t seed) {
  const auto model = test::model_of(model_text);
  const Mechanics m = mechanics(*model);
  Column all = {m.T, m.S, m.V_O, m.V_omega, power(m).h, power(m).dh_dt};
  for (const Column* c : {&m.Q, &m.Qomega, &m.minus_dVO, &m.minus_dVomega, &m.Gamma})
    all.insert(all.end(), c->begin(), c->end());
  const Column e = newton_left_side(m);
  all.insert(all.end(), e.begin(), e.end());
  for (const Column& row : mass_matrix(m)) all.insert(all.end(), row.begin(), row.end());
  return test::values(all, test::random_point(*model, seed));
}

double gap(const std::string& a, const std::string& b) {
  double worst = 0;
  for (std::uint64_t seed : {1, 2, 3}) {
    const std::vector<Multi> u = quantities(a, seed), v = quantities(b, seed);
    for (std::size_t i = 0; i < u.size(); ++i) worst = std::max(worst, test::distance(u[i], v[i]));
  }
  return worst;
}

class BodyGiven : public testing::Test {
 protected:
  PrecisionScope precision{40};
};

TEST_F(BodyGiven, ByItsMatrixIsItsParticles) {
  EXPECT_LE(gap(particles(), body(matrix(0))), kRounding);
  EXPECT_GT(gap(particles(), body(matrix(Rational(1, 100)))), 1e-5) << "mutant: a moment of inertia a little larger";
}

TEST_F(BodyGiven, ByAxesIsTheSame) { EXPECT_LE(gap(body(axes()), body(matrix(0))), kRounding); }

TEST_F(BodyGiven, ThreeMomentsAreTheDiagonalMatrix) {
  EXPECT_LE(gap(body("inertia = [2, 3, 4]\n"), body("inertia = [[2, 0, 0], [0, 3, 0], [0, 0, 4]]\n")), kRounding);
  EXPECT_LE(gap(body("inertia = [2, 3, 4]\n"),
                body("axes = [{weight = \"5/2\", vector = \"stone.x\"}, {weight = \"3/2\", vector = \"stone.y\"}, "
                     "{weight = \"1/2\", vector = \"stone.z\"}]\n")),
            kRounding);
  EXPECT_GT(gap(body("inertia = [2, 3, 4]\n"), body("inertia = [3, 2, 4]\n")), 1e-3);
}

TEST_F(BodyGiven, InThePlaneOneNumberIsTheMomentAboutTheNormal) {
  const auto plane = [](const std::string& inertia) {
    return "coordinates = [\"x\", \"y\", \"th\"]\n[observer]\nspin = \"t*ez\"\norigin_acceleration = [\"1\", \"t\", "
           "\"0\"]\n[[body]]\nname = \"b\"\nmass = 2\ncenter = "
           "\"x*ex + y*ey\"\nangle = \"th\"\n" +
           inertia;
  };
  EXPECT_LE(gap(plane("inertia = 3\n"), plane("inertia = [\"3/2\", \"3/2\", 3]\n")), kRounding);
  EXPECT_LE(gap(plane("inertia = 3\n"), plane("inertia = [1, 2, 3]\n")), kRounding) << "a lamina: only the sum matters";
  EXPECT_GT(gap(plane("inertia = 3\n"), plane("inertia = 2\n")), 1e-3);
}

// ---- generalized forces against their definitions, with derivatives by differences
// -----------------------------------------

using V3 = std::vector<Multi>;
V3 cross3(const V3& a, const V3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Multi dot3(const V3& a, const V3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V3 difference3(const V3& a, const V3& b, const Multi& h) {
  return {(a[0] - b[0]) / h, (a[1] - b[1]) / h, (a[2] - b[2]) / h};
}

const std::string kSwarm = kHead + R"toml([define]
mass1 = "2*exp(-t/4)*(1 + x^2/5) + ps'^2/10"
[[particle]]
name = "a"
mass = "mass1"
position = "O + stone(1, 2, t)"
expelled_velocity = ["1", "x'", "t"]
[[particle]]
name = "b"
mass = 3
position = ["x*y", "sin(th)*t", "ph^2"]
[[force]]
name = "pull"
on = "a"
vector = ["x'", "-y", "ps"]
)toml";

TEST(GeneralizedForces, AreTheirDefinitions) {
  const PrecisionScope precision(80);
  const double tolerance = 1e-30;  // differences with h = 1e-20 err by h^2
  const Multi h = test::raise(Multi(10), Rational(-20)), two_h = Multi(2) * h;
  const auto model = test::model_of(kSwarm);
  const Mechanics m = mechanics(*model);
  Graph& g = *model->graph;
  const test::Point at = test::random_point(*model, 5);
  const auto put = [&](const Column& c) { return test::values(put_masses(*model, c), at); };
  const auto three = [](const Vector& v, const test::Point& p) {
    return test::values(std::vector<Expr>{v.x, v.y, v.z}, p);
  };
  const V3 omega = three(model->observer.spin, at), a0 = three(model->observer.origin_acceleration, at);
  const V3 omega_dot = difference3(three(model->observer.spin, test::moved(*model, at, h, 2)),
                                   three(model->observer.spin, test::moved(*model, at, -h, 2)), two_h);
  std::vector<V3> expected(7, V3(m.q.size(), Multi(0)));
  Multi V_omega(0);
  for (const Body& b : model->bodies) {
    const auto place = [&](const test::Point& p) { return three(b.center, p); };
    const auto mass = [&](const test::Point& p) { return test::value(put_masses(*model, b.mass), p); };
    const test::Point later = test::moved(*model, at, h, 2), earlier = test::moved(*model, at, -h, 2);
    const V3 rho = place(at), v = difference3(place(later), place(earlier), two_h);
    const Multi mu = mass(at), mdot = (mass(later) - mass(earlier)) / two_h;
    V3 acceleration(3, Multi(0));
    for (std::size_t i = 0; i < 3; ++i)
      acceleration[i] = (place(later)[i] + place(earlier)[i] - Multi(2) * rho[i]) / (h * h);
    const V3 turned = cross3(omega, rho);
    V_omega -= mu * dot3(turned, turned) / Multi(2);
    V3 force = three(b.gravity, at);
    for (Multi& f : force) f *= mu;
    if (b.name == "a") {
      const V3 pull = three(model->forces[0].vector, at);
      for (std::size_t i = 0; i < 3; ++i) force[i] += pull[i];
    }
    const V3 u = b.expelled_velocity ? three(*b.expelled_velocity, at) : V3(3, Multi(0));
    for (std::uint32_t k = 0; k < m.q.size(); ++k) {
      test::Point up = at, down = at;
      up.set(m.q[k], at(g, m.q[k].id) + h);
      down.set(m.q[k], at(g, m.q[k].id) - h);
      const V3 along = difference3(place(up), place(down), two_h);
      expected[0][k] += dot3(force, along);
      expected[1][k] += mdot * dot3(u, along);
      expected[2][k] -= mu * dot3(cross3(omega_dot, rho), along);
      expected[3][k] -= mu * dot3(a0, along);
      expected[4][k] -= mu * dot3(cross3(omega, turned), along);
      expected[5][k] -= Multi(2) * mu * dot3(cross3(omega, v), along);
      expected[6][k] += mu * dot3(acceleration, along);
    }
  }
  const std::vector<std::pair<const char*, std::vector<Multi>>> found = {
      {"Q", put(m.Q)},
      {"QR", put(m.QR)},
      {"Qomega", put(m.Qomega)},
      {"minus_dVO", put(m.minus_dVO)},
      {"minus_dVomega", put(m.minus_dVomega)},
      {"Gamma", put(m.Gamma)},
      {"newton_left_side", test::values(newton_left_side(m), at)}};
  for (std::size_t f = 0; f < found.size(); ++f)
    for (std::size_t k = 0; k < m.q.size(); ++k) {
      const double rounding = f == 6 ? 1e-28 : tolerance;  // second differences cancel 40 of 80 digits
      EXPECT_LE(test::distance(found[f].second[k], expected[f][k]), rounding) << found[f].first << " " << k;
      // The mutant: twice a force is another force, if it is not zero.
      if (std::abs(to_double(expected[f][k])) > 1e-3) {
        EXPECT_GT(test::distance(Multi(2) * found[f].second[k], expected[f][k]), 1e-4);
      }
    }
  EXPECT_LE(test::distance(test::value(put_masses(*model, m.V_omega), at), V_omega), tolerance);
}

TEST(GeneralizedForces, ATorqueDoesItsWorkThroughTheAngularVelocity) {
  const PrecisionScope precision(40);
  const std::string stone = body("inertia = [2, 3, 4]\n");
  const auto torque =
      test::model_of(stone + "[[force]]\nname = \"tau\"\non = \"stone\"\ntorque = [\"1\", \"x\", \"t\"]\n");
  const auto couple = test::model_of(
      stone + "[[force]]\nname = \"up\"\non = {body = \"stone\", at = [1, 0, 0]}\nvector = \"3*stone.y\"\n" +
      "[[force]]\nname = \"down\"\non = {body = \"stone\", at = [0, 0, 0]}\nvector = \"-3*stone.y\"\n");
  const auto as_torque = test::model_of(stone + "[[force]]\nname = \"tau\"\non = \"stone\"\ntorque = \"3*stone.z\"\n");
  const auto Q = [](const Model& m) { return test::values(mechanics(m).Q, test::random_point(m, 4)); };
  const std::vector<Multi> a = Q(*couple), b = Q(*as_torque), c = Q(*torque);
  double other = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LE(test::distance(a[k], b[k]), kRounding) << "a couple of forces is a torque";
    other = std::max(other, test::distance(a[k], c[k]));
  }
  EXPECT_GT(other, 1e-3);
}

TEST(GeneralizedForces, ATensionPullsBothEndsTogether) {
  const PrecisionScope precision(40);
  const std::string two = "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"a\"\nmass = 1\nposition = "
                          "\"x*ex\"\n[[particle]]\nname = \"b\"\nmass = 1\nposition = \"y*ex + 3*ey\"\n";
  const auto pull = test::model_of(two + "[[force]]\nname = \"s\"\non = \"a\"\nfrom = \"b\"\ntension = 5\n");
  Graph& g = *pull->graph;
  test::Point p(1);
  p.set(g.jet(0, 0), Multi(0)).set(g.jet(1, 0), Multi(4));
  const std::vector<Multi> Q = test::values(mechanics(*pull).Q, p);
  EXPECT_LE(test::distance(Q[0], Multi(4)), kRounding) << "5 along (4, 3)/5";
  EXPECT_LE(test::distance(Q[1], Multi(-4)), kRounding);
}

// At jets off the motion, dh/dt differs from the power by q'.(E - G): tested on the rheonomic swarm with varying masses
// in a moving frame.
TEST(Power, IsTheRateOfTheEnergy) {
  const PrecisionScope precision(40);
  const auto model = test::model_of(kSwarm);
  const Mechanics m = mechanics(*model);
  const Power p = power(m);
  const Column miss =
      newton_left_side(m) - put_masses(*model, m.Q + m.QR + m.Qomega + m.minus_dVO + m.minus_dVomega + m.Gamma);
  Expr virtual_power = m.graph().zero();
  for (std::size_t a = 0; a < miss.size(); ++a) virtual_power += m.qd[a] * miss[a];
  const test::Point at = test::random_point(*model, 9);
  EXPECT_LE(test::distance(test::value(p.dh_dt, at), test::value(p.noncons + virtual_power, at)), kRounding);
  EXPECT_GT(test::distance(test::value(p.dh_dt, at), test::value(p.noncons, at)), 1e-3)
      << "off the motion both must differ";
}

}  // namespace
}  // namespace anholon::mechanics_test

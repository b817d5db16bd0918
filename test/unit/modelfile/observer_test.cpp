// One motion of the observer has one spin and one acceleration of the origin, in every accepted way of writing it.
#include <gtest/gtest.h>

#include "modelfile/mechanical/observer.h"
#include "support/model_point.h"
#include "support/models.h"

namespace anholon::observer_test {
namespace {

std::shared_ptr<const Model> with_observer(const std::string& observer) {
  return test::model_of("coordinates = [\"x\"]\n[parameters]\nw = 0.7\nA = \"2/3\"\n[observer]\n" + observer +
                        "[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n");
}

struct Motion {
  std::vector<Multi> spin, acceleration;
};

Motion at(const Model& model, const Multi& t) {
  test::Point p = test::random_point(model, 1);
  p.set(model.graph->time(), t);
  const auto three = [&](const Vector& v) { return test::values(std::vector<Expr>{v.x, v.y, v.z}, p); };
  return {three(model.observer.spin), three(model.observer.origin_acceleration)};
}

double gap(const Motion& a, const Motion& b) {
  double g = 0;
  for (std::size_t i = 0; i < 3; ++i)
    g = std::max({g, test::distance(a.spin[i], b.spin[i]), test::distance(a.acceleration[i], b.acceleration[i])});
  return g;
}

class ObserverTest : public testing::Test {
 protected:
  PrecisionScope precision{40};
  static constexpr double kRounding = 1e-37;
  void expect_one_motion(const std::vector<std::string>& ways, const std::string& mutant) {
    const Multi times[] = {Multi(0), Multi(0.4), Multi(-1.3), Multi(2)};
    const auto first = with_observer(ways[0]), wrong = with_observer(mutant);
    double wrong_by = 0;
    for (const Multi& t : times) {
      for (const std::string& way : ways) EXPECT_LE(gap(at(*with_observer(way), t), at(*first, t)), kRounding) << way;
      wrong_by = std::max(wrong_by, gap(at(*wrong, t), at(*first, t)));
    }
    EXPECT_GT(wrong_by, 1e-3) << "the mutant:\n" << mutant;
  }
};

// The frame turns about z by phi(t) = w t + sin t, with the origin at (A cos 2t, t^2, 0) in inertial components.
TEST_F(ObserverTest, InThePlane) {
  const std::string spin = "spin = \"(w + cos(t))*ez\"\n", rotation = "rotation = \"rotz(w*t + sin(t))\"\n";
  const std::string c = "cos(w*t + sin(t))", s = "sin(w*t + sin(t))";
  const std::string vx = "(-2*A*sin(2*t))", vy = "(2*t)", ax = "(-4*A*cos(2*t))", ay = "2";
  const auto turned_back = [&](const std::string& x, const std::string& y) {
    return "[\"" + x + "*" + c + " + " + y + "*" + s + "\", \"-" + x + "*" + s + " + " + y + "*" + c + "\", \"0\"]\n";
  };
  const std::string moving_velocity = "origin_velocity = " + turned_back(vx, vy);
  expect_one_motion({rotation + "origin_position_inertial = [\"A*cos(2*t)\", \"t^2\", \"0\"]\n",
                     spin + "origin_position_inertial = [\"A*cos(2*t)\", \"t^2\", \"0\"]\n",
                     rotation + "origin_velocity_inertial = [\"" + vx + "\", \"" + vy + "\", \"0\"]\n",
                     spin + "origin_velocity_inertial = [\"" + vx + "\", \"" + vy + "\", \"0\"]\n",
                     rotation + moving_velocity, spin + moving_velocity,
                     spin + "origin_acceleration = " + turned_back(ax, ay),
                     rotation + "origin_acceleration = " + turned_back(ax, ay)},
                    // The mutant: omega x v is added although the velocity is given in inertial components (theory:
                    // forces).
                    spin + "origin_velocity = [\"" + vx + "\", \"" + vy + "\", \"0\"]\n");
}

// A = rotz(t^2) rotx(sin t): spin in moving components = (cos t, 2t sin(sin t), 2t cos(sin t)).
TEST_F(ObserverTest, TumblingInSpace) {
  const std::string rotation = "rotation = \"rotz(t^2)*rotx(sin(t))\"\n";
  const std::string spin = "spin = [\"cos(t)\", \"2*t*sin(sin(t))\", \"2*t*cos(sin(t))\"]\n";
  const std::string place = "origin_position_inertial = [\"t^3\", \"sin(t)\", \"A*t\"]\n";
  const std::string velocity = "origin_velocity_inertial = [\"3*t^2\", \"cos(t)\", \"A\"]\n";
  // A^T r'' with r'' = (6t, -sin t, 0), written out row by row.
  const std::string acceleration =
      "origin_acceleration = [\"6*t*cos(t^2) - sin(t)*sin(t^2)\", \"(-6*t*sin(t^2) - sin(t)*cos(t^2))*cos(sin(t))\", "
      "\"(6*t*sin(t^2) + sin(t)*cos(t^2))*sin(sin(t))\"]\n";
  expect_one_motion({rotation + place, rotation + velocity, rotation + acceleration, spin + acceleration},
                    // The spin in inertial components, (2t about z, cos t about the turned x), is another vector.
                    "spin = [\"cos(t)*cos(t^2)\", \"cos(t)*sin(t^2)\", \"2*t\"]\n" + acceleration);
}

TEST_F(ObserverTest, WithoutASectionItIsInertial) {
  const auto model =
      test::model_of("coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n");
  EXPECT_TRUE(model->observer.inertial);
  EXPECT_TRUE(is_zero(model->observer.spin));
  EXPECT_FALSE(with_observer("spin = \"w*ez\"\n")->observer.inertial);
}

TEST_F(ObserverTest, ContradictionsAreRefused) {
  for (const char* section : {"spin = \"ez\"\nrotation = \"rotz(t)\"\n", "spin = \"x*ez\"\n",
                              "origin_velocity = \"t*ex\"\norigin_acceleration = \"ex\"\n",
                              "spin = \"cos(t^2)*ez\"\norigin_velocity_inertial = \"ex\"\n"})
    EXPECT_THROW(with_observer(section), std::runtime_error) << section;
}

TEST(Antiderivative, HasTheIntegrandAsDerivative) {
  const PrecisionScope precision(40);
  Graph g;
  const Expr t = g.time(), w = g.parameter(0);
  for (Expr e : {w, t * t, sin(w * t + g.one()), 3 * cos(2 * t) - w * exp(-t), sinh(t) + cosh(w * t), pow(t, {1, 2}),
                 pow(t, -2)}) {
    const auto f = antiderivative(e);
    ASSERT_TRUE(f);
    test::Point p(1);
    p.set(t, Multi(0.6));
    EXPECT_LE(test::distance(test::value(total_derivative(*f), p), test::value(e, p)), 1e-37);
  }
  EXPECT_FALSE(antiderivative(cos(t * t)));
  EXPECT_FALSE(antiderivative(t * sin(t)));
}

}  // namespace
}  // namespace anholon::observer_test

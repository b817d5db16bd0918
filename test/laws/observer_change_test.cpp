// Two observers describe the same motion: luo-zhao-example-2 in the frame of the plane and in an inertial frame.
#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::observer_change_test {
namespace {

// Both are integrated with the tolerance 1e-15; two hundred round-offs of coordinates of size one remain.
constexpr double kSameMotion = 5e-14;

using Rows = std::vector<std::vector<long double>>;

Rows motion(const std::string& text) {
  Scenario s;
  const Outcome o = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  if (!o.ok()) throw std::runtime_error(o.message);
  SimulationOptions options;
  for (int k = 0; k <= 8; ++k) options.at.push_back(Rational(k, 4));
  options.tolerance = Rational(1e-17);
  options.precision = Precision::long_real;
  test::TextRows sink;
  EXPECT_TRUE(simulate(s, options, sink).outcome.ok());
  Rows rows;
  for (const auto& row : sink.rows()) {
    rows.emplace_back();
    for (const std::string& v : row) rows.back().push_back(std::strtold(v.c_str(), nullptr));
  }
  return rows;
}

// Largest difference of X, Y, TH after the change of frame: turn = w0 t + w1 (1 - cos t), origin A1 (1 - cos t), A2/2
// (t - sin 2t/2).
double gap(const Rows& plane, const Rows& inertial) {
  long double worst = 0;
  for (std::size_t k = 0; k < plane.size(); ++k) {
    const long double t = plane[k][0], x = plane[k][1], y = plane[k][2], th = plane[k][3];
    const long double turn = 0.3L * t + 0.2L * (1 - std::cos(t)), c = std::cos(turn), s = std::sin(turn);
    const long double X = 0.5L * (1 - std::cos(t)) + c * x - s * y,
                      Y = -0.2L * (t - std::sin(2 * t) / 2) + s * x + c * y;
    worst = std::max(
        {worst, std::abs(X - inertial[k][1]), std::abs(Y - inertial[k][2]), std::abs(th + turn - inertial[k][3])});
  }
  return static_cast<double>(worst);
}

class ObserverChange : public testing::Test {
 protected:
  std::string plane = test::shipped_text("papers/luo-zhao-example-2-plane-frame");
  Rows inertial = motion(test::shipped_text("papers/luo-zhao-example-2-inertial-frame"));
};

TEST_F(ObserverChange, LeavesTheMotion) { EXPECT_LE(gap(motion(plane), inertial), kSameMotion); }

TEST_F(ObserverChange, RefutesAVelocityTakenAsMovingComponents) {
  EXPECT_GT(gap(motion(test::replaced(plane, "origin_velocity_inertial", "origin_velocity")), inertial), 1e-4);
}

TEST_F(ObserverChange, RefutesAnotherTurn) {
  EXPECT_GT(gap(motion(test::replaced(plane, "rotz(w0*t + w1*(1 - cos(t)))", "rotz(w0*t)")), inertial), 1e-4);
}

}  // namespace
}  // namespace anholon::observer_change_test

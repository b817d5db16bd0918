#include <vector>

#include <gtest/gtest.h>

#include "integrate/step_control.h"

namespace anholon::step_control_test {
namespace {

// The series of 1/(1 - x/radius)^power, of radius `radius`.
template <class N>
std::vector<N> pole(N radius, int power, int count) {
  std::vector<N> c = {N(1)};
  for (int k = 1; k < count; ++k) c.push_back(c.back() * N(power + k - 1) / (N(k) * radius));
  return c;
}

template <class N>
double step(const std::vector<N>& c, int d, int order, double shrink = 0) {
  const std::vector<UnknownSeries<N>> x = {{c.data(), d}};
  const std::vector<std::vector<std::uint32_t>> one_scale = {{0}};
  return to_double(step_size<N>(x, one_scale, order, shrink));
}

TEST(StepControl, OrderFollowsFromTheTolerance) {
  EXPECT_EQ(taylor_order(std::log(1e-15)), 19);  // ceil(15 ln(10)/2 + 1) = ceil(18.27)
  EXPECT_EQ(taylor_order(std::log(1e-12)), 19);  // ceil(12 ln(10)/2 + 1) = ceil(14.8), and four
  EXPECT_EQ(taylor_order(std::log(1e-14)), 22);
  EXPECT_GT(taylor_order(-400 * std::log(10.0)), 450);
  EXPECT_GE(taylor_order(std::log(0.5)), 8);
  EXPECT_EQ(least_work_order(std::log(0.5)), 4);
}

// At the order of Jorba & Zou a step is rho / e^2, at twice this order rho / e: the error is the same.
TEST(StepControl, ShrinksByTheSquareOfEAtTheOrderOfLeastWork) {
  const double tolerance = std::log(1e-15);
  EXPECT_EQ(step_shrink(tolerance, least_work_order(tolerance)), 2);
  EXPECT_EQ(step_shrink(tolerance, 2 * least_work_order(tolerance)), 1);
}

// A simple pole at rho: |x_k| = rho^-k, so that the formula gives rho exp(-shrink - 0.7/(p-1)).
TEST(StepControl, AStepIsAPartOfTheRadiusOfConvergence) {
  const int order = 20;
  for (const double radius : {0.01, 1.0, 50.0})
    for (const double shrink : {0.0, 2.0}) {
      const double expected = radius * std::exp(-shrink - 0.7 / (order - 1));
      EXPECT_NEAR(step(pole(radius, 1, order + 2), 1, order, shrink) / expected, 1, 1e-12);
    }
  const long double quarter = 0.25L;
  EXPECT_NEAR(step(pole(quarter, 1, order + 2), 1, order), 0.25 * std::exp(-0.7 / (order - 1)), 1e-12);
}

// The coefficient of the velocity is `order` times as large, so its step is shorter by the factor order^(-1/(order -
// 1)).
TEST(StepControl, VelocitiesAreMeasuredToo) {
  const int order = 20;
  const auto c = pole(1.0, 1, order + 3);
  const double expected = std::exp(-std::log(order) / (order - 1) - 0.7 / (order - 1));
  EXPECT_NEAR(step(c, 2, order) / expected, 1, 1e-12);
}

// The error is relative to the size of x or 1, whichever is larger; each level of derivatives has its own size.
TEST(StepControl, IsRelativeToTheSize) {
  const int order = 20;
  auto small = pole(1.0, 1, order + 2), large = small;
  for (double& x : small) x *= 1e-6;
  for (double& x : large) x *= 1e6;
  const double one = step(pole(1.0, 1, order + 2), 1, order);
  EXPECT_NEAR(step(large, 1, order) / one, 1, 1e-12);
  EXPECT_NEAR(step(small, 1, order) / one, std::pow(1e6, 1.0 / order), 1e-9);
  // The size of an angle that has turned often does not loosen the tolerance of its velocity.
  auto turned = pole(1.0, 1, order + 3);
  const double before = step(turned, 2, order);
  turned[0] = 1e4;
  EXPECT_EQ(step(turned, 2, order), before);
}

// Errors of a multiplier do not add up, so its series only keeps a step within half of its radius of convergence.
TEST(StepControl, StaysAwayFromPolesOfMultipliers) {
  const int order = 20;
  const auto smooth = pole(1e3, 1, order + 2);
  const auto multiplier = pole(0.5, 1, order);
  const std::vector<UnknownSeries<double>> x = {{smooth.data(), 1}, {multiplier.data(), 0}};
  const std::vector<std::vector<std::uint32_t>> scales = {{0}};
  EXPECT_NEAR(step_size<double>(x, scales, order, 2), 0.5 * std::exp(-0.7), 1e-12);
}

// An orbit in metres does not lengthen the steps that an angle allows, unless both have one common size.
TEST(StepControl, DimensionsAreMeasuredApart) {
  const int order = 20;
  auto orbit = pole(1e3, 1, order + 1), angle = pole(1.0, 1, order + 1);
  orbit[0] = 7e6;
  const std::vector<UnknownSeries<double>> x = {{orbit.data(), 1}, {angle.data(), 1}};
  const std::vector<std::vector<std::uint32_t>> apart = {{0}, {1}}, together = {{0, 1}};
  EXPECT_EQ(step_size<double>(x, apart, order, 2), step(angle, 1, order, 2));
  EXPECT_GT(step_size<double>(x, together, order, 2), 2 * step(angle, 1, order, 2));
}

TEST(StepControl, AMotionWithoutHigherTermsHasNoBound) {
  const std::vector<double> line = {1, 2, 0, 0, 0, 0, 0, 0};
  EXPECT_GT(step(line, 2, 6), 1e100);
}

// The integral of exp(20 x): the last two terms must be below the tolerance, relative to the largest of the first three
// over the horizon, which is the third.
TEST(StepControl, IntegralsShortenAStep) {
  const int order = 12;
  std::vector<double> c = {1};
  for (int k = 1; k < order; ++k) c.push_back(c.back() * 20 / k);
  const auto coefficient = [&](int k) { return c[static_cast<std::size_t>(k)]; };
  const double size = c[2] / 3;
  for (const double tolerance : {1e-6, 1e-9, 1e-12}) {
    const double h = limited_by_quadrature(1.0, order, std::log(tolerance), 0, coefficient);
    EXPECT_LT(h, 1);
    EXPECT_LE(c.back() * std::pow(h, order) / order, tolerance * size * (1 + 1e-9));
    EXPECT_GT(c.back() * std::pow(2 * h, order) / order, tolerance * size) << "nor is it much too short";
  }
  EXPECT_EQ(limited_by_quadrature(0.01, order, std::log(1e-6), 0, coefficient), 0.01);
  // The error is relative to the integral so far.
  EXPECT_GT(limited_by_quadrature(1.0, order, std::log(1e-9), 1e6, coefficient),
            limited_by_quadrature(1.0, order, std::log(1e-9), 0, coefficient));
}

}  // namespace
}  // namespace anholon::step_control_test

// Models of the zoo against numbers from elsewhere: closed solutions, and equations reduced by hand and integrated here.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <complex>
#include <functional>

#include "run/simulate.h"
#include "support/models.h"

namespace anholon {
namespace {

constexpr double kAgreement = 1e-9;  // of motions at tolerance 1e-13 and of 20 000 steps of Runge and Kutta

std::map<std::string, double> end_of(const std::string& text, int to) {
  Scenario s;
  const Outcome ready = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  if (!ready.ok()) throw std::runtime_error(ready.message);
  SimulationOptions o;
  o.tolerance = Rational(1, mpz_class("10000000000000"));
  o.at = {Rational(to)};
  MemorySink rows;
  const SimulationReport r = simulate(s, o, rows);
  if (!r.outcome.ok()) throw std::runtime_error(r.outcome.message);
  std::map<std::string, double> end;
  for (std::size_t k = 0; k < rows.names().size(); ++k) end[rows.names()[k]] = std::stod(rows.rows().back()[k]);
  return end;
}

template <std::size_t N>
using Rate = std::function<std::array<double, N>(double, const std::array<double, N>&)>;

template <std::size_t N>
std::array<double, N> runge_kutta(const Rate<N>& f, std::array<double, N> x, double to) {
  constexpr int steps = 20'000;
  const double h = to / steps;
  const auto ahead = [](const std::array<double, N>& a, double c, const std::array<double, N>& b) {
    std::array<double, N> out = a;
    for (std::size_t i = 0; i < N; ++i) out[i] += c * b[i];
    return out;
  };
  for (int k = 0; k < steps; ++k) {
    const double t = k * h;
    const auto a = f(t, x), b = f(t + h / 2, ahead(x, h / 2, a)), c = f(t + h / 2, ahead(x, h / 2, b)), d = f(t + h, ahead(x, h, c));
    for (std::size_t i = 0; i < N; ++i) x[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  return x;
}

// zeta = u + i v: zeta'' = i 2/7 W zeta' - i 5/7 g sin(tilt).
TEST(Zoo, TheBallOnATiltedTurntableDriftsAcrossTheSlope) {
  using C = std::complex<double>;
  const double pi = std::acos(-1.0), W = 2 * pi, turn = 2 * W / 7, drift = 2.5 * 9.81 * std::sin(pi / 36) / W;
  const auto at = [&](double level) {
    const C start(0.1, -0.05), v(0.2, 0.1);
    return start + level * 3.0 + (v - level) * (std::exp(C(0, turn * 3)) - 1.0) / C(0, turn);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/ball-on-tilted-turntable"), 3);
  EXPECT_LT(std::abs(C(end.at("u"), end.at("v")) - at(drift)), kAgreement);
  EXPECT_GT(std::abs(C(end.at("u"), end.at("v")) - at(0.99 * drift)), 1e-4) << "mutant: another drift";
  double norm = 0;
  for (const char* e : {"e0", "e1", "e2", "e3"}) norm += end.at(e) * end.at(e);
  EXPECT_NEAR(norm, 1, 1e-14);
}

// The wheels leave one velocity V along the seat: th' = (V sin ph - d2 ph')/(d1 cos ph + d2), and Kane's equation of V is
// m V' + (J1 th'' + J2 (th'' + ph'')) sin ph/(d1 cos ph + d2) = 0.
TEST(Zoo, TheRollerRacerFollowsItsReducedEquation) {
  const double pi = std::acos(-1.0);
  const auto reduced = [&](double d2) {
    return runge_kutta<4>([=](double t, const std::array<double, 4>& x) {
      const double m = 60, J1 = 4, J2 = 0.3, d1 = 0.4, A = 40 * pi / 180, w = 4;
      const double V = x[0], th = x[1], ph = A * std::sin(w * t), ph1 = A * w * std::cos(w * t), ph2 = -w * w * ph;
      const double D = d1 * std::cos(ph) + d2, D1 = -d1 * std::sin(ph) * ph1, th1 = (V * std::sin(ph) - d2 * ph1) / D, p = std::sin(ph) / D;
      // th'' = p V' + rest
      const double rest = (V * std::cos(ph) * ph1 - d2 * ph2 - th1 * D1) / D;
      const double V1 = -((J1 + J2) * rest + J2 * ph2) * p / (m + (J1 + J2) * p * p);
      return std::array<double, 4>{V1, th1, V * std::cos(th), V * std::sin(th)};
    }, {0.5, 0, 0, 0}, 6);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/roller-racer"), 6);
  const auto miss = [&](const std::array<double, 4>& x) { return std::abs(end.at("th") - x[1]) + std::abs(end.at("x") - x[2]) + std::abs(end.at("y") - x[3]); };
  EXPECT_LT(miss(reduced(0.15)), kAgreement);
  EXPECT_GT(miss(reduced(0.151)), 1e-4) << "mutant: a longer handlebar";
}

// Straight ahead: Lagrange's equations of the cart and the pendulum, the wheels as mass on the cart.
TEST(Zoo, TheTwoWheeledPendulumIsAPendulumOnACart) {
  const double pi = std::acos(-1.0);
  const auto reduced = [&](double wheel) {
    return runge_kutta<4>([=](double, const std::array<double, 4>& s) {
      const double M = 30, mw = 2, R = 0.2, b = 0.25, h = 0.5, g = 9.81, al = s[1], v = s[2], w = s[3], torque = 400 * al + 60 * w;
      const double I = M / 12 * (b * b + 4 * h * h), a11 = M + 2 * mw + 2 * wheel * mw, a12 = M * h * std::cos(al), a22 = I + M * h * h;
      const double f1 = M * h * std::sin(al) * w * w + 2 * torque / R, f2 = M * g * h * std::sin(al) - 2 * torque, det = a11 * a22 - a12 * a12;
      return std::array<double, 4>{v, w, (f1 * a22 - f2 * a12) / det, (f2 * a11 - f1 * a12) / det};
    }, {0, 10 * pi / 180, 0, 0}, 3);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/two-wheeled-pendulum"), 3);
  const auto miss = [&](const std::array<double, 4>& x) { return std::abs(end.at("x") - x[0]) + std::abs(end.at("al") - x[1]); };
  EXPECT_LT(miss(reduced(0.5)), kAgreement);
  EXPECT_GT(miss(reduced(0.55)), 1e-4) << "mutant: heavier rims";
  EXPECT_LT(std::abs(end.at("al")), 0.1 * pi / 18) << "and its motors hold it";
  EXPECT_NEAR(end.at("psi"), 0, 1e-14);
}

}  // namespace
}  // namespace anholon

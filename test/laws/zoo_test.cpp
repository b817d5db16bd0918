// Models of the zoo are compared with closed solutions, and with equations that are reduced by hand and integrated
// here.
#include <array>
#include <cmath>
#include <complex>
#include <functional>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::zoo_test {
namespace {

constexpr double kAgreement = 1e-9;  // motions at tolerance 1e-13 against 20 000 Runge-Kutta steps

std::map<std::string, double> end_of(const std::string& text, int to) {
  Scenario s;
  const Outcome ready = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  if (!ready.ok()) throw std::runtime_error(ready.message);
  SimulationOptions o;
  o.tolerance = Rational(1, mpz_class("10000000000000"));
  o.at = {Rational(to)};
  test::TextRows rows;
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
    const auto a = f(t, x), b = f(t + h / 2, ahead(x, h / 2, a)), c = f(t + h / 2, ahead(x, h / 2, b)),
               d = f(t + h, ahead(x, h, c));
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

// The wheels leave one velocity V along the seat: th' = (V sin ph - d2 ph')/(d1 cos ph + d2), and Kane's equation of V
// is m V' + (J1 th'' + J2 (th'' + ph'')) sin ph/(d1 cos ph + d2) = 0.
TEST(Zoo, TheRollerRacerFollowsItsReducedEquation) {
  const double pi = std::acos(-1.0);
  const auto reduced = [&](double d2) {
    return runge_kutta<4>(
        [=](double t, const std::array<double, 4>& x) {
          const double m = 60, J1 = 4, J2 = 0.3, d1 = 0.4, A = 40 * pi / 180, w = 4;
          const double V = x[0], th = x[1], ph = A * std::sin(w * t), ph1 = A * w * std::cos(w * t), ph2 = -w * w * ph;
          const double D = d1 * std::cos(ph) + d2, D1 = -d1 * std::sin(ph) * ph1,
                       th1 = (V * std::sin(ph) - d2 * ph1) / D, p = std::sin(ph) / D;
          // th'' = p V' + rest
          const double rest = (V * std::cos(ph) * ph1 - d2 * ph2 - th1 * D1) / D;
          const double V1 = -((J1 + J2) * rest + J2 * ph2) * p / (m + (J1 + J2) * p * p);
          return std::array<double, 4>{V1, th1, V * std::cos(th), V * std::sin(th)};
        },
        {0.5, 0, 0, 0}, 6);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/roller-racer"), 6);
  const auto miss = [&](const std::array<double, 4>& x) {
    return std::abs(end.at("th") - x[1]) + std::abs(end.at("x") - x[2]) + std::abs(end.at("y") - x[3]);
  };
  EXPECT_LT(miss(reduced(0.15)), kAgreement);
  EXPECT_GT(miss(reduced(0.151)), 1e-4) << "mutant: a longer handlebar";
}

// Straight ahead: Lagrange's equations of the cart and the pendulum, where the wheels add mass to the cart.
TEST(Zoo, TheTwoWheeledPendulumIsAPendulumOnACart) {
  const double pi = std::acos(-1.0);
  const auto reduced = [&](double wheel) {
    return runge_kutta<4>(
        [=](double, const std::array<double, 4>& s) {
          const double M = 30, mw = 2, R = 0.2, b = 0.25, h = 0.5, g = 9.81, al = s[1], v = s[2], w = s[3],
                       torque = 400 * al + 60 * w;
          const double I = M / 12 * (b * b + 4 * h * h), a11 = M + 2 * mw + 2 * wheel * mw, a12 = M * h * std::cos(al),
                       a22 = I + M * h * h;
          const double f1 = M * h * std::sin(al) * w * w + 2 * torque / R, f2 = M * g * h * std::sin(al) - 2 * torque,
                       det = a11 * a22 - a12 * a12;
          return std::array<double, 4>{v, w, (f1 * a22 - f2 * a12) / det, (f2 * a11 - f1 * a12) / det};
        },
        {0, 10 * pi / 180, 0, 0}, 3);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/two-wheeled-pendulum"), 3);
  const auto miss = [&](const std::array<double, 4>& x) {
    return std::abs(end.at("x") - x[0]) + std::abs(end.at("al") - x[1]);
  };
  EXPECT_LT(miss(reduced(0.5)), kAgreement);
  EXPECT_GT(miss(reduced(0.55)), 1e-4) << "mutant: heavier rims";
  EXPECT_LT(std::abs(end.at("al")), 0.1 * pi / 18) << "and its motors hold it";
  EXPECT_NEAR(end.at("psi"), 0, 1e-14);
}

// Kane's equations of the speeds V along the blade and om. The accelerations of a point (p, q(t)) of the sleigh are V'
// - om' q - 2 om q' - om^2 p along the blade and om' p + q'' + om V - om^2 q across it.
TEST(Zoo, TheSleighWithAMovingMassFollowsItsReducedEquations) {
  const auto reduced = [&](double d) {
    return runge_kutta<5>(
        [=](double t, const std::array<double, 5>& x) {
          const double M = 5, J = 0.4, a = 0.2, m = 1, b = 0.3, w = 3, V = x[0], om = x[1];
          const double q = b * std::sin(w * t), q1 = b * w * std::cos(w * t), q2 = -w * w * q;
          const double along = 2 * om * q1 + om * om * d, across = q2 + om * V - om * om * q;
          const double a11 = M + m, a12 = -m * q, a22 = J + M * a * a + m * (q * q + d * d);
          const double f1 = M * a * om * om + m * along, f2 = -M * a * om * V - m * (q * along + d * across),
                       det = a11 * a22 - a12 * a12;
          return std::array<double, 5>{(f1 * a22 - f2 * a12) / det, (f2 * a11 - f1 * a12) / det, om, V * std::cos(x[2]),
                                       V * std::sin(x[2])};
        },
        {1, 0.1, 0, 0, 0}, 10);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/sleigh-with-moving-mass"), 10);
  const auto miss = [&](const std::array<double, 5>& x) {
    return std::abs(end.at("th") - x[2]) + std::abs(end.at("x") - x[3]) + std::abs(end.at("y") - x[4]);
  };
  EXPECT_LT(miss(reduced(0.4)), kAgreement);
  EXPECT_GT(miss(reduced(0.401)), 1e-4) << "mutant: the weight a little ahead";
}

// Straight ahead the robot is a rolling hoop of mass 5/3 M with a pendulum: angles phi of the shell, th of the arm.
TEST(Zoo, TheSphericalRobotGoesStraightAsAHoopWithAPendulum) {
  const auto reduced = [&](double shell) {
    return runge_kutta<4>(
        [=](double t, const std::array<double, 4>& s) {
          const double M = 3, R = 0.2, m = 4, l = 0.12, g = 9.81, torque = 1.5 * std::sin(2 * t), th = s[1], w = s[3];
          const double a11 = ((1 + shell) * M + m) * R * R, a12 = -m * R * l * std::cos(th), a22 = m * l * l;
          const double f1 = torque - m * R * l * std::sin(th) * w * w, f2 = -torque - m * g * l * std::sin(th),
                       det = a11 * a22 - a12 * a12;
          return std::array<double, 4>{s[2], w, (f1 * a22 - f2 * a12) / det, (f2 * a11 - f1 * a12) / det};
        },
        {0, 0, 2, 0}, 2);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/spherical-robot"), 2);
  const auto miss = [&](const std::array<double, 4>& x) {
    return std::abs(end.at("x") - 0.2 * x[0]) + std::abs(end.at("al") - (x[1] - x[0]));
  };
  EXPECT_LT(miss(reduced(2.0 / 3)), kAgreement);
  EXPECT_GT(miss(reduced(0.4)), 1e-4) << "mutant: a solid ball";
  EXPECT_NEAR(end.at("y"), 0, 1e-12);
  EXPECT_NEAR(end.at("be"), 0, 1e-12);
}

// Seen from rest the ball goes round in a circle with 2/7 W, at its initial speed: zeta = x + i y, zeta'' = i 2/7 W
// zeta'.
TEST(Zoo, TheBallOnATurntableGoesRoundInACircle) {
  using C = std::complex<double>;
  // Rolling gives v = W ez x r + R om x ez, with om from the Euler rates at ps = 0.
  const double th1 = 0.5, ph1 = -2, th = 1.2, R = 0.25;
  const C start(0.5, -0.2), om(th1, -ph1 * std::sin(th)), v = C(0, 3) * start - C(0, R) * om;
  const auto at = [&](double turn) { return start + v * (std::exp(C(0, turn * 2)) - 1.0) / C(0, turn); };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/ball-on-turntable"), 2);
  const C there(end.at("x"), end.at("y"));
  EXPECT_LT(std::abs(there - at(2.0 / 7 * 3)), kAgreement);
  EXPECT_GT(std::abs(there - at(2.0 / 5 * 3)), 0.1) << "mutant: a hollow ball";
  // Seen from the table, the ball has the place to which the table has turned it.
  const std::map<std::string, double> seen = end_of(test::shipped_text("zoo/ball-on-turntable-rotating"), 2);
  EXPECT_LT(std::abs(C(seen.at("x"), seen.at("y")) * std::exp(C(0, 6)) - there), kAgreement);
}

struct Orbit {
  double mu = 3.986004418e14, R = 6778e3, n = std::sqrt(mu / (R * R * R));
  // Right side of the law across a tether of length l: l angle'' + 2 l' (angle' + n) = across(l, angle).
  double across(double l, double angle) const {
    const double r2 = R * R + 2 * R * l * std::cos(angle) + l * l;
    return R * std::sin(angle) * (mu / (r2 * std::sqrt(r2)) - n * n);
  }
};

TEST(Zoo, TheTetherTurnsByItsEquationAndHangsStill) {
  const Orbit o;
  const auto reduced = [&](double c) {
    return runge_kutta<2>(
        [=](double t, const std::array<double, 2>& x) {
          const double l = 50 * std::exp(c * t);
          return std::array<double, 2>{x[1], (o.across(l, x[0]) - 2 * c * l * (x[1] + o.n)) / l};
        },
        {-std::asin(4 * 3e-4 / (3 * o.n)) / 2, 0}, 9000);
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/tether"), 9000);
  EXPECT_NEAR(end.at("l"), 50 * std::exp(2.7), 1e-9);
  EXPECT_NEAR(end.at("angle"), reduced(3e-4)[0], kAgreement);
  EXPECT_GT(std::abs(end.at("angle") - reduced(3.001e-4)[0]), 1e-6) << "mutant: a faster reel";
  EXPECT_NEAR(end.at("angle"), -std::asin(4 * 3e-4 / (3 * o.n)) / 2, 2 * end.at("l") / o.R)
      << "the angle at which a short one hangs";
}

// The angle is held: the law across the tether gives its growth, the law along it the force of the reel.
TEST(Zoo, TheTetherKeptAtAnAngleGrowsAsItsServoWants) {
  const Orbit o;
  const double angle = -10 * std::acos(-1.0) / 180;
  const auto grown = [&](double at) {
    return runge_kutta<1>(
        [=](double, const std::array<double, 1>& x) { return std::array<double, 1>{o.across(x[0], at) / (2 * o.n)}; },
        {50}, 9000)[0];
  };
  const std::map<std::string, double> end = end_of(test::shipped_text("zoo/tether-by-servo"), 9000);
  const double l = end.at("l");
  EXPECT_NEAR(l, grown(angle), 1e-9 * l);
  EXPECT_GT(std::abs(l - grown(1.001 * angle)), 1e-4 * l) << "mutant: another angle";
  EXPECT_NEAR(std::log(l / 50), -0.75 * o.n * std::sin(2 * angle) * 9000, 4 * l / o.R)
      << "exponentially, as long as it is short";
  EXPECT_NEAR(end.at("angle"), angle, 1e-12);
  const double r2 = o.R * o.R + 2 * o.R * l * std::cos(angle) + l * l;
  const double along = -o.mu / (r2 * std::sqrt(r2)) * (l + o.R * std::cos(angle)) +
                       o.n * o.n * (l + o.R * std::cos(angle)) - end.at("l''");
  EXPECT_NEAR(end.at("pull"), 100 * along, 1e-9);
  EXPECT_NEAR(end.at("tension"), end.at("pull"), 1e-12);
}

}  // namespace
}  // namespace anholon::zoo_test

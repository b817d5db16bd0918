// The launcher of the zoo: budgets of mass, momentum and energy over the whole flight, taken in axes at rest while the
// motion is computed in turning axes; the times of its events at any tolerance; and the same flight, integrated here
// from Newton's law in axes at rest.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::launcher_test {
namespace {

struct Flight {
  std::map<std::string, double> end;
  std::vector<std::pair<std::string, double>> events;
};

Flight flight(const std::string& text, const char* tolerance = "1e-13") {
  Scenario s;
  const Outcome ready = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  if (!ready.ok()) throw std::runtime_error(ready.message);
  SimulationOptions o;
  o.tolerance = *parse_rational(tolerance);
  o.at = {Rational(600)};
  test::TextRows rows;
  const SimulationReport r = simulate(s, o, rows);
  if (!r.outcome.ok()) throw std::runtime_error(r.outcome.message);
  Flight f;
  for (std::size_t k = 0; k < rows.names().size(); ++k) f.end[rows.names()[k]] = std::stod(rows.rows().back()[k]);
  for (const EventReport& e : r.events) f.events.emplace_back(e.name, e.t.value);
  return f;
}

std::string launcher() { return test::shipped_text("zoo/launcher"); }

// Adds states that integrate flows and forces, and monitors of the differences from the budgets. Each state is scaled
// to the size of the positions, for which the tolerance is meant. Dropped parts take their momentum and energy with
// them.
std::string with_budgets(std::string text) {
  text = test::replaced(text, "state.fuel = {rate = \"-flow\", initial = \"mp1\"}", R"toml(
[state]
fuel = {rate = "-flow", initial = "mp1"}
burnt = {rate = "flow", initial = 0}
mx = {rate = "dot(push, rest.x)/kp", initial = "(ms1 + ms2 + mp1 + mp2)*lift/kp"}
my = {rate = "dot(push, rest.y)/kp", initial = "(ms1 + ms2 + mp1 + mp2)*wE*RE/kp"}
work = {rate = "(dot(w, drag - flow*u) - flow*specific)/ke", initial = "(ms1 + ms2 + mp1 + mp2)*((lift^2 + wE^2*RE^2)/2 - mu/RE)/ke"}
[frame]
pad = "rotz(atan2(y, x))"
rest = "rotz(-wE*t)")toml");
  text = test::replaced(text, "frame.pad = \"rotz(atan2(y, x))\"    # on the equator: pad.x up, pad.y east\n", "");
  text = test::replaced(text, "mode.stage = 1                     # 1 and 2 burn, 3 coasts\n", "");
  text = test::replaced(text, "[parameters]\n", R"toml([mode]
stage = 1
[parameters]
kp = 100
ke = 1e7
lift = "1 m/s"
)toml");
  text = test::replaced(text, "[define]\n", R"toml([define]
w = "vel(P, inertial)"
u = "-ue*(cos(pitch(t))*pad.x + sin(pitch(t))*pad.y)"
drag = "-q*Cd(norm(v)/sound(h))*A*unit(v)"
push = "drag + mass*gravity(P) - flow*(w + u)"
specific = "norm2(w)/2 - mu/norm(P)"
dropped = "choose(stage, ms1, 0, 0)"
)toml");
  text = test::replaced(
      text, "mp2, 0)\"}}",
      R"toml(mp2, 0)", mx = "mx - dropped*dot(w, rest.x)/kp", my = "my - dropped*dot(w, rest.y)/kp", work = "work - dropped*specific/ke"}})toml");
  return test::replaced(text, "[output]\n", R"toml([monitor]
mass_given_out = "(mass + burnt + choose(stage, 0, ms1, ms1) - ms1 - ms2 - mp1 - mp2)/mp1"
momentum_x = "(mass*dot(w, rest.x)/kp - mx)/1e6"
momentum_y = "(mass*dot(w, rest.y)/kp - my)/1e6"
energy = "(mass*specific/ke - work)/3e6"
[output]
)toml");
}

TEST(Launcher, ItsBudgetsClose) {
  const std::string text = with_budgets(launcher());
  constexpr double kClosed = 1e-12;  // of the momentum of the first stage, of the energy on the pad
  const Flight f = flight(text);
  for (const char* each : {"mass_given_out", "momentum_x", "momentum_y", "energy"})
    EXPECT_LT(std::abs(f.end.at(each)), kClosed) << each;
  // Mutants: the axes turn in the other sense; the thrust does not belong to the flow.
  const Flight turned = flight(test::replaced(text, "observer.spin = \"wE*ez\"", "observer.spin = \"-wE*ez\""));
  EXPECT_GT(std::abs(turned.end.at("momentum_x")), 1e-3);
  const Flight pushed = flight(test::replaced(text, "expelled_velocity = \"-ue", "expelled_velocity = \"-1.000001*ue"));
  EXPECT_GT(std::abs(pushed.end.at("energy")), 1e-8);
}

TEST(Launcher, ItsEventsHaveTheirTimesAtAnyTolerance) {
  constexpr double kSame = 1e-10;  // s
  for (const char* tolerance : {"1e-9", "1e-10", "1e-11", "1e-12", "1e-13", "1e-14"}) {
    const Flight f = flight(launcher(), tolerance);
    ASSERT_EQ(f.events.size(), 3U) << tolerance << ": a maximum of what is next to nothing, far up?";
    EXPECT_EQ(f.events[0].first, "max_q");
    EXPECT_NEAR(f.events[0].second, 73.694868873650995488, kSame) << tolerance;  // in 33 digits, tolerance 1e-32
    EXPECT_NEAR(f.events[1].second, 400.0 / 2.5, kSame) << tolerance;
    EXPECT_NEAR(f.events[2].second, 400.0 / 2.5 + 90 / 0.27, kSame) << tolerance;
  }
}

// ---- Newton's law at rest -----------------------------------------------------------------------

using Row = std::array<double, 4>;  // x, y, vx, vy

double between(double at, const std::vector<double>& x, const std::vector<double>& y) {
  if (at >= x.back()) return y.back();
  std::size_t k = 0;
  while (at >= x[k + 1]) ++k;
  return y[k] + (y[k + 1] - y[k]) * (at - x[k]) / (x[k + 1] - x[k]);
}

struct Air {
  double vx, vy, speed, height, density;
};

Air air(const Row& s, double wE) {
  const double vx = s[2] + wE * s[1], vy = s[3] - wE * s[0], height = std::hypot(s[0], s[1]) - 6371e3;
  return {vx, vy, std::hypot(vx, vy), height, 1.225 * std::exp(-height / 8500)};
}

Row rate(double t, const Row& s, int stage, double wE) {
  const double mu = 3.986004418e14, r = std::hypot(s[0], s[1]);
  const double flow = stage == 1 ? 2500 : stage == 2 ? 270 : 0, out = stage == 1 ? 2800 : 3400;
  const double mass = stage == 1   ? 37e3 + 20e3 + 90e3 + 400e3 - 2500 * t
                      : stage == 2 ? 20e3 + 90e3 - 270 * (t - 160)
                                   : 20e3;
  const Air a = air(s, wE);
  const double Cd = between(a.speed / std::max(295.0, 340.3 - 0.0041 * a.height), {0, 0.8, 1.05, 1.5, 3, 10},
                            {0.30, 0.32, 0.55, 0.45, 0.30, 0.25});
  const double drag = a.density * a.speed * Cd * 10 / 2, pitch = between(t, {0, 10, 160, 500}, {0, 0, 0.95, 1.5});
  const double ux = (std::cos(pitch) * s[0] - std::sin(pitch) * s[1]) / r,
               uy = (std::cos(pitch) * s[1] + std::sin(pitch) * s[0]) / r;
  return {s[2], s[3], (flow * out * ux - drag * a.vx) / mass - mu * s[0] / (r * r * r),
          (flow * out * uy - drag * a.vy) / mass - mu * s[1] / (r * r * r)};
}

// The position and velocity in axes at rest after 600 s, and the time of the greatest dynamic pressure.
std::pair<Row, double> at_rest(double wE) {
  constexpr double kStep = 0.01;
  const auto ahead = [](Row a, double c, const Row& b) {
    for (std::size_t i = 0; i < 4; ++i) a[i] += c * b[i];
    return a;
  };
  Row s{6371e3, 0, 1, wE * 6371e3};
  double t = 0, before = 1, greatest = 0;
  const double burnt[] = {160, 160 + 90 / 0.27, 600};
  for (int stage = 1; stage <= 3; ++stage)
    for (const double from = t, to = burnt[stage - 1]; t < to;) {
      const double steps = std::ceil((to - from) / kStep), h = (to - from) / steps;
      const double n = std::round((t - from) / h);
      const Row a = rate(t, s, stage, wE), b = rate(t + h / 2, ahead(s, h / 2, a), stage, wE),
                c = rate(t + h / 2, ahead(s, h / 2, b), stage, wE), d = rate(t + h, ahead(s, h, c), stage, wE);
      // q'/q = -h'/8500 + 2 v.v'/v^2, where v is the velocity relative to the air.
      const Air v = air(s, wE);
      const double growth = -(s[0] * s[2] + s[1] * s[3]) / std::hypot(s[0], s[1]) / 8500 +
                            2 * (v.vx * (a[2] + wE * s[3]) + v.vy * (a[3] - wE * s[2])) / (v.speed * v.speed);
      if (growth < 0 && before > 0) greatest = t - h * growth / (growth - before);
      before = growth;
      for (std::size_t i = 0; i < 4; ++i) s[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
      t = n + 1 >= steps ? to : from + (n + 1) * h;
    }
  return {s, greatest};
}

TEST(Launcher, FliesAsByNewtonsLawAtRest) {
  const Flight f = flight(launcher());
  const auto miss = [&](const Row& s, double wE) {  // m
    const double c = std::cos(600 * wE), d = std::sin(600 * wE);
    return std::hypot(f.end.at("x") - (c * s[0] + d * s[1]), f.end.at("y") - (c * s[1] - d * s[0]));
  };
  const double wE = 7.292115e-5;
  const auto [s, greatest] = at_rest(wE);
  EXPECT_LT(miss(s, wE), 1e-3) << "kinks of the drag lie within steps of 0.01 s";
  EXPECT_NEAR(std::hypot(s[2], s[3]), f.end.at("inertial_speed"), 1e-6);
  EXPECT_NEAR(f.events.at(0).second, greatest, 1e-4) << "the secant of one step";
  EXPECT_GT(miss(at_rest(1.001 * wE).first, wE), 1) << "mutant: a faster Earth";
}

}  // namespace
}  // namespace anholon::launcher_test

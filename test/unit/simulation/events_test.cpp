// Events, states, kinks and servo constraints, compared with closed forms.
#include <cmath>
#include <sstream>

#include <gtest/gtest.h>

#include "motion/motion.h"
#include "support/models.h"
#include "support/motion.h"

namespace anholon::events_test {
namespace {

using Result = test::Motion;

Result run(const std::string& text, const Rational& to, const std::string& tolerance = "1/100000000000000",
           const std::function<void(SimulationOptions&)>& more = {}, const char* form = "routh") {
  Result r;
  Scenario s;
  r.report.outcome = make_scenario(test::model_of(text), *find_formulation(form), {}, s);
  if (!r.report.outcome.ok()) return r;
  SimulationOptions o;
  o.to = to;
  o.tolerance = Rational(tolerance.c_str());
  if (more) more(o);
  r.report = simulate(s, o, r.rows);
  return r;
}

std::string mass_on_a_line(const std::string& force, const std::string& more) {
  return "coordinates = [\"x\"]\n" + more +
         "[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n[[force]]\non = \"p\"\nvector = \"(" + force +
         ")*ex\"\n";
}

// Kinks that depend on time alone are met at their times: forces that jump there add no error of the size of the
// tolerance.
TEST(Events, KinksInTimeAlone) {
  const std::string table = "table = [{name = \"h\", x = [0, 0.3, 0.7], y = [0, 1, 5], fit = \"hold\"}]\n";
  struct Case {
    const char* force;
    double velocity;
  };
  const double pi = std::acos(-1.0);
  for (const Case& c : {Case{"piecewise(t < 1, 0, 5)", 5}, Case{"piecewise(t <= 1, 0, 5)", 5}, Case{"h(t)", 6.9},
                        Case{"piecewise(t < 0.3, 0, t < 0.7, 1, 5)", 6.9}, Case{"1 + sign(t - 1)", 2},
                        Case{"piecewise(t < pi/3, 0, 5)", 5 * (2 - pi / 3)}, Case{"piecewise(3*t < 1, 6, 0)", 2}}) {
    const Result r = run(mass_on_a_line(c.force, table), 2, "1/1000000000000");
    ASSERT_TRUE(r.report.outcome.ok()) << c.force;
    EXPECT_NEAR(r.last("x'"), c.velocity, 4e-15 * c.velocity) << c.force;
  }
  const Result exact = run(mass_on_a_line("piecewise(t < 1, 0, 5)", ""), 2, "1/1000000000000");
  EXPECT_EQ(exact.last("x'"), 5);
  EXPECT_EQ(exact.last("x"), 2.5);
  EXPECT_EQ(exact.number(1, "t"), 1);
}

// A step that ends at the double next to a knot, as at an event, continues beyond the knot: 0.7 as a double is less
// than 0.7 as the state holds it.
TEST(Events, AtAKnot) {
  const std::string more = "table = [{name = \"h\", x = [0, 0.3, 0.7], y = [0, 1, 5], fit = \"hold\"}]\nmode.m = 0\n"
                           "event = [{name = \"e\", when = \"t - 0.7\", set = {m = 1}}]\n";
  for (const char* force : {"h(t)", "piecewise(t < 0.3, 0, t < 0.7, 1, 5)"}) {
    const Result r = run(mass_on_a_line(force, more), 2, "1/1000000000000");
    ASSERT_TRUE(r.report.outcome.ok());
    ASSERT_EQ(r.report.events.size(), 1U);
    EXPECT_EQ(r.report.events[0].t.value, 0.7);
    EXPECT_NEAR(r.last("x'"), 6.9, 1e-11) << force;
    for (const Warning& w : r.report.warnings) ADD_FAILURE() << w.message;
  }
}

TEST(Events, TwoThatAreNearlyAtOnce) {
  // The second ball arrives 3e-12 after the first one has bounced: its event comes later, and is not lost.
  const std::string text = R"(coordinates = ["x", "y"]
particle = [{name = "a", mass = 1, position = "x*ex"}, {name = "b", mass = 1, position = "y*ey"}]
event = [
  {name = "first", when = "x - 5", direction = "down", set = {"x'" = "-x'"}},
  {name = "second", when = "y - 5", direction = "down", set = {"y'" = "-y'"}},
]
[initial]
x = 6
"x'" = -1
y = "5.01 + 3e-14"
"y'" = -0.01
)";
  const Result r = run(text, 2);
  ASSERT_EQ(r.report.events.size(), 2U);
  EXPECT_NEAR(r.last("y"), 5.01, 1e-12) << "the second one has turned, too";
}

TEST(Events, AKinkInTheirFormula) {
  const Result r = run(
      mass_on_a_line("0", "initial = {x = 1.5, \"x'\" = -1}\nevent = [{name = \"far\", when = \"abs(x) - 2\"}]\n"), 4);
  ASSERT_EQ(r.report.events.size(), 1U);
  EXPECT_NEAR(r.report.events[0].t.value, 3.5, 1e-14);
}

// The events are found although the series of a formula does not show them: the formula has no series at the start of
// the motion, is nearly constant there, or has too high a power.
TEST(Events, AreFoundWhateverTheirFormula) {
  const auto moving = [](const std::string& when, const char* x = "0") {
    return mass_on_a_line("0", "[initial]\nx = " + std::string(x) +
                                   "\n\"x'\" = 1\n[[event]]\nname = \"there\"\nwhen = \"" + when + "\"\nstop = true\n");
  };
  struct Formula {
    const char *when, *x;
    double t;
  };
  for (const Formula& f :
       {Formula{"norm(x*ex) - 2", "0", 2}, Formula{"sqrt(x) - 1", "0", 1}, Formula{"x^20 - 1", "0", 1},
        Formula{"x^200 - 1", "0", 1}, Formula{"tanh((x - 1)/0.01)", "0", 1}, Formula{"tanh((x - 1)/0.01)", "-100", 101},
        Formula{"1/(1 + exp(-(x - 1)/0.001)) - 1/2", "0", 1}, Formula{"exp(x/0.01) - exp(100)", "-2", 3},
        Formula{"exp(-((x - 3)/0.01)^2) - 1/2", "0", 3 - 0.01 * 0.83255461115769776},
        Formula{"atan((x - 1)/0.0001)", "0", 1}, Formula{"x^(3/2) - 8", "0", 4}, Formula{"abs(x)^(1/3) - 1", "0", 1},
        Formula{"norm(x*ex + x^2*ey) - sqrt(2)", "0", 1}})
    for (const Precision precision : {Precision::real, Precision::quad}) {
      const Result r = run(moving(f.when, f.x), 5 + (f.t > 10 ? 200 : 0), "1/1000000000000",
                           [&](SimulationOptions& o) { o.precision = precision; });
      ASSERT_EQ(r.report.events.size(), 1U) << f.when << " " << r.report.outcome.message;
      EXPECT_NEAR(r.report.events[0].t.value, f.t, 1e-12) << f.when;
    }
}

TEST(Events, WithoutAnySeriesHoldNobodyUp) {
  // The formula is at rest, or has no value, which ends the motion at once.
  for (const char* when : {"sqrt(y) - 1", "norm(y*ey) - 1", "log(y) - 1", "1/y - 1", "log(x - 0.1)"}) {
    const Result r = run("coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + "
                         "y*ey\"}]\nevent = [{name = \"e\", when = \"" +
                             std::string(when) + "\"}]\ninitial = {\"x'\" = 1}\n",
                         3);
    if (std::string(when).find("log") == 0 || std::string(when).find("1/y") == 0) {
      EXPECT_EQ(r.report.outcome.kind, OutcomeKind::not_a_number) << when;
      EXPECT_EQ(r.report.outcome.message, "the formula of the event 'e' has no value at the start") << when;
      EXPECT_EQ(r.report.steps, 0U) << when;
      continue;
    }
    EXPECT_TRUE(r.report.outcome.ok()) << when << " " << r.report.outcome.message;
    EXPECT_LT(r.report.steps, 10U) << when;
  }
}

// In all types of numbers, a motion that ends because of an event's formula names this event and no other.
TEST(Events, ThatEndAMotionAreNamed) {
  for (const Precision precision : {Precision::real, Precision::long_real, Precision::quad, Precision::multi})
    for (const char* when : {"1/(x - 0.55)", "tan(3*x)", "log(0.55 - x)"}) {
      const Result r = run(mass_on_a_line("0", "initial = {x = 0, \"x'\" = 1}\nevent = [{name = \"other\", when = "
                                               "\"x - 9\"}, {name = \"e\", when = \"" +
                                                   std::string(when) + "\"}]\n"),
                           3, "1/1000000000000", [&](SimulationOptions& o) {
                             o.precision = precision;
                             o.estimate = ErrorEstimate::never;
                           });
      EXPECT_FALSE(r.report.outcome.ok()) << when;
      EXPECT_NE(r.report.outcome.message.find("the formula of the event 'e'"), std::string::npos)
          << when << " " << r.report.outcome.message;
    }
}

TEST(Events, DoNotFireWhereTheirFormulaOnlyTouches) {
  for (const char* when : {"abs(x - 1)", "norm((x - 1)*ex)", "abs(x - 1)*(x + 3)", "sqrt((x - 1)^2)"}) {
    const Result r = run(mass_on_a_line("0", "initial = {x = 0, \"x'\" = 1}\nevent = [{name = \"touch\", when = \"" +
                                                 std::string(when) + "\"}]\n"),
                         3);
    EXPECT_TRUE(r.report.events.empty()) << when;
  }
  const Result passes =
      run(mass_on_a_line("0",
                         "initial = {x = 0, \"x'\" = 1}\nevent = [{name = \"pass\", when = \"(x - 1)*abs(x - 1)\"}]\n"),
          3);
  ASSERT_EQ(passes.report.events.size(), 1U);
  EXPECT_NEAR(passes.report.events[0].t.value, 1, 1e-9);
}

TEST(Events, AreAtTheZeroOfTheFormula) {
  const Result r =
      run(mass_on_a_line(
              "-4*x", "initial = {x = 3}\nevent = [{name = \"e\", when = \"x^2 - 1\", set = {\"x'\" = \"2*x'\"}}]\n"),
          Rational(6, 5), "1/1000000000");
  ASSERT_EQ(r.report.events.size(), 2U) << "once down, once up";
  EXPECT_NEAR(r.report.events[0].t.value, std::acos(1.0 / 3) / 2, 1e-11);
}

// One step from bounce to bounce is so long that its terms cancel far from its start, to more than their round-off
// there.
TEST(Events, KeepTheirDirectionFarFromTheExpansion) {
  const Result r = run(mass_on_a_line("-1.98", R"(event = [
  {name = "above", when = "x^2 - 1.13^2", direction = "up"},
  {name = "floor", when = "x^2 - 0.21^2", direction = "down", set = {"x'" = "-0.89*x'"}},
]
initial = {x = 2.90, "x'" = -1.84}
)"),
                       5);
  std::string found;
  for (const EventReport& e : r.report.events) found += e.name + ' ';
  EXPECT_EQ(found, "floor above floor above ") << "falling through 1.13 at t = 4.028 is no way up";
}

TEST(Events, TakenBackwardsKeepTheirDirection) {
  const std::string text =
      mass_on_a_line("0", "initial = {x = 1, \"x'\" = 1}\nevent = [{name = \"up\", when = \"x\", direction = \"up\"}, "
                          "{name = \"down\", when = \"x\", direction = \"down\"}]\n");
  const Result back = run(text, -2);
  ASSERT_EQ(back.report.events.size(), 1U);
  EXPECT_EQ(back.report.events[0].name, "up");
  EXPECT_NEAR(back.report.events[0].t.value, -1, 1e-15);
}

TEST(Events, EnergyIsBalancedOverThem) {
  const std::string text = mass_on_a_line("-x - x'/10 - 3", "initial = {x = 2}\nevent = [{name = \"b\", when = \"x\", "
                                                            "direction = \"down\", set = {\"x'\" = \"-0.9*x'\"}}]\n");
  const Result r = run(text, 3);
  EXPECT_GE(r.report.events.size(), 2U);
  EXPECT_LT(r.report.power, 1e-12);
}

// Two pendulums, one on the other. The kernel makes nearly all steps.
constexpr const char* kSwings = "coordinates = [\"a\", \"b\"]\npoint.P = \"sin(a)*ex - cos(a)*ey\"\n"
                                "gravity.field = \"-9.81*ey\"\n"
                                "particle = [{name = \"p\", mass = 1, position = \"P\"}, {name = \"q\", mass = 2, "
                                "position = \"P + sin(b)*ex - cos(b)*ey\"}]\ninitial = {a = 1, b = 2}\n"
                                "event = [{name = \"low\", when = \"sin(a) + sin(b)\"}, {name = \"turns\", when = "
                                "\"a'\", set = {\"b'\" = \"b'/2\"}}]\n";

// A ball that bounces in a wind; if `counted`, a mode counts the bounces, so that the equations change.
std::string bouncing(bool counted) {
  const std::string mode = counted ? "mode.n = 0\n" : "", set = counted ? ", n = \"n + 1\"" : "";
  return mass_on_a_line("-10 - x'/5", "initial = {x = 2}\n" + mode + "state.z = {rate = \"x - " +
                                          (counted ? "n*z" : "z") +
                                          "\", initial = 0}\nevent = [{name = \"b\", when = \"x\", direction = "
                                          "\"down\", set = {\"x'\" = \"-0.9*x'\"" +
                                          set + "}}, {name = \"top\", when = \"x'\", direction = \"down\"}]\n");
}

TEST(Events, RunsGoOnAcrossThemWithTheSameBits) {
  for (const std::string& text : {bouncing(true), bouncing(false), std::string(kSwings)}) {
    std::string saved;
    const auto save = [&](SimulationOptions& o) { o.save = [&](const SavedRun& s) { saved = print(s); }; };
    const Result whole = run(text, 3, "1/1000000000000", save);
    const std::string end = saved;
    ASSERT_GE(whole.report.events.size(), 4U);
    for (const char* half : {"1/2", "16/25", "7/5", "5/2"}) {
      run(text, Rational(half), "1/1000000000000", save);
      const SavedRun from = read_saved({"run.state", saved});
      const Result second = run(text, 3, "1/1000000000000", [&](SimulationOptions& o) {
        save(o);
        o.resume = &from;
      });
      EXPECT_EQ(second.rows.rows().back(), whole.rows.rows().back()) << half;
      EXPECT_EQ(test::of_the_motion(saved), test::of_the_motion(end)) << half;
      EXPECT_EQ(second.report.events.size(), whole.report.events.size()) << half;
    }
  }
}

TEST(Events, AreThoseOfTheReferenceIfAKernelMakesTheSteps) {
  for (const std::string& text : {bouncing(true), bouncing(false), std::string(kSwings)}) {
    const auto by = [&](bool kernel) {
      return run(text, 4, "1/1000000000000000", [&](SimulationOptions& o) { o.kernel = kernel; });
    };
    const Result one = by(true), other = by(false);
    ASSERT_GE(one.report.events.size(), 5U);
    ASSERT_EQ(one.report.events.size(), other.report.events.size());
    for (std::size_t i = 0; i < one.report.events.size(); ++i) {
      EXPECT_EQ(one.report.events[i].name, other.report.events[i].name) << i;
      EXPECT_NEAR(one.report.events[i].t.value, other.report.events[i].t.value, 1e-12) << i;
    }
  }
}

// x'' = 2 to t = 1, -2 to t = 3, then 2: a kernel makes the rows of all three modes.
TEST(Events, SetModesThatTheRowsAfterThemHave) {
  const Result r =
      run(mass_on_a_line("2*push", "mode.push = 1\nevent = [{name = \"turn\", when = \"x - 1\", set = {push "
                                   "= \"-push\"}}]\n"),
          4, "1/1000000000000", [](SimulationOptions& o) {
            o.every = Rational(1, 128);
            o.estimate = ErrorEstimate::always;
          });
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  ASSERT_EQ(r.report.events.size(), 2U);
  ASSERT_EQ(r.rows.rows().size(), 513U);
  EXPECT_LT(r.report.rows_looked_at, 400U) << "the reference makes all rows";
  EXPECT_TRUE(r.report.warnings.empty()) << r.report.warnings.front().message;
  for (const std::vector<std::string>& row : r.rows.rows()) {
    const double t = std::stod(row[0]), x = std::stod(row[1]), acceleration = std::stod(row[3]);
    if (std::abs(t - 1) < 1e-9 || std::abs(t - 3) < 1e-9) continue;  // the times of the events, to round-off
    EXPECT_NEAR(acceleration, t < 1 || t > 3 ? 2 : -2, 1e-14) << t;
    const double since = t < 1 ? t : t < 3 ? t - 2 : t - 4;
    EXPECT_NEAR(x, t < 1 || t > 3 ? since * since : 2 - since * since, 1e-14) << t;
  }
  ASSERT_TRUE(r.report.error) << r.report.no_error;
  EXPECT_GE(r.report.error->worst().digits, 14);
}

// A row at the time of an event shows the motion before it, whether this time as a double is below or above that of the
// event.
TEST(Events, RowsAtTheirTimeShowTheMotionBefore) {
  for (const char* time : {"1/10", "1/5", "3/10", "3/5", "7/10", "9/10", "1/3"}) {
    const Result r = run(mass_on_a_line("0", "event = [{name = \"kick\", when = \"t - " + std::string(time) +
                                                 "\", set = {\"x'\" = \"x' + 10\"}}]\n"),
                         1, "1/1000000000000", [&](SimulationOptions& o) { o.at = {Rational(time), Rational(1)}; });
    ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
    EXPECT_EQ(r.number(0, "x'"), 0) << time;
    EXPECT_EQ(r.last("x'"), 10) << time;
  }
}

// Positions that an event sets beside a circle move to the nearest ones on it, and velocities to its tangents, in all
// forms.
TEST(Events, PositionsAreMadeConsistentByTheLeastChange) {
  const std::string text = R"toml(
coordinates = ["x", "y"]
particle = [{name = "bead", mass = 2, position = "x*ex + y*ey"}]
constraint = [{name = "hoop", equation = "x^2 + y^2 = 1"}]
event = [{name = "move", when = "t - 1/2", set = {x = "x + SHIFT"}}]
initial = {x = 1, y = 0, "y'" = 1}
)toml";
  const auto misfit = [&](const char* shift, const char* form) {
    const Result r = run(test::replaced(text, "SHIFT", shift), Rational(7, 10), "1/1000000000000", {}, form);
    EXPECT_TRUE(r.report.outcome.ok()) << form << r.report.outcome.message;
    const double x = std::cos(0.5) + 0.2, y = std::sin(0.5), angle = std::atan2(y, x),
                 speed = std::cos(0.5) * std::cos(angle) + std::sin(0.5) * std::sin(angle), end = angle + 0.2 * speed;
    return std::max(std::abs(r.last("x") - std::cos(end)), std::abs(r.last("y'") - speed * std::cos(end)));
  };
  for (const char* form : {"routh", "kane", "maggi", "chaplygin", "gauss"})
    EXPECT_LT(misfit("0.2", form), 1e-14) << form;
  EXPECT_GT(misfit("0.2001", "routh"), 1e-6);  // the mutant
}

// An event sets a velocity against a constraint: the impulse of the constraint distributes it by the masses, in all
// forms. With a velocity constraint beside it, positions follow only the constraints of position.
TEST(Events, VelocitiesAreMadeConsistentInTheMassNorm) {
  const std::string text = R"toml(
coordinates = ["x", "y", "z"]
[[particle]]
name = "a"
mass = 1
position = "x*ex + z*ey"
[[particle]]
name = "b"
mass = MASS
position = "y*ex"
[[constraint]]
name = "rope"
equation = "x - y = 0"
[[constraint]]
name = "blade"
equation = "z' - x' = 0"
[[event]]
name = "hit"
when = "t - 1/2"
set = {"x'" = "x' + 1"}
[[event]]
name = "move"
when = "t - 1"
set = {x = "x + 1"}
)toml";
  for (const char* form : {"routh", "kane", "maggi", "udwadia-kalaba"}) {
    const Result r = run(test::replaced(text, "MASS", "3"), Rational(3, 2), "1/1000000000000", {}, form);
    ASSERT_TRUE(r.report.outcome.ok()) << form << r.report.outcome.message;
    // Along (1, 1, 1) with the mass 1 + 3 + 1, then the masses 1 and 3 move by 1/4 to the middle of their rope.
    EXPECT_NEAR(r.last("x'"), 0.2, 1e-15) << form;
    EXPECT_NEAR(r.last("y"), 0.2 + 0.25, 1e-15) << form;
    EXPECT_NEAR(r.last("z"), 0.2, 1e-15) << form;
  }
  const Result mutant = run(test::replaced(text, "MASS", "2"), Rational(3, 2));
  EXPECT_GT(std::abs(mutant.last("x'") - 0.2), 1e-2);
}

// The kernel makes most steps, also with modes, each of which begins with a new stepper.
TEST(Events, LeaveTheStepsToTheKernel) {
  std::string counted = kSwings;
  counted.replace(counted.find("b'/2"), 5, "b'/2\", n = \"n + 1\"");
  for (const std::string& text : {std::string(kSwings), "mode.n = 0\n" + counted}) {
    Scenario s;
    ASSERT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
    Workspace own(s);
    Motion<double> motion(own, {}, {}, 0);
    ASSERT_TRUE(motion.start({}).ok());
    std::vector<Occurrence<long double>> seen;
    bool goes_on = true;
    std::size_t all = 0, by_kernel = 0;
    while (motion.stepper().time() < 20) {
      const std::size_t before = motion.stepper().expansions(), kernel_before = motion.stepper().expansions_by_kernel();
      ASSERT_TRUE(motion.step(20).ok());
      all += motion.stepper().expansions() - before;
      by_kernel += motion.stepper().expansions_by_kernel() - kernel_before;
      if (!motion.stepper().fired().empty()) {
        ASSERT_TRUE(motion.settle(seen, goes_on).ok());
      }
    }
    EXPECT_GE(seen.size(), 10U);
    EXPECT_GT(4 * by_kernel, 3 * all);
  }
}

TEST(States, FirstOrderLagAndTsiolkovsky) {
  const Result r = run(R"(coordinates = ["x"]
particle = [{name = "r", mass = "1 + fuel", position = "x*ex", expelled_velocity = "-3*ex"}]
state = {fuel = {rate = "-2", initial = 9}, lag = {rate = "(1 - lag)/2", initial = 0}}
)",
                       4);
  EXPECT_NEAR(r.last("x'"), 3 * std::log(10.0 / 2), 1e-12);
  EXPECT_NEAR(r.last("lag"), 1 - std::exp(-2), 1e-13);
  EXPECT_NEAR(r.last("fuel"), 1, 1e-13);
}

// Forces -sign(x), -2 x beyond 1, and a table: the error falls with the tolerance, and the closed form is met.
TEST(Kinks, TheErrorFollowsTheTolerance) {
  struct Case {
    const char* force;
    double exact;  // x at t = 3, from x = 2 at rest
  };
  // Constant force -1 for x > 0: x = 2 - t^2/2 until t = 2, v = -2; then +1: x = -2 s + s^2/2, s = 1.
  const double a = -2 + 0.5;
  // Force -1 above 1, -x below: until t = sqrt(2), v = -sqrt(2); then x = cos(s) - sqrt(2) sin(s).
  const double s = 3 - std::sqrt(2.0), b = std::cos(s) - std::sqrt(2.0) * std::sin(s);
  for (const Case& c :
       {Case{"-sign(x)", a}, Case{"piecewise(x > 1, -1, -x)", b}, Case{"max(-1, -x)", b}, Case{"F(x)", b}}) {
    double before = 1;
    for (const char* tolerance : {"1/10000", "1/100000000", "1/1000000000000"}) {
      const std::string table = "table = [{name = \"F\", x = [-3, 1, 3], y = [3, -1, -1]}]\n";
      const Result r = run(mass_on_a_line(c.force, "initial = {x = 2}\n" + table), 3, tolerance);
      ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
      const double error = std::abs(r.last("x") - c.exact);
      EXPECT_LT(error, 100 * Rational(tolerance).get_d()) << c.force;
      EXPECT_TRUE(error < before || error < 1e-13) << c.force;
      before = error;
    }
  }
}

// A pendulum with drag, driven by forces that have kinks on the way, in its motion and in time.
std::string driven(const std::string& force) {
  return R"(coordinates = ["a"]
table = [
  {name = "steps", x = [0, 1, 2, 3, 4], y = [0, 2, -1, 3, 0], fit = "hold"},
  {name = "lines", x = [0, 1, 2, 3, 4], y = [0, 2, -1, 3, 0]},
  {name = "curves", x = [0, 1, 2, 3, 4], y = [0, 2, -1, 3, 0], fit = "spline"},
]
particle = [{name = "p", mass = 1, position = "sin(a)*ex - cos(a)*ez"}]
gravity.field = "-9*ez"
force = [{on = "p", vector = "-vel(p)*norm(vel(p))/8"}, {generalized = {a = ")" +
         force + R"("}}]
initial = {a = 1}
)";
}

TEST(Kinks, AreThoseOfTheReferenceIfAKernelMakesTheSteps) {
  for (const char* force :
       {"0", "-abs(a)", "piecewise(a' > 1, 2, sin(t))", "max(a, max(a', -1/2))", "sign(cos(3*t))", "steps(t)",
        "lines(t)", "curves(t)", "lines(2 + a')", "atan2(sin(4*t), cos(4*t))", "atan2(sin(3*a), cos(3*a))"}) {
    const std::string text = driven(force);
    const auto by = [&](bool kernel) {
      return run(text, 5, "1/1000000000000000", [&](SimulationOptions& o) {
        o.kernel = kernel;
        o.method = Method::taylor;
        o.at = {1, 2, 3, 4, 5};
      });
    };
    const Result one = by(true), other = by(false);
    ASSERT_TRUE(one.report.outcome.ok()) << force << ": " << one.report.outcome.message;
    ASSERT_EQ(one.rows.rows().size(), 5U) << force;
    for (std::size_t i = 0; i < 5; ++i)
      for (const std::size_t j : {1U, 2U})
        EXPECT_NEAR(std::stod(one.rows.rows()[i][j]), std::stod(other.rows.rows()[i][j]), 2e-13) << force << " " << i;
  }
}

// A table ends at the height of a floor: a ball that bounces there stays within the table, one that continues leaves
// it.
TEST(Bounds, AMotionMayTurnBackWhereATableEnds) {
  const auto falls = [](const std::string& floor) {
    return run(R"(coordinates = ["x", "z"]
table = [{name = "wind", x = [0, 1, 2], y = [0, 2, -1], outside = "error"}]
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
gravity.field = "-ez"
force = [{on = "p", vector = "wind(z)*ex"}]
initial = {z = 0.5}
)" + floor,
               Rational(5, 2), "1/1000000000000", [](SimulationOptions& o) { o.at = {Rational(5, 2)}; });
  };
  const Result back = falls(R"(event = [{name = "floor", when = "z", direction = "down", set = {"z'" = "-z'/2"}}])");
  ASSERT_TRUE(back.report.outcome.ok()) << back.report.outcome.message;
  // Bounces at t = 1, 2 and 2.5 with the speeds 1/2 and 1/4.
  EXPECT_NEAR(std::stod(back.rows.rows()[0][2]), 0, 1e-12);
  const Result on = falls(R"(event = [{name = "slower", when = "z", direction = "down", set = {"z'" = "z'/2"}}])");
  EXPECT_EQ(on.report.outcome.kind, OutcomeKind::not_a_number);
  EXPECT_NE(on.report.outcome.message.find("below its first knot 0 at t = 1"), std::string::npos)
      << on.report.outcome.message;
}

// From a knot at which a table ends a motion may only go inwards.
TEST(Bounds, AMotionThatStartsWhereATableEndsAndLeavesItEnds) {
  const auto from = [](const std::string& x, const std::string& event, const Rational& to) {
    return run(R"(coordinates = ["x"]
particle = [{name = "p", mass = 1, position = "x*ex"}]
table = [{name = "F", x = [0, 1], y = [-1, 1], outside = "error"}]
force = [{on = "p", vector = "F(x)*ex"}]
initial = {x = )" + x +
                   "}\n" + event,
               to, "1/1000000000000", [&](SimulationOptions& o) { o.at = {to}; })
        .report.outcome;
  };
  for (const Rational& to : {Rational(1, 10), Rational(-1, 10)})
    for (const char* x : {"0", "1"}) {
      const Outcome o = from(x, "", to);
      EXPECT_EQ(o.kind, OutcomeKind::not_a_number) << x;
      EXPECT_NE(o.message.find("at the start"), std::string::npos) << o.message;
    }
  const std::string set = "[[event]]\nname = \"set\"\nwhen = \"t - 0.05\"\nset = {x = 1}\n";
  EXPECT_EQ(from("0.5", set, Rational(1, 10)).kind, OutcomeKind::not_a_number);
  EXPECT_TRUE(from("0.5", "", Rational(1, 10)).ok());
  // An event that sets the motion beyond the table ends it.
  const std::string beyond = "[[event]]\nname = \"set\"\nwhen = \"t - 0.05\"\nset = {x = 1.5}\n";
  EXPECT_EQ(from("0.5", beyond, Rational(1, 10)).kind, OutcomeKind::not_a_number);
}

// A potential with a step, a position with a kink, a constraint whose velocity jumps: the motion continues without the
// impulse that each of them needs, and has a warning. A force that jumps has none.
TEST(Kinks, ThatWouldNeedAnImpulseHaveAWarning) {
  const auto warnings = [](const std::string& text) {
    Result r;
    Scenario s;
    r.report.outcome = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
    EXPECT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
    SimulationOptions o;
    o.to = 3;
    Workspace own(s);
    o.conserved = conserved(*own.mechanics);
    r.report = simulate_in(own, o, r.rows);
    EXPECT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
    return r.report.warnings.size();
  };
  const auto particle = [](const std::string& position, const std::string& more) {
    return "coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"(" + position +
           ")*ex + y*ey\"}]\ninitial = {x = 0, \"x'\" = 1, \"y'\" = 0.5}\n" + more;
  };
  EXPECT_EQ(warnings(particle("x", "")), 0U);
  EXPECT_EQ(warnings(particle("x", "potential.V = \"abs(x - 1)\"\n")), 0U);
  EXPECT_GT(warnings(particle("x", "potential.V = \"piecewise(x > 1, 3, 0)\"\n")), 0U);
  EXPECT_GT(warnings(particle("x + max(x - 1, 0)", "")), 0U);
  EXPECT_GT(warnings("coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + "
                     "y*ey\"}]\nconstraint = [{name = \"drive\", equation = \"x' + y = sign(t - 1)\"}]\n"),
            0U);
}

// The angle of a direction that turns with the rate 1 jumps at t = pi. Its integral over a turn is 0.
TEST(Kinks, AnAngleJumpsBesideTheNegativeAxis) {
  for (const bool kernel : {true, false}) {
    const Result r = run(R"(coordinates = ["x"]
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "atan2(sin(t), cos(t))*ex"}]
)",
                         5, "1/1000000000000", [&](SimulationOptions& o) {
                           o.kernel = kernel;
                           o.method = Method::taylor;
                           o.at = {5};
                         });
    ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
    const double pi = std::numbers::pi;
    EXPECT_NEAR(std::stod(r.rows.rows()[0][2]), 12.5 - 2 * pi * (5 - pi), 1e-10);
    EXPECT_NEAR(std::stod(r.rows.rows()[0][1]), 125 / 6.0 - pi * (5 - pi) * (5 - pi), 1e-10);
  }
}

// A motion starts at rest at the height of a kink, z = 1 - t^2/2. The force along x is that of the side to which the
// motion goes, and for a time the height differs from that of the kink by less than its resolution.
TEST(Kinks, OfAMotionAtRestAreLeft) {
  for (const auto& [force, x] : {std::pair{"lines(z)", 1 - 1 / 12.0},
                                 {"abs(z - 1)", 1 / 24.0},
                                 {"1 - min(z, 1)", 1 / 24.0},
                                 {"piecewise(z < 1, 1 - z, 2 - 2*z)", 1 / 24.0}}) {
    const std::string text = std::string(R"(coordinates = ["x", "z"]
table = [{name = "lines", x = [0, 1, 2], y = [0, 2, -1]}]
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
gravity.field = "-ez"
force = [{on = "p", vector = "()") +
                             force + R"()*ex"}]
initial = {z = 1}
)";
    for (const bool kernel : {true, false}) {
      const Result r = run(text, 1, "1/1000000000000", [&](SimulationOptions& o) {
        o.kernel = kernel;
        o.method = Method::taylor;
        o.at = {1};
      });
      ASSERT_TRUE(r.report.outcome.ok()) << force << ": " << r.report.outcome.message;
      EXPECT_NEAR(std::stod(r.rows.rows()[0][1]), x, 1e-13) << force;
      EXPECT_LE(r.report.steps, 9U) << force;
    }
  }
}

TEST(Kinks, LeaveTheStepsToTheKernel) {
  for (const char* force :
       {"-abs(a)", "piecewise(a' > 1, 2, sin(t))", "sign(cos(3*t))", "curves(t)", "lines(2 + a')"}) {
    Scenario s;
    ASSERT_TRUE(make_scenario(test::model_of(driven(force)), *find_formulation("routh"), {}, s).ok());
    Workspace own(s);
    Motion<double> motion(own, {}, {}, 0);
    ASSERT_TRUE(motion.start({}).ok());
    while (motion.stepper().time() < 20) ASSERT_TRUE(motion.step(20).ok()) << force;
    const std::size_t all = motion.stepper().expansions(), by_kernel = motion.stepper().expansions_by_kernel();
    EXPECT_GT(4 * by_kernel, 3 * all) << force << ": " << by_kernel << " of " << all;
    EXPECT_GE(motion.stepper().kinks(), 3U) << force;
  }
}

// A tether is reeled out: the pull along it equals an ideal reaction, a thrust sideways does not.
TEST(Servo, IsTheIdealReactionWhereItActsAlongIt) {
  const auto tether = [](const std::string& force, const std::string& by) {
    return run(R"(coordinates = ["x", "y"]
particle = [{name = "p", mass = 2, position = "x*ex + y*ey"}]
force = [{name = "f", on = "p", vector = ")" +
                   force + R"("}]
constraint = [{name = "reel", equation = "norm(p.center) = 1 + t/10")" +
                   by + R"(}]
gravity.field = "-9.81*ey"
input.u = )" + (by.empty() ? "\"0\"" : "{}") +
                   R"(
[initial]
x = 0.6
y = -0.8
conditions = ["x' = 0.2"]
)",
               Rational(1, 10));
  };
  const Result ideal = tether("0*ex", ""), along = tether("-u*unit(p.center)", ", by = \"u\""),
               sideways = tether("u*ex", ", by = \"u\"");
  EXPECT_NEAR(along.last("x"), ideal.last("x"), 1e-13);
  EXPECT_NEAR(along.last("u"), -ideal.last("lambda.reel"), 1e-11);
  EXPECT_GT(std::abs(sideways.last("x") - ideal.last("x")), 1e-3);
  EXPECT_NEAR(std::hypot(sideways.last("x"), sideways.last("y")), 1.01, 1e-13) << "it keeps the length all the same";
  EXPECT_EQ(along.last("N.x"), 0);
}

}  // namespace
}  // namespace anholon::events_test

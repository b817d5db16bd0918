// Methods other than Taylor's give the same motion, and the automatic choice takes them where they are cheaper.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "motion/course.h"
#include "support/models.h"
#include "support/motion.h"

namespace anholon::course_test {
namespace {

using Result = test::Motion;

struct Asked {
  Method method = Method::automatic;
  Rational tolerance{1, 100000000};
  std::size_t most_steps = 50'000'000;
};

Rational power_of_ten(int n) {
  Rational r(1);
  for (int k = 0; k < n; ++k) r /= 10;
  return r;
}

Result motion(const std::string& text, const Rational& to, const Asked& asked, const std::string& form = "routh") {
  Scenario s;
  if (const Outcome o = make_scenario(test::model_of(text), *find_formulation(form), {}, s); !o.ok())
    throw std::runtime_error(o.message);
  SimulationOptions o;
  o.to = to;
  o.every = Rational(to / 4);
  o.tolerance = asked.tolerance;
  o.method = asked.method;
  o.most_steps = asked.most_steps;
  Result r;
  r.report = simulate(s, o, r.rows);
  return r;
}

// Largest difference of two tables of rows, relative to 1 + |x|.
double difference(const Result& a, const Result& b) {
  double worst = a.rows.rows().size() == b.rows.rows().size() ? 0 : 1e300;
  for (std::size_t k = 0; k < std::min(a.rows.rows().size(), b.rows.rows().size()); ++k)
    for (std::size_t i = 0; i < a.rows.names().size(); ++i) {
      const double x = std::stod(a.rows.rows()[k][i]), y = std::stod(b.rows.rows()[k][i]);
      worst = std::max(worst, std::abs(x - y) / (1 + std::abs(y)));
    }
  return worst;
}

// A slider between a very stiff spring and a strong damper, with a hanging pendulum.
const char* const kStiff = R"(
coordinates = ["x", "th"]
[[particle]]
name = "slider"
mass = 1
position = "x*ex"
[[particle]]
name = "bob"
mass = 1
position = "x*ex + sin(th)*ex - cos(th)*ey"
[gravity]
field = "-9.81*ey"
[[force]]
name = "spring"
on = "slider"
vector = "(-1e8*x - 2e5*x')*ex"
[initial]
th = 1
)";

// A bead on a spring whose force is piecewise linear, driven through many knots.
const char* const kTable = R"(
coordinates = ["x"]
table = [{name = "pull", x = [-2, -1, -0.5, 0.25, 0.75, 1.5, 2], y = [9, 5, 1, 0, -2, -4, -9], outside = "linear"}]
[[particle]]
name = "bead"
mass = 1
position = "x*ex"
[[force]]
name = "spring"
on = "bead"
vector = "(pull(x) + cos(t))*ex"
[initial]
x = 1.25
)";

class ByMethod : public testing::TestWithParam<std::string> {};

// The models have constraints of orders 0 to 3, many links, varying masses, and forms that eliminate.
TEST_P(ByMethod, TheMotionIsTheSame) {
  const std::string text = test::shipped_text(GetParam());
  const Result expected = motion(text, 1, {Method::taylor, power_of_ten(13)});
  const Result rk = motion(text, 1, {Method::runge_kutta, power_of_ten(9)}),
               bdf = motion(text, 1, {Method::bdf, power_of_ten(8)});
  for (const Result* r : {&rk, &bdf}) {
    ASSERT_TRUE(r->report.outcome.ok()) << r->report.outcome.message;
    EXPECT_EQ(r->report.method.taylor_steps, 0U);
    EXPECT_EQ(r->report.steps, r->report.method.steps);
    EXPECT_GT(r->report.method.evaluations, r->report.steps);
    // Rows are points on the constraints; accelerations and multipliers are solved for there.
    EXPECT_LT(r->report.newton, 1e-15);
    EXPECT_LT(r->report.constraints_kept, 1e-15);
    EXPECT_GT(difference(*r, expected), 0) << "the same bits are no other method";
  }
  EXPECT_LT(difference(rk, expected), 3e-8);
  EXPECT_LT(difference(bdf, expected), 1e-4);
  EXPECT_LT(rk.report.power, 1e-7);
  EXPECT_LT(bdf.report.power, 1e-5);
}
INSTANTIATE_TEST_SUITE_P(Model, ByMethod,
                         testing::Values("zoo/double-pendulum-cartesian", "zoo/chaplygin-sleigh", "zoo/disc",
                                         "zoo/isokinetic", "zoo/second-order-linear", "zoo/third-order-linear",
                                         "zoo/rocket", "zoo/snakeboard", "zoo/chain", "zoo/spherical-robot",
                                         "zoo/fourbar"),
                         [](const auto& p) { return test::test_name(p.param); });

TEST(Course, OtherCoordinatesAreEliminatedOnTheWay) {
  const std::string text = test::shipped_text("zoo/chaplygin-sleigh");
  const Result expected = motion(text, 8, {Method::taylor, power_of_ten(12)}, "maggi"),
               r = motion(text, 8, {Method::runge_kutta, power_of_ten(9)}, "maggi");
  ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
  EXPECT_GT(expected.report.eliminations, 0U);
  EXPECT_GT(r.report.eliminations, 0U);
  EXPECT_GT(r.report.method.steps, 4 * r.report.method.taylor_steps);
  EXPECT_LT(difference(r, expected), 1e-7);
}

TEST(Course, StiffMotionsGoByBdf) {
  constexpr std::size_t kForTaylor = 100'000, kForBdf = 5000;
  const Result taylor = motion(kStiff, 10, {Method::taylor, power_of_ten(8), kForTaylor});
  EXPECT_EQ(taylor.report.outcome.kind, OutcomeKind::interrupted) << "not stiff: " << taylor.report.steps << " steps";
  const Result bdf = motion(kStiff, 10, {Method::bdf, power_of_ten(8), kForBdf});
  ASSERT_TRUE(bdf.report.outcome.ok()) << bdf.report.outcome.message;
  for (const std::size_t most : {kForTaylor, std::size_t{50'000'000}}) {
    const Result found = motion(kStiff, 10, {Method::automatic, power_of_ten(8), most});
    ASSERT_TRUE(found.report.outcome.ok()) << found.report.outcome.message;
    const MethodReport& m = found.report.method;
    EXPECT_LT(m.steps, kForBdf);
    EXPECT_LT(m.taylor_steps, kForBdf);
    ASSERT_EQ(m.turns.size(), 1U);
    EXPECT_EQ(m.turns[0].to, Method::bdf);
    EXPECT_NE(m.turns[0].why.find("stiff"), std::string::npos) << m.turns[0].why;
    EXPECT_NEAR(found.number(4, "th"), bdf.number(4, "th"), 1e-6);
    // The choice is the same every time, at the same place.
    const Result again = motion(kStiff, 10, {Method::automatic, power_of_ten(8), most});
    EXPECT_EQ(again.rows.rows(), found.rows.rows());
    EXPECT_EQ(again.report.method.trial_evaluations, m.trial_evaluations);
  }
}

// Rows of small tolerance, and motions that are not stiff, stay with Taylor's method at any cost.
TEST(Course, NothingElseGoesByBdf) {
  const Result sharp = motion(kStiff, Rational(1, 5), {Method::automatic, power_of_ten(12)});
  EXPECT_TRUE(sharp.report.outcome.ok());
  EXPECT_GT(sharp.report.method.taylor_steps, 2048U);
  EXPECT_EQ(sharp.report.method.trials, 0U);
  const Result smooth = motion(test::shipped_text("zoo/chaplygin-sleigh"), 4000, {Method::automatic, power_of_ten(8)});
  EXPECT_EQ(smooth.report.method.steps, 0U);
  const Result disc = motion(test::shipped_text("zoo/disc"), 450, {Method::automatic, power_of_ten(8)});
  EXPECT_GT(disc.report.method.taylor_steps, 4096U);
  EXPECT_GT(disc.report.method.trials, 0U) << "it was not even tried";
  EXPECT_EQ(disc.report.method.steps, 0U);
}

// At a tolerance that BDF does not support, a long stiff motion is reported as stiff, also if it does not reach its
// end.
TEST(Course, StiffMotionsWithTightTolerancesAreTold) {
  const auto told = [](const Result& r) {
    return std::count_if(r.report.notes.begin(), r.report.notes.end(),
                         [](const std::string& note) { return note.find("is stiff: BDF") != std::string::npos; });
  };
  const Result whole = motion(kStiff, 10, {Method::automatic, power_of_ten(12)});
  EXPECT_TRUE(whole.report.outcome.ok());
  EXPECT_EQ(told(whole), 1);
  EXPECT_EQ(whole.report.method.trials, 0U);
  const Result stopped = motion(kStiff, 10, {Method::automatic, power_of_ten(12), 20'000});
  EXPECT_EQ(stopped.report.outcome.kind, OutcomeKind::interrupted);
  EXPECT_EQ(told(stopped), 1);
  const Result smooth = motion(test::shipped_text("zoo/disc"), 8000, {Method::automatic, power_of_ten(12)});
  EXPECT_GT(smooth.report.steps, 80'000U);
  EXPECT_EQ(told(smooth), 0);
}

TEST(Course, KinksAreMetToTheTolerance) {
  const Result expected = motion(kTable, 20, {Method::taylor, power_of_ten(14)});
  ASSERT_TRUE(expected.report.outcome.ok()) << expected.report.outcome.message;
  for (const int digits : {5, 7, 9, 11}) {
    const Result rk = motion(kTable, 20, {Method::runge_kutta, power_of_ten(digits)});
    ASSERT_TRUE(rk.report.outcome.ok()) << rk.report.outcome.message;
    EXPECT_LT(difference(rk, expected), 30 * std::pow(10.0, -digits)) << digits;
  }
}

// A blade whose edge wears by the force on it.
const char* const kWear = R"toml(
coordinates = ["x", "y", "th"]
[[body]]
name = "plate"
mass = 1
inertia = 0.1
center = "x*ex + y*ey + 0.2*(cos(th)*ex + sin(th)*ey)"
angle = "th"
[[constraint]]
name = "blade"
equation = "y'*cos(th) - x'*sin(th) = 0"
[state]
wear = {rate = "sqrt(1 + lambda.blade^2 + th''^2)", initial = 0}
[initial]
"x'" = 1
"th'" = 1
)toml";

// Accelerations and multipliers follow from linear equations here, and the nonlinear rate follows from them.
TEST(Course, RatesOfStatesMayBeNonlinear) {
  const Result taylor = motion(kWear, 5, {Method::taylor, power_of_ten(14)});
  ASSERT_TRUE(taylor.report.outcome.ok()) << taylor.report.outcome.message;
  for (const Method method : {Method::runge_kutta, Method::bdf}) {
    const Result other = motion(kWear, 5, {method, power_of_ten(9)});
    ASSERT_TRUE(other.report.outcome.ok()) << other.report.outcome.message;
    EXPECT_LT(difference(other, taylor), 1e-7);
    EXPECT_GT(other.report.method.evaluations, 0U);
  }
}

// If the error test alone met the kinks, each would cost a dozen refusals and as many short steps.
TEST(Course, StepsEndAtKinks) {
  const Result rk = motion(kTable, 20, {Method::runge_kutta, power_of_ten(8)});
  EXPECT_LT(rk.report.method.refused, rk.report.method.steps / 10);
}

// A particle with a stiff spring, or with none to speak of, which a force of the time moves sideways; exact is y at 520.
std::string pushed(const std::string& spring, const std::string& push) {
  return "coordinates = [\"x\", \"y\"]\nparticle = [{name = \"a\", mass = 1, position = \"x*ex + y*ey\"}]\n"
         "force = [{on = \"a\", vector = \"(" +
         spring + ")*ex + (" + push +
         ")*ey\"}]\ninitial = {x = 1, y = 0}\n"
         "table = [{name = \"f\", x = [0, 500, 501, 502, 503], y = [0, 0, 3, 0, 0]}]\n";
}

// Between two points at which a method evaluates the force, a force may act and end. Steps end where the time alone
// decides, so no such force is passed over.
TEST(Course, ForcesThatActForATimeAreSeen) {
  struct Push {
    std::string force;
    double y;
  };
  const std::string stiff = "-1e6*x - 1e5*x' - 1e5*x^3", soft = "-1e-8*x";
  const double root = std::sqrt(std::numbers::pi);
  for (const Push& push :
       {Push{"piecewise(t < 500, 0, t < 510, 0.3, 0)", 45}, Push{"f(t)", 57},
        Push{"piecewise(abs(t - 500) < 0.5, 3, 0)", 60}, Push{"3*exp(-(t - 500)^2)", 60 * root},
        Push{"(t - 500)*exp(-(t - 500)^2)", -root / 2}, Push{"tanh(100*(t - 500)) - tanh(100*(t - 501))", 39}}) {
    // An error of the velocity moves the particle for 20 units of time.
    const auto expect = [&](const std::string& spring, const Asked& asked) {
      const Result r = motion(pushed(spring, push.force), 520, asked);
      ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
      EXPECT_NEAR(r.number(4, "y"), push.y, 20 * asked.tolerance.get_d() * (1 + std::abs(push.y))) << push.force;
    };
    expect(stiff, {Method::bdf, power_of_ten(6)});
    expect(stiff, {Method::automatic, power_of_ten(6)});
    expect(soft, {Method::runge_kutta, power_of_ten(4)});
    expect(soft, {Method::bdf, power_of_ten(4)});
  }
}

// Rows close to a kink, before, at and behind it, lie on the same motion, whatever the last stages of a step see.
TEST(Course, RowsAtKinksOfTheTime) {
  for (const Method method : {Method::runge_kutta, Method::bdf})
    for (const int way : {1, -1}) {
      const std::string since = way > 0 ? "t" : "-t";
      Scenario s;
      ASSERT_TRUE(make_scenario(test::model_of(pushed("-1e-8*x", "piecewise(" + since + " < 100, 0, " + since +
                                                                     " < 101, 1e3, 0)")),
                                *find_formulation("routh"), {}, s)
                      .ok());
      SimulationOptions o;
      o.to = Rational(way * 200);
      o.tolerance = power_of_ten(6);
      o.method = method;
      for (const Rational& t : {Rational(99), Rational(100), Rational(100) + power_of_ten(13), Rational(201, 2),
                                Rational(101), Rational(101) + power_of_ten(13), Rational(200)})
        o.at.push_back(Rational(way) * t);
      std::sort(o.at.begin(), o.at.end());
      Result r;
      r.report = simulate(s, o, r.rows);
      ASSERT_TRUE(r.report.outcome.ok()) << r.report.outcome.message;
      ASSERT_EQ(r.rows.rows().size(), o.at.size());
      for (std::size_t i = 0; i < o.at.size(); ++i) {
        const double t = std::abs(r.number(i, "t")), pushed_for = std::clamp(t - 100, 0.0, 1.0),
                     y = 500 * pushed_for * pushed_for + 1e3 * std::max(0.0, t - 101);
        EXPECT_NEAR(r.number(i, "y'"), way * 1e3 * pushed_for, 1e-2) << t;
        EXPECT_NEAR(r.number(i, "y"), y, 1e-2 + 1e-5 * y) << t;
      }
    }
}

// A particle among many fixed attracting points: its evaluation is long, its unknowns are few.
std::string among_many() {
  std::string x, y;
  for (int k = -6; k <= 6; ++k) {
    const std::string a = std::to_string(k), b = std::to_string(k * k % 7),
                      force = "((x - (" + a + "))^2 + (y - " + b + ")^2 + 1)^(-3/2)";
    x += " + (" + a + " - x)*" + force;
    y += " + (" + b + " - y)*" + force;
  }
  return "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex + "
         "y*ey\"\n[[force]]\nname = \"f\"\non = \"p\"\nvector = \"(" +
         x.substr(3) + ")*ex + (" + y.substr(3) + ")*ey\"\n[initial]\nx = 0.3\ny = 0.1\n\"x'\" = 0.5\n\"y'\" = 0.2\n";
}

TEST(Course, LooseTolerancesGoByRungeKutta) {
  const std::string text = among_many();
  const Result found = motion(text, 150, {Method::automatic, power_of_ten(4)}),
               taylor = motion(text, 150, {Method::taylor, power_of_ten(4)});
  ASSERT_TRUE(found.report.outcome.ok()) << found.report.outcome.message;
  ASSERT_EQ(found.report.method.turns.size(), 1U);
  EXPECT_EQ(found.report.method.turns[0].to, Method::runge_kutta);
  EXPECT_LT(found.report.method.taylor_steps, 100U);
  EXPECT_GT(taylor.report.method.taylor_steps, 200U);
  // The end time is short enough that the motion still depends on its start.
  const Result exact = motion(text, 10, {Method::taylor, power_of_ten(12)});
  EXPECT_LT(difference(motion(text, 10, {Method::runge_kutta, power_of_ten(4)}), exact),
            10 * difference(motion(text, 10, {Method::taylor, power_of_ten(4)}), exact))
      << "cheaper, not worse";
  const Result sharp = motion(text, 150, {Method::automatic, power_of_ten(7)});
  EXPECT_EQ(sharp.report.method.steps, 0U);
}

// x = -cos t; x y' = 0 does not determine y' at x = 0, where no multiplier has a pole and the pivot, a square, keeps
// its sign.
TEST(Course, SingularPointsAreNotPassed) {
  const auto hold = [](const std::string& factor) {
    return "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex + "
           "y*ey\"\n[[force]]\nname = \"f\"\non = \"p\"\n"
           "vector = \"-x*ex\"\n[[constraint]]\nname = \"hold\"\nequation = \"" +
           factor + "*y' = 0\"\n[initial]\nx = -1\ny = 0\n\"x'\" = 0\n\"y'\" = 0\n";
  };
  for (const Method m : {Method::taylor, Method::runge_kutta, Method::bdf})
    for (const int digits : {4, 6, 9}) {
      const Result r = motion(hold("x"), 4, {m, power_of_ten(digits)});
      EXPECT_EQ(r.report.outcome.kind, OutcomeKind::singular)
          << name(m) << " " << digits << ": " << r.report.outcome.message;
      EXPECT_NEAR(r.report.t, std::numbers::pi / 2, 1e-3) << name(m) << " " << digits;
      const Result regular = motion(hold("(x + 3)"), 4, {m, power_of_ten(digits)});
      EXPECT_TRUE(regular.report.outcome.ok()) << name(m) << " " << digits << ": " << regular.report.outcome.message;
      if (m != Method::taylor) {
        EXPECT_EQ(regular.report.method.taylor_steps, 0U) << "nothing is suspected without need";
      }
    }
}

// Where another method cannot continue, Taylor's method does, and stops at the same time as alone.
TEST(Course, TheEndsOfAMotionAreTaylors) {
  const std::string table = test::replaced(kTable, "outside = \"linear\"", "outside = \"error\"");
  const std::string mass = "coordinates = [\"x\"]\n[functions]\nm = \"1 - t/3\"\n[[particle]]\nname = \"p\"\nmass = "
                           "\"m\"\nposition = \"x*ex\"\n"
                           "[[force]]\nname = \"f\"\non = \"p\"\nvector = \"ex\"\n";
  const std::string blow = "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n"
                           "[[force]]\nname = \"f\"\non = \"p\"\nvector = \"6*x^2*ex\"\n[initial]\nx = 1\n\"x'\" = 2\n";
  for (const std::string& text : {test::replaced(table, "x = 1.25", "x = 1.25\n\"x'\" = 6"), mass, blow}) {
    const Result expected = motion(text, 20, {Method::taylor, power_of_ten(10)}),
                 rk = motion(text, 20, {Method::runge_kutta, power_of_ten(10)});
    EXPECT_FALSE(expected.report.outcome.ok());
    EXPECT_EQ(rk.report.outcome.kind, expected.report.outcome.kind) << rk.report.outcome.message << "\n"
                                                                    << expected.report.outcome.message;
    EXPECT_EQ(rk.report.outcome.message.substr(0, 40), expected.report.outcome.message.substr(0, 40));
    EXPECT_GT(rk.report.method.steps, 0U);
    EXPECT_NEAR(rk.report.t, expected.report.t, 1e-5);
  }
}

// x = -cos t, and x y' = 0 does not determine y' at x = 0. The motion stops at a step that ends before this point, or
// at one that cannot be made.
TEST(Course, TheLastRowOfAStopIsOfItsTime) {
  const std::string text = R"(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
force = [{name = "f", on = "p", vector = "-x*ex"}]
constraint = [{name = "hold", equation = "x*y' = 0"}]
initial = {x = -1, "x'" = 0, y = 0, "y'" = 0}
)";
  for (const int digits : {4, 6, 8, 10, 12, 14, 15}) {
    const Result r = motion(text, 4, {Method::taylor, power_of_ten(digits)});
    EXPECT_EQ(r.report.outcome.kind, OutcomeKind::singular) << r.report.outcome.message;
    ASSERT_EQ(r.rows.rows().size(), 3U) << "at 0, at 1, and the last good state";
    const double t = r.number(2, "t");
    EXPECT_GT(t, 1);
    EXPECT_LT(t, std::numbers::pi / 2);
    EXPECT_NEAR(r.number(2, "x"), -std::cos(t), 1e-3 * std::pow(10, 4 - digits) + 1e-14)
        << "at t = " << t << ", to " << digits << " digits";
  }
}

TEST(Course, ShippedModelsStayTaylors) {
  for (const char* name : {"zoo/disc", "zoo/chaplygin-sleigh", "zoo/rocket", "zoo/tether"}) {
    const std::string text = test::shipped_text(name);
    const Result chosen = motion(text, 1, {Method::automatic, power_of_ten(12)}),
                 taylor = motion(text, 1, {Method::taylor, power_of_ten(12)});
    EXPECT_EQ(chosen.rows.rows(), taylor.rows.rows()) << name;
    EXPECT_EQ(chosen.report.method.trials, 0U) << name;
  }
}

// A stretch of steps has the course of its steps one by one: trials of other methods begin after the same steps.
TEST(Course, AStretchTakesTheCourseOfItsSteps) {
  struct Run {
    MethodReport report;
    std::vector<long double> times, state;
  };
  const auto run = [](const std::string& text, double log_tolerance, long double end, std::size_t most) {
    Scenario s;
    if (const Outcome o = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s); !o.ok())
      throw std::runtime_error(o.message);
    Workspace w(s);
    StepSettings settings;
    settings.log_tolerance = log_tolerance;
    Course<double> course(w, settings, Method::automatic, {}, 1);
    Outcome o = course.start({});
    Run r;
    Stretch<long double> stretch;
    while (o.ok() && !(course.time() == end)) {
      stretch.restart();
      stretch.most = most;
      o = course.steps(end, stretch);
      r.times.insert(r.times.end(), stretch.times.begin(), stretch.times.end());
    }
    EXPECT_TRUE(o.ok()) << o.message;
    r.report = course.report();
    r.state = course.taylor().stepper().state();
    return r;
  };
  struct Case {
    std::string text;
    double log_tolerance;
    long double end;
  };
  std::size_t turns = 0, trials = 0;
  for (const Case& c :
       {Case{kStiff, std::log(1e-7), 3}, Case{test::shipped_text("zoo/disc"), std::log(1e-4), 30},
        Case{test::shipped_text("zoo/disc"), std::log(1e-10), 1500}, Case{kTable, std::log(1e-9), 60}}) {
    const Run one = run(c.text, c.log_tolerance, c.end, 1), many = run(c.text, c.log_tolerance, c.end, 64);
    EXPECT_EQ(one.times, many.times);
    EXPECT_EQ(one.state, many.state);
    EXPECT_EQ(one.report.trials, many.report.trials);
    EXPECT_EQ(one.report.steps, many.report.steps);
    EXPECT_EQ(one.report.taylor_steps, many.report.taylor_steps);
    ASSERT_EQ(one.report.turns.size(), many.report.turns.size());
    for (std::size_t i = 0; i < one.report.turns.size(); ++i) EXPECT_EQ(one.report.turns[i].t, many.report.turns[i].t);
    turns += one.report.turns.size(), trials += one.report.trials;
  }
  EXPECT_GT(turns, 0U) << "no motion of these has turned to another method";
  EXPECT_GT(trials, 2U);
}

}  // namespace
}  // namespace anholon::course_test

// A run that is saved and continued gives the rows of the run that never stopped, bit by bit.
#include <sstream>

#include <gtest/gtest.h>

#include "support/models.h"
#include "support/motion.h"
#include "support/rows.h"

namespace anholon::restart_test {
namespace {

struct Case {
  const char* name;
  const char* model;
  const char* form = "routh";
  Precision precision = Precision::real;
  int digits = 16;
  Rational half{1}, whole{2};
  bool steps = false;  // rows at the steps
};

struct Result {
  std::vector<std::vector<std::string>> rows;
  SimulationReport report;
  std::string saved;
};

// With `most_steps` the run ends between requested rows and has no row of its own there.
Result run(const Case& c, const Rational& to, const SavedRun* resume, const std::string& set_apart = {},
           std::size_t most_steps = 0) {
  Scenario s;
  EXPECT_TRUE(
      make_scenario(test::model_of(test::shipped_text(c.model) + set_apart), *find_formulation(c.form), {}, s).ok());
  SimulationOptions o;
  o.to = to;
  if (!c.steps) o.every = Rational(1, 8);
  o.precision = c.precision;
  o.digits = c.digits;
  if (c.digits > 16) o.tolerance = Rational(1, mpz_class("1" + std::string(static_cast<std::size_t>(c.digits), '0')));
  o.resume = resume;
  if (most_steps > 0) o.most_steps = most_steps;
  Result r;
  o.save = [&](const SavedRun& run) { r.saved = print(run); };
  test::TextRows sink;
  r.report = simulate(s, o, sink);
  EXPECT_EQ(r.report.outcome.kind, most_steps > 0 ? OutcomeKind::interrupted : OutcomeKind::finished)
      << r.report.outcome.message;
  r.rows = sink.rows();
  return r;
}

class Restart : public testing::TestWithParam<Case> {};

TEST_P(Restart, GoesOnWithTheSameBits) {
  const Case& c = GetParam();
  const std::string monitor = "\n[monitor]\nwatched = \"t^2\"\n";
  Result first = run(c, c.half, nullptr, monitor);
  // If rows are at the steps, the end of the first run is one more row, with residuals of its own.
  if (c.steps) first = run(c, c.whole, nullptr, monitor, first.report.steps);
  const SavedRun saved = read_saved({"run.state", first.saved});
  const Result second = run(c, c.whole, &saved, monitor), whole = run(c, c.whole, nullptr, monitor);
  ASSERT_GT(second.rows.size(), 2U);
  ASSERT_GT(whole.rows.size(), second.rows.size());
  const std::vector<std::vector<std::string>> tail(whole.rows.end() - static_cast<std::ptrdiff_t>(second.rows.size()),
                                                   whole.rows.end());
  EXPECT_EQ(second.rows, tail);
  if (!c.steps) {
    EXPECT_EQ(first.rows.size() + second.rows.size(), whole.rows.size());
  }
  EXPECT_EQ(second.report.steps, whole.report.steps);
  EXPECT_EQ(second.report.eliminations, whole.report.eliminations);
  EXPECT_EQ(second.report.power, whole.report.power);
  EXPECT_EQ(second.report.newton, whole.report.newton);
  EXPECT_EQ(second.report.constraints, whole.report.constraints);
  EXPECT_EQ(second.report.smallest_sigma, whole.report.smallest_sigma);
  EXPECT_EQ(second.saved, whole.saved);
}

INSTANTIATE_TEST_SUITE_P(
    Runs, Restart,
    testing::Values(Case{"Sleigh", "zoo/chaplygin-sleigh"}, Case{"DoublePendulum", "zoo/double-pendulum-cartesian"},
                    Case{"AtTheSteps", "zoo/double-pendulum-cartesian", "routh", Precision::real, 16, 1, 2, true},
                    Case{"ConstantJerk", "zoo/constant-jerk"},
                    // Its equations are written anew between the two runs
                    Case{"WrittenAnew", "zoo/two-wheeled-pendulum", "routh", Precision::real, 16, 150, 165},
                    Case{"InQuasiVelocities", "zoo/disc"},
                    Case{"InQuasiVelocitiesAtTheSteps", "zoo/snakeboard", "routh", Precision::real, 16, 1, 2, true},
                    Case{"Backwards", "zoo/disc", "routh", Precision::real, 16, -1, -2},
                    // Chaplygin's form divides by cos(theta), which vanishes on the way.
                    Case{"Elimination", "zoo/chaplygin-sleigh", "chaplygin", Precision::real, 16, 5, 10},
                    Case{"LongDouble", "zoo/disc", "routh", Precision::long_real},
                    Case{"Quad", "zoo/chaplygin-sleigh", "routh", Precision::quad},
                    Case{"ThirtyDigits", "zoo/chaplygin-sleigh", "routh", Precision::multi, 30}),
    [](const auto& p) { return std::string(p.param.name); });

TEST(Restart, TheEliminationChangesBeforeAndAfter) {
  const Case c{"", "zoo/chaplygin-sleigh", "chaplygin", Precision::real, 16, 5, 10};
  const std::size_t all = run(c, 20, nullptr).report.eliminations.value();
  EXPECT_GE(all, 1U) << "the case above must hold a change of the elimination";
}

// The run is stopped between any two steps, also next to a change of the elimination.
TEST(Restart, GoesOnFromEveryStep) {
  const auto motion = [](std::size_t most_steps, const SavedRun* resume, std::string* saved) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::shipped("zoo/chaplygin-sleigh"), *find_formulation("chaplygin"), {}, s).ok());
    SimulationOptions o;
    o.to = 4;
    o.most_steps = most_steps;
    o.resume = resume;
    o.save = [&](const SavedRun& run) { *saved = print(run); };
    test::TextRows sink;
    const SimulationReport report = simulate(s, o, sink);
    EXPECT_EQ(report.outcome.kind, most_steps < 1000 ? OutcomeKind::interrupted : OutcomeKind::finished)
        << report.outcome.message;
    return std::pair(sink.rows(), report);
  };
  std::string end, middle, again;
  const auto [all, whole] = motion(1000, nullptr, &end);
  ASSERT_GE(whole.eliminations, 1U);
  for (std::size_t k = 1; k < whole.steps; ++k) {
    motion(k, nullptr, &middle);
    const SavedRun saved = read_saved({"run.state", middle});
    const auto [rows, report] = motion(1000, &saved, &again);
    const std::size_t first = k + 1;  // rows at the start and at k steps were given before
    ASSERT_EQ(rows.size() + first, all.size()) << k;
    EXPECT_TRUE(std::equal(rows.begin(), rows.end(), all.begin() + static_cast<std::ptrdiff_t>(first)))
        << "after " << k << " steps";
    EXPECT_EQ(report.eliminations, whole.eliminations) << k;
    EXPECT_EQ(test::of_the_motion(again), test::of_the_motion(end)) << k;
  }
}

// An event sets a mode before the run is saved; none sets it afterwards.
TEST(Restart, GoesOnWithTheModesThatEventsHaveSet) {
  const auto motion = [](Precision precision, const Rational& to, const SavedRun* resume, std::string* saved) {
    Scenario s;
    EXPECT_TRUE(make_scenario(test::model_of(R"toml(
coordinates = ["x"]
mode.n = 1
[[particle]]
name = "p"
mass = 1
position = ["x", "0", "0"]
[[force]]
on = "p"
vector = ["-4*n*x", "0", "0"]
[[event]]
name = "cross"
when = "x"
set = {n = "n + 1"}
[monitor]
gear = "n"
[initial]
x = 1
"x'" = 0
)toml"),
                              *find_formulation("routh"), {}, s)
                    .ok());
    SimulationOptions o;
    o.to = to;
    o.every = Rational(1, 8);
    o.precision = precision;
    o.resume = resume;
    o.save = [&](const SavedRun& run) { *saved = print(run); };
    test::TextRows sink;
    SimulationReport report = simulate(s, o, sink);
    EXPECT_TRUE(report.outcome.ok()) << report.outcome.message;
    return std::pair(sink.rows(), report);
  };
  for (const Precision precision : {Precision::real, Precision::long_real}) {
    std::string middle, end;
    motion(precision, Rational(1), nullptr, &middle);
    const SavedRun saved = read_saved({"run.state", middle});
    const auto [rows, report] = motion(precision, Rational(3, 2), &saved, &end);
    const auto [all, whole] = motion(precision, Rational(3, 2), nullptr, &end);
    ASSERT_EQ(whole.events.size(), 1U);
    ASSERT_EQ(rows.size(), 4U);
    EXPECT_EQ(rows, std::vector(all.end() - 4, all.end()));
    EXPECT_EQ(report.power, whole.power);
    EXPECT_TRUE(report.warnings.empty());
  }
}

TEST(Restart, RefusesWhatDoesNotFit) {
  const Case c{"", "zoo/chaplygin-sleigh"};
  const std::string saved = run(c, 1, nullptr).saved;
  const auto refusal = [](const std::string& text) -> std::string {
    try {
      read_saved({"run.state", text});
    } catch (const Failure& f) {
      return f.diagnostic.message;
    }
    return {};
  };
  EXPECT_EQ(refusal(saved), "");
  EXPECT_EQ(refusal("coordinates = []\n"), "this is not a saved run");
  EXPECT_EQ(refusal(test::replaced(saved, "counts", "countz")),
            "the saved run was changed after it was written, or is cut off");
  // The saved run belongs to a larger system.
  const SavedRun of_another = read_saved({"run.state", run({"", "zoo/disc"}, 1, nullptr).saved});
  EXPECT_THROW(run(c, 2, &of_another), Failure);
}

TEST(Restart, NumbersAsTextKeepTheirBits) {
  EXPECT_EQ(parse_exact<double>(exact_text(0.1)), 0.1);
  EXPECT_EQ(parse_exact<long double>(exact_text(-1.0L / 3)), -1.0L / 3);
  EXPECT_TRUE(std::signbit(*parse_exact<double>(exact_text(-0.0))));
  const Quad sevenths = -Quad(1) / Quad(7);
  EXPECT_TRUE(*parse_exact<Quad>(exact_text(sevenths)) == sevenths);
  EXPECT_FALSE(parse_exact<Quad>("0x1p3x"));
  const PrecisionScope precision(40);
  const Multi third = Multi(1) / Multi(3);
  EXPECT_TRUE(*parse_exact<Multi>(exact_text(third)) == third);
  EXPECT_FALSE(parse_exact<double>("0x1p3x"));
  EXPECT_FALSE(parse_exact<Multi>(""));
}

}  // namespace
}  // namespace anholon::restart_test

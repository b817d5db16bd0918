// Extremes and means of motions: of polynomials, compared with fine sampling, and of cases, compared with dense rows.
// The bits are the same for any number of threads and lanes.
#include <algorithm>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "ensemble/table.h"
#include "support/models.h"

namespace anholon::reduction_test {
namespace {

const char* const kPendulum = R"toml(
coordinates = ["x", "y"]
[parameters]
m = 1
l = 2
[[particle]]
name = "bob"
mass = "m"
position = "x*ex + y*ey"
[[force]]
name = "weight"
on = "bob"
vector = "-10*m*ey"
[[constraint]]
name = "rod"
equation = "x^2 + y^2 = l^2"
[initial]
x = 1
guess = {y = -1}
[output]
height = "y + l"
)toml";

// An event that ends the motion of some cases; no case in lanes has an event.
const char* const kStop = R"toml(
[[event]]
name = "turned"
when = "x + 0.9"
direction = "down"
stop = true
)toml";

const char* const kOscillator = R"toml(
coordinates = ["x"]
particle = [{name = "p", mass = 1, position = "x*ex"}]
potential.V = "x^2/2"
initial = {x = 1}
)toml";

class Results final : public CaseSink {
 public:
  void result(const CaseResult& r) override { list.push_back(r); }
  std::vector<CaseResult> list;
};

struct Sweep {
  Sweep(const std::string& text, const std::vector<std::string>& words) {
    Diagnostics diagnostics;
    open = open_model({"model.toml", text}, diagnostics);
    if (!open) throw std::runtime_error(diagnostics.print({"model.toml", text}));
    for (const std::string& word : words) options.reductions.add(word, *open);
    EXPECT_TRUE(make_scenario(open->model, *find_formulation("routh"), {}, scenario).ok());
    options.to = 3;
    options.varied = {{Varied::Kind::initial, 0, 0, "x"}};
  }
  std::vector<CaseResult> go(std::size_t cases, std::size_t threads) {
    options.cases = cases;
    options.threads = threads;
    options.numbers = [](std::size_t k) { return EnsembleCase{{Rational(50 + static_cast<long>(k % 100), 100)}, {}}; };
    Results results;
    report = ensemble(scenario, options, results);
    return results.list;
  }
  // One case, x = cos t up to t = 10.
  CaseResult one() {
    options.to = 10;
    options.cases = 1;
    options.varied = {{Varied::Kind::initial, 0, 1, "x'"}};
    options.numbers = [](std::size_t) { return EnsembleCase{{Rational(0)}, {}}; };
    Results results;
    report = ensemble(scenario, options, results);
    return results.list.at(0);
  }
  std::optional<OpenModel> open;  // its graph holds the formulas
  Scenario scenario;
  EnsembleOptions options;
  EnsembleReport report;
};

double value(const std::vector<double>& c, double x) {
  double s = 0;
  for (std::size_t k = c.size(); k-- > 0;) s = s * x + c[k];
  return s;
}

TEST(Reduction, TheGreatestValueOfAPolynomialIsFound) {
  const std::vector<std::vector<double>> list = {{1},
                                                 {0, 1},
                                                 {0, -1},
                                                 {0, 1, -1},
                                                 {0, 0, 0, 1, -2, 0.5},
                                                 {1, -9, 24, -20, 3, 1},
                                                 {0, 1, -8.5, 24, -29, 12.5},
                                                 {0.3, 0, -1},
                                                 {-1, 0, 0, 0, 0, 0, 0}};
  for (const auto& c : list)
    for (const double h : {1.0, -1.0, 2.3, 0.1}) {
      constexpr int kSamples = 20'000;
      double most = -INFINITY;
      for (int k = 0; k <= kSamples; ++k) most = std::max(most, value(c, h * k / kSamples));
      const double found = greatest_on(c.data(), static_cast<int>(c.size()) - 1, h, -INFINITY);
      // Samples miss an extreme by the second order of their distance.
      EXPECT_GE(found, most - 1e-14 * (1 + std::abs(most)));
      EXPECT_LE(found, most + 1e-6 * (1 + std::abs(most)));
      EXPECT_EQ(greatest_on(c.data(), static_cast<int>(c.size()) - 1, h, 1e6), 1e6);
    }
}

// x = sin t, with so many other formulas that series of several formulas are parts of the series of the unknowns.
TEST(Reduction, AnyNumberOfFormulasIsFollowed) {
  for (const int others : {0, 3, 13, 15, 20, 40}) {
    std::vector<std::string> words{"last(x)", "mean(x)", "last(v)", "mean(v)"};
    for (int k = 1; k <= others; ++k) words.push_back("max(x + " + std::to_string(k) + ")");
    Sweep run(R"toml(
coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
potential.V = "x^2/2"
initial = {"x'" = 1}
output.v = "x'"
)toml",
              words);
    run.options.to = 20;
    for (const bool kernel : {true, false}) {
      run.options.kernel = kernel;
      for (const CaseResult& r : run.go(9, 1)) {
        ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
        const double a = 0.5 + 0.01 * static_cast<double>(r.number % 100), s = std::sin(20), c = std::cos(20);
        const double expected[] = {a * c + s, (a * s + 1 - c) / 20, c - a * s, (a * c + s - a) / 20};
        for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(r.reduced[i], expected[i], 1e-11) << others << " " << words[i];
      }
    }
  }
}

// The motion is a polynomial and needs one step only: the series of some formulas converge less far, or do not exist.
TEST(Reduction, FormulasNeedNotConvergeWithTheMotion) {
  Sweep run(R"toml(
coordinates = ["x", "z"]
gravity.field = "-10*ez"
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
initial = {"z'" = 10}
)toml",
            {"last(cos(5*x))", "mean(sin(5*x))", "max(norm(vel(p)))", "min(norm(vel(p)))", "mean(exp(-x^2))",
             "mean(abs(z'))", "mean(cos(x^3))"});
  run.options.varied = {{Varied::Kind::initial, 0, 1, "x'"}};
  for (const CaseResult& r : run.go(4, 1)) {
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    const double v = r.values[0], end = 3 * v;
    EXPECT_NEAR(r.reduced[0], std::cos(5 * end), 1e-10);
    EXPECT_NEAR(r.reduced[1], (1 - std::cos(5 * end)) / (5 * end), 1e-10);
    EXPECT_NEAR(r.reduced[2], std::hypot(v, 20), 1e-9);
    EXPECT_NEAR(r.reduced[3], v, 1e-9);
    EXPECT_NEAR(r.reduced[4], std::sqrt(std::atan(1)) * std::erf(end) / end, 1e-10);
    EXPECT_NEAR(r.reduced[5], 25.0 / 3, 1e-9);
    double sum = 0;
    constexpr int kParts = 20000;
    for (int k = 0; k < kParts; ++k) sum += std::cos(std::pow(end * (k + 0.5) / kParts, 3));
    EXPECT_NEAR(r.reduced[6], sum / kParts, 1e-6);
  }
  EXPECT_EQ(run.report.in_workspaces, 0U);
}

// Last values are the values of the formulas at the end: cos(40 x) turns often in the one step of the motion, which
// stays one step, and the distance has no series at the start.
TEST(Reduction, LastValuesShortenNoStep) {
  const std::string text = R"toml(
coordinates = ["x", "z"]
gravity.field = "-10*ez"
particle = [{name = "p", mass = 1, position = "x*ex + z*ez"}]
initial = {"z'" = 10}
)toml";
  const std::vector<std::string> words{"last(cos(40*x))", "last(sqrt(x^2+z^2))", "last(sqrt(x))"};
  Sweep without(text, {}), run(text, words);
  for (Sweep* s : {&without, &run}) s->options.varied = {{Varied::Kind::initial, 0, 1, "x'"}};
  const auto plain = without.go(4, 1);
  const auto list = run.go(4, 1);
  for (std::size_t k = 0; k < list.size(); ++k) {
    const CaseResult& r = list[k];
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    const double end = 3 * r.values[0];
    EXPECT_EQ(r.steps, plain[k].steps);
    EXPECT_EQ(r.last, plain[k].last);
    EXPECT_NEAR(r.reduced[0], std::cos(40 * end), 1e-11);
    EXPECT_NEAR(r.reduced[1], std::hypot(end, 15), 1e-12);
    EXPECT_NEAR(r.reduced[2], std::sqrt(end), 1e-12);
  }
  EXPECT_EQ(run.report.in_workspaces, 0U);
}

// A norm at rest, and an angle at the ends of its range: values beside these points are taken.
TEST(Reduction, FormulasMayHaveNoDerivativesOnTheWay) {
  Sweep run(R"toml(
coordinates = ["x"]
particle = [{name = "p", mass = 1, position = "x*ex"}]
potential.V = "x^2/2"
initial = {x = 1}
)toml",
            {"mean(norm(vel(p)))", "max(norm(vel(p)))", "max(acos(x))", "mean(acos(x))"});
  run.options.to = 4;
  run.options.varied = {{Varied::Kind::initial, 0, 1, "x'"}};
  run.options.numbers = [](std::size_t) { return EnsembleCase{{Rational(0)}, {}}; };
  run.options.cases = 1;
  Results results;
  const EnsembleReport report = ensemble(run.scenario, run.options, results);
  const CaseResult& r = results.list.at(0);
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  const double pi = 4 * std::atan(1);
  EXPECT_NEAR(r.reduced[0], (3 + std::cos(4)) / 4, 1e-10);
  EXPECT_NEAR(r.reduced[1], 1, 1e-10);
  EXPECT_NEAR(r.reduced[2], pi, 1e-8);
  EXPECT_NEAR(r.reduced[3], (pi * pi - (2 * pi - 4) * (2 * pi - 4) / 2) / 4, 1e-8);
  EXPECT_TRUE(report.without_value.empty());
}

// x = cos t passes 0.3 three times, in steps at whose start the formula and its derivatives are 0 in double:
// exp(-49000).
TEST(Reduction, APulseWithinAStepIsSeen) {
  constexpr double kMean = 0.00176269447011, kSign = -0.0575222039231;  // mpmath
  Sweep run(kOscillator, {"max(exp(-100000*(x - 0.3)^2))", "mean(exp(-100000*(x - 0.3)^2))",
                          "max(1 + exp(-100000*(x - 0.3)^2))", "max(tanh(1000*x))", "mean(tanh(1000*x))"});
  for (const bool kernel : {true, false}) {
    run.options.kernel = kernel;
    const CaseResult r = run.one();
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_NEAR(r.reduced[0], 1, 1e-11);
    EXPECT_NEAR(r.reduced[1], kMean, 1e-11);
    EXPECT_NEAR(r.reduced[2], 2, 1e-11);
    EXPECT_NEAR(r.reduced[3], 1, 1e-11);
    EXPECT_NEAR(r.reduced[4], kSign, 1e-9);
  }
}

// The motion does not depend on whether a formula has values and derivatives along it.
TEST(Reduction, AFormulaWithoutAValueDoesNotEndTheMotion) {
  Sweep run(kOscillator, {"max(sqrt(x))", "mean(sqrt(x))", "max(1/x)", "min(1/x)", "mean(1/x)", "mean(tan(2*x))",
                          "min(log(abs(x)))", "max(1/sqrt(abs(x)))", "mean(sqrt(abs(x)))", "mean(abs(x)^(1/3))",
                          "mean(log(abs(x)))", "max(log(abs(x)))", "min(sqrt(abs(x)))", "max(sign(x))"});
  for (const bool kernel : {true, false}) {
    run.options.kernel = kernel;
    const CaseResult r = run.one();
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_NEAR(r.last[0], std::cos(10), 1e-12);
    for (std::size_t k = 0; k < 8; ++k) EXPECT_TRUE(std::isnan(r.reduced[k])) << run.options.reductions.list[k].name;
    EXPECT_NEAR(r.reduced[8], 0.774806089878175, 1e-11);  // by mpmath, as the others
    EXPECT_NEAR(r.reduced[9], 0.832579052528112, 1e-10);
    EXPECT_NEAR(r.reduced[10], -0.656560131336238, 1e-8);
    EXPECT_NEAR(r.reduced[11], 0, 1e-12);
    EXPECT_NEAR(r.reduced[12], 0, 1e-8);
    EXPECT_EQ(r.reduced[13], 1);
    EXPECT_EQ(run.report.without_value.size(), 8U);
  }
}

// 3 x - y is round-off all along the motion and changes its sign anywhere; the motion is the one without the reduction.
TEST(Reduction, KinksOfRoundOffMakeNoStepShort) {
  const std::string text = R"toml(
coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
potential.V = "(x^2 + y^2)/2 + (3*x - y)^2/2"
initial = {x = 0.1, y = 0.3}
)toml";
  Sweep without(text, {}), run(text, {"max(abs(3*x - y))", "max(x + abs(y - 3*x))", "mean(sign(3*x - y)*(3*x - y))"});
  for (const bool kernel : {true, false}) {
    without.options.kernel = run.options.kernel = kernel;
    const CaseResult plain = without.one(), r = run.one();
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_LE(r.steps, plain.steps + 2);
    EXPECT_NEAR(r.last[0], plain.last[0], 1e-14);
    EXPECT_NEAR(r.reduced[0], 0, 1e-14);
    EXPECT_NEAR(r.reduced[1], 0.1, 1e-13);
    EXPECT_NEAR(r.reduced[2], 0, 1e-14);
  }
}

// Kinks of a formula that accumulate at a time neither end the motion nor cost endless steps.
TEST(Reduction, KinksThatAddUpDoNotEndTheMotion) {
  Sweep run(kOscillator, {"max(abs((t - 2)*sin(1/(t - 2))))"});
  run.options.most_steps = 4000;
  const CaseResult r = run.one();
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_NEAR(r.last[0], std::cos(10), 1e-12);
  EXPECT_NEAR(r.reduced[0], 8 * std::sin(0.125), 1e-12);
}

// The pendulum rises to the height of its start: y = -sqrt(l^2 - x^2). Its lowest points lie between the ends of steps.
TEST(Reduction, ExtremesAreThoseOfTheMotion) {
  Sweep run(kPendulum, {"max(height)", "min(height)", "last(height)", "mean(x')", "max(abs(x))"});
  const auto list = run.go(4, 1);
  for (const CaseResult& r : list) {
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    const double x = r.values[0], high = 2 - std::sqrt(4 - x * x);
    EXPECT_NEAR(r.reduced[0], high, 1e-11);
    EXPECT_NEAR(r.reduced[1], 0, 1e-11);
    EXPECT_NEAR(r.reduced[2], r.last[4], 1e-11);
    EXPECT_NEAR(r.reduced[3], (r.last[0] - x) / 3, 1e-11);
    EXPECT_NEAR(r.reduced[4], x, 1e-11);  // at both ends of the swing
  }
}

// Cases in lanes, alone, and by `simulate` give the same values, and the number of threads changes no bit.
TEST(Reduction, ThreadsAndLanesHaveNoInfluence) {
  const std::vector<std::string> words = {"max(x')", "min(y)", "mean(height)", "max(lambda)"};
  Sweep run(kPendulum, words);
  const auto one = run.go(100, 1), two = run.go(100, 3), few = run.go(5, 1);
  EXPECT_EQ(run.report.in_workspaces, 0U);
  for (std::size_t k = 0; k < one.size(); ++k) {
    ASSERT_EQ(one[k].reduced.size(), words.size());
    EXPECT_EQ(std::memcmp(one[k].reduced.data(), two[k].reduced.data(), words.size() * sizeof(double)), 0);
    if (k < few.size()) {
      EXPECT_EQ(std::memcmp(one[k].reduced.data(), few[k].reduced.data(), words.size() * sizeof(double)), 0);
    }
  }
  run.options.kernel = false;
  const auto reference = run.go(5, 1);
  for (std::size_t k = 0; k < reference.size(); ++k)
    for (std::size_t i = 0; i < words.size(); ++i)
      EXPECT_NEAR(reference[k].reduced[i], one[k].reduced[i], 1e-11 * (1 + std::abs(one[k].reduced[i])));
}

TEST(Reduction, TheTimeItselfEndsWithTheMotion) {
  Sweep run(kPendulum, {"max(t)", "mean(t)", "min(t)"});
  for (const CaseResult& r : run.go(40, 2)) {
    EXPECT_EQ(r.reduced[0], r.t);
    EXPECT_NEAR(r.reduced[1], r.t / 2, 1e-14);
    EXPECT_EQ(r.reduced[2], 0);
  }
}

TEST(Reduction, AnEventThatEndsACaseIsNamed) {
  Sweep run(std::string(kPendulum) + kStop, {"min(x)", "max(t)"});
  const auto list = run.go(80, 2);
  bool stopped = false, went_on = false;
  for (const CaseResult& r : list) {
    ASSERT_TRUE(r.outcome.ok());
    if (r.event == "turned") {
      stopped = true;
      EXPECT_LT(r.t, 3);
      EXPECT_NEAR(r.reduced[0], -0.9, 1e-11);
      EXPECT_NEAR(r.reduced[1], r.t, 1e-11);
    } else {
      went_on = true;
      EXPECT_EQ(r.event, "");
      EXPECT_EQ(r.t, 3);
      EXPECT_GT(r.reduced[0], -0.9 - 1e-12);  // 0.9 is where one starts and turns
    }
  }
  EXPECT_TRUE(stopped && went_on);
}

// The table has a row for each case and time, also for times that the motion does not reach.
TEST(Reduction, TablesAreLongWithTimes) {
  Sweep run(std::string(kPendulum) + kStop, {"min(x)"});
  run.options.at = {Rational(1, 2), Rational(5, 2)};
  const auto list = run.go(60, 2);
  SweepTable table(*run.scenario.model, run.options);
  std::vector<std::string> names;
  for (const SweepColumn& c : table.columns()) names.push_back(c.name);
  EXPECT_EQ(names, std::vector<std::string>(
                       {"case", "x(0)", "outcome", "event", "t", "x", "y", "x'", "y'", "height", "min(x)"}));
  for (const CaseResult& r : list) {
    std::size_t row = 0;
    table.rows(r, r.number, "", [&](std::span<const SweepCell> cells) {
      EXPECT_EQ(cells[0].number, static_cast<double>(r.number));
      const double t = row++ == 0 ? 0.5 : 2.5;
      EXPECT_EQ(cells[4].number, t);
      EXPECT_EQ(std::isnan(cells[5].number), t > r.t);
      EXPECT_EQ(cells[10].number, r.reduced[0]);
    });
    EXPECT_EQ(row, 2U);
  }
}

// Some cases have residual reports.
TEST(Reduction, ResidualsOfSomeCasesAreLookedAt) {
  Sweep run(kPendulum, {});
  run.options.estimate = ErrorEstimate::short_runs;
  run.go(9, 2);
  EXPECT_EQ(run.report.residuals.cases, std::vector<std::size_t>({0, 4, 8}));
  for (const auto& worst :
       {run.report.residuals.newton, run.report.residuals.constraints, run.report.residuals.power}) {
    EXPECT_GT(worst.residual, 0);
    EXPECT_LT(worst.residual, 1e-11);
  }
}

}  // namespace
}  // namespace anholon::reduction_test

// Ensembles: a case gives the result of `simulate`, and the same bits in any thread and after any other case.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::ensemble_test {
namespace {

const char* const kPendulum = R"toml(
coordinates = ["x", "y"]
[parameters]
m = 1
l = 2
g = 10
weight = "m*g"
[[particle]]
name = "bob"
mass = "m"
position = "x*ex + y*ey"
[[force]]
name = "weight"
on = "bob"
vector = "-weight*ey"
[[constraint]]
name = "rod"
equation = "x^2 + y^2 = l^2"
[initial]
x = 1
guess = {y = -1}
[monitor]
energy = "m*(x'^2 + y'^2)/2 + weight*y"
)toml";

const char* const kBall = R"toml(
coordinates = ["y"]
[parameters]
e = 0.5
[[particle]]
name = "ball"
mass = 1
position = "y*ey"
[[force]]
name = "weight"
on = "ball"
vector = "-10*ey"
[[event]]
name = "bounce"
when = "y"
direction = "down"
set = {"y'" = "-e*y'"}
[initial]
y = 1
)toml";

// A pendulum with events that stop it, that turn it by a set velocity or by a mode, or that are only reported.
const char* const kWatched = R"toml(
coordinates = ["a"]
parameters = {l = 1, g = 9.81}
mode.n = 0
particle = [{name = "p", mass = 1, position = "l*sin(a)*ex - l*cos(a)*ez"}]
gravity.field = "-g*ez"
force = [{on = "p", vector = "n*vel(p)/8"}]
[[event]]
name = "passes"
when = "a - 1/10"
[[event]]
name = "wall"
when = "a + 1/5"
direction = "down"
set = {"a'" = "-9*a'/10", n = "n - 1"}
[[event]]
name = "high"
when = "a - 1"
stop = true
[initial]
a = 0
)toml";

// A pendulum that a table drives and that forces with kinks drag along.
const char* const kKinks = R"toml(
coordinates = ["a"]
parameters = {l = 1, g = 9.81}
table = [{name = "torque", x = [0, 0.3, 0.5, 0.6, 2], y = [0, 2, -1, 3, 0], fit = "spline"}]
particle = [{name = "p", mass = 1, position = "l*sin(a)*ex - l*cos(a)*ez"}]
gravity.field = "-g*ez"
force = [{on = "p", vector = "-vel(p)*norm(vel(p))/8"}, {generalized = {a = "torque(t) - sign(a)"}}]
[initial]
a = 0.4
)toml";

// A pendulum that is pushed for short times, each within one step.
const char* const kPulses = R"toml(
coordinates = ["a"]
parameters = {l = 1, g = 9.81}
particle = [{name = "p", mass = 1, position = "l*sin(a)*ex - l*cos(a)*ez"}]
gravity.field = "-g*ez"
force = [{generalized = {a = "800*(1 - tanh((t - 3)*900)^2) - 800*(1 - tanh((t + 4)*900)^2) - a'/4"}}]
[initial]
a = 0.4
)toml";

class Results final : public CaseSink {
 public:
  void result(const CaseResult& r) override { list.push_back(r); }
  std::vector<CaseResult> list;
};

Varied parameter(const Model& m, const std::string& name) {
  for (std::size_t i = 0; i < m.parameters.size(); ++i)
    if (m.parameters[i].name == name) return {Varied::Kind::parameter, i, 0, name};
  throw std::runtime_error("no parameter " + name);
}
Varied initial(std::size_t coordinate, unsigned order) { return {Varied::Kind::initial, coordinate, order, ""}; }

struct Sweep {
  explicit Sweep(std::string text, const char* form = "routh") : text_(std::move(text)) {
    EXPECT_TRUE(make_scenario(test::model_of(text_), *find_formulation(form), {}, scenario).ok());
    options.to = 1;
  }
  // One list of numbers for each case.
  void cases(const std::vector<std::vector<Rational>>& values) {
    options.cases = values.size();
    options.numbers = [values](std::size_t k) { return EnsembleCase{values[k], {}}; };
  }
  std::vector<CaseResult> go(std::size_t threads = 2) {
    options.threads = threads;
    Results results;
    report = ensemble(scenario, options, results);
    return results.list;
  }
  const Model& model() const { return *scenario.model; }

  Scenario scenario;
  EnsembleOptions options;
  EnsembleReport report;

 private:
  std::string text_;
};

// All bits of the results, as text.
std::string bits(const std::vector<CaseResult>& list) {
  std::string all;
  const auto add = [&](const std::vector<double>& numbers) {
    const std::size_t at = all.size();
    all.resize(at + numbers.size() * sizeof(double));
    if (!numbers.empty()) std::memcpy(&all[at], numbers.data(), numbers.size() * sizeof(double));
  };
  for (const CaseResult& r : list) {
    all += std::to_string(r.number) + name(r.outcome.kind) + r.outcome.message + std::to_string(r.steps) + r.event;
    add({r.t});
    add(r.last);
    for (const auto& row : r.rows) add(row);
  }
  return all;
}

// The last row that `simulate` gives if these parameters are set in the file. Without a kernel no bit may differ.
std::vector<double> simulated(const std::string& text, const Overrides& set, const Rational& to, bool kernel = false) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text, set), *find_formulation("routh"), {}, s).ok());
  SimulationOptions o;
  o.kernel = kernel;
  o.at = {to};
  test::TextRows sink;
  simulate(s, o, sink);
  std::vector<double> row;
  for (const std::string& v : sink.rows().back()) row.push_back(std::stod(v));
  return row;
}

// Lengths, some of which are too short for x = 1, and masses.
std::vector<std::vector<Rational>> lengths(int count) {
  std::vector<std::vector<Rational>> list;
  for (int k = 0; k < count; ++k) list.push_back({Rational(4 + k) / 5, Rational(1 + k % 3)});
  return list;
}

TEST(Ensemble, EveryCaseIsWhatSimulateMakesOfIt) {
  Sweep run(kPendulum);
  run.options.kernel = false;
  run.options.varied = {parameter(run.model(), "l"), parameter(run.model(), "m")};
  run.cases({{Rational(3, 2), Rational(2)}, {Rational(5, 2), Rational(1)}});
  const auto list = run.go();
  ASSERT_EQ(list.size(), 2U);
  for (const auto& [k, set] :
       {std::pair{0U, Overrides{{"l", "1.5"}, {"m", "2"}}}, std::pair{1U, Overrides{{"l", "2.5"}}}}) {
    const std::vector<double> row = simulated(kPendulum, set, 1);
    ASSERT_TRUE(list[k].outcome.ok()) << list[k].outcome.message;
    EXPECT_EQ(list[k].t, 1);
    ASSERT_EQ(list[k].last.size(), 5U) << "x, y, x', y', energy";
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(list[k].last[i], row[1 + i]) << "the last bit";
    EXPECT_EQ(list[k].last[4], row.back()) << "derived parameters follow";
  }
  EXPECT_EQ(run.report.in_workspaces, 0U) << "nothing here needs a workspace of its own";
}

// An event sets numbers by derivatives beyond those of the equations: x = cos t and s = sin t until t = 1.
TEST(Ensemble, EventsSetDerivativesOfAnyOrderAsInSimulate) {
  const std::string text = R"toml(
coordinates = ["x", "y"]
parameters.scale = 1
state.s = {rate = "cos(t)", initial = 0}
potential.k = "x^2/2"
initial.x = 1
[[particle]]
name = "p"
mass = 1
position = "x*ex + y*ey"
[[event]]
name = "set"
when = "t - 1"
set = {y = "scale*D(x,3)", "y'" = "scale*D(x,6)", s = "s'' + s'"}
)toml";
  Sweep run(text);
  run.options.to = 2;
  run.options.kernel = false;
  run.options.varied = {parameter(run.model(), "scale")};
  run.cases({{Rational(1)}, {Rational(3)}});
  const auto list = run.go();
  ASSERT_EQ(list.size(), 2U);
  for (const std::size_t k : {0U, 1U}) {
    const double scale = k == 0 ? 1 : 3, sine = std::sin(1.0), cosine = std::cos(1.0);
    const std::vector<double> row = simulated(text, {{"scale", k == 0 ? "1" : "3"}}, 2);
    ASSERT_TRUE(list[k].outcome.ok()) << list[k].outcome.message;
    ASSERT_EQ(list[k].last.size(), 5U) << "x, y, x', y', s";
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(list[k].last[i], row[1 + i]) << "the last bit";
    EXPECT_NEAR(list[k].last[1], scale * (sine - cosine), 1e-14);
    EXPECT_NEAR(list[k].last[3], -scale * cosine, 1e-14);
    EXPECT_NEAR(list[k].last[4], cosine - sine + std::sin(2.0) - sine, 1e-14);
  }
}

// A kernel has the pivots of the start for which it is made, which in an ensemble is the start of another case.
TEST(Ensemble, KernelsAreSeenInTheLastDigits) {
  Sweep run(kPendulum);
  run.options.varied = {parameter(run.model(), "l"), parameter(run.model(), "m")};
  run.cases({{Rational(3, 2), Rational(2)}, {Rational(5, 2), Rational(1)}});
  const auto with = run.go();
  run.options.kernel = false;
  const auto without = run.go();
  ASSERT_EQ(with.size(), 2U);
  EXPECT_NE(bits(with) == bits(without), true) << "kernels were at work";
  constexpr double kLastDigits = 1e-13;  // a thousand roundings
  for (const auto& [k, set] :
       {std::pair{0U, Overrides{{"l", "1.5"}, {"m", "2"}}}, std::pair{1U, Overrides{{"l", "2.5"}}}}) {
    const std::vector<double> row = simulated(kPendulum, set, 1, true);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(with[k].last[i], row[1 + i], kLastDigits);
      EXPECT_NEAR(with[k].last[i], without[k].last[i], kLastDigits);
    }
  }
}

// Compares some cases of a sweep with sweeps of one case.
void expect_the_bits_of_a_case_alone(const std::string& text, Sweep& many, std::initializer_list<std::size_t> cases) {
  const std::vector<CaseResult> together = many.go(1);
  ASSERT_EQ(together.size(), many.options.cases);
  for (const std::size_t k : cases) {
    Sweep one(text);
    one.options.varied = many.options.varied;
    one.options.at = many.options.at;
    one.options.to = many.options.to;
    one.options.tolerance = many.options.tolerance;
    one.options.cases = 1;
    one.options.numbers = [&](std::size_t) { return many.options.numbers(k); };
    const std::vector<CaseResult> alone = one.go(1);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_EQ(alone[0].steps, together[k].steps) << k;
    EXPECT_EQ(alone[0].last, together[k].last) << k;
    EXPECT_EQ(alone[0].rows, together[k].rows) << k;
  }
  EXPECT_NE(together[0].last, together[1].last);
}

// Many cases share the lanes of a kernel, few do not. No bit of a case depends on the lanes, nor on its neighbours,
// their parameters or their ends.
TEST(Ensemble, LanesHaveTheBitsOfACaseAlone) {
  const std::string text = test::shipped_text("zoo/disc");
  Sweep many(text);
  many.options.varied = {parameter(many.model(), "m"), initial(3, 0)};
  many.options.at = {Rational(1, 2)};
  std::vector<std::vector<Rational>> values;
  for (int k = 0; k < 40; ++k) values.push_back({Rational(1) + Rational(k % 5, 8), Rational(1, 4) + Rational(k, 64)});
  many.cases(values);
  // Case 13 has no motion, as its end is its start.
  many.options.numbers = [values](std::size_t k) {
    return EnsembleCase{values[k], k == 13 ? Rational(0) : Rational(1) + Rational(static_cast<int>(k % 3), 4)};
  };
  expect_the_bits_of_a_case_alone(text, many, {0, 7, 8, 13, 23, 39});
}

// A long sweep tries more lanes after a while.
TEST(Ensemble, LongSweepsHaveTheBitsOfACaseAlone) {
  const std::string text = test::shipped_text("zoo/disc");
  Sweep many(text);
  many.options.varied = {initial(3, 0)};
  many.options.cases = 12'000;
  many.options.numbers = [](std::size_t k) {
    return EnsembleCase{{Rational(1, 4) + Rational(static_cast<int>(k % 97), 128)}, Rational(1, 4)};
  };
  expect_the_bits_of_a_case_alone(text, many, {0, 5000, 11'000, 11'999});
}

// Steps of all lanes are made together until one lane reaches its end, a row, or a pulse that its series do not show.
TEST(Ensemble, StepsTogetherAreThoseOfACaseAlone) {
  const std::string text = kPulses;
  Sweep many(text);
  many.options.varied = {initial(0, 0), initial(0, 1)};
  many.options.at = {Rational(5), Rational(31, 4)};
  many.options.cases = 40;
  many.options.numbers = [](std::size_t k) {
    const auto i = static_cast<int>(k);
    return EnsembleCase{{Rational(i, 80), Rational(i % 7, 9)}, Rational(i % 4 == 3 ? -9 : 9) + Rational(i, 31)};
  };
  expect_the_bits_of_a_case_alone(text, many, {0, 1, 3, 7, 8, 13, 23, 39});
}

// A pendulum that drags a light body through a viscous fluid.
const char* const kStiff = R"toml(
coordinates = ["a", "b"]
parameters = {c = 2000}
particle = [{name = "p", mass = 1, position = "sin(a)*ex - cos(a)*ez"}, {name = "q", mass = "1/100", position = "b*ey"}]
gravity.field = "-10*ez"
force = [{generalized = {b = "-c*(b' - a')"}}]
[initial]
a = 0.4
b = 0.1
)toml";

// Lanes leave a motion to `simulate` if another method is by far cheaper, and keep the others.
TEST(Ensemble, StiffCasesGoByTheMethodOfSimulate) {
  const std::string text = kStiff;
  Sweep many(text);
  many.options.tolerance = Rational(1, 1'000'000);
  many.options.to = 2;
  many.options.varied = {parameter(many.model(), "c")};
  many.options.cases = 33;
  many.options.numbers = [](std::size_t k) {
    return EnsembleCase{{k % 16 == 0 ? Rational(2000) : Rational(static_cast<int>(k), 100)}, {}};
  };
  expect_the_bits_of_a_case_alone(text, many, {0, 1, 16, 17});
  EXPECT_EQ(many.report.in_workspaces, 3U);
  for (const CaseResult& r : many.go(1)) EXPECT_LT(r.steps, 3000U) << r.number;
}

// With Runge-Kutta and BDF, cases are computed one by one, as by `simulate`.
TEST(Ensemble, CasesGoByTheMethodAskedFor) {
  for (const Method method : {Method::runge_kutta, Method::bdf}) {
    Sweep run(kPendulum);
    run.options.varied = {parameter(run.model(), "l"), parameter(run.model(), "m")};
    run.options.tolerance = Rational(1, 100000000);
    run.cases({{Rational(3, 2), Rational(2)}, {Rational(5, 2), Rational(1)}, {Rational(4, 5), Rational(1)}});
    const auto taylor = run.go();
    run.options.method = method;
    const auto list = run.go(1);
    ASSERT_EQ(list.size(), 3U);
    EXPECT_EQ(bits(run.go(3)) == bits(list), true) << name(method);
    EXPECT_EQ(list[2].outcome.kind, OutcomeKind::inconsistent) << "l = 0.8 < x = 1";
    for (const std::size_t k : {0U, 1U}) {
      ASSERT_TRUE(list[k].outcome.ok()) << list[k].outcome.message;
      EXPECT_GT(list[k].steps, taylor[k].steps) << name(method);
      for (std::size_t i = 0; i < 5; ++i) EXPECT_NEAR(list[k].last[i], taylor[k].last[i], 1e-5) << name(method);
      EXPECT_NE(list[k].last, taylor[k].last) << name(method);
    }
  }
}

TEST(Ensemble, OneInconsistentCaseStopsNoOther) {
  Sweep run(kPendulum);
  run.options.varied = {parameter(run.model(), "l"), parameter(run.model(), "m")};
  run.cases(lengths(5));
  const auto list = run.go();
  ASSERT_EQ(list.size(), 5U);
  EXPECT_EQ(list[0].outcome.kind, OutcomeKind::inconsistent) << "l = 0.8 < x = 1";
  EXPECT_NE(list[0].outcome.message.find("'rod'"), std::string::npos);
  EXPECT_TRUE(list[0].last.empty());
  for (std::size_t k = 1; k < 5; ++k) EXPECT_TRUE(list[k].outcome.ok()) << k << list[k].outcome.message;
  EXPECT_EQ(run.report.done, 5U);
  EXPECT_EQ(run.report.finished, 4U);
  EXPECT_TRUE(run.report.outcome.ok());
}

TEST(Ensemble, NumbersThatNoBodyHasAreRefused) {
  Sweep run(kPendulum);
  run.options.varied = {parameter(run.model(), "m"), parameter(run.model(), "l")};
  run.cases({{Rational(-1), Rational(2)}, {Rational(1), Rational(2)}});
  const auto list = run.go();
  EXPECT_EQ(list[0].outcome.kind, OutcomeKind::negative_mass);
  EXPECT_TRUE(list[1].outcome.ok());

  Sweep top(R"toml(
coordinates = ["psi", "theta", "phi"]
[parameters]
A = 1
C = 1
[[body]]
name = "top"
mass = 1
center = "0*ex"
orientation = "rotz(psi)*rotx(theta)*rotz(phi)"
inertia = ["A", "A", "C"]
[initial]
theta = 1
"psi'" = 1
)toml");
  top.options.varied = {parameter(top.model(), "C")};
  top.cases({{Rational(19, 10)}, {Rational(21, 10)}, {Rational(-1)}});
  const auto tops = top.go();
  EXPECT_TRUE(tops[0].outcome.ok()) << tops[0].outcome.message;
  EXPECT_EQ(tops[1].outcome.kind, OutcomeKind::negative_mass) << "C <= 2 A";
  EXPECT_EQ(tops[2].outcome.kind, OutcomeKind::negative_mass);
}

struct Of {
  const char* name;
  const char* text;
  const char* vary;
  const char* form;
  int cases;
};

class Threads : public testing::TestWithParam<Of> {};

TEST_P(Threads, HaveNoInfluenceOnAnyBit) {
  const Of& kind = GetParam();
  Sweep run(kind.text, kind.form);
  run.options.varied = {parameter(run.model(), kind.vary), initial(0, 1)};
  run.options.at = {Rational(1, 4), Rational(1, 2), Rational(3, 4)};
  std::vector<std::vector<Rational>> values;
  for (int k = 0; k < kind.cases; ++k) values.push_back({Rational(k) / 50, Rational(k % 7) / 9});
  run.cases(values);
  const std::string one = bits(run.go(1));
  EXPECT_FALSE(one.empty());
  for (const std::size_t threads : {2U, 3U, 4U, 5U, 6U, 7U, 8U})
    EXPECT_EQ(bits(run.go(threads)) == one, true) << threads << " threads";
  // A case by itself gives the same result as among others.
  const auto all = run.go(2);
  for (const std::size_t k : {std::size_t{0}, values.size() / 3, values.size() - 1}) {
    run.cases({values[k]});
    auto alone = run.go(1);
    ASSERT_EQ(alone.size(), 1U);
    alone[0].number = k;
    EXPECT_EQ(bits(alone), bits({all[k]})) << k;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, Threads,
                         testing::Values(Of{"Constraints", kPendulum, "g", "routh", 100},
                                         Of{"Events", kBall, "e", "routh", 48},
                                         Of{"EventsAndModes", kWatched, "g", "routh", 48},
                                         Of{"Kinks", kKinks, "g", "routh", 48}),
                         [](const auto& p) { return std::string(p.param.name); });

// Coordinates are eliminated anew on the way, which builds expressions. In graphs that hold the expressions of other
// cases, some of these cases would have other last bits.
TEST(Ensemble, WhatOneCaseBuildsIsNotSeenByAnother) {
  Sweep run(test::shipped_text("zoo/double-pendulum-cartesian"), "chaplygin");
  run.options.varied = {initial(0, 1)};
  run.options.to = 2;
  std::vector<std::vector<Rational>> values;
  for (int k = 0; k < 7; ++k) values.push_back({Rational(3 * k) / 2});
  run.cases(values);
  const auto one = run.go(1);
  EXPECT_EQ(run.report.in_workspaces, 7U);
  EXPECT_EQ(bits(run.go(3)) == bits(one), true);
  std::reverse(values.begin(), values.end());
  run.cases(values);
  auto turned = run.go(1);
  std::reverse(turned.begin(), turned.end());
  for (std::size_t k = 0; k < turned.size(); ++k) turned[k].number = k;
  EXPECT_EQ(bits(turned) == bits(one), true);
}

TEST(Ensemble, AChangedCaseChangesItsLineOnly) {
  Sweep run(kPendulum);
  run.options.varied = {parameter(run.model(), "l"), parameter(run.model(), "m")};
  auto values = lengths(20);
  run.cases(values);
  const auto before = run.go();
  values[11][0] += Rational(1, 1000000);
  run.cases(values);
  const auto after = run.go();
  for (std::size_t k = 0; k < 20; ++k) EXPECT_EQ(bits({before[k]}) == bits({after[k]}), k != 11) << k;
}

TEST(Ensemble, EventsEndAndAccumulateAsInSimulate) {
  Sweep run(kBall);
  run.options.varied = {parameter(run.model(), "e")};
  run.cases({{Rational(1, 5)}, {Rational(4, 5)}});
  const auto list = run.go();
  EXPECT_EQ(list[0].outcome.kind, OutcomeKind::step_collapse) << "infinitely many before t = 0.671";
  EXPECT_NEAR(list[0].t, std::sqrt(0.2) * 1.5, 1e-6);
  ASSERT_FALSE(list[0].last.empty()) << "the last good state is kept";
  const std::vector<double> row = simulated(kBall, {{"e", "0.8"}}, 1, true);
  for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(list[1].last[i], row[1 + i], 1e-14);
  EXPECT_EQ(run.report.in_workspaces, 1U) << "the case whose events accumulate";
}

TEST(Ensemble, CasesWithKinksAreMadeByKernels) {
  Sweep run(kKinks);
  run.options.varied = {parameter(run.model(), "l"), initial(0, 1)};
  run.options.to = 2;
  std::vector<std::vector<Rational>> values;
  for (int k = 0; k < 40; ++k) values.push_back({Rational(10 + k % 4) / 10, Rational(k) / 10});
  run.cases(values);
  const auto with = run.go();
  EXPECT_EQ(run.report.in_workspaces, 0U);
  run.options.kernel = false;
  const auto without = run.go();
  EXPECT_NE(bits(with) == bits(without), true) << "kernels were at work";
  for (std::size_t k = 0; k < values.size(); ++k) {
    ASSERT_TRUE(with[k].outcome.ok()) << with[k].outcome.message;
    for (const std::size_t i : {0U, 1U}) EXPECT_NEAR(with[k].last[i], without[k].last[i], 1e-11) << k;
  }
}

TEST(Ensemble, CasesWithEventsAreWhatSimulateMakesOfThem) {
  Sweep run(kWatched);
  run.options.varied = {parameter(run.model(), "l"), initial(0, 1)};
  run.options.to = 3;
  run.options.at = {Rational(1, 2), 1, 2, 3};
  std::vector<std::vector<Rational>> values;
  for (int k = 0; k < 40; ++k) values.push_back({Rational(10 + k % 4) / 10, Rational(1 + k) / 10});
  run.cases(values);
  const auto list = run.go();
  EXPECT_EQ(run.report.in_workspaces, 0U);
  std::size_t stopped = 0, hit = 0;
  for (std::size_t k = 0; k < values.size(); ++k) {
    Scenario s;
    StateChoice state;
    state.overrides = {{1, 0, values[k][1]}};
    ASSERT_TRUE(
        make_scenario(test::model_of(kWatched, {{"l", values[k][0].get_str()}}), *find_formulation("routh"), state, s)
            .ok());
    SimulationOptions o;
    o.state = state;
    o.at = run.options.at;
    test::TextRows rows;
    const SimulationReport report = simulate(s, o, rows);
    ASSERT_TRUE(list[k].outcome.ok()) << list[k].outcome.message;
    EXPECT_NEAR(list[k].t, report.t, 1e-13) << k;
    const bool stops = !report.events.empty() && report.events.back().stop;
    EXPECT_EQ(list[k].event, stops ? "high" : "") << k;
    stopped += stops ? 1 : 0;
    hit += report.events.size() > 2 ? 1 : 0;
    ASSERT_EQ(list[k].rows.size() + (stops ? 1 : 0), rows.rows().size()) << k;
    for (std::size_t i = 0; i < rows.rows().size(); ++i) {
      const bool at_end = i == list[k].rows.size();
      for (const std::size_t j : {0U, 1U})
        EXPECT_NEAR(at_end ? list[k].last[j] : list[k].rows[i][1 + j], std::stod(rows.rows()[i][1 + j]), 1e-12) << k;
    }
  }
  EXPECT_GT(stopped, 5U);
  EXPECT_GT(hit, 5U);
}

// Without the coefficient of the file the equations have another structure, so the case is derived anew.
TEST(Ensemble, AnotherStructureIsDerivedAnew) {
  const char* const text = R"toml(
coordinates = ["x", "y"]
[parameters]
m = 0
[[particle]]
name = "a"
mass = 1
position = "x*ex"
[[particle]]
name = "b"
mass = "m"
position = "y*ex"
[[force]]
name = "spring"
on = "a"
from = "b"
vector = "(y - x)*ex"
[[force]]
name = "damper"
on = "b"
vector = "-y'*ex"
[initial]
x = 1
)toml";
  Sweep run(text);
  run.options.kernel = false;
  run.options.varied = {parameter(run.model(), "m")};
  run.cases({{Rational(0)}, {Rational(1)}, {Rational(0)}});
  const auto list = run.go();
  for (std::size_t k = 0; k < 3; ++k) {
    ASSERT_TRUE(list[k].outcome.ok()) << list[k].outcome.message;
    const std::vector<double> row = simulated(text, {{"m", k == 1 ? "1" : "0"}}, 1);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(list[k].last[i], row[1 + i]) << k;
  }
  EXPECT_EQ(run.report.in_workspaces, 1U);
}

// A coordinate that follows from the others has no velocity in a run, and none in a case. If it follows beside others
// that move, it has one.
TEST(Ensemble, AVelocityThatARunDoesNotHaveHasNoNumber) {
  const std::string text = R"toml(
coordinates = ["x"]
parameters = {a = 1, m = 0}
particle = [{name = "p", mass = "m", position = "x*ex"}]
force = [{on = "p", vector = "(z - 4*x)*ex"}]
state.z = {rate = "-a*z", initial = 2}
monitor.twice = "2*x"
)toml";
  for (const Method method : {Method::automatic, Method::taylor, Method::runge_kutta}) {
    Sweep run(text);
    run.options.method = method;
    run.options.varied = {parameter(run.model(), "a")};
    run.options.at = {Rational(0), Rational(1)};
    run.cases({{Rational(1)}, {Rational(2)}});
    for (const CaseResult& r : run.go()) {
      ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
      ASSERT_EQ(r.rows.size(), 2U);
      for (const std::vector<double>& row : r.rows) {
        ASSERT_EQ(row.size(), 5U) << name(method);
        const double z = 2 * std::exp(-r.values[0] * row[0]);
        EXPECT_NEAR(row[1], z / 4, 1e-10) << name(method);
        EXPECT_TRUE(std::isnan(row[2])) << name(method);
        EXPECT_NEAR(row[3], z, 1e-10) << name(method);
        EXPECT_NEAR(row[4], z / 2, 1e-10) << name(method);
      }
      EXPECT_EQ(r.last.size(), 4U);
    }
    EXPECT_TRUE(method == Method::runge_kutta || run.report.in_workspaces == 0);
  }

  // A case with a mass has another structure, and its motion has velocities.
  Sweep mass(text);
  mass.options.varied = {parameter(mass.model(), "m")};
  mass.cases({{Rational(0)}, {Rational(1)}});
  mass.options.estimate = ErrorEstimate::always;
  const auto list = mass.go();
  ASSERT_EQ(list[0].last.size(), 4U);
  ASSERT_EQ(list[1].last.size(), 4U);
  EXPECT_TRUE(std::isnan(list[0].last[1]));
  EXPECT_FALSE(std::isnan(list[1].last[1]));
  EXPECT_EQ(list[0].last[3], 2 * list[0].last[0]);
  EXPECT_EQ(list[1].last[3], 2 * list[1].last[0]);
  EXPECT_TRUE(mass.report.error.error.has_value());
}

TEST(Ensemble, RowsAreThoseOfTheTimes) {
  Sweep run(kPendulum);
  run.options.kernel = false;
  run.options.varied = {parameter(run.model(), "g")};
  run.options.at = {Rational(0), Rational(1, 3), Rational(1)};
  run.cases({{Rational(9)}});
  const auto list = run.go();
  ASSERT_EQ(list[0].rows.size(), 3U);
  EXPECT_EQ(list[0].rows[0][0], 0);
  EXPECT_EQ(list[0].rows[0][1], 1) << "x at the start";
  const std::vector<double> row = simulated(kPendulum, {{"g", "9"}}, Rational(1, 3));
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(list[0].rows[1][i], row[i]);
  EXPECT_EQ(std::vector<double>(list[0].rows[2].begin() + 1, list[0].rows[2].end()), list[0].last);
}

TEST(Ensemble, EndsAndDirectionsMayDiffer) {
  Sweep run(kPendulum);
  run.options.cases = 3;
  run.options.numbers = [](std::size_t k) { return EnsembleCase{{}, Rational(static_cast<long>(k) - 1)}; };
  const auto list = run.go();
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(list[k].t, static_cast<double>(k) - 1);
  EXPECT_EQ(list[1].last[0], 1) << "no motion";
  EXPECT_NEAR(list[0].last[0], list[2].last[0], 1e-12) << "from rest forwards and backwards alike";
}

TEST(Ensemble, CancelledKeepsWhatIsComputed) {
  Sweep run(kPendulum);
  run.options.varied = {parameter(run.model(), "g")};
  run.options.cases = 100000;
  run.options.numbers = [](std::size_t k) { return EnsembleCase{{Rational(static_cast<long>(k % 100))}, {}}; };
  std::atomic<bool> stop{false};
  run.options.progress = [&](std::size_t done) { stop = stop || done >= 20; };
  run.options.cancelled = [&] { return stop.load(); };
  const auto list = run.go();
  EXPECT_EQ(run.report.outcome.kind, OutcomeKind::interrupted);
  EXPECT_GE(list.size(), 20U);
  EXPECT_LT(list.size(), 5000U) << "at most what was on its way";
  for (std::size_t k = 0; k < list.size(); ++k) {
    EXPECT_TRUE(list[k].outcome.ok());
    EXPECT_EQ(list[k].number, k) << "the first ones, without a gap";
  }
}

TEST(Ensemble, HoldsAWindowOfResultsOnly) {
  Sweep run(kPendulum);
  run.options.varied = {parameter(run.model(), "g")};
  run.options.to = Rational(1, 100);
  run.options.tolerance = Rational(1, 1000);
  run.options.cases = 6000;
  run.options.numbers = [](std::size_t k) { return EnsembleCase{{Rational(static_cast<long>(k % 100))}, {}}; };
  const auto list = run.go();
  ASSERT_EQ(list.size(), 6000U);
  for (std::size_t k = 0; k < list.size(); ++k) ASSERT_EQ(list[k].number, k) << "in order";
  EXPECT_GE(run.report.most_held, 8U);
  EXPECT_LE(run.report.most_held, 256U * 2);
}

TEST(Ensemble, TheFileNeedsNoStartOfItsOwn) {
  const std::string text = test::replaced(kPendulum, "x = 1", "x = 3");
  Scenario s;
  EXPECT_FALSE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  EnsembleOptions o;
  o.to = 1;
  o.kernel = false;
  o.varied = {initial(0, 0)};
  o.cases = 3;
  o.numbers = [](std::size_t k) { return EnsembleCase{{Rational(static_cast<long>(3 - k))}, {}}; };
  scenario_of_cases(o, s);
  EXPECT_FALSE(o.each_anew);
  EXPECT_EQ(s.state.q[0], 2) << "of the second case";
  Results results;
  ensemble(s, o, results);
  EXPECT_EQ(results.list[0].outcome.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(results.list[1].outcome.ok());
  EXPECT_EQ(results.list[2].last[0], simulated(kPendulum, {}, 1)[1]);
}

// The first case with a start comes after those that are tried for a scenario of all cases.
TEST(Ensemble, EachCaseHasAnOutcomeWhereTheFirstOnesHaveNoStart) {
  constexpr std::size_t kWithout = 66;
  Scenario s;
  const std::string text = test::replaced(kPendulum, "x = 1", "x = 3");
  EXPECT_FALSE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  EnsembleOptions o;
  o.to = 1;
  o.kernel = false;
  o.varied = {initial(0, 0)};
  o.cases = kWithout + 1;
  o.numbers = [](std::size_t k) { return EnsembleCase{{Rational(k < kWithout ? 3 : 1)}, {}}; };
  scenario_of_cases(o, s);
  EXPECT_TRUE(o.each_anew);
  Results results;
  ensemble(s, o, results);
  ASSERT_EQ(results.list.size(), kWithout + 1);
  for (std::size_t k = 0; k < kWithout; ++k) ASSERT_EQ(results.list[k].outcome.kind, OutcomeKind::inconsistent) << k;
  ASSERT_TRUE(results.list[kWithout].outcome.ok());
  EXPECT_EQ(results.list[kWithout].last[0], simulated(kPendulum, {}, 1)[1]);
}

// Of nine pendulums, the first, the middle and the last are compared with runs of smaller tolerance.
TEST(Ensemble, SaysHowExactItsResultsAre) {
  Sweep s(kPendulum);
  s.options.varied = {parameter(s.model(), "g")};
  std::vector<std::vector<Rational>> values;
  for (int k = 0; k < 9; ++k) values.push_back({Rational(5 + k)});
  s.cases(values);
  s.options.to = 5;
  s.options.tolerance = Rational(1, 1'000'000);
  s.go();
  EXPECT_FALSE(s.report.error.error) << "nobody asked";
  s.options.estimate = ErrorEstimate::short_runs;
  const std::vector<CaseResult> loose = s.go();
  const CasesError coarse = s.report.error;
  ASSERT_TRUE(coarse.error) << coarse.none;
  EXPECT_EQ(coarse.cases, (std::vector<std::size_t>{0, 4, 8}));
  s.options.tolerance = Rational(1, mpz_class("1000000000000000"));
  const std::vector<CaseResult> sharp = s.go();
  ASSERT_TRUE(s.report.error.error);
  EXPECT_LT(s.report.error.error->worst().error, coarse.error->worst().error / 1000);
  // No compared case has a larger error than the report says, coordinates in units of their own size.
  double most[2] = {0, 0};
  for (const std::size_t k : coarse.cases)
    for (std::size_t i = 0; i < 2; ++i)
      most[i] = std::max(most[i], std::abs(loose[k].last[i] - sharp[k].last[i]) / std::abs(sharp[k].last[i]));
  EXPECT_LE(std::max(most[0], most[1]), coarse.error->kinds[0].error);
  EXPECT_GE(std::max(most[0], most[1]), coarse.error->kinds[0].error / 10);
}

// The error is also reported if events reset the state.
TEST(Ensemble, SaysHowExactCasesWithEventsAre) {
  Sweep s(kBall);
  s.options.varied = {parameter(s.model(), "e")};
  s.cases({{Rational(1, 2)}, {Rational(3, 5)}, {Rational(7, 10)}});
  s.options.to = Rational(6, 5);
  s.options.estimate = ErrorEstimate::short_runs;
  s.go();
  ASSERT_TRUE(s.report.error.error) << s.report.error.none;
  EXPECT_GE(s.report.error.error->worst().digits, 12);
}

// A kernel makes the second run with other roundings. If accelerations enter nonlinearly there is no kernel, and the
// second run is in wider numbers.
TEST(Ensemble, ComparesWithOtherRoundingsWhereAKernelMakesTheMotion) {
  constexpr const char* kSpring = R"(coordinates = ["x"]
parameters = {k = 0.3}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "(-x - k*FORCE)*ex"}]
[initial]
x = 1
)";
  const auto means = [&](const std::string& force) {
    std::string text = kSpring;
    Sweep s(text.replace(text.find("FORCE"), 5, force).c_str());
    s.options.varied = {parameter(s.model(), "k")};
    s.cases({{Rational(1, 5)}, {Rational(3, 10)}});
    s.options.to = 60;
    s.options.estimate = ErrorEstimate::short_runs;
    s.go();
    return s.report.error.error ? s.report.error.error->means : s.report.error.none;
  };
  EXPECT_NE(means("x^3").find("with other roundings"), std::string::npos) << means("x^3");
  EXPECT_NE(means("abs(x - 0.2)").find("with other roundings"), std::string::npos) << means("abs(x - 0.2)");
  EXPECT_NE(means("x''^3").find("in long double"), std::string::npos) << means("x''^3");
}

// Results and second runs compute a monitor in long double, where its terms cancel in the same way.
TEST(Ensemble, CountsWhatCancelsInBothRuns) {
  Sweep s(R"(coordinates = ["x"]
parameters = {R = 1e6}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "(1/(R + x)^2 - 1/R^2)*1e12*ex"}]
monitor = {F = "(1/(R + x)^2 - 1/R^2)*1e12"}
)");
  s.options.varied = {initial(0, 0)};
  s.cases({{Rational(1)}, {Rational(2)}});
  s.options.to = 5;
  s.options.estimate = ErrorEstimate::short_runs;
  const std::vector<CaseResult> results = s.go();
  ASSERT_TRUE(s.report.error.error) << s.report.error.none;
  // In quadruple precision F is -1.9999470004373289187e-06.
  const double error = std::abs(results[0].last.back() + 1.9999470004373289187e-06) / 2e-06;
  EXPECT_GT(error, 1e-15);
  for (const KindError& kind : s.report.error.error->kinds)
    if (kind.kind == ColumnKind::monitor) {
      EXPECT_LT(error, 10 * kind.error);
      EXPECT_LT(kind.error, 1e-12);
    }
}

TEST(Ensemble, HasNothingToSayWhereNoCaseFinishes) {
  Sweep s(kPendulum);
  s.options.varied = {parameter(s.model(), "g")};
  s.cases({{Rational(5)}, {Rational(6)}});
  s.options.to = 50;
  s.options.most_steps = 3;
  s.options.estimate = ErrorEstimate::short_runs;
  s.go();
  EXPECT_FALSE(s.report.error.error);
  EXPECT_NE(s.report.error.none, "");
}

}  // namespace
}  // namespace anholon::ensemble_test

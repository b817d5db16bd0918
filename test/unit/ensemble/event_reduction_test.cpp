// The number of events in a motion and the time of the first: bouncing balls are compared with closed forms, with
// events that reset and with contacts, in lanes, alone and without a kernel.
#include <cmath>
#include <cstring>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "ensemble/reduce/reducer.h"
#include "ensemble/request.h"
#include "ensemble/with_contacts.h"
#include "modelfile/contacts.h"
#include "support/models.h"

namespace anholon::event_reduction_test {
namespace {

const char* const kBall = R"toml(
coordinates = ["z"]
parameters = {e = 0.5}
gravity.field = "-10*ez"
particle = [{name = "ball", mass = 1, position = "z*ez"}]
initial = {z = 1}
[monitor]
height = "z"
)toml";

const char* const kReset = R"toml(
[[event]]
name = "bounce"
when = "z"
direction = "down"
set = {"z'" = "-e*z'"}
[[event]]
name = "rises"
when = "z - 0.4"
direction = "up"
)toml";

const char* const kContact = R"toml(
[[contact]]
name = "floor"
gap = "z"
restitution = "e"
)toml";

constexpr double kEnd = 2;

// Restitutions from 0.65 to 0.99, for which the impacts do not accumulate before the end.
Rational restitution(std::size_t number) { return Rational(65 + static_cast<long>(number % 35), 100); }

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
    const std::vector<Contact>& moving = contacts(*open->names);
    for (const std::string& word : words) options.reductions.add(word, *open, moving);
    EXPECT_TRUE(make_scenario(open->model, *find_formulation("routh"), {}, scenario).ok());
    options.to = 2;
    options.varied = {{Varied::Kind::parameter, 0, 0, "e"}};
    move_with(moving, scenario, options);
  }
  std::vector<CaseResult> go(std::size_t cases, std::size_t threads) {
    options.cases = cases;
    options.threads = threads;
    options.numbers = [](std::size_t k) { return EnsembleCase{{restitution(k)}, {}}; };
    Results results;
    report = ensemble(scenario, options, results);
    return results.list;
  }
  std::optional<OpenModel> open;
  Scenario scenario;
  EnsembleOptions options;
  EnsembleReport report;
};

// The times of the impacts: the flight after impact n takes e^n times twice the fall to the first impact.
std::vector<double> impacts(double e) {
  std::vector<double> times;
  double flight = 2 * std::sqrt(0.2);
  for (double t = flight / 2; t < kEnd; t += flight) times.push_back(t), flight *= e;
  return times;
}

// The first time at height 0.4 on the way up, not a number if the rebound e^2 is lower.
double first_rise(double e) {
  const double v = e * std::sqrt(20.0), root = v * v - 8;
  return root <= 0 ? NAN : std::sqrt(0.2) + (v - std::sqrt(root)) / 10;
}

bool same_bits(const CaseResult& a, const CaseResult& b) {
  return a.reduced.size() == b.reduced.size() &&
         std::memcmp(a.reduced.data(), b.reduced.data(), a.reduced.size() * sizeof(double)) == 0;
}

const std::vector<std::string> kOfReset = {"count(bounce)", "first(bounce)", "count(rises)", "first(rises)",
                                           "max(height)"};

void must_be_closed_forms(const CaseResult& r) {
  const double e = r.values[0];
  EXPECT_EQ(r.reduced[0], static_cast<double>(impacts(e).size())) << e;
  EXPECT_NEAR(r.reduced[1], std::sqrt(0.2), 1e-14);
  std::size_t rises = 0;
  const std::vector<double> times = impacts(e);
  for (std::size_t n = 0; n < times.size(); ++n) {
    const double v = std::pow(e, static_cast<double>(n + 1)) * std::sqrt(20.0), root = v * v - 8;
    if (root > 0 && times[n] + (v - std::sqrt(root)) / 10 < kEnd) ++rises;
  }
  EXPECT_EQ(r.reduced[2], static_cast<double>(rises)) << e;
  if (rises == 0) {
    EXPECT_TRUE(std::isnan(r.reduced[3])) << e;
  } else {
    EXPECT_NEAR(r.reduced[3], first_rise(e), 1e-13) << e;
  }
  EXPECT_NEAR(r.reduced[4], 1, 1e-14);
}

TEST(EventReduction, ABallBouncesAsOftenAsItsClosedForm) {
  Sweep run(std::string(kBall) + kReset, kOfReset);
  for (const CaseResult& r : run.go(100, 1)) must_be_closed_forms(r);
  EXPECT_EQ(run.report.in_workspaces, 0U);
  run.options.kernel = false;
  for (const CaseResult& r : run.go(36, 1)) must_be_closed_forms(r);
}

TEST(EventReduction, ThreadsAndLanesHaveNoInfluence) {
  Sweep run(std::string(kBall) + kReset, kOfReset);
  const auto one = run.go(100, 1), two = run.go(100, 3), few = run.go(5, 1);
  for (std::size_t k = 0; k < one.size(); ++k) {
    EXPECT_TRUE(same_bits(one[k], two[k]));
    if (k < few.size()) {
      EXPECT_TRUE(same_bits(one[k], few[k]));
    }
  }
}

// `simulate` computes each of these cases in a workspace of its own.
TEST(EventReduction, CasesInWorkspacesCountTheSame) {
  Sweep run(std::string(kBall) + kReset, {"count(bounce)", "first(bounce)"});
  run.options.own_motion = [](Workspace& s, const SimulationOptions& o, RowSink& rows) {
    return simulate_in(s, o, rows);
  };
  const auto alone = run.go(12, 2);
  EXPECT_EQ(run.report.in_workspaces, 12U);
  run.options.own_motion = nullptr;
  const auto plain = run.go(12, 2);
  for (std::size_t k = 0; k < plain.size(); ++k) {
    EXPECT_EQ(alone[k].reduced[0], plain[k].reduced[0]);
    EXPECT_NEAR(alone[k].reduced[1], plain[k].reduced[1], 1e-14);
  }
}

TEST(EventReduction, AContactHitsAsOftenAsItsClosedForm) {
  Sweep run(std::string(kBall) + kContact, {"count(floor.hits)", "first(floor.hits)", "count(floor.rests)",
                                            "first(floor.rests)", "max(height)", "min(z')", "mean(t)", "mean(z')"});
  const auto one = run.go(36, 1), two = run.go(36, 2);
  for (std::size_t k = 0; k < one.size(); ++k) {
    const CaseResult& r = one[k];
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_TRUE(same_bits(r, two[k]));
    EXPECT_EQ(r.reduced[0], static_cast<double>(impacts(r.values[0]).size())) << r.values[0];
    EXPECT_NEAR(r.reduced[1], std::sqrt(0.2), 1e-14);
    EXPECT_EQ(r.reduced[2], 0);
    EXPECT_TRUE(std::isnan(r.reduced[3]));
    EXPECT_NEAR(r.reduced[4], 1, 1e-14);
    EXPECT_NEAR(r.reduced[5], -std::sqrt(20.0), 1e-13);
    EXPECT_NEAR(r.reduced[6], kEnd / 2, 1e-13);
    EXPECT_NEAR(r.reduced[7], (r.last[0] - 1) / kEnd, 1e-12);
  }
}

// An event of the model that ends a motion with contacts leaves the state at its time, which is no time of a row.
TEST(EventReduction, AStopAmongContactsHasAState) {
  const std::string stop = R"toml(
[[event]]
name = "low"
when = "z - 0.5"
stop = true
)toml";
  for (const bool rows : {false, true}) {
    Sweep run(std::string(kBall) + kContact + stop, {"last(z)"});
    if (rows) run.options.at = {Rational(1, 10), Rational(1)};
    const CaseResult r = run.go(1, 1).front();
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_EQ(r.event, "low");
    EXPECT_NEAR(r.t, std::sqrt(0.1), 1e-14);
    ASSERT_GE(r.last.size(), 3U);
    EXPECT_NEAR(r.last[0], 0.5, 1e-14);
    EXPECT_NEAR(r.last[1], -std::sqrt(10.0), 1e-13);
    EXPECT_EQ(r.last[2], r.last[0]) << "height";
    EXPECT_EQ(r.last[0], r.reduced[0]);
    EXPECT_EQ(r.rows.size(), rows ? 1U : 0U);
  }
}

// The impacts add up to the time t1 (1 + e)/(1 - e), at which the ball comes to rest.
TEST(EventReduction, AContactComesToRestOnce) {
  Sweep run(std::string(kBall) + kContact, {"count(floor.rests)", "first(floor.rests)"});
  run.options.to = 4;
  const CaseResult r = run.go(1, 1).front();
  EXPECT_EQ(r.reduced[0], 1);
  EXPECT_NEAR(r.reduced[1], std::sqrt(0.2) * 1.65 / 0.35, 1e-9);
}

// A motion with a stretch by BDF has no polynomials in it, but all of its events.
TEST(EventReduction, EventsStayWithoutPolynomials) {
  Sweep run(std::string(kBall) + kReset, {"max(height)", "count(bounce)", "mean(height)", "first(bounce)"});
  Reducer reducer(run.options.reductions);
  EXPECT_TRUE(reducer.step({2,
                            3,
                            [](std::size_t, int k) { return k == 0   ? 1.0
                                                            : k == 1 ? -0.5
                                                                     : 0.0; },
                            [](std::size_t, double x) { return FormulaValue{1 - 0.5 * x, 1}; },
                            {}}));
  reducer.event("rises", 0.25);
  reducer.event("bounce", 0.5);
  reducer.event("bounce", 0.75);
  std::vector<double> values;
  reducer.values(values);
  EXPECT_EQ(values, std::vector<double>({1, 2, 0.5, 0.5}));
  reducer.lose_formulas();
  reducer.values(values);
  EXPECT_TRUE(std::isnan(values[0]) && std::isnan(values[2]));
  EXPECT_EQ(values[1], 2);
  EXPECT_EQ(values[3], 0.5);
  reducer.restart();
  reducer.values(values);
  EXPECT_EQ(values[1], 0);
  EXPECT_TRUE(std::isnan(values[3]));
}

// Without a consistent start there is no motion, and so no number of events.
TEST(EventReduction, WithoutAMotionThereIsNoNumber) {
  Sweep run(std::string(kBall) + kContact, {"count(floor.hits)"});
  run.options.varied = {{Varied::Kind::initial, 0, 0, "z"}};
  run.options.cases = 1;
  run.options.numbers = [](std::size_t) { return EnsembleCase{{Rational(-1)}, {}}; };
  Results results;
  ensemble(run.scenario, run.options, results);
  EXPECT_FALSE(results.list[0].outcome.ok());
  EXPECT_TRUE(results.list[0].reduced.empty());
}

}  // namespace
}  // namespace anholon::event_reduction_test

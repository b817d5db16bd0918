// Reading a prepared system never changes it: neither earlier requests nor requests in other threads change the bits of
// a motion.
#include <thread>

#include <gtest/gtest.h>

#include "expr/copy.h"
#include "mechanics/conserved.h"
#include "motion/start.h"
#include "observe/evaluate.h"
#include "setup/explain.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::const_scenario_test {
namespace {

struct Prepared {
  explicit Prepared(const std::shared_ptr<const Model>& model, const char* form = "routh") {
    const Outcome o = make_scenario(model, *find_formulation(form), {}, scenario);
    if (!o.ok()) throw std::runtime_error(o.message);
  }
  Scenario scenario;
};

SimulationOptions to(const Rational& end) {
  SimulationOptions o;
  o.to = end;
  return o;
}

auto rows(const Scenario& s, const SimulationOptions& o) {
  test::TextRows sink;
  simulate(s, o, sink);
  return sink.rows();
}

// The rows and the residuals of a motion.
auto motion_in(Workspace& s, const SimulationOptions& o) {
  test::TextRows sink;
  const SimulationReport r = simulate_in(s, o, sink);
  return std::pair(sink.rows(), std::vector<double>{r.newton, r.projected, r.power, r.constraints});
}

// Calls the functions that build expressions.
void ask(const Scenario& s) {
  StateReport report;
  evaluate(s, {}, 16, report);
  Workspace own(s);
  explain(own);
  conserved(*own.mechanics);
  newton_left_side(*own.mechanics);
  regular_at_start(s);
}

class ConstScenario : public testing::TestWithParam<std::string> {};

TEST_P(ConstScenario, GivesTheMotionThatItGaveBefore) {
  const auto model = test::shipped(GetParam());
  const Prepared asked(model), other(model);
  ask(asked.scenario);
  const auto motion = rows(asked.scenario, to(Rational(1, 2)));
  ASSERT_GT(motion.size(), 1U);
  EXPECT_EQ(motion, rows(other.scenario, to(Rational(1, 2)))) << "evaluate; explain; simulate against simulate";
  EXPECT_EQ(motion, rows(asked.scenario, to(Rational(1, 2)))) << "once more";
  Workspace one(asked.scenario), two(other.scenario);
  EXPECT_EQ(motion_in(one, to(Rational(1, 10))), motion_in(two, to(Rational(1, 10))));
}

INSTANTIATE_TEST_SUITE_P(Model, ConstScenario, testing::ValuesIn(test::moving_models()),
                         [](const auto& p) { return test::test_name(p.param); });

// The mutant: a workspace already holds the expressions that a motion builds, built in another order, as are the terms
// of its sums.
TEST(ConstScenarioOf, AWorkspaceThatHasGrownIsSeen) {
  std::size_t differ = 0;
  for (const std::string& name : test::moving_models()) {
    const Prepared p(test::shipped(name));
    Workspace fresh(p.scenario), used(p.scenario);
    const auto expected = motion_in(fresh, to(Rational(1, 10)));
    Graph& g = fresh.graph();
    for (auto id = static_cast<NodeId>(p.scenario.model->graph->size()); id < g.size(); ++id) {
      if (g.node(id).kind != Kind::sum) continue;
      const std::vector<Term> terms(g.terms(id).rbegin(), g.terms(id).rend());
      for (const Term& t : terms) {
        const Expr e{&g, t.node};
        copied({&e, 1}, used.graph());
      }
    }
    if (motion_in(used, to(Rational(1, 10))) != expected) ++differ;
  }
  EXPECT_GT(differ, 0U);
}

// A model, a form of its equations and the end of its motion. Some motions eliminate coordinates anew on the way.
struct Shared {
  const char *model, *form;
  int end;
};

class SharedScenario : public testing::TestWithParam<Shared> {};

TEST_P(SharedScenario, IsSimulatedByTwoThreadsAtOnce) {
  const Prepared p(test::shipped(GetParam().model), GetParam().form);
  const Scenario& s = p.scenario;
  const SimulationOptions o = to(GetParam().end);
  const auto alone = rows(s, o);
  std::remove_const_t<decltype(alone)> first, second;
  std::thread one([&] { first = rows(s, o); });
  std::thread two([&] { second = rows(s, o); });
  std::thread three([&] { ask(s); });
  for (std::thread* t : {&one, &two, &three}) t->join();
  EXPECT_EQ(first, alone);
  EXPECT_EQ(second, alone);
}

INSTANTIATE_TEST_SUITE_P(Model, SharedScenario,
                         testing::Values(Shared{"zoo/disc", "routh", 1}, Shared{"zoo/chaplygin-sleigh", "maggi", 1},
                                         Shared{"zoo/double-pendulum-cartesian", "chaplygin", 2},
                                         Shared{"zoo/rocket", "routh", 1}),
                         [](const auto& p) { return test::test_name(std::string(p.param.model)); });

}  // namespace
}  // namespace anholon::const_scenario_test

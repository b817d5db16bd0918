#include "run/representation.h"

#include <gtest/gtest.h>

#include "run/form_choice.h"
#include "support/models.h"

namespace anholon {
namespace {

struct Written {
  explicit Written(const std::string& name) {
    if (!make_scenario(test::shipped(name), *find_formulation("routh"), {}, scenario).ok()) throw std::runtime_error("no start");
    parameters = parameter_values<long double>(*scenario.model);
    Start<long double> start;
    if (!initial_state(scenario, {}, start).ok()) throw std::runtime_error("no start");
    state.assign(start.state.begin(), start.state.end());
    derived = KernelPlan::make(std::make_shared<const Program>(program(scenario.system, scenario.structure)), 14, parameters, static_cast<double>(start.t), state);
    const std::size_t before = scenario.model->graph->size();
    list = representations({derived, scenario.structure, {}, parameters, static_cast<double>(start.t), state, scenario.mechanics.get()}, WritingEffort::long_motion);
    grown = scenario.model->graph->size() != before;
  }
  Scenario scenario;
  std::vector<long double> parameters;
  std::vector<double> state;
  std::shared_ptr<const KernelPlan> derived;
  std::vector<Representation> list;
  bool grown = false;
};

TEST(Representation, TheDiscIsWrittenOut) {
  const Written disc("zoo/disc");
  const Representation& best = cheapest(disc.list);
  EXPECT_EQ(best.writing, Writing::expanded);
  EXPECT_LE(best.plan->work(), 0.35 * disc.derived->work());
  EXPECT_FALSE(disc.grown) << "the graph of the model";
}

TEST(Representation, WhereSolutionsAreRefinedEquationsStay) {
  const Written rattleback("zoo/rattleback");
  EXPECT_TRUE(rattleback.derived->tables().refine);
  EXPECT_EQ(cheapest(rattleback.list).writing, Writing::derived);
}

TEST(Representation, IsTheSameTwice) {
  const Written a("zoo/disc"), b("zoo/disc");
  ASSERT_EQ(a.list.size(), b.list.size());
  for (std::size_t i = 0; i < a.list.size(); ++i) {
    EXPECT_EQ(a.list[i].writing, b.list[i].writing);
    EXPECT_EQ(a.list[i].plan->work(), b.list[i].plan->work());
  }
}

TEST(Representation, ComesWithTheStepsMade) {
  EXPECT_EQ(effort_after(0), WritingEffort::at_once);
  for (const WritingEffort e : kWritingEfforts) EXPECT_EQ(effort_after(steps_before(e)), e);
  EXPECT_EQ(effort_after(steps_before(WritingEffort::long_motion) - 1), WritingEffort::at_once);
}

TEST(FormChoice, CountsBothForms) {
  const FormChoice c = choose_form([] { return test::shipped("zoo/disc"); }, {});
  ASSERT_EQ(c.costs.size(), 2U);
  EXPECT_STREQ(c.costs[0].form->name, "routh");
  EXPECT_GT(c.costs[0].total, 0);
  EXPECT_GT(c.costs[1].total, 0);
  // Maggi's divide by pivots, so they are not written out on the way, and do not pay.
  EXPECT_STREQ(c.form->name, c.costs[0].total >= 1.25 * c.costs[1].total ? "maggi" : "routh");
}

}  // namespace
}  // namespace anholon

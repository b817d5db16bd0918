// Workspaces: copies of a prepared system in which expressions may be built.
#include <gtest/gtest.h>

#include "base/assert.h"
#include "print/print.h"
#include "setup/scenario.h"
#include "support/models.h"

namespace anholon::workspace_test {
namespace {

// The numbers of a scenario's handles that belong to this graph, and to any other.
std::pair<std::size_t, std::size_t> handles(Scenario& s, const Graph* of) {
  std::pair<std::size_t, std::size_t> count;
  for_each_expression(s, [&](Expr& e) {
    if (e.graph) ++(e.graph == of ? count.first : count.second);
  });
  return count;
}

struct Prepared {
  explicit Prepared(const std::string& name, const char* form = "routh") : model(test::shipped(name)) {
    EXPECT_TRUE(make_scenario(model, *find_formulation(form), {}, scenario).ok()) << name;
  }
  std::shared_ptr<const Model> model;
  Scenario scenario;
};

class WorkspaceOf : public testing::TestWithParam<std::string> {};

TEST_P(WorkspaceOf, HasNoHandleToTheOriginalAndTheSameEquations) {
  Prepared p(GetParam());
  Scenario& s = p.scenario;
  const Graph* graph = s.model->graph.get();
  EXPECT_TRUE(graph->frozen());
  EXPECT_EQ(handles(s, p.model->graph.get()).first, 0U) << "the scenario has a graph of its own";
  const auto before = handles(s, graph);
  EXPECT_EQ(before.second, 0U);
  Workspace own(s);
  EXPECT_FALSE(own.graph().frozen());
  EXPECT_EQ(handles(own, graph).first, 0U);
  EXPECT_EQ(handles(own, &own.graph()), before);
  EXPECT_EQ(handles(s, graph), before) << "the original is as it was";
  EXPECT_EQ(own.mechanics->model, own.model.get());
  EXPECT_EQ(own.system.model, own.model);
  if (own.routh) {
    EXPECT_EQ(own.routh->model, own.model);
  }
  EXPECT_EQ(print(own.system.equations, own.model->names, Format::text),
            print(s.system.equations, s.model->names, Format::text));
  EXPECT_EQ(own.graph().size(), graph->size());
}

INSTANTIATE_TEST_SUITE_P(Model, WorkspaceOf, testing::ValuesIn(test::moving_models()),
                         [](const auto& p) { return test::test_name(p.param); });

TEST(Workspace, OfAFormThatEliminates) {
  for (const char* form : {"maggi", "kane", "chaplygin"}) {
    Prepared p("zoo/chaplygin-sleigh", form);
    Workspace own(p.scenario);
    EXPECT_EQ(handles(own, &own.graph()).second, 0U) << form;
    ASSERT_FALSE(own.elimination.free.u.empty());
    EXPECT_EQ(own.elimination.free.u[0].graph, &own.graph());
    // The workspace eliminates in its own graph.
    EXPECT_EQ(own.elimination.rate(own.elimination.g())[0].graph, &own.graph());
    Workspace again(own);
    EXPECT_EQ(handles(again, &again.graph()).second, 0U) << form;
  }
}

// The mutant: one handle is left behind.
TEST(Workspace, AHandleLeftBehindIsSeen) {
  Prepared p("zoo/disc");
  Workspace own(p.scenario);
  own.system.equations.back() = p.scenario.system.equations.back();
  EXPECT_EQ(handles(own, &own.graph()).second, 1U);
}

TEST(Workspace, TheScenarioItselfCannotBeBuiltIn) {
  Prepared p("zoo/disc");
  EXPECT_THROW(static_cast<void>(sin(p.scenario.mechanics->T)), InternalFault);
  EXPECT_NE(sin(Workspace(p.scenario).mechanics->T).id, 0U);
}

TEST(Workspace, TheGivenModelIsThatBeforeItsEquations) {
  Prepared p("zoo/disc");
  EXPECT_FALSE(p.model->graph->frozen());
  EXPECT_EQ(p.scenario.given_nodes, p.model->graph->size()) << "the model given was left as it is";
  const auto given = given_model(p.scenario);
  EXPECT_EQ(given->graph->size(), p.model->graph->size());
  // A further derivation from the model has the ids of the first one.
  Scenario again;
  ASSERT_TRUE(make_scenario(given, *find_formulation("routh"), {}, again).ok());
  EXPECT_EQ(again.system.equations, p.scenario.system.equations);
  EXPECT_EQ(again.model->graph->size(), p.scenario.model->graph->size());
}

TEST(Workspace, TakesAnotherNumberForAParameter) {
  Prepared p("zoo/disc");
  Workspace own(p.scenario);
  const std::vector<double> before = parameter_values<double>(*p.scenario.model);
  own.set_parameter(0, Rational(7, 3));
  EXPECT_DOUBLE_EQ(parameter_values<double>(*own.model)[0], 7.0 / 3);
  EXPECT_EQ(parameter_values<double>(*p.scenario.model), before);
}

}  // namespace
}  // namespace anholon::workspace_test

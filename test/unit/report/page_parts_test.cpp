// The computations of a page before its motion can be shown.
#include <gtest/gtest.h>

#include "expr/expr.h"
#include "report/page/page_of.h"
#include "support/models.h"

namespace anholon::page_parts_test {
namespace {

// `anholon check` reports integrability. For a bicycle it would take most of the time of a page, and no section shows
// it.
TEST(PageInParts, DecidesNoIntegrability) {
  const std::shared_ptr<const Model> model = test::shipped("zoo/whipple");
  Scenario scenario;
  ASSERT_TRUE(make_scenario(model, *find_formulation("routh"), {}, scenario).ok());
  Workspace shown(scenario), explained(scenario);
  const std::size_t before = shown.graph().size();
  const PageInParts parts({PagedRun{"", &shown, {}, {}}}, model, {});
  const Explanation all = explain(explained);
  const std::size_t added = shown.graph().size() - before, mutant = explained.graph().size() - before;
  EXPECT_GT(mutant, 1000U) << "a page that is made with explain()";
  EXPECT_LT(10 * added, mutant);

  const std::vector<ConstraintFacts>& facts = parts.page().cases.front().facts;
  ASSERT_EQ(facts.size(), all.constraints.size());
  ASSERT_FALSE(facts.empty());
  for (std::size_t r = 0; r < facts.size(); ++r) {
    EXPECT_EQ(facts[r].hypothesis, all.constraints[r].hypothesis) << r;
    EXPECT_EQ(is_zero(facts[r].power_factor), is_zero(all.constraints[r].power_factor)) << r;
    EXPECT_EQ(facts[r].follows_from, all.constraints[r].follows_from) << r;
  }
}

}  // namespace
}  // namespace anholon::page_parts_test

// A formulation is added by one file and nothing else: this program is built with one more file in its list of forms.
#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "setup/eliminate.h"
#include "support/models.h"

namespace anholon {
namespace {

TEST(NewForm, IsFoundByItsName) {
  const Formulation* form = find_formulation("twice-routh");
  ASSERT_NE(form, nullptr);
  EXPECT_GE(formulations().size(), 2U);
}

TEST(NewForm, GivesTheMotion) {
  Scenario routh, twice;
  ASSERT_TRUE(make_scenario(test::shipped("zoo/chaplygin-sleigh"), *find_formulation("routh"), {}, routh).ok());
  ASSERT_TRUE(make_scenario(test::shipped("zoo/chaplygin-sleigh"), *find_formulation("twice-routh"), {}, twice).ok());
  StateReport one, two;
  ASSERT_TRUE(evaluate(routh, {}, 16, one).ok());
  ASSERT_TRUE(evaluate(twice, {}, 16, two).ok());
  EXPECT_EQ(one.derivatives, two.derivatives);
}

TEST(NewForm, EveryFormStandsOnce) {
  for (std::size_t i = 1; i < formulations().size(); ++i)
    for (std::size_t j = 0; j < i; ++j) EXPECT_STRNE(formulations()[i]->name, formulations()[j]->name);
}

}  // namespace
}  // namespace anholon

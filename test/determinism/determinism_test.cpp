// The same input gives the same digits, whatever was computed before in the same process and however often.
#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::determinism_test {
namespace {

std::vector<std::vector<std::string>> rows(const std::shared_ptr<const Model>& model, const Rational& to,
                                           Precision precision = Precision::real) {
  Scenario s;
  const Outcome o = make_scenario(model, *find_formulation("routh"), {}, s);
  if (!o.ok()) throw std::runtime_error(o.message);
  SimulationOptions options;
  options.to = to;
  options.precision = precision;
  options.digits = precision == Precision::multi ? 20 : 16;
  test::TextRows sink;
  simulate(s, options, sink);
  return sink.rows();
}

class Determinism : public testing::TestWithParam<std::string> {};

TEST_P(Determinism, TheSameModelSimulatedTwice) {
  const auto model = test::shipped(GetParam());
  ASSERT_FALSE(not_integrated(*model)) << "every shipped model has a motion";
  const auto first = rows(model, Rational(1, 2));
  ASSERT_GT(first.size(), 1U);
  EXPECT_EQ(first, rows(model, Rational(1, 2))) << "the graph has grown in between";
  EXPECT_EQ(first, rows(test::shipped(GetParam()), Rational(1, 2))) << "read anew";
}

INSTANTIATE_TEST_SUITE_P(Model, Determinism, testing::ValuesIn(test::moving_models()),
                         [](const auto& p) { return test::test_name(p.param); });

TEST(DeterminismOf, MultiprecisionAndAfterAnotherPrecision) {
  const auto model = test::shipped("zoo/chaplygin-sleigh");
  const auto first = rows(model, Rational(1, 4), Precision::multi);
  rows(model, Rational(1, 4), Precision::long_real);
  {
    const PrecisionScope precision(90);
    EXPECT_EQ(first, rows(model, Rational(1, 4), Precision::multi));
  }
}

TEST(DeterminismOf, ADifferentParameterIsSeen) {
  const std::string text = test::shipped_text("zoo/rocket");
  EXPECT_NE(rows(test::model_of(text), Rational(1)), rows(test::model_of(text, {{"ue", "3 + 1e-15"}}), Rational(1)))
      << "the mutant";
}

}  // namespace
}  // namespace anholon::determinism_test

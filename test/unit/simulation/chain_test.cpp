#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/chain.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::chain_test {
namespace {

TEST(Chain, OfThirtyTwoLinksKeepsItsEnergyAndNewtonsLaw) {
  Scenario s;
  ASSERT_TRUE(make_scenario(test::model_of(test::chain_text(32)), *find_formulation("routh"), {}, s).ok());
  SimulationOptions options;
  options.to = Rational(1, 10);
  options.every = Rational(1, 20);
  test::TextRows sink;
  const SimulationReport r = simulate(s, options, sink);
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_EQ(sink.rows().size(), 3U);
  // The first link carries the forces of the whole chain: a thousand round-offs.
  EXPECT_LE(r.newton, 1e-12);
  EXPECT_LE(r.power, 1e-12);
  EXPECT_GT(r.smallest_sigma, 0);
}

}  // namespace
}  // namespace anholon::chain_test

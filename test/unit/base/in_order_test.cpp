// Blocks are worked on in their order by several threads, and an exception of the work is rethrown. Rows have the same
// bits if they are computed beside the motion or in its thread.
#include <gtest/gtest.h>
#include <sched.h>

#include "base/in_order.h"
#include "simulation/simulate.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::in_order_test {
namespace {

using Block = std::vector<int>;

class InOrderOf : public testing::TestWithParam<bool> {};

TEST_P(InOrderOf, KeepsTheOrder) {
  std::vector<int> seen;
  InOrder<Block> work(std::vector<Block>(3), [&](Block& block) {
    seen.insert(seen.end(), block.begin(), block.end());
    block.clear();
  });
  if (GetParam()) work.work_beside();
  std::vector<int> all;
  for (int i = 0; i < 10'000; ++i) {
    work.filling().push_back(i);
    all.push_back(i);
    if (i % 7 == 0) work.pass_on();
  }
  work.pass_on();
  work.settle();
  EXPECT_EQ(seen, all);
}

TEST_P(InOrderOf, GivesBackWhatTheWorkThrows) {
  const auto run = [&] {
    InOrder<Block> work(std::vector<Block>(3), [](Block& block) {
      if (block.front() == 5) throw std::runtime_error("five");
      block.clear();
    });
    if (GetParam()) work.work_beside();
    for (int i = 0; i < 10; ++i) work.filling().assign(1, i), work.pass_on();
    work.settle();
  };
  EXPECT_THROW(run(), std::runtime_error);
}

INSTANTIATE_TEST_SUITE_P(Threads, InOrderOf, testing::Bool());

// Compares the rows and the report of a run on one core with those on all cores. There are 2000 rows, more than start a
// thread.
TEST(RowsBesideTheMotion, HaveTheSameBits) {
  const auto run = [](const char* model, SimulationReport& report) {
    Scenario s;
    SimulationOptions o;
    o.to = 20;
    o.every = Rational(1, 100);
    EXPECT_TRUE(make_scenario(test::model_of(test::shipped_text(model)), *find_formulation("routh"), o.state, s).ok());
    test::TextRows rows;
    report = simulate(s, o, rows);
    return rows.rows();
  };
  cpu_set_t all, one;
  ASSERT_EQ(sched_getaffinity(0, sizeof all, &all), 0);
  CPU_ZERO(&one);
  for (int cpu = 0; cpu < CPU_SETSIZE && CPU_COUNT(&one) == 0; ++cpu)
    if (CPU_ISSET(cpu, &all)) CPU_SET(cpu, &one);
  for (const char* model : {"zoo/disc", "zoo/chain", "zoo/fourbar"}) {
    SimulationReport beside, alone;
    const auto rows = run(model, beside);
    ASSERT_EQ(sched_setaffinity(0, sizeof one, &one), 0);
    const auto same = run(model, alone);
    ASSERT_EQ(sched_setaffinity(0, sizeof all, &all), 0);
    EXPECT_EQ(rows.size(), 2001U);
    EXPECT_EQ(rows, same) << model;
    EXPECT_EQ(beside.newton, alone.newton);
    EXPECT_EQ(beside.power, alone.power);
    EXPECT_EQ(beside.rows_looked_at, alone.rows_looked_at);
  }
}

// A sink that records the end of each step, the number of rows before it, and the thread that reports it.
class Steps final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>&) override {}
  void row(const Row& row) override { last_ = row.values[0]; }
  void step(double t) override {
    in_order = in_order && (ends.empty() || ends.back() < t) && last_ <= t;
    ends.push_back(t);
  }
  std::vector<double> ends;
  bool in_order = true;

 private:
  double last_ = 0;
};

// Several steps lie between two rows, so steps are reported while rows are still being computed.
TEST(RowsBesideTheMotion, HaveTheStepsInTheirOrder) {
  Scenario s;
  SimulationOptions o;
  o.to = 600;
  o.every = Rational(1, 4);
  o.estimate = ErrorEstimate::never;
  ASSERT_TRUE(
      make_scenario(test::model_of(test::shipped_text("zoo/disc")), *find_formulation("routh"), o.state, s).ok());
  Steps sink;
  const SimulationReport report = simulate(s, o, sink);
  ASSERT_TRUE(report.outcome.ok());
  EXPECT_GT(report.steps, 2 * report.rows);
  EXPECT_EQ(sink.ends.size(), report.steps);
  EXPECT_TRUE(sink.in_order);
}

}  // namespace
}  // namespace anholon::in_order_test

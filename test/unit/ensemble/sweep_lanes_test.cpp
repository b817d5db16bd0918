// A sweep chooses the number of lanes in which a case takes the least time.
#include <gtest/gtest.h>

#include "ensemble/lanes/sweep_lanes.h"
#include "setup/scenario.h"
#include "support/compiler.h"
#include "support/models.h"

namespace anholon::sweep_lanes_test {
namespace {

constexpr std::size_t kCases = 1'000'000'000'000'000;  // more than the test begins

class SweepOfDiscs : public testing::Test {
 protected:
  SweepOfDiscs() {
    Scenario prepared;
    if (!make_scenario(test::model_of(test::shipped_text("zoo/disc")), *find_formulation("routh"), {}, prepared).ok())
      throw std::runtime_error("no start");
    Workspace s(prepared);
    Start<long double> start;
    if (!initial_state(s, {}, start).ok()) throw std::runtime_error("no start");
    plan_ = KernelPlan::make(std::make_shared<const Program>(program(s.system, s.structure)), 12,
                             parameter_values<long double>(*s.model), static_cast<double>(start.t),
                             {start.state.begin(), start.state.end()}, Company::in_lanes);
  }

  SweepLanes::Turn begin(SweepLanes& sweep) { return sweep.begin(plan_, next_ += 32); }
  // Without machine code the groups do not show the time of a case.
  void expect_no_choice() {
    SweepLanes sweep(kCases, 0, 1, tiers().back().lanes);
    end_groups(sweep, 1, 0.02);
    for (int k = 0; k < 100; ++k) EXPECT_FALSE(begin(sweep).compiled);
    EXPECT_EQ(begin(sweep).lanes, 1);
  }
  // Begins groups that take no time until one has machine code. Returns its number of lanes.
  int begin_until_compiled(SweepLanes& sweep) {
    SweepLanes::Turn turn;
    while (!turn.compiled) turn = begin(sweep);
    return turn.lanes;
  }
  void begin_until_lanes_change(SweepLanes& sweep) {
    const int lanes = begin(sweep).lanes;
    while (begin(sweep).lanes == lanes) {
    }
  }
  // Ends enough groups for a decision.
  void end_groups(SweepLanes& sweep, int lanes, double seconds) {
    for (int k = 0; k < 8; ++k) sweep.end({lanes, test::compiler_expected()}, 32, seconds);
  }

  std::shared_ptr<const KernelPlan> plan_;
  std::size_t next_ = 0;
};

TEST_F(SweepOfDiscs, FewCasesAreComputedInOneLane) {
  SweepLanes sweep(31, 1);
  EXPECT_EQ(begin(sweep).lanes, 1);
  SweepLanes many(32, 1);
  EXPECT_EQ(begin(many).lanes, tiers().size() > 1 ? 4 : tiers().back().lanes);
  EXPECT_EQ(SweepLanes(32, 1).begin(nullptr, 0).lanes, 1) << "a model without a kernel";
}

TEST_F(SweepOfDiscs, GoesOnWithTheNumberOfLanesThatTakesLessTime) {
  if (!test::compiler_expected()) return expect_no_choice();
  const int wide = tiers().back().lanes;
  for (const bool wide_is_faster : {true, false}) {
    SweepLanes sweep(kCases, 0, 1, wide);
    ASSERT_EQ(begin_until_compiled(sweep), 1);
    end_groups(sweep, 1, 0.02);
    begin_until_lanes_change(sweep);
    sweep.end({wide, true}, 32, 0.02);  // one group is not enough for a decision
    EXPECT_EQ(begin(sweep).lanes, wide);
    end_groups(sweep, wide, wide_is_faster ? 0.01 : 0.03);
    begin(sweep);
    EXPECT_EQ(begin(sweep).lanes, wide_is_faster ? wide : 1);
  }
}

// Groups without machine code, and a sweep near its end, are no reason to try more lanes.
TEST_F(SweepOfDiscs, TriesMoreLanesOnlyIfTheCasesLeftPayForTheCompiler) {
  if (!test::compiler_expected()) return expect_no_choice();
  const int wide = tiers().back().lanes;
  SweepLanes sweep(kCases, 0, 1, wide);
  for (int k = 0; k < 100; ++k) sweep.end({1, false}, 32, 0.02);
  ASSERT_EQ(begin_until_compiled(sweep), 1);
  next_ = kCases - 92 * 32;
  end_groups(sweep, 1, 0.0015);
  for (int k = 0; k < 90; ++k) begin(sweep);
  ASSERT_EQ(plan_->compile({}, wide, CodeEffort::quick), "");
  EXPECT_EQ(begin(sweep).lanes, 1);
}

}  // namespace
}  // namespace anholon::sweep_lanes_test

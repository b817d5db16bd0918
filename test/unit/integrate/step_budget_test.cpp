#include <functional>

#include <gtest/gtest.h>

#include "integrate/step_budget.h"

namespace anholon {
namespace step_budget_test {

// Makes steps of the length step(k) from time 0 towards `end`. Returns the number of steps after which the end is
// called out of reach, or 0 if this does not occur within `most` steps. `before`: number of steps of an earlier part of
// the motion.
std::size_t judged(const std::function<double(std::size_t)>& step, double end, std::size_t most,
                   std::size_t before = 0) {
  StepSettings settings;
  settings.most_steps = 50'000'000;
  StepPaces paces;
  long double t = 0;
  paces.begin(t, before);
  for (std::size_t k = 0; k < most && t < end; ++k) {
    const double h = step(k);
    if (paces.out_of_reach(settings, before + k, t, h, end - static_cast<double>(t))) return k;
    t += h;
  }
  return 0;
}

TEST(StepBudget, AHopelessPaceIsNoticedAfterAThousandSteps) {
  EXPECT_EQ(judged([](std::size_t) { return 1e-15; }, 10, 100'000), 1000U);
  // One long step does not help if the mean stays too slow.
  EXPECT_EQ(judged([](std::size_t k) { return k == 100 ? 1e-9 : 1e-15; }, 10, 100'000), 1000U);
  // The mutant: a pace at which the end is reached.
  EXPECT_EQ(judged([](std::size_t) { return 1e-6; }, 10, 100'000), 0U);
}

TEST(StepBudget, OneShortStepIsNoPace) {
  const auto short_at = [](std::size_t where) { return [where](std::size_t k) { return k == where ? 1e-14 : 1e-4; }; };
  for (const std::size_t where : {0U, 999U, 1000U, 1499U, 5000U})
    EXPECT_EQ(judged(short_at(where), 10, 100'000), 0U) << where;
  // A motion that is continued after many steps has no record of their pace.
  EXPECT_EQ(judged(short_at(0), 10, 100'000, 1'000'000), 0U);
}

TEST(StepBudget, StepsThatGrowAreWaitedFor) {
  const auto growing = [](double factor) {
    return [factor](std::size_t k) { return std::min(1e-3, 1e-16 * std::pow(factor, static_cast<double>(k))); };
  };
  EXPECT_EQ(judged(growing(1.01), 10, 100'000), 0U);
  EXPECT_EQ(judged(growing(1.002), 10, 100'000), 0U);
  EXPECT_EQ(judged(growing(1.00001), 10, 100'000), 1000U);  // the mutant
}

TEST(StepBudget, AnEndJustBeyondTheLimitIsWaitedFor) {
  const double pace = 1e-7;
  EXPECT_EQ(judged([&](std::size_t) { return pace; }, 2 * pace * 5e7, 100'000), 20'000U);
  EXPECT_EQ(judged([&](std::size_t) { return pace; }, 2000 * pace * 5e7, 100'000), 1000U);
  // After 3000 slow steps the motion continues at an ordinary pace.
  EXPECT_EQ(judged([](std::size_t k) { return k < 3000 ? 1e-8 : 1e-3; }, 10, 100'000), 0U);
}

// A motion that is fast first and then chatters has a good mean, which does not show what follows.
TEST(StepBudget, AMotionThatChattersIsNoticed) {
  const auto chatters = [](double then) { return [then](std::size_t k) { return k < 100 ? 0.05 : then; }; };
  EXPECT_EQ(judged(chatters(1e-13), 10, 200'000), 50'500U);
  // The mutants: a pace that is slow but not hopeless, and one that is hopeless for a while.
  EXPECT_EQ(judged(chatters(1e-9), 10, 200'000), 0U);
  EXPECT_EQ(judged([](std::size_t k) { return k < 100 || k > 45'000 ? 0.05 : 1e-13; }, 10, 200'000), 0U);
}

}  // namespace step_budget_test
}  // namespace anholon

// Compilations whose motion has ended do no harm.
#include <cstdlib>

#include <gtest/gtest.h>

#include "motion/code_for_long_runs.h"
#include "setup/scenario.h"
#include "support/models.h"

namespace anholon::code_for_long_runs_test {
namespace {

std::shared_ptr<const KernelPlan> plan_of(const std::string& name, int stages) {
  Scenario prepared;
  if (!make_scenario(test::model_of(test::shipped_text(name)), *find_formulation("routh"), {}, prepared).ok())
    throw std::runtime_error("no start");
  Workspace s(prepared);
  Start<long double> start;
  if (!initial_state(s, {}, start).ok()) throw std::runtime_error("no start");
  return KernelPlan::make(std::make_shared<const Program>(program(s.system, s.structure)), stages,
                          parameter_values<long double>(*s.model), static_cast<double>(start.t),
                          {start.state.begin(), start.state.end()});
}

// Begins several compilations in the last moments of a program that computes one motion after another.
void leave_some_behind(int milliseconds) {
  setenv("ANHOLON_CACHE", "", 1);  // no code is found on disk
  const std::vector<std::shared_ptr<const KernelPlan>> plans = {
      plan_of("zoo/disc", 14), plan_of("zoo/chain", 15), plan_of("zoo/snakeboard", 16), plan_of("zoo/fourbar", 17)};
  std::vector<std::unique_ptr<CodeForLongRuns>> runs;
  for (std::size_t k = 0; k < plans.size(); ++k) runs.push_back(std::make_unique<CodeForLongRuns>());
  for (std::size_t k = 0; k < plans.size(); ++k) runs[k]->step(plans[k], 0, 1);
  std::this_thread::sleep_for(std::chrono::milliseconds(450));  // a long run, of which little is done
  for (std::size_t k = 0; k < plans.size(); ++k)
    for (int asked = 0; asked < 64; ++asked) runs[k]->step(plans[k], 1e-6, 1);
  runs.clear();
  std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));  // the next motion
  std::exit(0);  // on a fast machine some compilations end before
}

// The compiler's static objects are destroyed at exit; those that it creates while it works are destroyed first.
TEST(CodeForLongRuns, ExitWaitsForWhatIsLeftBehind) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  for (int milliseconds : {20, 60, 180})
    EXPECT_EXIT(leave_some_behind(milliseconds), testing::ExitedWithCode(0), "") << milliseconds;
}

}  // namespace
}  // namespace anholon::code_for_long_runs_test

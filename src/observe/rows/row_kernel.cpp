#include "observe/rows/row_kernel.h"

#include <cmath>

#include "base/thread_time.h"
#include "setup/outputs/output_tape.h"

namespace anholon {

std::unique_ptr<RowKernel> RowKernel::make(Workspace& s, const Column& outputs, int stages,
                                           const std::vector<long double>& parameters, const RowPlace& here, double end,
                                           std::size_t rows) {
  constexpr std::size_t kMany = 2000;
  const Column put = OutputTape<long double>::put(s, outputs);
  if (!s.elimination.pivots().empty() || !s.redundant.empty() || s.routh || orders_needed(s, put) > 0) return nullptr;
  auto program = std::make_shared<const Program>(anholon::program(s.system, s.structure, put));
  if (!no_plan(*program).empty()) return nullptr;
  const std::vector<double> state(here.state.begin(), here.state.end());
  auto plan = KernelPlan::make(std::move(program), std::max(1, stages), parameters, static_cast<double>(here.t), state,
                               Company::in_lanes);
  if (!plan) return nullptr;
  const int lanes = rows > kMany ? lanes_at_first() : tiers().back().lanes;
  return std::unique_ptr<RowKernel>(new RowKernel(std::move(plan), lanes, stages > 0, parameters, end));
}

RowKernel::RowKernel(std::shared_ptr<const KernelPlan> plan, int lanes, bool with_series,
                     const std::vector<long double>& parameters, double end)
    : with_series_(with_series), plan_(std::move(plan)), kernel_(plan_, lanes), end_(end) {
  set_parameters(parameters);
}

void RowKernel::set_parameters(const std::vector<long double>& parameters) {
  for (int lane = 0; lane < kernel_.lanes(); ++lane) kernel_.set_parameters(lane, parameters);
}

void RowKernel::place(std::size_t lane, const RowPlace& place) {
  const double t = static_cast<double>(place.t);
  if (lane == 0) at_ = t;
  kernel_.place(static_cast<int>(lane), place.state, place.leading);
  kernel_.set_time(static_cast<int>(lane), t);
}

// Reading the clock takes longer than a short row, so one computation is timed for several.
void RowKernel::compute() {
  constexpr std::size_t kSometimes = 16;
  const bool timed = computed_++ % kSometimes == kSometimes / 2;
  double begun = 0;
  if (timed) {
    code_.step(plan_, at_, end_, kernel_.lanes(), spent_);
    begun = seconds_of_this_thread();
  }
  if (with_series_)
    kernel_.begin();
  else
    kernel_.begin_point();
  if (timed) spent_ += kSometimes * (seconds_of_this_thread() - begun);
}

bool RowKernel::good(std::size_t lane) const {
  if (!(kernel_.pivots(static_cast<int>(lane)).health > plan_->least_health())) return false;
  const Plan& plan = plan_->plan();
  for (std::size_t j = 0; j < plan.x.size(); ++j)
    if (!std::isfinite(derivative(j, plan.d[j] + (with_series_ ? plan.stages : 0), lane))) return false;
  return true;
}

}  // namespace anholon

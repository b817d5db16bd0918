#include "integrate/states/state_rate.h"

#include <algorithm>
#include <cmath>

#include "numeric/told_time.h"

namespace anholon {

StateRate::StateRate(const Program& program, const std::vector<double>& parameters,
                     const std::vector<long double>& wide_parameters, std::shared_ptr<const KernelPlan> plan,
                     std::vector<Guard> guards)
    : program_(&program), point_(program, parameters, 0), guards_(std::move(guards)), leading_(program.unknowns(), 0.0),
      integrands_(program.quadratures, 0.0) {
  if (plan) {
    kernel_ = std::make_unique<Kernel>(std::move(plan));
    kernel_->set_parameters(0, wide_parameters);
    find_kinks();
  }
  const auto levels = static_cast<std::size_t>(std::max(1, *std::max_element(program.d.begin(), program.d.end())));
  std::vector<std::size_t> first(program.unknowns(), 0);  // the first scale of each unknown
  for (std::size_t s = 0; s < program.scales.size(); ++s)
    for (const std::uint32_t j : program.scales[s]) first[j] = s * levels;
  for (std::size_t j = 0; j < program.unknowns(); ++j)
    for (std::size_t k = 0; k < static_cast<std::size_t>(program.d[j]); ++k) scale_.push_back(first[j] + k);
  scales_ = levels * std::max<std::size_t>(1, program.scales.size());
  constrained_ = std::any_of(program.c.begin(), program.c.end(), [](int c) { return c > 0; });
  rate_.resize(scale_.size());
}

void StateRate::find_kinks() {
  for (const Step& s : kernel_->plan().plan().point) {
    const bool turns = s.act == Act::function && (s.index == static_cast<std::uint32_t>(Function::abs) ||
                                                  s.index == static_cast<std::uint32_t>(Function::sign));
    if (turns)
      kinks_.push_back({s.a});
    else if (s.act == Act::select)
      kinks_.push_back({s.c});
    else if (s.act == Act::lookup)
      kinks_.push_back({s.a, &kernel_->plan().tables().knots[s.index].at});
  }
}

double StateRate::beyond(std::size_t kink, double x, int side, int other) const {
  const Kink& k = kinks_[kink];
  const double end = k.knots ? (*k.knots)[static_cast<std::size_t>(other > side ? side : side - 1)] : 0;
  return other > side ? x - end : end - x;
}

Outcome StateRate::evaluate(double t, const std::vector<double>& state, bool projected) {
  projected = projected && constrained_;
  ++evaluations_;
  guarded_ = false;
  const auto finite = [](const std::vector<double>& list) {
    return std::all_of(list.begin(), list.end(), [](double x) { return std::isfinite(x); });
  };
  const auto no_value = [&] {
    return told(
        {OutcomeKind::not_a_number,
         "a formula has no value (a root or logarithm of a negative number, or a division by zero)" + at_time(t),
         "the motion leaves the region where the model is defined: stop it before, or change the formula"},
        t);
  };
  if (!finite(state)) return no_value();
  if (!by_kernel(t, state, projected)) {
    ++by_reference_;
    if (Outcome o = by_reference(t, state, projected); !o.ok()) return o;
  }
  std::size_t i = 0;
  for (std::size_t j = 0; j < program_->unknowns(); ++j)
    for (int k = 0; k < program_->d[j]; ++k, ++i) rate_[i] = k + 1 < program_->d[j] ? state_[i + 1] : leading_[j];
  if (!finite(rate_) || !finite(integrands_)) return no_value();
  for (const Guard& g : guards_)
    if (integrands_[g.quadrature] < 0) {
      guarded_ = true;
      return g.fault;
    }
  return {};
}

bool StateRate::by_kernel(double t, const std::vector<double>& state, bool projected) {
  if (!kernel_) return false;
  if (std::any_of(leading_.begin(), leading_.end(), [](double x) { return !std::isfinite(x); }))
    leading_.assign(leading_.size(), 0.0);
  kernel_->load(0, t, state, leading_);
  kernel_->expand(projected);
  pivots_ = kernel_->pivots(0);
  if (!(pivots_->health > kernel_->plan().least_health())) return false;
  moved_ = projected && kernel_->moved(0);
  drift_ = projected ? kernel_->drift(0) : 0;
  state_.resize(state.size());
  std::size_t i = 0;
  for (std::size_t j = 0; j < program_->unknowns(); ++j) {
    for (int k = 0; k < program_->d[j]; ++k, ++i) state_[i] = moved_ ? kernel_->derivative(j, k) : state[i];
    leading_[j] = kernel_->derivative(j, program_->d[j]);
  }
  for (std::size_t q = 0; q < integrands_.size(); ++q) integrands_[q] = kernel_->quadrature(q, 0);
  sides_.clear();
  arguments_.clear();
  for (const Kink& k : kinks_) {
    const double x = kernel_->series(k.argument, 0);
    arguments_.push_back(x);
    sides_.push_back(
        k.knots ? static_cast<int>(std::upper_bound(k.knots->begin(), k.knots->end(), x) - k.knots->begin()) : x >= 0);
  }
  return true;
}

Outcome StateRate::by_reference(double t, const std::vector<double>& state, bool projected) {
  point_.load(t, state, leading_);
  if (Outcome o = point_.prepare(); !o.ok()) return o;
  if (projected)
    if (Outcome o = point_.project(); !o.ok()) return o;
  if (Outcome o = point_.solve(); !o.ok()) return o;
  point_.evaluate_quadratures();
  point_.state(state_);
  moved_ = projected && state_ != state;
  drift_ = projected ? point_.drift() : 0;
  sides_.clear();
  point_.leading(leading_);
  for (std::size_t q = 0; q < integrands_.size(); ++q) integrands_[q] = point_.quadrature(q)[0];
  return {};
}

void scale_sizes(const StateRate& rate, const std::vector<double>& state, std::vector<double>& sizes) {
  sizes.assign(rate.scales(), 1.0);
  for (std::size_t i = 0; i < state.size(); ++i) {
    double& size = sizes[rate.scale()[i]];
    size = std::max(size, std::abs(state[i]));
  }
}

}  // namespace anholon

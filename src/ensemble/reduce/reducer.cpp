#include "ensemble/reduce/reducer.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "integrate/series/sign_change.h"

namespace anholon {

Reducer::Reducer(const Reductions& of, double tolerance)
    : of_(&of), tolerance_(std::max(tolerance, 4 * std::numeric_limits<double>::epsilon())) {
  restart();
}

void Reducer::restart() {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  seen_.assign(of_->formulas.size(), {});
  ends_.assign(of_->ends.size(), kNone);
  fired_.assign(of_->events.size(), {});
  for (Fired& f : fired_) f.first = kNone;
  for (const Reduction& r : of_->list) {
    if (r.of_event() || r.kind == Reduction::Kind::last) continue;
    seen_[r.of].ask(r.kind);
  }
  length_ = 0;
  kinks_ = 0;
  foretold_ = false;
}

bool Reducer::step(const ReducedStep& step) {
  bool good = true;
  const bool kink = std::exchange(kinks_, step.kinks) != step.kinks;
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    FormulaSummary& s = seen_[i];
    if (s.done()) continue;
    polynomial_.resize(static_cast<std::size_t>(step.degree) + 1);
    for (int k = 0; k <= step.degree; ++k) polynomial_[static_cast<std::size_t>(k)] = step.coefficient(i, k);
    if (foretold_ && std::isfinite(polynomial_[0]) &&
        !agrees(polynomial_[0], s.last(), std::abs(polynomial_[0]), tolerance_))
      good = false;
    const auto value = [&](double x) { return step.value(i, x); };
    if (holds(step, i))
      s.see(polynomial_, step.h, value, kink);
    else
      s.see_by_values(value, step.h, hidden_, tolerance_);
  }
  length_ += step.h;
  foretold_ = !step.look && !kink;
  return good;
}

// True if the polynomial is the formula over the step. The last two terms decide, and, if these are zero or do not fall
// below the others, values.
bool Reducer::holds(const ReducedStep& step, std::size_t formula) {
  hidden_.clear();
  constexpr double kFalls = 1e-3, kTolerances = 100, kNearEnd = 31.0 / 32;
  constexpr int kPoints = 7, kNoise = 4096;
  const int degree = step.degree;
  arguments_reach_ = true;
  if (step.h != 0) find_hidden(step, formula);
  if (!arguments_reach_) return false;
  if (degree < 2 || step.h == 0) return step.h == 0 && std::isfinite(polynomial_[0]);
  double power = 1, most = 0, end = 0;
  for (int k = 0; k <= degree; ++k, power *= step.h) {
    const double term = std::abs(polynomial_[static_cast<std::size_t>(k)] * power);
    if (!std::isfinite(term)) return false;
    (k < degree - 1 ? most : end) = std::max(k < degree - 1 ? most : end, term);
  }
  if (!(end <= kFalls * most) && end > 0) return false;
  if (!(end <= kTolerances * tolerance_ * std::max(1.0, most))) return false;
  const auto shows = [&](double x) {
    const FormulaValue there = step.value(formula, x);
    const double foretold = value_at(polynomial_.data(), degree, x);
    return agrees(there.value, foretold, std::max(most, std::abs(there.value)), tolerance_) ||
           std::abs(there.value - foretold) <= kNoise * std::numeric_limits<double>::epsilon() * there.made_of;
  };
  if (step.look && !shows(kNearEnd * step.h)) return false;
  for (int k = 1; end == 0 && k <= kPoints; ++k)
    if (!shows((k - 0.5) / kPoints * step.h)) return false;
  return std::all_of(hidden_.begin(), hidden_.end(), shows);
}

// Finds the points at which functions may hide their variation, by the polynomials of their arguments.
void Reducer::find_hidden(const ReducedStep& step, std::size_t formula) {
  const auto add = [&](const Hiding& function, const std::vector<double>& argument) {
    const std::vector<double> nothing(argument.size(), std::numeric_limits<double>::quiet_NaN());
    std::vector<double> points;
    const int last = static_cast<int>(argument.size()) - 1;
    if (!add_hidden_points(function, argument.data(), nothing.data(), last, 1.0, points)) arguments_reach_ = false;
    for (const double u : points)
      if (u > 0 && u < 1) hidden_.push_back(u * step.h);
  };
  if (step.hiding_polynomials) {
    for (HidingPolynomial& p : step.hiding_polynomials(formula)) {
      double power = 1;
      for (double& c : p.argument) c *= power, power *= step.h;
      if (p.argument.size() > 1 &&
          std::all_of(p.argument.begin(), p.argument.end(), [](double c) { return std::isfinite(c); }))
        add(p.function, p.argument);
    }
  } else if (step.hiding) {
    find_by_values(step, formula, add);
  }
  std::sort(hidden_.begin(), hidden_.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  hidden_.erase(std::unique(hidden_.begin(), hidden_.end()), hidden_.end());
}

// Finds these points if only values are known. The arguments are smooth, so polynomials through a few values suffice.
void Reducer::find_by_values(const ReducedStep& step, std::size_t formula,
                             const std::function<void(const Hiding&, const std::vector<double>&)>& add) {
  const std::size_t count = step.hiding(formula, 0).size();
  if (count == 0) return;
  std::map<double, std::vector<HidingArgument>> seen;
  std::vector<double> argument;
  for (std::size_t k = 0; k < count; ++k) {
    std::optional<Hiding> function;
    const Interpolation of(
        [&](double x) {
          const auto [at, is_new] = seen.try_emplace(x);
          if (is_new) at->second = step.hiding(formula, x);
          if (k >= at->second.size()) return FormulaValue{};
          function = at->second[k].function;
          return FormulaValue{at->second[k].value, 0};
        },
        0, step.h);
    if (of.without_value() > 0) continue;
    of.polynomial(argument);
    add(*function, argument);
  }
}

void Reducer::event(const std::string& name, double t) {
  for (std::size_t i = 0; i < fired_.size(); ++i)
    if (of_->events[i] == name && fired_[i].times++ == 0) fired_[i].first = t;
}

void Reducer::lose_formulas() {
  for (FormulaSummary& s : seen_) s.lose();
  ends_.assign(of_->ends.size(), std::numeric_limits<double>::quiet_NaN());
}

void Reducer::values(std::vector<double>& to) const {
  to.clear();
  for (const Reduction& r : of_->list) {
    if (r.of_event())
      to.push_back(r.kind == Reduction::Kind::count ? fired_[r.of].times : fired_[r.of].first);
    else
      to.push_back(r.kind == Reduction::Kind::last ? ends_[r.of] : seen_[r.of].value(r.kind, length_));
  }
}

}  // namespace anholon

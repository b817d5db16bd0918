#include "program/expansion.h"

#include <algorithm>

#include "base/assert.h"
#include "numeric/relative.h"
#include "program/fault.h"

namespace anholon {

namespace {
constexpr int kMostProjections = 4;
// An LU is singular if its smallest scaled singular value is below this many round-offs.
constexpr int kSingularRoundoffs = 50;
}  // namespace

// Returns the number of orders of the series: those of the state and the leading derivative, the stages, and one
// beyond.
static std::size_t length_of_series(const Program& program, int stages) {
  return static_cast<std::size_t>(stages + *std::max_element(program.d.begin(), program.d.end()) + 2);
}

template <Number N>
Expansion<N>::Expansion(const Program& program, const std::vector<N>& parameters, int stages)
    : program_(&program), parameters_(parameters), stages_(stages),
      machine_(program.tape, static_cast<std::size_t>(stages) + 1, parameters),
      x_(program.d, length_of_series(program, stages)), jacobian_(program), delta_x_(program.unknowns(), N(0)),
      r_(program.unknowns(), N(0)), hidden_(program.c) {}

template <Number N>
void Expansion<N>::load(const N& t, const std::vector<N>& state, const std::vector<N>& leading) {
  t_ = t;
  const Program& p = *program_;
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    N* x = x_.series(j);
    for (int k = 0; k < p.d[j]; ++k) x[k] = state[x_.offset(j) + static_cast<std::size_t>(k)] / x_.factorial(k);
    x[p.d[j]] = leading.empty() ? N(0) : leading[j] / x_.factorial(p.d[j]);
  }
}

template <Number N>
void Expansion<N>::state(std::vector<N>& out) const {
  out.resize(state_size());
  for (std::size_t j = 0; j < program_->unknowns(); ++j)
    for (int k = 0; k < program_->d[j]; ++k) out[x_.offset(j) + static_cast<std::size_t>(k)] = derivative(j, k);
}

template <Number N>
void Expansion<N>::leading(std::vector<N>& out) const {
  out.resize(program_->unknowns());
  for (std::size_t j = 0; j < program_->unknowns(); ++j) out[j] = derivative(j, program_->d[j]);
}

template <Number N>
void Expansion<N>::set_inputs(int stage, std::size_t from, std::size_t to) {
  for (std::size_t i = from; i < to; ++i) {
    const ProgramInput& in = program_->inputs[i];
    const int p = stage + program_->tape.code[in.slot].lead;
    if (p < 0) continue;
    N& w = machine_.series(in.slot)[p];
    switch (in.kind) {
    case ProgramInput::Kind::time:
      w = p == 0 ? t_ : p == 1 ? N(1) : N(0);
      break;
    case ProgramInput::Kind::variable: {
      // (x^(k))_p = x_(p+k) (p+k)! / p!
      const std::size_t up = static_cast<std::size_t>(p), k = up + static_cast<std::size_t>(in.order);
      w = k < x_.length() ? x_(in.variable, k) * rising<N>(up, k) : N(0);
      break;
    }
    case ProgramInput::Kind::other:
      break;
    }
  }
}

template <Number N>
void Expansion<N>::sweep(int stage) {
  set_inputs(stage, 0, program_->inputs.size());
  machine_.sweep(stage, 0, program_->tape.main_end);
}

template <Number N>
void Expansion<N>::sweep_known(int last_stage) {
  for (int s = -program_->tape.largest_lead; s <= last_stage; ++s) sweep(s);
}

template <Number N>
void Expansion<N>::evaluate(const std::vector<std::uint32_t>& slots) {
  for (int s = -program_->tape.largest_lead; s <= 0; ++s) {
    set_inputs(s, 0, program_->inputs.size());
    machine_.sweep(s, slots);
  }
}

template <Number N>
void Expansion<N>::sweep_quadratures(int last_stage) {
  const Program& p = *program_;
  if (p.quadratures == 0) return;
  const std::uint32_t end = static_cast<std::uint32_t>(p.tape.code.size());
  for (int stage = 0; stage <= last_stage; ++stage) {
    set_inputs(stage, 0, p.inputs.size());
    machine_.sweep(stage, p.tape.main_end, end);
  }
}

template <Number N>
void Expansion<N>::equations(std::vector<N>& out) const {
  const Program& p = *program_;
  out.resize(p.unknowns());
  for (std::size_t i = 0; i < p.unknowns(); ++i) {
    const std::size_t order = static_cast<std::size_t>(p.c[i]);
    out[i] = machine_.series(p.tape.roots[i])[order] * x_.factorial(order);
  }
}

template <Number N>
Outcome Expansion<N>::prepare() {
  sweep_known(0);
  jacobian_.compute(machine_);
  if (!jacobian_.finite()) return fault_outcome(*program_, machine_, 0);
  const auto vanishes = [&] { return smallest_singular_value() < unit_roundoff<N>() * N(kSingularRoundoffs); };
  if (!jacobian_.factor()) return singular();
  if (!vanishes()) return {};
  // Sparse factors do not decide that J is singular.
  if (jacobian_.is_sparse() && jacobian_.factor_written() && !vanishes()) return {};
  return singular();
}

// Names the constraint that has become singular, or the coordinate that has lost its inertia.
template <Number N>
Outcome Expansion<N>::singular() const {
  const System& s = *program_->system;
  const std::size_t n = s.coordinates, constraints = s.constraints.size();
  constexpr double kLost = 1e-10, kTiny = 1e-9;
  const Matrix<N> j = jacobian_.matrix();
  Matrix<N> phi(constraints, n);
  for (std::size_t i = 0; i < constraints; ++i)
    for (std::size_t a = 0; a < n; ++a) phi(i, a) = j(n + i, a);
  const RowChoice<N> rows = choose_rows(phi, N(kLost));
  if (!rows.dependent.empty()) {
    std::string names;
    for (std::size_t i : rows.dependent) names += (names.empty() ? "'" : ", '") + s.equation_names[n + i] + "'";
    const bool vanishes = rows.vanishing.size() == rows.dependent.size();
    return {OutcomeKind::singular,
            "singular configuration: the constraint " + names + " has lost its hold" +
                (vanishes ? " (all its coefficients vanish)" : " (its coefficients depend on those of the others)"),
            "start or stop the motion away from this configuration, or write the constraint in a form that is regular "
            "here"};
  }
  const RowChoice<N> all = choose_rows(j, N(kLost));
  std::vector<bool> used(s.size(), false);
  for (std::size_t column : all.pivot_columns) used[column] = true;
  std::string names, hint = "no inertia acts in some direction, a constraint has lost its hold, or angles are at their "
                            "singularity (Euler angles at theta = 0)";
  for (std::size_t k = 0; k < s.size(); ++k) {
    if (used[k]) continue;
    names += (names.empty() ? "" : ", ") +
             derivative_name(s.variable_names[k], static_cast<unsigned>(program_->d[k]), Format::text);
    if (const double largest = to_double(jacobian_.largest(k)); k >= n && k < n + constraints && largest < kTiny)
      hint = "the coefficients of the constraint '" + s.equation_names[k] + "' are at most " + number_text(largest, 2) +
             " here: multiply the constraint by a number that brings them near 1, or start where they do not vanish";
  }
  return {OutcomeKind::singular,
          "singular configuration: the equations do not determine " +
              (names.empty() ? std::string("the accelerations") : names),
          hint};
}

// Returns the size of the terms of equation i at derivative order c_i - level, including those that result from the
// unknowns by J.
template <Number N>
N Expansion<N>::terms_of(std::size_t i, int level) const {
  const Program& p = *program_;
  const N scale = machine_.terms(i, static_cast<std::size_t>(p.c[i] - level)), moved = moved_by_unknowns(i, level);
  return moved > scale ? moved : scale;
}

template <Number N>
N Expansion<N>::moved_by_unknowns(std::size_t i, int level) const {
  const Program& p = *program_;
  if (jacobian_.is_sparse()) {
    if (moved_.size() <= static_cast<std::size_t>(level)) moved_.resize(static_cast<std::size_t>(level) + 1);
    std::vector<N>& moved = moved_[static_cast<std::size_t>(level)];
    if (moved.empty()) {
      std::vector<N> x(p.unknowns(), N(0));
      for (std::size_t j = 0; j < p.unknowns(); ++j)
        if (const int k = p.d[j] - level; k >= 0) x[j] = x_(j, k);
      jacobian_.sparse().multiply_sizes(x, moved);
    }
    return moved[i];
  }
  const Matrix<N>& all = jacobian_.written();
  N moved(0);
  for (std::size_t j = 0; j < p.unknowns(); ++j)
    if (const int k = p.d[j] - level; k >= 0 && all(i, j) != N(0)) moved += abs(N(all(i, j) * x_(j, k)));
  return moved;
}

// Returns the largest x_j^(d_j - level), or the largest force that causes one, as measured by the balanced J. If a
// whole level is round-off of the levels above and below (the velocities of a motion at rest), the size of that
// round-off counts.
template <Number N>
const N& Expansion<N>::balanced_size(int level) const {
  const Program& p = *program_;
  const int deepest = *std::max_element(p.d.begin(), p.d.end());
  size_.resize(static_cast<std::size_t>(deepest) + 1);
  std::optional<N>& known = size_[static_cast<std::size_t>(level)];
  if (known) return *known;
  const Balance& balance = jacobian_.balance();
  N size(0);
  for (std::size_t j = 0; j < p.unknowns(); ++j)
    if (const int k = p.d[j] - level; k >= 0)
      if (N v = abs(derivative(j, k)) / N(balance.column[j]); v > size) size = v;
  for (std::size_t i = 0; level == 0 && i < p.unknowns(); ++i)
    if (N v = terms_of(i, 0) * x_.factorial(p.c[i]) * N(balance.row[i]); v > size) size = v;
  if (level > 0 && level < deepest) {
    const N between = sqrt(N(balanced_size(level - 1) * balanced_size(deepest)));
    if (is_finite(between) && size < unit_roundoff<N>() * N(kRoundoffsOfSum) * between) size = between;
  }
  known = size;
  return *known;
}

template <Number N>
N Expansion<N>::size_of_level(int level, std::size_t i) const {
  const N& size = balanced_size(level);
  return size / N(jacobian_.balance().row[i]);
}

template <Number N>
N Expansion<N>::size_of_leading(std::size_t j) const {
  const N& size = balanced_size(0);
  return size * N(jacobian_.balance().column[j]);
}

// Computes the residuals of the equations at derivative order c_i - level, as right sides for J.
template <Number N>
bool Expansion<N>::residual(int level, std::vector<N>& r, N& worst) {
  const Program& p = *program_;
  bool any = false;
  worst = N(0);
  size_.clear(), moved_.clear();
  for (std::size_t i = 0; i < p.unknowns(); ++i) {
    const int order = p.c[i] - level;
    r[i] = N(0);
    if (order < 0) continue;
    N* hidden = level > 0 ? &hidden_(i, order) : nullptr;
    if (hidden) *hidden = N(0);
    const N value = machine_.series(p.tape.roots[i])[order];
    if (!is_finite(value)) {
      worst = value;
      return true;
    }
    const N& factor = x_.factorial(order);
    r[i] = -(value * factor);
    if (!(abs(value) > N(0))) continue;
    any = true;
    const N relative = relative_miss(value, terms_of(i, level), [&] { return N(size_of_level(level, i) / factor); });
    if (hidden) *hidden = relative;
    if (relative > worst) worst = relative;
  }
  return any;
}

// Returns the distance of the state from the hidden constraints of a level, relative to its size: residuals r relative
// to their rows of J. `equation`: the equation with this distance.
template <Number N>
N Expansion<N>::displacement(int level, const std::vector<N>& r, std::size_t& equation) const {
  const Program& p = *program_;
  N size(1), most(0);
  for (std::size_t j = 0; j < p.unknowns(); ++j)
    if (const int k = p.d[j] - level; k >= 0)
      if (N v = abs(derivative(j, k)); v > size) size = v;
  for (std::size_t i = 0; i < p.unknowns(); ++i) {
    if (p.c[i] < level) continue;
    const N row = jacobian_.largest(i, level);
    if (!(row > N(0))) continue;
    if (N v = abs(r[i]) / (row * size); v > most) most = v, equation = i;
  }
  return most;
}

template <Number N>
Outcome Expansion<N>::project() {
  return project([this](const std::vector<N>& r, std::vector<N>& y) { jacobian_.solve(r, y); });
}

template <Number N>
Outcome Expansion<N>::project(const Solver& solver) {
  const Program& p = *program_;
  const N quiet = unit_roundoff<N>() * N(kQuietRoundoffs);
  constraint_residual_ = drift_ = N(0);
  const int deepest = *std::max_element(p.c.begin(), p.c.end());
  bool changed = false;
  for (int level = deepest; level >= 1; --level) {
    N worst(0), before(-1);
    for (int k = 0;; ++k) {
      if (changed || k > 0) sweep_known(-level);
      const bool any = residual(level, r_, worst);
      std::size_t equation = 0;
      if (k == 0)
        if (const N d = displacement(level, r_, equation); d > drift_) drift_ = d, most_missed_ = equation;
      if (!any || !(worst > quiet)) break;
      if (!is_finite(worst)) return fault_outcome(*program_, machine_, -level);
      if (k >= kMostProjections || (before >= N(0) && !(worst < before * N(0.5)))) break;
      before = worst;
      solver(r_, y_);
      for (std::size_t j = 0; j < p.unknowns(); ++j) {
        const int order = p.d[j] - level;
        if (order < 0) continue;
        x_(j, order) += y_[j] / x_.factorial(order);
      }
      changed = true;
    }
    if (worst > constraint_residual_) constraint_residual_ = worst;
  }
  if (changed) sweep_known(0);
  return {};
}

template <Number N>
void Expansion<N>::measure() {
  constraint_residual_ = N(0);
  for (int level = *std::max_element(program_->c.begin(), program_->c.end()); level >= 1; --level) {
    N worst(0);
    residual(level, r_, worst);
    if (!(worst <= constraint_residual_)) constraint_residual_ = worst;  // true for NaN as well
  }
}

// Adds the effect of the new coefficients to all slots that depend on them.
template <Number N>
void Expansion<N>::add_leading(int stage) {
  jacobian_.sensitivity().add(
      stage, machine_, [&](std::size_t j) -> const N& { return delta_x_[j]; },
      [&](std::size_t j, std::size_t k) -> const N& { return x_(j, k); });
}

template <Number N>
Outcome Expansion<N>::extend() {
  const Program& p = *program_;
  // J and the partial derivatives at the computed leading derivatives (they may enter nonlinearly).
  jacobian_.compute(machine_);
  if (!jacobian_.factored() && !jacobian_.factor()) return singular();
  for (int stage = 1; stage <= stages_; ++stage) {
    for (std::size_t j = 0; j < p.unknowns(); ++j) x_(j, p.d[j] + stage) = N(0);
    sweep(stage);
    const std::size_t s = static_cast<std::size_t>(stage);
    // The passes after the first are steps of iterative refinement. Their residual comes from the tape itself, not from
    // J: if J is nearly singular (Euler angles near their singularity), the tape still contains the small difference of
    // two rates whose squares J has rounded away.
    for (int pass = 0; pass < jacobian_.passes(); ++pass) {
      for (std::size_t i = 0; i < p.unknowns(); ++i) {
        const std::size_t order = s + static_cast<std::size_t>(p.c[i]);
        r_[i] = -(machine_.series(p.tape.roots[i])[order] * rising<N>(s, order));
      }
      jacobian_.solve_once(r_, y_);
      for (std::size_t j = 0; j < p.unknowns(); ++j) {
        const std::size_t order = s + static_cast<std::size_t>(p.d[j]);
        delta_x_[j] = y_[j] / rising<N>(s, order);
        x_(j, order) += delta_x_[j];
        if (!is_finite(y_[j])) return fault_outcome(*program_, machine_, stage);
      }
      add_leading(stage);
    }
  }
  sweep_quadratures(stages_);
  return {};
}

template <Number N>
void Expansion<N>::cut_to(const std::vector<N>& leading) {
  const Program& p = *program_;
  for (std::size_t j = 0; j < p.unknowns(); ++j) {
    N* x = x_.series(j);
    const std::size_t d = static_cast<std::size_t>(p.d[j]);
    x[d] = leading[j] / x_.factorial(d);
    std::fill(x + d + 1, x + x_.length(), N(0));
  }
  sweep_known(0);
  sweep_quadratures(0);
  for (std::uint32_t slot = 0; slot < p.tape.code.size(); ++slot) {
    const Instruction& in = p.tape.code[slot];
    if (in.constant) continue;
    N* series = machine_.series(slot);
    std::fill(series + in.lead + 1, series + stages_ + in.lead + 1, N(0));
    // An integrated or watched formula without a value at the point counts as zero in so short a step.
    if (slot >= p.tape.main_end && !is_finite(series[0])) series[0] = N(0);
  }
}

template class Expansion<double>;
template class Expansion<long double>;
template class Expansion<Quad>;
template class Expansion<Multi>;

}  // namespace anholon

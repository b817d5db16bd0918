#include "structure/stage.h"

#include <algorithm>
#include <cmath>
#include <concepts>

namespace anholon {

namespace {
constexpr int kMostIterations = 60;
// Steps along Newton's flow grow by a factor where it leaves a place at which the Jacobian is nearly singular, and a flow
// that comes to an end needs fewer.
constexpr int kMostFlowSteps = 100;
// After this number of line searches in a row without improvement the iteration is given up.
constexpr int kMostInVain = 3;
}  // namespace

static Tape compiled(const Mechanics& m, const std::vector<StageEquation>& equations, const Column& unknowns,
                     const std::vector<Column>* mass, bool& linear) {
  Column es;
  for (const StageEquation& e : equations) es.push_back(e.residual);
  for (const StageEquation& e : equations) {
    const Column d = gradient(e.residual, unknowns);
    es.insert(es.end(), d.begin(), d.end());
  }
  const std::vector<NodeId> met = symbols(std::span<const Expr>(es).subspan(equations.size()));
  linear = std::none_of(unknowns.begin(), unknowns.end(),
                        [&](Expr u) { return std::find(met.begin(), met.end(), u.id) != met.end(); });
  for (const Column& row : mass && !mass->empty() ? *mass : mass_matrix(m)) es.insert(es.end(), row.begin(), row.end());
  return compile(es);
}

StagePlan::StagePlan(const Mechanics& m, std::vector<StageEquation> of, Column in, unsigned measured,
                     const std::vector<Column>* mass)
    : equations(std::move(of)), unknowns(std::move(in)), metric(measured),
      tape(compiled(m, equations, unknowns, mass, linear)) {
  std::vector<std::uint32_t> slots;
  for (const Input& input : tape.inputs) {
    is_unknown.push_back(std::any_of(unknowns.begin(), unknowns.end(), [&](Expr u) { return u.id == input.symbol; }));
    if (is_unknown.back()) slots.push_back(input.slot);
  }
  moving = dependents(tape, slots);
  mass_moves = std::any_of(tape.roots.begin() + static_cast<std::ptrdiff_t>(equations.size() * (unknowns.size() + 1)),
                           tape.roots.end(), [&](std::uint32_t root) {
                             return std::binary_search(moving.begin(), moving.end(), root) ||
                                    std::find(slots.begin(), slots.end(), root) != slots.end();
                           });
}

template <Number N>
Stage<N>::Stage(const Mechanics& m, std::shared_ptr<const StagePlan> plan, const std::vector<N>& parameters)
    : m_(m), plan_(std::move(plan)), machine_(plan_->tape, 0, parameters) {}

namespace {

// Whether two numbers have the same bits; false in number types that are not compared bit by bit.
template <Number N>
bool same_bits(const N& a, const N& b) {
  if constexpr (std::floating_point<N>)
    return a == b && std::signbit(a) == std::signbit(b);
  else
    return false;
}

}  // namespace

template <Number N>
typename Stage<N>::Change Stage<N>::bind_inputs(const InitialState<N>& s) {
  Change change = known_ ? Change::none : Change::all;
  const Graph& g = m_.graph();
  const std::vector<Input>& inputs = plan_->tape.inputs;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const Node& n = g.node(inputs[i].symbol);
    const N* known = s.value(n);
    const N value = n.kind == Kind::time ? s.t : known ? *known : N(0);
    N& input = machine_.series(inputs[i].slot)[0];
    if (!same_bits(input, value)) change = std::max(change, plan_->is_unknown[i] ? Change::unknowns : Change::all);
    input = value;
  }
  return change;
}

template <Number N>
bool Stage<N>::evaluate(const InitialState<N>& s) {
  const Change change = bind_inputs(s);
  // An unknown that occurs in no equation has no input, but moves the scales.
  const std::size_t n = unknowns();
  bool moved = change != Change::none || at_.size() != n;
  for (std::size_t j = 0; j < n && !moved; ++j) moved = !same_bits(at_[j], *s.value(unknown(j)));
  if (!moved) return true;
  known_ = false;
  if (change == Change::all)
    machine_.evaluate();
  else if (change == Change::unknowns)
    machine_.evaluate(plan_->moving);
  at_.resize(n);
  for (std::size_t j = 0; j < n; ++j) at_[j] = *s.value(unknown(j));
  const bool stays = change != Change::all && plan_->linear && !plan_->mass_moves;
  if (!stays) elimination_.reset(), determined_.reset();
  if (!read_equations(stays)) return false;
  if (!stays && !read_metric()) return false;
  known_ = true;
  return true;
}

template <Number N>
bool Stage<N>::read_equations(bool jacobian_stays) {
  const std::size_t n = unknowns();
  residual.assign(size(), N(0));
  scale.assign(size(), N(0));
  floor_.assign(size(), N(0));
  if (!jacobian_stays) jacobian.rows = size(), jacobian.cols = n, jacobian.data.assign(size() * n, N(0));
  N largest_unknown(1);
  for (const N& x : at_)
    if (N v = abs(x); v > largest_unknown) largest_unknown = v;
  for (std::size_t i = 0; i < size(); ++i) {
    if (!kept_.empty() && !kept_[i]) {
      scale[i] = N(1);
      continue;
    }
    undefined = i;
    residual[i] = machine_.value(i);
    if (!is_finite(residual[i])) return false;
    scale[i] = machine_.terms(i, 0);
    for (std::size_t j = 0; j < n; ++j) {
      N& slope = jacobian(i, j);
      if (!jacobian_stays) slope = machine_.value(size() + i * n + j);
      if (!is_finite(slope)) return false;
      if (!(abs(slope) > N(0))) continue;
      if (N part = abs(N(slope * at_[j])); part > scale[i]) scale[i] = part;
      if (N part = abs(slope) * largest_unknown * unit_roundoff<N>(); part > floor_[i]) floor_[i] = part;
    }
    if (floor_[i] > scale[i]) scale[i] = floor_[i];
    if (!(scale[i] > N(0))) scale[i] = N(1);
  }
  undefined = size();
  return true;
}

template <Number N>
bool Stage<N>::read_metric() {
  const std::size_t n = unknowns(), q = m_.q.size();
  metric.rows = metric.cols = n;
  metric.data.assign(n * n, N(0));
  const std::size_t first = size() * (n + 1);
  const auto mass = [&](std::size_t a, std::size_t b) -> const N& { return machine_.value(first + a * q + b); };
  N largest(0);
  for (std::size_t a = 0; a < q; ++a)
    for (std::size_t b = 0; b < q; ++b) {
      if (!is_finite(mass(a, b))) return false;
      if (a == b && abs(mass(a, b)) > largest) largest = abs(mass(a, b));
    }
  // A coordinate without inertia still needs a metric.
  if (!(largest > N(0))) largest = N(1);
  const auto measured = [&](const Node& u) { return u.kind == Kind::jet && (plan_->metric >> u.order & 1U) != 0; };
  for (std::size_t i = 0; i < n; ++i) {
    const Node& a = unknown(i);
    if (measured(a))
      for (std::size_t j = 0; j < n; ++j)
        if (const Node& b = unknown(j); measured(b) && a.order == b.order) metric(i, j) = mass(a.index, b.index);
    metric(i, i) += largest * N(1e-12);
  }
  return true;
}

template <Number N>
typename Stage<N>::Elimination& Stage<N>::elimination(const std::vector<std::size_t>& free) {
  if (elimination_ && elimination_->free == free) return *elimination_;
  Elimination& e = elimination_.emplace();
  e.a = Matrix<N>(size(), free.size());
  for (std::size_t i = 0; i < size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j) e.a(i, j) = jacobian(i, free[j]);
  e.rows = choose_rows(e.a, N(kDependent));
  const std::vector<std::size_t>& rows = e.rows.independent;
  Matrix<N> ar(rows.size(), free.size()), part(free.size(), free.size());
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j) ar(i, j) = e.a(rows[i], j);
  for (std::size_t i = 0; i < free.size(); ++i)
    for (std::size_t j = 0; j < free.size(); ++j) part(i, j) = metric(free[i], free[j]);
  e.possible = !rows.empty() && e.change.factor(part, ar);
  e.free = free;  // is set last: after an exception the elimination is that of no unknowns
  return e;
}

namespace {

// Tells for each column of a whether a x = b determines that entry of x: true if its unit vector is a combination of the
// rows, which Gauss-Jordan elimination with full pivoting shows.
template <Number N>
std::vector<bool> determined_columns(Matrix<N> a) {
  for (std::size_t i = 0; i < a.rows; ++i) {
    N largest(0);
    for (std::size_t j = 0; j < a.cols; ++j)
      if (N v = abs(a(i, j)); v > largest) largest = v;
    for (std::size_t j = 0; j < a.cols && largest > N(0); ++j) a(i, j) = N(a(i, j) / largest);
  }
  std::vector<bool> determined(a.cols, false), used(a.cols, false);
  std::vector<std::size_t> pivots;
  for (std::size_t top = 0; top < a.rows; ++top) {
    std::size_t row = top, column = 0;
    N pivot(0);
    for (std::size_t i = top; i < a.rows; ++i)
      for (std::size_t j = 0; j < a.cols; ++j)
        if (N v = abs(a(i, j)); !used[j] && v > pivot) pivot = v, row = i, column = j;
    if (!(pivot > N(kDependent))) break;
    used[column] = true;
    pivots.push_back(column);
    const N by = a(row, column);
    for (std::size_t j = 0; j < a.cols; ++j) std::swap(a(top, j), a(row, j)), a(top, j) = N(a(top, j) / by);
    for (std::size_t i = 0; i < a.rows; ++i)
      if (const N factor = a(i, column); i != top && factor != N(0))
        for (std::size_t j = 0; j < a.cols; ++j) a(i, j) = N(a(i, j) - factor * a(top, j));
  }
  for (std::size_t k = 0; k < pivots.size(); ++k) {
    bool alone = true;
    for (std::size_t j = 0; j < a.cols; ++j) alone = alone && (used[j] || !(abs(a(k, j)) > N(kDependent)));
    determined[pivots[k]] = alone;
  }
  return determined;
}

}  // namespace

template <Number N>
const std::vector<bool>& Stage<N>::determined(const std::vector<std::size_t>& free) {
  if (!determined_ || determined_->free != free) {
    Matrix<N> a(size(), free.size());
    for (std::size_t i = 0; i < size(); ++i)
      for (std::size_t j = 0; j < free.size(); ++j) a(i, j) = jacobian(i, free[j]);
    determined_ = Determined{free, determined_columns(std::move(a))};
  }
  return determined_->is;
}

// Values may have few digits, in relation to the terms that they make; and they may be doubles of which the greatest has a
// round-off as large as all terms of an equation.
template <Number N>
bool Stage<N>::is_rounded(std::size_t i) const {
  const N round_off_of_doubles = floor_[i] * N(std::max(1.0, unit_roundoff<double>() / to_double(unit_roundoff<N>())));
  return abs(residual[i]) <= N(kRounded) * scale[i] || abs(residual[i]) <= round_off_of_doubles;
}

template <Number N>
bool Stage<N>::is_rounded() const {
  for (std::size_t i = 0; i < size(); ++i)
    if (!is_rounded(i)) return false;
  return true;
}

template <Number N>
bool Stage<N>::contradicts(const std::vector<std::size_t>& free) const {
  for (std::size_t i = 0; i < size(); ++i)
    if (!is_rounded(i) &&
        std::none_of(free.begin(), free.end(), [&](std::size_t j) { return abs(jacobian(i, j)) > N(0); }))
      return true;
  return false;
}

template <Number N>
N Stage<N>::worst(const std::vector<N>& scales, std::size_t* which) const {
  N most(0);
  for (std::size_t i = 0; i < size(); ++i)
    if (N v = abs(residual[i]) / scales[i]; v > most && abs(residual[i]) > floor_[i]) {
      most = v;
      if (which) *which = i;
    }
  return most;
}

namespace {

// The smallest part of a step of Newton's method along its flow, a power of 4.
constexpr double kLeastFlowPart = 0x1p-40;

// Newton's method on a stage, in the free unknowns.
template <Number N>
class Iteration {
 public:
  Iteration(Stage<N>& stage, InitialState<N>& state, const std::vector<std::size_t>& free)
      : s_(stage), state_(state), free_(free) {
    for (std::size_t j : free) x_.push_back(&s_.x(state, j)), guess_.push_back(*x_.back());
  }

  const std::vector<N>& guess() const { return guess_; }
  std::vector<N> point() const {
    std::vector<N> p;
    for (const N* v : x_) p.push_back(*v);
    return p;
  }
  // Returns false if the equations have no value there.
  bool go_to(const std::vector<N>& point) {
    for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = point[j];
    return s_.evaluate(state_);
  }
  bool solved() const { return !(s_.worst() > stage_rounding<N>()); }

  // The square of the distance from the guess, in the metric at the point.
  N distance() const {
    N sum(0);
    for (std::size_t i = 0; i < x_.size(); ++i)
      for (std::size_t j = 0; j < x_.size(); ++j)
        sum += (*x_[i] - guess_[i]) * s_.metric(free_[i], free_[j]) * (*x_[j] - guess_[j]);
    return sum;
  }

  // Goes towards the solution nearest to the guess or, if `nearest` is false, to any solution: every step is then the
  // least one.
  bool run(bool nearest) {
    in_vain_ = 0;
    const N rounding = stage_rounding<N>();
    if (!s_.evaluate(state_)) return false;
    N last_step(-1);
    bool nudged = false;
    for (int k = 0; k < kMostIterations && !free_.empty(); ++k) {
      typename Stage<N>::Elimination& elimination = s_.elimination(free_);
      const RowChoice<N>& rows = elimination.rows;
      if (rows.dependent.size() && !nudged && s_.worst() > rounding && k == 0) {
        // The guess may be a stationary point of a constraint (the centre of a circle): move away from it.
        nudged = true;
        if (flat(rows)) {
          for (std::size_t j = 0; j < free_.size(); ++j) *x_[j] += N(0.1) + N(0.037) * N(static_cast<int>(j % 7));
          if (!s_.evaluate(state_)) return false;
          continue;
        }
      }
      if (rows.independent.empty()) break;
      if (!elimination.possible) return true;
      least_step(elimination, nearest);
      if (!search()) return false;
      if (in_vain_ > kMostInVain) return true;
      N moved(0), size(0);
      for (std::size_t j = 0; j < free_.size(); ++j) {
        if (N v = abs(step_[j]); v > moved) moved = v;
        if (N v = abs(*x_[j]); v > size) size = v;
      }
      const N floor = unit_roundoff<N>() * N(8) * (size > N(1) ? size : N(1));
      const bool settled = !(moved > floor) || (last_step >= N(0) && !(moved < last_step) && moved < floor * N(100));
      last_step = moved;
      if (settled) break;
    }
    return true;
  }

  // Follows Newton's flow from the point, along which all residuals fall in proportion: the solution at its end is that
  // which belongs to the point, also where a full step of Newton's method would land near another one. Returns false if
  // the flow ends before.
  bool follow() {
    if (!s_.evaluate(state_)) return false;
    flow_part_ = kLeastFlowPart;
    for (int k = 0; k < kMostFlowSteps; ++k) {
      if (solved()) return true;
      typename Stage<N>::Elimination& elimination = s_.elimination(free_);
      if (elimination.rows.independent.empty() || !elimination.possible) return false;
      least_step(elimination, false);
      if (!flow()) return false;
    }
    return solved();
  }

 private:
  bool flat(const RowChoice<N>& rows) const {
    return std::any_of(rows.dependent.begin(), rows.dependent.end(),
                       [&](std::size_t i) { return abs(s_.residual[i]) > stage_rounding<N>() * s_.scale[i]; });
  }

  // Computes the step that least changes the point, or the guess if `nearest`.
  void least_step(typename Stage<N>::Elimination& e, bool nearest) {
    const std::vector<std::size_t>& rows = e.rows.independent;
    const std::size_t n = free_.size();
    right_.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      right_[i] = -s_.residual[rows[i]];
      if (nearest)
        for (std::size_t j = 0; j < n; ++j) right_[i] += e.a(rows[i], j) * (*x_[j] - guess_[j]);
    }
    e.change.solve(right_, step_);
    if (nearest)
      for (std::size_t j = 0; j < n; ++j) step_[j] = N(guess_[j] + step_[j] - *x_[j]);
  }

  // Whether the residuals are those of Newton's flow at this part of the step: a part of them is gone, to the fraction
  // kBent of that part.
  bool flows(double part) const {
    constexpr double kBent = 0.5;
    N most(0), missed(0);
    for (std::size_t i = 0; i < s_.size(); ++i) {
      if (const N v = abs(old_residual_[i]) / scale_[i]; v > most) most = v;
      if (const N v = abs(N(s_.residual[i] - N(1 - part) * old_residual_[i])) / scale_[i]; v > missed) missed = v;
    }
    return missed <= N(kBent * part) * most + stage_rounding<N>() * N(4);
  }

  // Goes along the step as far as Newton's flow does, found from smaller parts of the step to larger ones: a full step may
  // end near a solution by chance. Returns false if the flow does not go along the step.
  bool flow() {
    constexpr double kTimes = 4, kFewer = 64;
    scale_ = s_.scale;
    old_residual_ = s_.residual;
    old_.clear();
    for (const N* v : x_) old_.push_back(*v);
    const auto go = [&](double part) {
      for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = old_[j] + N(part) * step_[j];
      return s_.evaluate(state_);
    };
    double good = 0;
    for (double part = std::max(kLeastFlowPart, flow_part_ / kFewer); part <= 1; part *= kTimes) {
      if (!go(part) || !flows(part)) break;
      good = part;
    }
    if (!go(good) || !(good > 0)) return false;
    flow_part_ = good;
    return true;
  }

  // Goes along the step as long as the residual decreases; `step_` is then the step made.
  bool search() {
    // Progress is measured relative to the scales at the start of the step: those at its end grow with it.
    scale_ = s_.scale;
    old_.clear();
    for (const N* v : x_) old_.push_back(*v);
    const N now = s_.worst(scale_);
    N fraction(1);
    bool better = false;
    for (int halvings = 0; halvings < 12 && !better; ++halvings) {
      if (halvings > 0) fraction = fraction * N(0.5);
      for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = old_[j] + fraction * step_[j];
      if (!s_.evaluate(state_)) continue;
      const bool less = s_.worst(scale_) <= now * N(0.9) + stage_rounding<N>() * N(4);
      in_vain_ = less ? 0 : in_vain_ + (halvings == 11);
      better = less || halvings == 11;
    }
    for (std::size_t j = 0; j < x_.size(); ++j) step_[j] = *x_[j] - old_[j];
    return better || s_.evaluate(state_);
  }

  Stage<N>& s_;
  InitialState<N>& state_;
  const std::vector<std::size_t>& free_;
  std::vector<N*> x_;
  std::vector<N> guess_;
  std::vector<N> right_, step_;  // of a step: the right side, and the step itself
  std::vector<N> scale_, old_;   // at the start of a step
  std::vector<N> old_residual_;  // of a step along Newton's flow
  double flow_part_ = 1;         // the part of the last step that was made along the flow
  int in_vain_ = 0;              // searches in a row that found no improvement along their step
};

// The k-th point around the guess, at increasing distance.
template <Number N>
std::vector<N> around(const std::vector<N>& guess, int k) {
  std::vector<N> p = guess;
  for (std::size_t j = 0; j < p.size(); ++j) {
    const unsigned draw = (static_cast<unsigned>(k) * 2654435761U + static_cast<unsigned>(j + 1) * 2246822519U) >> 16;
    const N size = abs(p[j]) > N(1) ? N(abs(p[j])) : N(1);
    p[j] += size * N(k) * N(static_cast<int>(draw % 2001U) - 1000) / N(4000);
  }
  return p;
}

}  // namespace

template <Number N>
bool find_by_least_change(Stage<N>& s, InitialState<N>& state, const std::vector<std::size_t>& free,
                          const InitialState<double>* near, bool by_flow) {
  constexpr int kStarts = 12;
  Iteration<N> newton(s, state, free);
  if (near && !free.empty()) {
    std::vector<N> there = newton.guess();
    for (std::size_t j = 0; j < free.size(); ++j)
      if (const double* x = near->value(s.unknown(free[j]))) there[j] = N(*x);
    if (newton.go_to(there) && newton.run(true) && newton.solved()) return true;
    newton.go_to(newton.guess());
  }
  if (by_flow && !free.empty()) {
    if (newton.follow()) {
      // Then to the nearest of a family of solutions, and to all digits. Another solution is farther by more than round-off.
      const std::vector<N> there = newton.point();
      const N farther = N(2) * newton.distance();
      if (!newton.run(true) || !newton.solved() || newton.distance() > farther) newton.go_to(there);
      return true;
    }
    newton.go_to(newton.guess());
  }
  const bool value = newton.run(true);
  if ((value && newton.solved()) || free.empty() || s.linear()) return value;
  const InitialState<N> first = state;
  std::vector<N> best;
  N least(0);
  for (int k = 0; k <= kStarts && (best.empty() || k < 3); ++k) {
    if (!newton.go_to(around(newton.guess(), k)) || !newton.run(false) || !newton.solved()) continue;
    const std::vector<N> there = newton.point();
    if (!newton.run(true) || !newton.solved()) newton.go_to(there);
    if (const N d = newton.distance(); best.empty() || d < least) least = d, best = newton.point();
  }
  if (!best.empty()) return newton.go_to(best);
  state = first;
  return value && s.evaluate(state);
}

template class Stage<double>;
template class Stage<long double>;
template class Stage<Quad>;
template class Stage<Multi>;
template bool find_by_least_change<double>(Stage<double>&, InitialState<double>&, const std::vector<std::size_t>&,
                                           const InitialState<double>*, bool);
template bool find_by_least_change<long double>(Stage<long double>&, InitialState<long double>&,
                                                const std::vector<std::size_t>&, const InitialState<double>*, bool);
template bool find_by_least_change<Quad>(Stage<Quad>&, InitialState<Quad>&, const std::vector<std::size_t>&,
                                         const InitialState<double>*, bool);
template bool find_by_least_change<Multi>(Stage<Multi>&, InitialState<Multi>&, const std::vector<std::size_t>&,
                                          const InitialState<double>*, bool);

// A tape names the symbols of its inputs by their ids, which a clone of the graph has, too.
template <>
inline constexpr bool kHoldsNoExpressions<Tape> = true;

static void for_each_expression(StageEquation& e, const ExprVisitor& f) {
  auto& [residual, what, span, condition] = e;
  for_each_expression_of(f, residual, what, span, condition);
}

void for_each_expression(StagePlan& p, const ExprVisitor& f) {
  auto& [equations, unknowns, metric, linear, tape, moving, mass_moves, is_unknown] = p;
  for_each_expression_of(f, equations, unknowns, metric, linear, tape);
  static_cast<void>(moving), static_cast<void>(mass_moves), static_cast<void>(is_unknown);  // without handles
}

}  // namespace anholon

#include "structure/stage.h"

#include <algorithm>
#include <limits>

#include "expr/derivatives/point_gradient.h"

namespace anholon {

static Tape compiled(const Mechanics& m, const std::vector<StageEquation>& equations, const Column& unknowns,
                     const std::vector<Column>* mass, bool& linear) {
  Column es;
  for (const StageEquation& e : equations) es.push_back(e.residual);
  for (const StageEquation& e : equations) {
    const Column d = point_gradient(e.residual, unknowns, AtKinks::no_value);
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
  for (const StageEquation& e : equations) {
    const std::vector<NodeId> met = symbols({&e.residual, 1});
    std::vector<bool>& row = holds.emplace_back();
    for (Expr u : unknowns) row.push_back(std::find(met.begin(), met.end(), u.id) != met.end());
    std::vector<NodeId>& others = known.emplace_back();
    for (const NodeId id : met) {
      const Kind kind = e.residual.graph->node(id).kind;
      if ((kind == Kind::jet || kind == Kind::multiplier) &&
          std::none_of(unknowns.begin(), unknowns.end(), [&](Expr u) { return u.id == id; }))
        others.push_back(id);
    }
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
    : m_(m), plan_(std::move(plan)), parameters_(parameters), machine_(plan_->tape, 0, parameters) {}

namespace {

// True if two numbers have the same bits; false in number types that are not compared bit by bit.
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
  if (!read_equations(s, stays)) return false;
  if (!stays && !read_metric()) return false;
  known_ = !lacks_slopes_;  // the values that are given may change without an input
  return true;
}

template <Number N>
bool Stage<N>::read_equations(const InitialState<N>& s, bool jacobian_stays) {
  const std::size_t n = unknowns();
  residual.assign(size(), N(0));
  scale.assign(size(), N(0));
  floor_.assign(size(), N(0));
  lacks_slopes_ = false;
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
      // A value that is given is held, and derivatives by it are not needed: an equilibrium has no velocities.
      if (!is_finite(slope) && *s.origin(unknown(j)) == Origin::given) slope = N(0), lacks_slopes_ = true;
      if (!is_finite(slope)) return false;
      if (!(abs(slope) > N(0))) continue;
      if (N part = abs(N(slope * at_[j])); part > scale[i]) scale[i] = part;
      if (N part = abs(slope) * largest_unknown * unit_roundoff<N>(); part > floor_[i]) floor_[i] = part;
    }
    if (floor_[i] > scale[i]) scale[i] = floor_[i];
    if (!(scale[i] > N(0))) scale[i] = N(1);
  }
  undefined = size();
  if (!jacobian_stays) drop_round_off();
  return true;
}

// Sets partial derivatives to zero that are round-off. The round-off of doubles is used in all number types, because
// users type values as doubles.
template <Number N>
void Stage<N>::drop_round_off() {
  constexpr double kSmall = 64 * std::numeric_limits<double>::epsilon(),
                   kMoved = 2 * std::numeric_limits<double>::epsilon();
  if (!plan_->linear) return;
  // Moves a value by a few units in the last place, by different numbers for different k.
  const auto moved = [](const N& value, std::size_t k) {
    return N(value * N(1 + kMoved * static_cast<double>(1 + k % 3)));
  };
  std::optional<Machine<N>> machine;
  const std::size_t n = unknowns();
  for (std::size_t i = 0; i < size(); ++i) {
    N largest(0);
    for (std::size_t j = 0; j < n; ++j)
      if (N v = abs(jacobian(i, j)); v > largest) largest = v;
    for (std::size_t j = 0; j < n; ++j) {
      N& slope = jacobian(i, j);
      if (!(abs(slope) > N(0)) || abs(slope) > N(kSmall) * largest) continue;
      if (!machine) {
        machine = machine_;
        std::vector<N> parameters = parameters_;
        for (std::size_t k = 0; k < parameters.size(); ++k) parameters[k] = moved(parameters[k], k);
        machine->set_parameters(parameters);
        for (std::size_t k = 0; k < plan_->tape.inputs.size(); ++k) {
          N& input = machine->series(plan_->tape.inputs[k].slot)[0];
          input = moved(machine_.series(plan_->tape.inputs[k].slot)[0], k);
        }
        machine->evaluate();
      }
      if (N change = abs(N(machine->value(size() + i * n + j) - slope)); !(abs(slope) > change)) slope = N(0);
    }
  }
}

// A direction without inertia still needs a metric: adds `least` to the diagonal where Cholesky's pivot vanishes but for
// round-off. The sum of both is positive definite if the matrix has no negative eigenvalue.
template <Number N>
static void support_metric(Matrix<N>& metric, const N& least) {
  constexpr double kVanishes = 1e-12;
  const std::size_t n = metric.rows;
  Matrix<N> factor(n, n);
  for (std::size_t i = 0; i < n; ++i) {
    N pivot = metric(i, i);
    for (std::size_t j = 0; j < i; ++j) {
      N rest = metric(i, j);
      for (std::size_t k = 0; k < j; ++k) rest -= factor(i, k) * factor(j, k);
      factor(i, j) = N(rest / factor(j, j));
      pivot -= factor(i, j) * factor(i, j);
    }
    if (!(pivot > N(kVanishes) * metric(i, i))) {
      metric(i, i) += least;
      pivot = std::max(N(pivot + least), least);
    }
    factor(i, i) = sqrt(pivot);
  }
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
  if (!(largest > N(0))) largest = N(1);
  const auto measured = [&](const Node& u) { return u.kind == Kind::jet && (plan_->metric >> u.order & 1U) != 0; };
  for (std::size_t i = 0; i < n; ++i) {
    const Node& a = unknown(i);
    if (measured(a))
      for (std::size_t j = 0; j < n; ++j)
        if (const Node& b = unknown(j); measured(b) && a.order == b.order) metric(i, j) = mass(a.index, b.index);
  }
  support_metric(metric, N(largest * N(1e-12)));
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
  e.free = free;  // set last, so that after an exception the elimination belongs to no unknowns
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

// Values may be written with few digits in relation to their terms, or be doubles, the greatest of which has a
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

template class Stage<double>;
template class Stage<long double>;
template class Stage<Quad>;
template class Stage<Multi>;

// A tape refers to the symbols of its inputs by their ids, which are the same in a clone of the graph.
template <>
inline constexpr bool kHoldsNoExpressions<Tape> = true;

static void for_each_expression(StageEquation& e, const ExprVisitor& f) {
  auto& [residual, what, span, condition] = e;
  for_each_expression_of(f, residual, what, span, condition);
}

void for_each_expression(StagePlan& p, const ExprVisitor& f) {
  auto& [equations, unknowns, metric, linear, tape, moving, mass_moves, is_unknown, holds, known] = p;
  for_each_expression_of(f, equations, unknowns, metric, linear, tape);
  static_cast<void>(moving), static_cast<void>(mass_moves), static_cast<void>(is_unknown), static_cast<void>(holds),
      static_cast<void>(known);  // without handles
}

}  // namespace anholon

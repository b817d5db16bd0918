#include <algorithm>
#include <optional>

#include "base/assert.h"
#include "numeric/ball.h"
#include "tape/function_value.h"
#include "tape/tape.h"

namespace anholon {

namespace {

template <Scalar N>
N constant_value(const Rational& r) {
  if constexpr (std::same_as<N, Ball>)
    return Ball(r);
  else
    return from_rational<N>(r);
}

template <Scalar N>
N pi_value() {
  if constexpr (std::same_as<N, Ball>)
    return Ball::pi();
  else
    return pi<N>();
}

// abs and sign are smooth only away from 0, and atan2 away from its cut: elsewhere their Taylor coefficients after the
// first are meaningless. All other functions are not finite where they are not smooth.
bool smooth(Function f, const Ball& u) { return (f != Function::abs && f != Function::sign) || !u.contains_zero(); }
bool smooth(const Ball& y, const Ball& x) { return !y.contains_zero() || x.is_positive(); }

// Returns `exact` in halves, if it is one of the exponents that are roots; else 0.
int halves_of(const Rational& exact) {
  for (const int halves : {1, -1, 3, -3})
    if (exact == Rational(halves, 2)) return halves;
  return 0;
}

template <Scalar N>
N power_value(const N& u, const N& r, const Rational& exact, int halves) {
  switch (halves) {
  case 1:
    return sqrt(u);
  case -1:
    return N(1) / sqrt(u);
  case 3:
    return u * sqrt(u);
  case -3:
    return N(1) / (u * sqrt(u));
  default:
    break;
  }
  if constexpr (std::same_as<N, Ball>)
    return pow(u, exact);
  else
    return pow(u, r);
}

// Returns the side of a choice: 1 if s >= 0, -1 if s < 0, 0 if a ball does not decide.
template <Scalar N>
int branch(const N& s) {
  if constexpr (std::same_as<N, Ball>)
    return s.contains_zero() ? 0 : s.is_positive() ? 1 : -1;
  else
    return s < N(0) ? -1 : 1;
}

// Returns the number of ascending knots at or below x, and whether that number is certain.
template <Scalar N>
std::pair<std::size_t, bool> below(const std::vector<N>& knots, const N& x) {
  std::size_t low = 0, high = knots.size();
  while (low < high) {
    const std::size_t middle = (low + high) / 2;
    const int side = branch(N(x - knots[middle]));
    if (side == 0) return {0, false};
    if (side > 0)
      low = middle + 1;
    else
      high = middle;
  }
  return {low, true};
}

// True if the coefficients of orders 0..last are zero; always false for balls.
template <Scalar N>
bool vanishes(const N* series, std::size_t last) {
  if constexpr (std::same_as<N, Ball>)
    return false;
  else
    return std::all_of(series, series + last + 1, [](const N& c) { return c == N(0); });
}

template <Scalar N>
N unknown() {
  if constexpr (std::same_as<N, Ball>)
    return Ball::unknown();
  else
    return N(0);
}

// Returns an enclosure of both values, for a ball that does not decide.
template <Scalar N>
N either(const N& a, const N& b) {
  if constexpr (std::same_as<N, Ball>)
    return hull(a, b);
  else
    return a;
}

// Returns the coefficient of order p of a product of series.
template <Scalar N>
N product(const N* a, const N* b, std::size_t p) {
  N s(0);
  for (std::size_t j = 0; j <= p; ++j) addmul(s, a[j], b[p - j]);
  return s;
}

template <Scalar N>
N square(const N* a, std::size_t p) {
  N s(0);
  for (std::size_t j = 0; 2 * j < p; ++j) addmul(s, a[j], a[p - j]);
  s = s + s;
  if (p % 2 == 0) addmul(s, a[p / 2], a[p / 2]);
  return s;
}

// Returns an enclosure of all values of a step function on a ball.
template <Scalar N>
N any_value(const std::vector<N>& knots, const std::vector<N>& values, const N& x) {
  std::optional<N> all;
  for (std::size_t k = 0; k < values.size(); ++k) {
    const bool beyond = k > 0 && branch(N(x - knots[k - 1])) < 0,
               before = k < knots.size() && branch(N(x - knots[k])) > 0;
    if (!beyond && !before) all = all ? either(*all, values[k]) : values[k];
  }
  return all ? *all : unknown<N>();
}

}  // namespace

template <Scalar N>
Machine<N>::Machine(const Tape& tape, std::size_t orders, const std::vector<N>& parameters)
    : tape_(&tape),
      // An odd stride keeps histories of different slots off the same cache sets.
      stride_((orders + static_cast<std::size_t>(tape.largest_lead) + 1) | 1), data_(stride_ * tape.code.size(), N(0)) {
  for (const Rational& r : tape.rationals) rationals_.push_back(constant_value<N>(r)), halves_.push_back(halves_of(r));
  for (const StepFunction& f : tape.step_functions) {
    Steps s;
    for (const Rational& r : f.knots) s.knots.push_back(constant_value<N>(r));
    for (const Rational& r : f.values) s.values.push_back(constant_value<N>(r));
    steps_.push_back(std::move(s));
  }
  set_parameters(parameters);
}

template <Scalar N>
void Machine<N>::set_parameters(const std::vector<N>& parameters) {
  const std::vector<Instruction>& code = tape_->code;
  for (std::uint32_t s = 0; s < code.size(); ++s)
    if (code[s].op == Op::parameter) series(s)[0] = parameters[code[s].index];
  // Constant slots are computed once; derivatives of constants may come later in the tape and are not needed.
  for (std::uint32_t s = 0; s < code.size(); ++s)
    if (code[s].constant) step(code[s], s, 0);
}

template <Scalar N>
void Machine<N>::sweep(int stage, std::uint32_t from, std::uint32_t to) {
  for (std::uint32_t s = from; s < to; ++s) step_of_stage(s, stage);
}

template <Scalar N>
void Machine<N>::sweep(int stage, const std::vector<std::uint32_t>& slots) {
  for (const std::uint32_t s : slots) step_of_stage(s, stage);
}

template <Scalar N>
void Machine<N>::step_of_stage(std::uint32_t slot, int stage) {
  const Instruction& in = tape_->code[slot];
  const int p = stage + in.lead;
  if (in.constant || in.op == Op::input || p < 0) return;
  step(in, slot, static_cast<std::size_t>(p));
}

// Computes the coefficient of order p from the operands' coefficients up to p, and from the slot's own below p.
template <Scalar N>
void Machine<N>::step(const Instruction& in, std::uint32_t slot, std::size_t p) {
  N* w = series(slot);
  switch (in.op) {
  case Op::constant:
    w[0] = rationals_[in.index];
    return;
  case Op::pi:
    w[0] = pi_value<N>();
    return;
  case Op::input:
  case Op::parameter:
    return;
  case Op::linear:
    w[p] = sum(in, p);
    return;
  case Op::scale:
    w[p] = series(in.a)[0] * series(in.b)[p];
    return;
  case Op::multiply:
    w[p] = product(series(in.a), series(in.b), p);
    return;
  case Op::square:
    w[p] = square(series(in.a), p);
    return;
  case Op::divide:
    w[p] = quotient(in, w, p);
    return;
  case Op::power:
    w[p] = power(in, w, p);
    return;
  case Op::function:
    w[p] = p == 0 ? function_value(static_cast<Function>(in.index), series(in.a)[0]) : function(in, p);
    return;
  case Op::arctan2:
    w[p] = p == 0 ? atan2(series(in.a)[0], series(in.b)[0]) : arctan2(in, p);
    return;
  case Op::select:
    w[p] = chosen(in, p);
    return;
  case Op::lookup:
    w[p] = looked_up(in, p);
    return;
  case Op::rate:
    w[p] = rate(in, p);
    return;
  }
}

template <Scalar N>
N Machine<N>::sum(const Instruction& in, std::size_t p) const {
  N s(0);
  for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
    const LinearTerm& t = tape_->linear_terms[k];
    if (p > 0 && tape_->code[t.slot].constant) continue;
    addmul(s, rationals_[t.coefficient], series(t.slot)[p]);
  }
  return s;
}

template <Scalar N>
N Machine<N>::quotient(const Instruction& in, const N* w, std::size_t p) const {
  const N *a = series(in.a), *b = series(in.b);
  N s = p == 0 || !tape_->code[in.a].constant ? a[p] : N(0);
  if (!tape_->code[in.b].constant)
    for (std::size_t j = 1; j <= p; ++j) addmul(s, N(-b[j]), w[p - j]);
  return s / b[0];
}

// Uses u w' = r w u'. Multiples of r, for example of 1/3, would be rounded in the same way at every step.
template <Scalar N>
N Machine<N>::power(const Instruction& in, const N* w, std::size_t p) const {
  const N* u = series(in.a);
  const N& r = rationals_[in.index];
  if (p == 0) return power_value(u[0], r, tape_->rationals[in.index], halves_[in.index]);
  // A positive power of a series that is zero up to the known order is zero up to that order.
  if (sgn(tape_->rationals[in.index]) > 0 && vanishes(u, p)) return N(0);
  N rates_of_u(0), rates_of_w(0);
  for (std::size_t j = 0; j < p; ++j) {
    const N product = u[p - j] * w[j];
    addmul(rates_of_u, N(static_cast<int>(p - j)), product);
    addmul(rates_of_w, N(static_cast<int>(j)), product);
  }
  return (r * rates_of_u - rates_of_w) / (N(static_cast<int>(p)) * u[0]);
}

// Uses w' = f'(u) u', p > 0.
template <Scalar N>
N Machine<N>::function(const Instruction& in, std::size_t p) const {
  const N *u = series(in.a), *g = series(in.b);
  if constexpr (std::same_as<N, Ball>)
    if (!smooth(static_cast<Function>(in.index), u[0])) return Ball::unknown();
  if (tape_->code[in.b].constant) return g[0] * u[p];
  N s(0);
  for (std::size_t j = 1; j <= p; ++j) addmul(s, N(N(static_cast<int>(j)) * u[j]), g[p - j]);
  return s / N(static_cast<int>(p));
}

// Uses w' = gy y' + gx x', p > 0.
template <Scalar N>
N Machine<N>::arctan2(const Instruction& in, std::size_t p) const {
  const N *y = series(in.a), *x = series(in.b), *gy = series(in.first), *gx = series(in.count);
  if constexpr (std::same_as<N, Ball>)
    if (!smooth(y[0], x[0])) return Ball::unknown();
  N s(0);
  for (std::size_t j = 1; j <= p; ++j) {
    const N k(static_cast<int>(j));
    if (!tape_->code[in.a].constant) addmul(s, N(k * y[j]), gy[p - j]);
    if (!tape_->code[in.b].constant) addmul(s, N(k * x[j]), gx[p - j]);
  }
  return s / N(static_cast<int>(p));
}

template <Scalar N>
N Machine<N>::chosen(const Instruction& in, std::size_t p) const {
  const int side = branch(series(in.first)[0]);
  if (side == 0) return p == 0 ? either(series(in.a)[0], series(in.b)[0]) : unknown<N>();
  const std::uint32_t from = side > 0 ? in.a : in.b;
  return p > 0 && tape_->code[from].constant ? N(0) : series(from)[p];
}

template <Scalar N>
N Machine<N>::looked_up(const Instruction& in, std::size_t p) const {
  if (p > 0) return N(0);
  const auto& [knots, values] = steps_[in.index];
  const auto [k, sure] = below(knots, series(in.a)[0]);
  return sure ? values[k] : any_value(knots, values, series(in.a)[0]);
}

template <Scalar N>
N Machine<N>::rate(const Instruction& in, std::size_t p) const {
  N s = series(in.a)[p + in.index];
  for (std::uint32_t k = 1; k <= in.index; ++k) s = s * N(static_cast<int>(p + k));
  return s;
}

template <Scalar N>
std::pair<const N*, const N*> Machine<N>::knots_around(std::uint32_t slot) const {
  const Instruction& in = tape_->code[slot];
  const std::vector<N>& knots = steps_[in.index].knots;
  const std::size_t k = below(knots, series(in.a)[0]).first;
  return {k > 0 ? &knots[k - 1] : nullptr, k < knots.size() ? &knots[k] : nullptr};
}

template <Scalar N>
typename Machine<N>::Partials Machine<N>::partials(std::uint32_t slot) const {
  const Instruction& in = tape_->code[slot];
  const N* w = series(slot);
  switch (in.op) {
  case Op::constant:
  case Op::pi:
  case Op::input:
  case Op::parameter:
  case Op::linear:
    break;
  case Op::scale:
    return {N(0), series(in.a)[0]};
  case Op::multiply:
    return {series(in.b)[0], series(in.a)[0]};
  case Op::square:
    return {N(2) * series(in.a)[0], N(0)};
  case Op::divide: {
    const N& b = series(in.b)[0];
    return {N(1) / b, -(w[0] / b)};
  }
  case Op::power: {
    const N &r = rationals_[in.index], &u = series(in.a)[0];
    if (tape_->rationals[in.index] > 1 && vanishes(&u, 0)) return {N(0), N(0)};
    return {r * w[0] / u, N(0)};
  }
  case Op::function:
    return {series(in.b)[0], N(0)};
  case Op::arctan2:
    return {series(in.first)[0], series(in.count)[0]};
  case Op::select: {
    const bool first = branch(series(in.first)[0]) > 0;
    return {N(first ? 1 : 0), N(first ? 0 : 1)};
  }
  case Op::lookup:
    break;
  case Op::rate:
    return {N(1), N(0)};
  }
  return {N(0), N(0)};
}

template <Scalar N>
N Machine<N>::magnitude(std::uint32_t slot) const {
  const Instruction& in = tape_->code[slot];
  if (in.op != Op::linear) return abs(series(slot)[0]);
  N s(0);
  for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
    s += abs(N(rationals_[tape_->linear_terms[k].coefficient] * series(tape_->linear_terms[k].slot)[0]));
  return s;
}

template <Scalar N>
void Machine<N>::made_of(std::vector<N>& sizes) const {
  sizes.assign(tape_->code.size(), N(0));
  const auto value = [&](std::uint32_t slot) { return N(abs(series(slot)[0])); };
  for (std::uint32_t s = 0; s < sizes.size(); ++s) {
    const Instruction& in = tape_->code[s];
    switch (in.op) {
    case Op::linear:
      for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
        addmul(sizes[s], N(abs(rationals_[tape_->linear_terms[k].coefficient])), sizes[tape_->linear_terms[k].slot]);
      break;
    case Op::multiply:
    case Op::scale:
      sizes[s] = sizes[in.a] * value(in.b) + value(in.a) * (sizes[in.b] - value(in.b));
      break;
    case Op::square:
      sizes[s] = (sizes[in.a] + sizes[in.a] - value(in.a)) * value(in.a);
      break;
    case Op::divide:
      sizes[s] = (sizes[in.a] + value(in.a) * (sizes[in.b] / value(in.b) - N(1))) / value(in.b);
      break;
    case Op::constant:
    case Op::pi:
    case Op::input:
    case Op::parameter:
    case Op::power:
    case Op::function:
    case Op::arctan2:
    case Op::select:
    case Op::lookup:
    case Op::rate:
      sizes[s] = abs(series(s)[0]);
      break;
    }
  }
}

template <Scalar N>
N Machine<N>::terms(std::size_t root, std::size_t order) const {
  const LinearTerm& alias = tape_->linear_terms[tape_->code[tape_->roots[root]].first];
  const std::uint32_t slot = alias.slot;
  const N unit = abs(rational(alias.coefficient));
  const Instruction& in = tape_->code[slot];
  N s(0);
  const auto add_product = [&](std::uint32_t a, std::uint32_t b) {
    const N *u = series(a), *v = series(b);
    for (std::size_t k = 0; k <= order; ++k) s += abs(N(u[k] * v[order - k]));
  };
  if (in.op != Op::linear) return N(unit * abs(series(slot)[order]));
  for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
    const LinearTerm& t = tape_->linear_terms[k];
    const Instruction& term = tape_->code[t.slot];
    if (order > 0 && term.constant) continue;
    if (order > 0 && (term.op == Op::multiply))
      add_product(term.a, term.b);
    else
      s += abs(N(rational(t.coefficient) * series(t.slot)[order]));
  }
  return N(unit * s);
}

template <Scalar N>
std::vector<N> evaluate_parameters(Graph& graph, std::span<const Expr> values) {
  // Parameters may refer to each other in any order: substitute values until none is left.
  std::vector<N> out;
  if (values.empty()) return out;
  Column es(values.begin(), values.end());
  for (std::size_t depth = 0; depth <= values.size() && !symbols(es).empty(); ++depth)
    es = substitute(es, [&](NodeId id) {
      const Node& n = graph.node(id);
      return n.kind == Kind::parameter ? values[n.index] : Expr{};
    });
  const Tape tape = compile(es);
  Machine<N> machine(tape, 0, {});
  machine.evaluate();
  for (std::size_t i = 0; i < es.size(); ++i) out.push_back(machine.value(i));
  return out;
}

template class Machine<double>;
template class Machine<long double>;
template class Machine<Quad>;
template class Machine<Multi>;
template class Machine<Ball>;
template std::vector<double> evaluate_parameters<double>(Graph&, std::span<const Expr>);
template std::vector<long double> evaluate_parameters<long double>(Graph&, std::span<const Expr>);
template std::vector<Quad> evaluate_parameters<Quad>(Graph&, std::span<const Expr>);
template std::vector<Multi> evaluate_parameters<Multi>(Graph&, std::span<const Expr>);
template std::vector<Ball> evaluate_parameters<Ball>(Graph&, std::span<const Expr>);

}  // namespace anholon

#include "kernel/plan/linearized_tape.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

static constexpr std::uint32_t kNone = Slots::kNone;

LinearizedTape::LinearizedTape(const Program& p, const Slots& slots, PlanLayout& layout, const PlanSteps& steps,
                               Plan& plan)
    : p_(p), slots_(slots), layout_(layout), steps_(steps), plan_(plan), column_(slots.code.size(), kNone) {}

void LinearizedTape::run() {
  plan_.rows = static_cast<std::uint32_t>(p_.unknowns());
  for (std::uint32_t s = 0; s < p_.tape.main_end; ++s) {
    const Op op = slots_.code[s].op;
    if (slots_.live[s] && slots_.tainted[s] && op != Op::input && op != Op::rate) column_[s] = plan_.rows++;
  }
  for (std::uint32_t s = 0; s < p_.tape.main_end; ++s)
    if (column_[s] != kNone) add_row(s);
  add_equations();
  add_completions();
}

std::uint32_t LinearizedTape::column(std::uint32_t s) const {
  if (slots_.code[s].op == Op::rate) return column(slots_.same_as(slots_.code[s].a));
  return slots_.code[s].op == Op::input ? static_cast<std::uint32_t>(slots_.inputs[s]->variable) : column_[s];
}

std::uint32_t LinearizedTape::partial(Partial::Kind kind, std::uint32_t a, std::uint32_t b) {
  const std::uint32_t out = layout_.take(1);
  plan_.partials.push_back({kind, out, a, b});
  return out;
}

void LinearizedTape::enter(std::uint32_t s, std::uint32_t operand, std::uint32_t from, double sign) {
  plan_.entries.push_back({column_[s], column(operand), from, sign});
}

// Adds a row: the slot itself, minus its partial derivatives times the slots on which it depends.
void LinearizedTape::add_row(std::uint32_t s) {
  plan_.entries.push_back({column_[s], column_[s], layout_.coefficient({Rational(1), {}}), 1});
  const Instruction& in = slots_.code[s];
  if (slots_.sum_like(s)) {
    for (const Slots::Summand& t : slots_.sums[s])
      if (t.slot != kNone && slots_.unknown(t.slot, in.lead)) enter(s, t.slot, layout_.coefficient(t.c), -1);
  } else if (takes_two(in.op)) {
    add_two_operands(s);
  } else {
    add_operation(s);
  }
}

void LinearizedTape::add_operation(std::uint32_t s) {
  const Instruction& in = slots_.code[s];
  const std::uint32_t a = slots_.same_as(in.a), w = layout_.place(s).at;
  switch (in.op) {
  case Op::square:
    enter(s, a, partial(Partial::Kind::twice, layout_.place(a).at, 0), -1);
    break;
  case Op::power:
    if (p_.tape.rationals[in.index] == Rational(1, 2))
      enter(s, a, partial(Partial::Kind::half_reciprocal, w, 0), -1);
    else
      enter(s, a, steps_.derivative(s), -1);
    break;
  case Op::function:
    if (const auto cosine = slots_.cosine_of.find(s); cosine != slots_.cosine_of.end())
      enter(s, a, layout_.place(cosine->second).at, -1);
    else if (const auto sine = slots_.sine_of.find(s); sine != slots_.sine_of.end())
      enter(s, a, layout_.place(sine->second).at, 1);
    else
      enter(s, a, layout_.place(in.b).at, -1);
    break;
  default:
    ANHOLON_ASSERT(!"no slot that depends on unknowns");
  }
}

void LinearizedTape::add_two_operands(std::uint32_t s) {
  const Instruction& in = slots_.code[s];
  const std::uint32_t a = slots_.same_as(in.a), b = slots_.same_as(in.b);
  const bool by_a = slots_.unknown(a, in.lead), by_b = slots_.unknown(b, in.lead);
  const auto at = [&](std::uint32_t slot) { return layout_.place(slot).at; };
  switch (in.op) {
  case Op::multiply:
    if (by_a) enter(s, a, at(b), -1);
    if (by_b) enter(s, b, at(a), -1);
    break;
  case Op::divide:
    if (by_a) enter(s, a, steps_.reciprocal(s), -1);
    if (by_b) enter(s, b, partial(Partial::Kind::quotient, at(s), steps_.reciprocal(s)), 1);
    break;
  case Op::arctan2:
    if (by_a) enter(s, a, at(in.first), -1);
    if (by_b) enter(s, b, at(in.count), -1);
    break;
  case Op::select:
    if (by_a) enter(s, a, partial(Partial::Kind::chosen, at(in.first), 0), -1);
    if (by_b) enter(s, b, partial(Partial::Kind::not_chosen, at(in.first), 0), -1);
    break;
  default:
    ANHOLON_ASSERT(!"no operation of two operands");
  }
}

// Adds the rows of the equations: root = right side.
void LinearizedTape::add_equations() {
  const std::uint32_t unit = layout_.coefficient({Rational(1), {}});
  std::vector<int> depth;
  for (std::uint32_t i = 0; i < p_.unknowns(); ++i) {
    const std::uint32_t alias = p_.tape.roots[i], r = slots_.same_as(alias);
    const bool varies = !slots_.code[r].constant, unknown = slots_.unknown(r, slots_.code[alias].lead);
    plan_.roots.push_back(layout_.place(r));
    plan_.root_is_zero.push_back(!varies || (unknown && slots_.pure[r]));
    if (varies && unknown) plan_.entries.push_back({i, column(r), unit, 1});
    plan_.sides.push_back(i);
    depth.push_back(steps_.depth(r));
  }
  std::stable_sort(plan_.sides.begin(), plan_.sides.end(),
                   [&](std::uint32_t i, std::uint32_t j) { return depth[i] < depth[j]; });
}

void LinearizedTape::add_completions() {
  for (std::uint32_t s = 0; s < p_.tape.main_end; ++s) {
    if (!slots_.live[s] || !slots_.tainted[s] || !slots_.series[s]) continue;
    const bool input = slots_.code[s].op == Op::input;
    if (input && slots_.inputs[s]->order == 0) continue;
    plan_.completions.push_back({layout_.place(s), slots_.code[s].lead, column(s), input || slots_.pure[s]});
  }
}

}  // namespace anholon

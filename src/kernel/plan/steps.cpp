#include "kernel/plan/steps.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

namespace {

constexpr std::uint32_t kNone = Slots::kNone;

Step weigh(const Place& out, const Place& a, std::uint8_t lead) {
  Step w;
  w.act = Act::weigh;
  w.lead = lead;
  w.out = out;
  w.a = a;
  return w;
}

}  // namespace

PlanSteps::PlanSteps(const Program& p, const Slots& slots, PlanLayout& layout, Plan& plan, bool judged)
    : p_(p), slots_(slots), code_(slots.code), layout_(layout), plan_(plan), judged_(judged), depth_(code_.size(), 0) {
  if (judged_) find_values_only();
  for (std::uint32_t s = 0; s < code_.size(); ++s) {
    if (!slots_.varies(s)) continue;
    for (std::uint32_t o : slots_.operands(s))
      if (o < s) depth_[s] = std::max(depth_[s], depth_[o] + 1);
    slots_.sum_like(s) ? emit_sum(s) : emit(s);
  }
}

void PlanSteps::find_values_only() {
  const Tape& tape = slots_.tape;
  value_only_.assign(code_.size(), true);
  std::fill(value_only_.begin(), value_only_.begin() + tape.main_end, false);
  for (std::size_t i = p_.unknowns(); i + 1 < tape.roots.size(); ++i)
    value_only_[slots_.same_as(tape.roots[i])] = false;
  for (std::uint32_t s = static_cast<std::uint32_t>(code_.size()); s-- > 0;)
    if (!value_only_[s] && slots_.varies(s)) {
      for (const std::uint32_t o : slots_.operands(s)) value_only_[o] = false;
      for (const Slots::Summand& t : slots_.sums[s])
        if (t.slot != kNone) value_only_[t.slot] = false;
    }
  for (const auto& [sine, cosine] : slots_.cosine_of)
    if (!value_only_[sine] || !value_only_[cosine]) value_only_[sine] = value_only_[cosine] = false;
}

std::vector<Step>& PlanSteps::list(std::uint32_t s, bool beyond) {
  return !slots_.in_main(s) && !value_only(s) ? plan_.after : beyond ? plan_.stage : plan_.point;
}

// The time at which a coefficient is known; coefficients of earlier stages come first.
int PlanSteps::arrival(std::uint32_t s, std::uint8_t lead) const {
  return code_[s].constant || code_[s].lead > lead ? -1 : depth_[s];
}

// ---- sums -----------------------------------------------------------------------------------------------------------

void PlanSteps::emit_sum(std::uint32_t s) {
  // Sorts terms that are known early to the front, so that the sum waits for the last one only.
  std::vector<Slots::Summand> terms = slots_.sums[s];
  std::stable_sort(terms.begin(), terms.end(), [&](const Slots::Summand& x, const Slots::Summand& y) {
    return x.slot != kNone && y.slot != kNone ? depth_[x.slot] < depth_[y.slot] : x.slot != kNone && y.slot == kNone;
  });
  for (const bool beyond : {false, true}) {
    if (beyond && (!slots_.in_main(s) || (slots_.tainted[s] && slots_.pure[s]))) break;
    Step step;
    step.lead = code_[s].lead;
    step.out = layout_.place(s);
    step.first = static_cast<std::uint32_t>(plan_.terms.size());
    for (const Slots::Summand& t : terms) {
      if (t.slot == kNone) {
        if (beyond) continue;
        plan_.terms.push_back({layout_.coefficient(t.c), {}});
        ++step.constants;
      } else if (!(beyond && slots_.unknown(t.slot, step.lead) && slots_.pure[t.slot])) {
        plan_.terms.push_back({layout_.coefficient(t.c), layout_.place(t.slot)});
        ++step.count;
      }
    }
    list(s, beyond).push_back(step);
    if (!beyond) sums_[s] = step;
  }
}

// ---- other operations -----------------------------------------------------------------------------------------------

void PlanSteps::emit(std::uint32_t s) {
  std::optional<Step> step = step_of(s);
  if (!step) return;
  if (code_[s].op != Op::input) add_operands(*step, s);
  if (step->act == Act::power && slots_.tainted[s])
    plan_.weigh_again.push_back(weigh(step->d, step->out, code_[s].lead));
  list(s, false).push_back(*step);
  if (!slots_.in_main(s) || solved_for(s)) return;
  mark_unknown(*step, s);
  plan_.stage.push_back(*step);
}

// Returns the step without its operands; nullopt if no step computes the slot.
std::optional<Step> PlanSteps::step_of(std::uint32_t s) {
  const Instruction& in = code_[s];
  Step step;
  step.lead = in.lead;
  step.out = layout_.place(s);
  switch (in.op) {
  case Op::constant:
  case Op::pi:
  case Op::parameter:
  case Op::linear:
  case Op::scale:
    return std::nullopt;
  case Op::input:
    return input(s, step);
  case Op::rate:
    step.act = Act::input;
    step.index = in.index;
    return step;
  case Op::multiply:
    step.act = Act::multiply;
    return step;
  case Op::square:
    step.act = Act::square;
    return step;
  case Op::divide:
    step.act = Act::divide;
    step.c = layout_.take_number();
    reciprocal_[s] = step.c.at;
    return step;
  case Op::power:
    return power(s, step);
  case Op::function:
    return function(s, step);
  case Op::arctan2:
    return arctan2(s, step);
  case Op::select:
    step.act = Act::select;
    step.c = layout_.place(in.first);
    return step;
  case Op::lookup:
    step.act = Act::lookup;
    step.index = in.index;
    return step;
  }
  return std::nullopt;
}

// Returns the step of a derivative of an unknown; the series of the unknowns need no step.
std::optional<Step> PlanSteps::input(std::uint32_t s, Step step) const {
  const ProgramInput& in = *slots_.inputs[s];
  if (in.kind != ProgramInput::Kind::variable || in.order == 0) return std::nullopt;
  step.act = Act::input;
  step.a = {plan_.x[in.variable], true};
  step.index = static_cast<std::uint32_t>(in.order);
  return step;
}

Step PlanSteps::power(std::uint32_t s, Step step) {
  const Rational& exponent = slots_.tape.rationals[code_[s].index];
  step.value = exponent.get_d();
  step.act = exponent == Rational(1, 2) ? Act::square_root : Act::power;
  if (step.act == Act::square_root) return step;
  step.c = weighted(slots_.same_as(code_[s].a), !slots_.in_main(s));
  step.b = layout_.take_number();
  step.d = layout_.take_series();
  step.e = layout_.take_number();
  derivative_[s] = step.e.at;
  return step;
}

// A sine and a cosine of the same argument are one step, made with the first of the two.
std::optional<Step> PlanSteps::function(std::uint32_t s, Step step) {
  const std::uint32_t a = slots_.same_as(code_[s].a);
  const bool after = !slots_.in_main(s);
  step.index = code_[s].index;
  if (!slots_.sine_of.count(s) && !slots_.cosine_of.count(s)) {
    step.act = Act::function;
    step.c = weighted(a, after);
    return step;
  }
  const std::uint32_t sine = slots_.sine_of.count(s) ? slots_.sine_of.at(s) : s, cosine = slots_.cosine_of.at(sine);
  if (std::max(sine, cosine) == s) return std::nullopt;
  ANHOLON_ASSERT(code_[cosine].lead == code_[sine].lead && slots_.in_main(sine) == slots_.in_main(cosine));
  step.act = Act::sine_cosine;
  step.b = weighted(a, after);
  step.out = layout_.place(sine);
  step.c = layout_.place(cosine);
  step.d = beyond_double(a);
  return step;
}

Step PlanSteps::arctan2(std::uint32_t s, Step step) {
  const Instruction& in = code_[s];
  const bool after = !slots_.in_main(s);
  step.act = Act::arctan2;
  step.c = layout_.place(in.first);
  step.d = layout_.place(in.count);
  if (!code_[in.a].constant) step.e = weighted(slots_.same_as(in.a), after);
  if (!code_[in.b].constant) step.f = weighted(slots_.same_as(in.b), after);
  return step;
}

void PlanSteps::add_operands(Step& step, std::uint32_t s) const {
  const Instruction& in = code_[s];
  const std::uint32_t a = slots_.same_as(in.a);
  step.a = layout_.place(a);
  step.a_constant = code_[a].constant;
  if (!takes_two(in.op) && step.act != Act::function) return;
  const std::uint32_t b = slots_.same_as(in.b);
  step.b = layout_.place(b);
  step.b_constant = code_[b].constant;
  step.b_later = arrival(b, in.lead) > arrival(a, in.lead);
}

// True if the newest coefficient is an unknown of the stage, or a multiple of one.
bool PlanSteps::solved_for(std::uint32_t s) const {
  return (code_[s].op == Op::input && slots_.inputs[s]->leading) || (code_[s].op == Op::rate && slots_.pure[s]);
}

void PlanSteps::mark_unknown(Step& step, std::uint32_t s) const {
  const Instruction& in = code_[s];
  const auto unknown = [&](std::uint32_t slot) {
    const std::uint32_t x = slots_.same_as(slot);
    return slots_.unknown(x, in.lead) && slots_.pure[x];
  };
  step.a_unknown = in.op != Op::input && unknown(in.a);
  if (takes_two(in.op) && in.op != Op::select) step.b_unknown = unknown(in.b);
}

// The series j a_j.
Place PlanSteps::weighted(std::uint32_t a, bool after) {
  const auto [it, fresh] = weighted_.try_emplace({a, after}, Place{});
  if (!fresh) return it->second;
  it->second = layout_.take_series();
  const Step w = weigh(it->second, layout_.place(a), after ? std::uint8_t{0} : code_[a].lead);
  if (after) {
    if (!value_only(a)) plan_.after.push_back(w);
  } else {
    plan_.point.push_back(w);
    if (!(slots_.tainted[a] && slots_.pure[a])) plan_.stage.push_back(w);
    if (slots_.tainted[a]) plan_.weigh_again.push_back(w);
  }
  return it->second;
}

// ---- parts beyond a double ------------------------------------------------------------------------------------------

// The part of a slot's value beyond its double, for a coordinate or a sum with coordinates; a place at 0 if it is not
// known.
Place PlanSteps::beyond_double(std::uint32_t s) {
  if (const auto it = beyond_.find(s); it != beyond_.end()) return it->second;
  beyond_[s] = {};
  Place out;
  if (code_[s].op == Op::input && slots_.inputs[s])
    out = beyond_of_input(*slots_.inputs[s]);
  else if (const auto sum = sums_.find(s); sum != sums_.end())
    out = beyond_of_sum(s, sum->second);
  return beyond_[s] = out;
}

Place PlanSteps::beyond_of_input(const ProgramInput& in) {
  if (in.kind != ProgramInput::Kind::variable || in.order > 0 || p_.d[in.variable] == 0) return {};
  std::uint32_t index = 0;
  for (std::size_t j = 0; j < in.variable; ++j) index += static_cast<std::uint32_t>(p_.d[j]);
  const Place out = layout_.take_number();
  plan_.beyond_double.push_back({out.at, index});
  return out;
}

Place PlanSteps::beyond_of_sum(std::uint32_t s, const Step& sum) {
  std::vector<PlanTerm> terms;
  bool any = false;
  for (std::uint32_t k = sum.first; k < sum.first + sum.count; ++k) {
    terms.push_back({plan_.terms[k].coefficient, {}});
    if (const auto x = layout_.coordinates().find(plan_.terms[k].x.at); x != layout_.coordinates().end())
      terms.back().x = beyond_double(x->second);
    any = any || terms.back().x.at != 0;
  }
  if (!any) return {};
  Step step = sum;
  step.act = Act::beyond;
  step.out = layout_.take_number();
  step.index = static_cast<std::uint32_t>(plan_.terms.size());
  plan_.terms.insert(plan_.terms.end(), terms.begin(), terms.end());
  list(s, false).push_back(step);
  return step.out;
}

}  // namespace anholon

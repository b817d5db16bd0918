#include "kernel/plan/planner.h"

#include <algorithm>

#include "base/assert.h"
#include "kernel/plan/linearized_tape.h"
#include "tape/operands.h"

namespace anholon {

namespace {

// The limit of the tables of a kernel (arithmetic.h: kMostRising).
constexpr int kHighestOrder = 12;

// Notes the slots that a step of the motion has to look at: those that decide which function holds, and functions that
// may hide their variation.
void note_watched(const Slots& slots, const PlanLayout& layout, Plan& plan) {
  using K = Plan::Deciding::Kind;
  const Tape& tape = slots.tape;
  for (std::uint32_t s = 0; s < tape.code.size(); ++s) {
    const Instruction& in = tape.code[s];
    if (!slots.varies(s)) continue;
    const auto add = [&](K kind, std::uint32_t by) {
      if (!tape.code[by].constant) plan.deciding.push_back({kind, by, in.index, layout.place(slots.same_as(by))});
    };
    if (in.op == Op::power && tape.rationals[in.index].has_even_denominator()) add(K::radicand, in.a);
    if (turns_at_zero(in)) add(K::sign, in.a);
    if (in.op == Op::select) add(K::sign, in.first);
    if (in.op == Op::lookup) add(K::knots, in.a);
    if (in.op == Op::arctan2) add(K::sign, in.a), add(K::sign, in.b);
  }
  for (std::uint32_t s = 0; s < tape.code.size(); ++s)
    if (const auto hides = slots.varies(s) ? may_hide(tape, s) : std::nullopt)
      plan.hiding.push_back({s, hides->function, layout.place(hides->argument), layout.place(s)});
}

}  // namespace

std::string no_plan(const Program& p) {
  if (p.nonlinear) return "the leading derivatives enter nonlinearly";
  int highest = p.tape.largest_lead;
  for (int d : p.d) highest = std::max(highest, d);
  for (const ProgramInput& in : p.inputs) highest = std::max(highest, in.order);
  if (highest > kHighestOrder) return "derivatives of order " + std::to_string(highest) + " occur";
  return {};
}

Plan plan(const Program& program, int stages, bool judged) {
  ANHOLON_ASSERT(no_plan(program).empty());
  const Slots slots(program);
  Plan plan;
  PlanLayout layout(program, slots, stages, plan);
  const PlanSteps steps(program, slots, layout, plan, judged);
  LinearizedTape(program, slots, layout, steps, plan).run();
  for (std::size_t i = program.unknowns(); i < program.tape.roots.size(); ++i)
    plan.quadratures.push_back(layout.place(program.tape.roots[i]));
  if (judged) {
    plan.determinant = plan.quadratures.back();
    plan.quadratures.pop_back();
  }
  plan.scales = program.scales;
  note_watched(slots, layout, plan);
  return plan;
}

}  // namespace anholon

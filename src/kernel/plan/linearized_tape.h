// The linearized tape of a plan: one row and one column for each unknown, and for each slot that depends on unknowns.
#pragma once
#include "kernel/plan/steps.h"

namespace anholon {

class LinearizedTape {
 public:
  LinearizedTape(const Program& program, const Slots& slots, PlanLayout& layout, const PlanSteps& steps, Plan& plan);
  // Adds rows, entries, sides and completions to the plan.
  void run();

 private:
  std::uint32_t column(std::uint32_t s) const;
  std::uint32_t partial(Partial::Kind kind, std::uint32_t a, std::uint32_t b);
  void enter(std::uint32_t s, std::uint32_t operand, std::uint32_t from, double sign);
  void add_row(std::uint32_t s);
  void add_operation(std::uint32_t s);
  void add_two_operands(std::uint32_t s);
  void add_equations();
  void add_completions();

  const Program& p_;
  const Slots& slots_;
  PlanLayout& layout_;
  const PlanSteps& steps_;
  Plan& plan_;
  std::vector<std::uint32_t> column_;
};

}  // namespace anholon

// The steps of a plan: they compute a coefficient of each slot of the tape, at the point and at the stages beyond.
#pragma once
#include "kernel/plan/layout.h"

namespace anholon {

// True if an operation has a second operand `b` that is not a derivative.
inline bool takes_two(Op op) { return op == Op::multiply || op == Op::divide || op == Op::arctan2 || op == Op::select; }

class PlanSteps {
 public:
  // Adds all steps to the plan.
  PlanSteps(const Program& program, const Slots& slots, PlanLayout& layout, Plan& plan, bool judged);

  // The length of the longest chain of operations before a slot.
  int depth(std::uint32_t s) const { return depth_[s]; }
  // The places of 1 / b_0 of a quotient and of the derivative of a power.
  std::uint32_t reciprocal(std::uint32_t s) const { return reciprocal_.at(s); }
  std::uint32_t derivative(std::uint32_t s) const { return derivative_.at(s); }

 private:
  void find_values_only();
  bool value_only(std::uint32_t s) const { return judged_ && value_only_[s]; }
  std::vector<Step>& list(std::uint32_t s, bool beyond);
  int arrival(std::uint32_t s, std::uint8_t lead) const;

  void emit(std::uint32_t s);
  void emit_sum(std::uint32_t s);
  std::optional<Step> step_of(std::uint32_t s);
  std::optional<Step> input(std::uint32_t s, Step step) const;
  Step power(std::uint32_t s, Step step);
  std::optional<Step> function(std::uint32_t s, Step step);
  Step arctan2(std::uint32_t s, Step step);
  void add_operands(Step& step, std::uint32_t s) const;
  bool solved_for(std::uint32_t s) const;
  void mark_unknown(Step& step, std::uint32_t s) const;
  Place weighted(std::uint32_t a, bool after);
  Place beyond_double(std::uint32_t s);
  Place beyond_of_input(const ProgramInput& in);
  Place beyond_of_sum(std::uint32_t s, const Step& sum);

  const Program& p_;
  const Slots& slots_;
  const std::vector<Instruction>& code_;
  PlanLayout& layout_;
  Plan& plan_;
  bool judged_;
  std::vector<bool> value_only_;  // slots that only the last root needs: only their values are computed
  std::vector<int> depth_;
  std::map<std::uint32_t, std::uint32_t> reciprocal_, derivative_;
  std::map<std::pair<std::uint32_t, bool>, Place> weighted_;
  std::map<std::uint32_t, Place> beyond_;  // the parts of slots beyond their doubles, if known
  std::map<std::uint32_t, Step> sums_;     // of slots
};

}  // namespace anholon

#include "integrate/motion_state.h"

namespace anholon {

template <Number N>
StepRecord<N> with_other_equations(const StepRecord<N>& record) {
  // Structured bindings name all members, so a member that is added and forgotten here does not compile.
  [[maybe_unused]] const auto& [branch_step, steps, worst_constraint, worst_equation, first_sigma, least_regular,
                                sigma_before, last_step, least_health, careful] = record;
  StepRecord<N> to;
  to.steps = steps;
  to.worst_constraint = worst_constraint;
  to.worst_equation = worst_equation;
  to.first_sigma = first_sigma;
  to.least_regular = least_regular;
  return to;
}

template <Number N>
MotionState<N> motion_from(const Wider<N>& t, const std::vector<Wider<N>>& state, const std::vector<Wider<N>>& leading,
                           std::size_t quadratures) {
  using W = Wider<N>;
  const std::vector<W> none(quadratures, W(0));
  MotionState<N> m{t, state, std::vector<W>(state.size(), W(0)), leading, {}, {}, none, none, {}};
  m.record.least_regular.t = t;
  return m;
}

#define INSTANTIATE(N)                                                                                                 \
  template StepRecord<N> with_other_equations(const StepRecord<N>&);                                                   \
  template MotionState<N> motion_from(const Wider<N>&, const std::vector<Wider<N>>&, const std::vector<Wider<N>>&,     \
                                      std::size_t);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

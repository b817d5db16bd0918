#include "program/fault.h"

#include "model/formula_of_slot.h"

namespace anholon {

template <Number N>
std::optional<std::uint32_t> first_fault(const Program& program, const Machine<N>& machine, int last_stage) {
  const Tape& tape = program.tape;
  for (int stage = -tape.largest_lead; stage <= last_stage; ++stage)
    for (std::uint32_t slot = 0; slot < tape.main_end; ++slot) {
      const Instruction& in = tape.code[slot];
      const int order = in.constant ? 0 : stage + in.lead;
      if (order >= 0 && !is_finite(machine.series(slot)[order])) return slot;
    }
  return std::nullopt;
}

template <Number N>
Outcome fault_outcome(const Program& program, const Machine<N>& machine, int last_stage) {
  const std::optional<std::uint32_t> slot = first_fault(program, machine, last_stage);
  if (!slot)
    return {OutcomeKind::not_a_number, "the equations have no finite solution",
            "start or stop the motion away from this point, or change the formulas"};
  const auto value = [&](std::uint32_t of) { return to_double(machine.series(of)[0]); };
  return without_value(program.tape, *program.system->model, *slot, value);
}

#define INSTANTIATE(N)                                                                                                 \
  template std::optional<std::uint32_t> first_fault<N>(const Program&, const Machine<N>&, int);                        \
  template Outcome fault_outcome<N>(const Program&, const Machine<N>&, int);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

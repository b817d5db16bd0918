// Which formula of a program has no value, or no derivatives, where a Taylor expansion was tried.
#pragma once
#include <string>

#include "base/outcome.h"
#include "program/program.h"

namespace anholon {

// The first slot whose coefficients, up to those of stage `last_stage`, are not finite, in the order in which they are
// computed; nullopt if all are finite. REQUIRES: all stages up to `last_stage` have been swept, or the sweep ended at
// one that is not finite.
template <Number N>
std::optional<std::uint32_t> first_fault(const Program& program, const Machine<N>& machine, int last_stage);

// `not_a_number`, with the formula and the value of its argument: "sqrt(x - 1) has no value, where x - 1 = -0.25". The
// caller adds the time.
template <Number N>
Outcome fault_outcome(const Program& program, const Machine<N>& machine, int last_stage);

}  // namespace anholon

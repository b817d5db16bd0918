// Finds the formula of a program that has no value, or no derivatives, at the point of a Taylor expansion.
#pragma once
#include <string>

#include "base/outcome.h"
#include "program/program.h"

namespace anholon {

// Returns the first slot, in the order of computation, whose coefficients up to those of stage `last_stage` are not
// finite; nullopt if all are finite. REQUIRES: all stages up to `last_stage` have been swept, or the sweep ended at a
// coefficient that is not finite.
template <Number N>
std::optional<std::uint32_t> first_fault(const Program& program, const Machine<N>& machine, int last_stage);

// Returns `not_a_number`, with the formula and the value of its argument: "sqrt(x - 1) has no value, where x - 1 =
// -0.25". The caller adds the time.
template <Number N>
Outcome fault_outcome(const Program& program, const Machine<N>& machine, int last_stage);

}  // namespace anholon

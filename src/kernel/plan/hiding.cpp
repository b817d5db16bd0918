#include <cmath>

#include "kernel/plan/plan.h"

namespace anholon {

std::optional<Hiding> may_hide(const Tape& tape, const Instruction& in) {
  if (in.constant) return std::nullopt;
  if (in.op == Op::power) {
    // A power this steep acts like a wall; lower powers are visible from afar.
    constexpr double kSteep = 6;
    const double exponent = tape.rationals[in.index].get_d();
    return std::abs(exponent) < kSteep ? std::nullopt : std::optional(Hiding{std::nullopt, exponent});
  }
  if (in.op == Op::divide) return tape.code[in.b].constant ? std::nullopt : std::optional(Hiding{std::nullopt, -1});
  if (in.op != Op::function) return std::nullopt;
  const Function f = static_cast<Function>(in.index);
  return info(f).hides ? std::optional(Hiding{f, 0}) : std::nullopt;
}

}  // namespace anholon

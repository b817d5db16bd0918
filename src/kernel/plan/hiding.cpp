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
  switch (const Function f = static_cast<Function>(in.index)) {
  case Function::exp:
  case Function::tanh:
  case Function::sinh:
  case Function::cosh:
  case Function::atan:
    return Hiding{f, 0};
  case Function::sin:
  case Function::cos:
  case Function::tan:
  case Function::asin:
  case Function::acos:
  case Function::asinh:
  case Function::acosh:
  case Function::atanh:
  case Function::log:
  case Function::abs:
  case Function::sign:
    break;
  }
  return std::nullopt;
}

}  // namespace anholon

#include <cmath>

#include "kernel/plan/plan.h"

namespace anholon {

namespace {

// A slot, up to a constant factor, as a positive power of another one.
struct PowerOf {
  std::uint32_t base;
  double exponent;
};

PowerOf as_power(const Tape& tape, std::uint32_t slot) {
  const Instruction& in = tape.code[slot];
  switch (in.op) {
  case Op::square: {
    const PowerOf a = as_power(tape, in.a);
    return {a.base, 2 * a.exponent};
  }
  case Op::power: {
    if (!(tape.rationals[in.index] > 0)) break;
    const PowerOf a = as_power(tape, in.a);
    return {a.base, tape.rationals[in.index].get_d() * a.exponent};
  }
  case Op::scale:
    return as_power(tape, tape.code[in.a].constant ? in.b : in.a);
  case Op::multiply:
    if (const PowerOf a = as_power(tape, in.a), b = as_power(tape, in.b); a.base == b.base)
      return {a.base, a.exponent + b.exponent};
    break;
  default:
    break;
  }
  return {slot, 1};
}

std::optional<HidingSlot> quotient_by(const Tape& tape, std::uint32_t divisor, double exponent) {
  if (tape.code[divisor].constant) return std::nullopt;
  const PowerOf by = as_power(tape, divisor);
  return HidingSlot{{std::nullopt, exponent * by.exponent, true}, by.base};
}

}  // namespace

std::optional<HidingSlot> may_hide(const Tape& tape, std::uint32_t slot) {
  const Instruction& in = tape.code[slot];
  if (in.constant) return std::nullopt;
  if (in.op == Op::divide) return quotient_by(tape, in.b, 1);
  if (in.op == Op::power) {
    // A power this steep acts like a wall; lower powers are visible from afar.
    constexpr double kSteep = 6;
    const double exponent = tape.rationals[in.index].get_d();
    if (exponent < 0) return quotient_by(tape, in.a, -exponent);
    return exponent < kSteep ? std::nullopt : std::optional(HidingSlot{{std::nullopt, exponent}, in.a});
  }
  if (in.op != Op::function) return std::nullopt;
  const Function f = static_cast<Function>(in.index);
  return info(f).hides ? std::optional(HidingSlot{{f}, in.a}) : std::nullopt;
}

}  // namespace anholon

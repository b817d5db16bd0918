#include <algorithm>
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

// The quotient that a slot is by this power of a divisor.
std::optional<HidingSlot> quotient(const Tape& tape, std::uint32_t slot, std::uint32_t divisor, double exponent) {
  constexpr double kSmall = 1e-3;  // a divisor this small, relative to its value at the start
  if (tape.code[divisor].constant) return std::nullopt;
  const PowerOf by = as_power(tape, divisor);
  HidingSlot found{slot, by.base, {std::nullopt, exponent * by.exponent, true}};
  found.function.near_zero = std::pow(kSmall, 1 / found.function.exponent);
  return found;
}

bool hides(const Instruction& in) { return in.op == Op::function && info(static_cast<Function>(in.index)).hides; }

std::optional<HidingSlot> hiding_at(const Tape& tape, std::uint32_t slot) {
  const Instruction& in = tape.code[slot];
  if (in.constant) return std::nullopt;
  if (in.op == Op::divide) return quotient(tape, slot, in.b, 1);
  if (in.op == Op::power) {
    // A power this steep acts like a wall; lower powers are visible from afar.
    constexpr double kSteep = 6;
    const double exponent = tape.rationals[in.index].get_d();
    if (exponent < 0) return quotient(tape, slot, in.a, -exponent);
    return exponent < kSteep ? std::nullopt : std::optional(HidingSlot{slot, in.a, {std::nullopt, exponent}});
  }
  return hides(in) ? std::optional(HidingSlot{slot, in.a, {static_cast<Function>(in.index)}}) : std::nullopt;
}

}  // namespace

std::optional<HidingSlot> may_hide(const Tape& tape, std::uint32_t slot) {
  std::optional<HidingSlot> found = hiding_at(tape, slot);
  if (!found) return found;
  const std::vector<std::uint32_t> made_of = precedents(tape, {found->argument});
  found->function.needs_reach =
      std::none_of(made_of.begin(), made_of.end(), [&](std::uint32_t s) { return hides(tape.code[s]); });
  return found;
}

}  // namespace anholon

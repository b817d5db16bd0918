// The slots that an instruction reads.
#pragma once
#include "tape/tape.h"

namespace anholon {

// True if the instruction continues as another function where its argument passes zero: abs and sign.
inline bool turns_at_zero(const Instruction& in) {
  return in.op == Op::function && (in.index == static_cast<std::uint32_t>(Function::abs) ||
                                   in.index == static_cast<std::uint32_t>(Function::sign));
}

// Calls f(slot) for each slot from whose value that of `in` is computed; slots of derivatives, which series need, are
// left out.
template <class F>
void for_each_operand(const Tape& tape, const Instruction& in, const F& f) {
  switch (in.op) {
  case Op::constant:
  case Op::pi:
  case Op::input:
  case Op::parameter:
    return;
  case Op::linear:
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) f(tape.linear_terms[k].slot);
    return;
  case Op::select:
    f(in.first);
    [[fallthrough]];
  case Op::multiply:
  case Op::scale:
  case Op::divide:
  case Op::arctan2:
    f(in.b);
    [[fallthrough]];
  case Op::square:
  case Op::power:
  case Op::function:
  case Op::lookup:
  case Op::rate:
    f(in.a);
    return;
  }
}

}  // namespace anholon

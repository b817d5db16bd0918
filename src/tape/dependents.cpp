#include "tape/tape.h"

namespace anholon {

std::vector<std::uint32_t> dependents(const Tape& tape, const std::vector<std::uint32_t>& of) {
  std::vector<bool> depends(tape.code.size(), false);
  for (const std::uint32_t s : of) depends[s] = true;
  const auto on_operand = [&](const Instruction& in) -> bool {
    switch (in.op) {
    case Op::constant:
    case Op::pi:
    case Op::input:
    case Op::parameter:
      return false;
    case Op::linear:
      for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
        if (depends[tape.linear_terms[k].slot]) return true;
      return false;
    case Op::multiply:
    case Op::scale:
    case Op::divide:
    case Op::arctan2:
      return depends[in.a] || depends[in.b];
    case Op::square:
    case Op::power:
    case Op::function:
    case Op::lookup:
    case Op::rate:
      return depends[in.a];
    case Op::select:
      return depends[in.a] || depends[in.b] || depends[in.first];
    }
    return false;
  };
  std::vector<std::uint32_t> out;
  for (std::uint32_t s = 0; s < tape.code.size(); ++s)
    if (on_operand(tape.code[s])) depends[s] = true, out.push_back(s);
  return out;
}

}  // namespace anholon

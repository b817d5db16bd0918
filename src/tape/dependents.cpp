#include "tape/operands.h"

namespace anholon {

std::vector<std::uint32_t> dependents(const Tape& tape, const std::vector<std::uint32_t>& of) {
  std::vector<bool> depends(tape.code.size(), false);
  for (const std::uint32_t s : of) depends[s] = true;
  std::vector<std::uint32_t> out;
  for (std::uint32_t s = 0; s < tape.code.size(); ++s) {
    bool reads = false;
    for_each_operand(tape, tape.code[s], [&](std::uint32_t k) { reads = reads || depends[k]; });
    if (reads) depends[s] = true, out.push_back(s);
  }
  return out;
}

std::vector<std::uint32_t> precedents(const Tape& tape, const std::vector<std::uint32_t>& of) {
  std::vector<bool> needed(tape.code.size(), false);
  for (const std::uint32_t s : of) needed[s] = true;
  const auto need = [&](std::uint32_t s) { needed[s] = true; };
  // The slots of derivatives may come after those of their functions.
  for (bool more = true; more;) {
    more = false;
    for (std::uint32_t s = static_cast<std::uint32_t>(tape.code.size()); s-- > 0;) {
      if (!needed[s]) continue;
      const Instruction& in = tape.code[s];
      for_each_operand(tape, in, need);
      const auto late = [&](std::uint32_t derivative) {
        more = more || (derivative > s && !needed[derivative]);
        need(derivative);
      };
      if (in.op == Op::function) late(in.b);
      if (in.op == Op::arctan2) late(in.first), late(in.count);
    }
  }
  std::vector<std::uint32_t> out;
  for (std::uint32_t s = 0; s < tape.code.size(); ++s)
    if (needed[s]) out.push_back(s);
  return out;
}

}  // namespace anholon

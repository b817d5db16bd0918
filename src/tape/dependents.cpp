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

}  // namespace anholon

#include "tape/leads.h"

#include <algorithm>

namespace anholon {

void spread_leads(Tape& tape, std::span<const int> leads) {
  std::vector<Instruction>& code = tape.code;
  for (std::size_t i = 0; i < leads.size(); ++i) {
    code[tape.roots[i]].lead = static_cast<std::uint8_t>(leads[i]);
  }
  const auto raise = [&](std::uint32_t slot, std::uint8_t lead) {
    bool changed = code[slot].lead < lead;
    code[slot].lead = std::max(code[slot].lead, lead);
    return changed;
  };
  // Derivative slots may come after the function that uses them: repeat until nothing changes.
  for (bool again = true; again;) {
    again = false;
    for (std::uint32_t s = tape.main_end; s-- > 0;) {
      const Instruction in = code[s];
      switch (in.op) {
      case Op::constant:
      case Op::pi:
      case Op::input:
      case Op::parameter:
        break;
      case Op::linear:
        for (std::uint32_t k = in.first; k < in.first + in.count; ++k) raise(tape.linear_terms[k].slot, in.lead);
        break;
      case Op::square:
      case Op::power:
      case Op::lookup:
        raise(in.a, in.lead);
        break;
      case Op::rate:
        raise(in.a, static_cast<std::uint8_t>(in.lead + in.index));
        break;
      case Op::select:
        raise(in.a, in.lead), raise(in.b, in.lead), raise(in.first, in.lead);
        break;
      case Op::multiply:
      case Op::scale:
      case Op::divide:
        raise(in.a, in.lead), raise(in.b, in.lead);
        break;
      case Op::function:
        raise(in.a, in.lead);
        if (raise(in.b, in.lead)) again = true;
        break;
      case Op::arctan2:
        raise(in.a, in.lead), raise(in.b, in.lead);
        if (raise(in.first, in.lead)) again = true;
        if (raise(in.count, in.lead)) again = true;
        break;
      }
    }
  }
  for (const Instruction& in : code) tape.largest_lead = std::max<int>(tape.largest_lead, in.lead);
}

}  // namespace anholon

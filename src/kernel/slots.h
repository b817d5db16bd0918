// What a plan makes of the slots of a tape before it lays them out: which are needed, which are sums and of what, which
// keep their series, and which depend on the unknowns of a stage.
#pragma once
#include <map>

#include "kernel/plan.h"

namespace anholon {

class Slots {
 public:
  explicit Slots(const Program& program);

  static constexpr std::uint32_t kNone = 0xffffffffU;
  static constexpr std::uint32_t kReciprocal = 0x80000000U;  // in the slots of a coefficient: a divisor
  struct Summand {
    Coefficient c;
    std::uint32_t slot;  // kNone: constant in time
  };

  const Tape& tape;
  const std::vector<Instruction>& code;
  std::vector<const ProgramInput*> inputs;                    // null for other slots
  std::map<std::uint32_t, std::uint32_t> cosine_of, sine_of;  // of a sine, a cosine of the same argument; and back
  std::vector<bool> live, series;
  std::vector<bool> tainted, pure;  // the newest coefficient depends on the unknowns of the stage; is zero without them
  std::vector<std::vector<Summand>> sums;

  bool sum_like(std::uint32_t s) const {
    return code[s].op == Op::linear || code[s].op == Op::scale ||
           (code[s].op == Op::divide && code[code[s].b].constant);
  }
  bool in_main(std::uint32_t s) const { return s < tape.main_end; }
  bool unknown(std::uint32_t s, std::uint8_t lead) const { return tainted[s] && code[s].lead == lead; }
  // The slot whose value this one repeats.
  std::uint32_t same_as(std::uint32_t s) const;
  // The operands of a slot, with repeats seen through.
  std::vector<std::uint32_t> operands(std::uint32_t s) const;

 private:
  void pair_functions();
  void mark_live();
  void gather_sums();
  void share_sums();
  void mark_series();
  void inline_sums();
  void taint();

  const Program& p_;
  std::vector<int> uses_;
};

}  // namespace anholon

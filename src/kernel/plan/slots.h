// Analysis of a tape's slots before layout: which slots are needed, which are sums of which terms, which store their
// series, and which depend on the unknowns of a stage.
#pragma once
#include <map>

#include "kernel/plan/plan.h"

namespace anholon {

class Slots {
 public:
  explicit Slots(const Program& program);

  static constexpr std::uint32_t kNone = 0xffffffffU;
  struct Summand {
    Coefficient c;
    std::uint32_t slot;  // kNone if constant in time
  };

  const Tape& tape;
  const std::vector<Instruction>& code;
  std::vector<const ProgramInput*> inputs;  // nullptr for other slots
  // cosine_of: for a sine, a cosine of the same argument; sine_of: the reverse
  std::map<std::uint32_t, std::uint32_t> cosine_of, sine_of;
  std::vector<bool> live, series;
  // tainted: the newest coefficient depends on the unknowns of the stage; pure: it is zero without them
  std::vector<bool> tainted, pure;
  std::vector<std::vector<Summand>> sums;

  bool sum_like(std::uint32_t s) const {
    return code[s].op == Op::linear || code[s].op == Op::scale ||
           (code[s].op == Op::divide && code[code[s].b].constant);
  }
  bool varies(std::uint32_t s) const { return live[s] && !code[s].constant; }
  bool in_main(std::uint32_t s) const { return s < tape.main_end; }
  bool unknown(std::uint32_t s, std::uint8_t lead) const { return tainted[s] && code[s].lead == lead; }
  // The first slot with the same value; the slot itself if it repeats none.
  std::uint32_t same_as(std::uint32_t s) const;
  // The operands of a slot, with repeats replaced.
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

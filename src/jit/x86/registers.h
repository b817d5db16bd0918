// Keeps numbers in vector registers. If a register is needed, the number with the latest next use leaves (Belady's
// rule, which is optimal for straight-line code if all numbers cost the same).
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "jit/x86/encoder.h"
#include "jit/x86/numbers.h"

namespace anholon::jit::x86 {

// The memory of a function on the stack, relative to rsp.
class Frame {
 public:
  std::int64_t take(std::int64_t bytes, std::int64_t align);
  std::int64_t size() const { return size_; }

 private:
  std::int64_t size_ = 0;
};

class Registers {
 public:
  static constexpr int kCount = 15;
  static constexpr int kSpare = 15;  // belongs to no number: for moves

  Registers(const Numbers& numbers, Encoder& code, Frame& frame);

  // Begins an instruction; the numbers that it uses stay where they are until `end`.
  void begin(const Numbers::Block& block, int position);
  // The register of a number, which is loaded if it is not in one.
  int in_register(int number);
  // Returns the place of a number, without loading it if this is its last use.
  Operand anywhere(int number);
  // A register for the present instruction.
  int take();
  // Frees the registers of numbers that are not used after this instruction.
  void release();
  // The register of a new number.
  int define(int number);
  // Turns a number that is not used again into a new number; returns false if it is used again, or is not in a
  // register.
  bool rename(int from, int to);
  bool dies(int number) const;
  bool held(int number) const { return state(number).reg >= 0; }
  int reg(int number) const { return state(number).reg; }
  // Begins the next part of the present instruction.
  void next_part();
  void end();

  // Stores the living numbers that are not in memory yet.
  void store(const llvm::BitVector& living);
  void store_all_that_live();
  // Forgets all registers.
  void clear();
  // Sets the place of a number at the begin of a block: a register, or memory.
  void bind(int number, int reg);
  void bind_to_memory(int number, std::int64_t place);
  Memory slot(int number);

 private:
  struct State {
    int reg = -1;
    std::int64_t slot = -1;
    bool stored = false;
    bool fixed = false;  // the memory is for this number alone
  };
  State& state(int n) { return states_[static_cast<std::size_t>(n)]; }
  const State& state(int n) const { return states_[static_cast<std::size_t>(n)]; }
  int next_use(int number, int from) const;
  void leave(int reg);
  void store_number(int number);
  void give_slot_back(int number);

  const Numbers& numbers_;
  Encoder& code_;
  Frame& frame_;
  std::vector<State> states_;
  std::array<int, kCount> holder_;
  std::uint32_t locked_ = 0;
  std::vector<int> used_;
  std::vector<std::int64_t> free_slots_[2], freed_[2];  // of doubles and of vectors
  const Numbers::Block* block_ = nullptr;
  int position_ = 0;
};

}  // namespace anholon::jit::x86

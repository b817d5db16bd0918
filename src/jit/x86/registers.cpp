#include "jit/x86/registers.h"

#include <algorithm>

namespace anholon::jit::x86 {

namespace {
constexpr int kNobody = -1, kNever = 1 << 30, kLater = kNever - 1;
}

std::int64_t Frame::take(std::int64_t bytes, std::int64_t align) {
  const std::int64_t at = (size_ + align - 1) / align * align;
  size_ = at + bytes;
  return at;
}

Registers::Registers(const Numbers& numbers, Encoder& code, Frame& frame)
    : numbers_(numbers), code_(code), frame_(frame), states_(static_cast<std::size_t>(numbers.count())) {
  holder_.fill(kNobody);
}

void Registers::begin(const Numbers::Block& block, int position) {
  block_ = &block;
  position_ = position;
}

// Returns the first use at a position or after it; kLater if only later blocks use the number.
int Registers::next_use(int number, int from) const {
  const std::vector<int>& uses = numbers_.uses(number);
  const auto next = std::lower_bound(uses.begin(), uses.end(), from);
  if (next != uses.end() && *next <= block_->end) return *next;
  if (!block_->after.test(static_cast<unsigned>(number))) return kNever;
  return next != uses.end() ? *next : kLater;
}

bool Registers::dies(int number) const { return next_use(number, position_ + 1) == kNever; }

int Registers::in_register(int number) {
  State& s = state(number);
  if (s.reg < 0) {
    if (!s.stored) throw Unknown("a number is neither in a register nor in memory");
    const int reg = take();
    code_.load(numbers_.wide(number), reg, slot(number));
    s.reg = reg;
    holder_[static_cast<std::size_t>(reg)] = number;
  }
  locked_ |= 1U << s.reg;
  used_.push_back(number);
  return s.reg;
}

Operand Registers::anywhere(int number) {
  if (state(number).reg >= 0 || !dies(number)) return Operand::of(in_register(number));
  if (!state(number).stored) throw Unknown("a number is neither in a register nor in memory");
  used_.push_back(number);
  return Operand::of(slot(number));
}

int Registers::take() {
  int best = -1, farthest = -1;
  for (int r = 0; r < kCount; ++r) {
    if (locked_ & (1U << r)) continue;
    const int n = holder_[static_cast<std::size_t>(r)];
    if (n == kNobody) {
      best = r;
      break;
    }
    if (const int next = next_use(n, position_); next > farthest) farthest = next, best = r;
  }
  if (best < 0) throw Unknown("an instruction needs more registers than there are");
  if (holder_[static_cast<std::size_t>(best)] != kNobody) leave(best);
  locked_ |= 1U << best;
  return best;
}

void Registers::leave(int reg) {
  const int n = holder_[static_cast<std::size_t>(reg)];
  if (!state(n).stored && next_use(n, position_) != kNever) store_number(n);
  state(n).reg = -1;
  holder_[static_cast<std::size_t>(reg)] = kNobody;
}

void Registers::store_number(int number) {
  code_.store(numbers_.wide(number), state(number).reg, slot(number));
  state(number).stored = true;
}

Memory Registers::slot(int number) {
  State& s = state(number);
  if (s.slot < 0) {
    const bool wide = numbers_.wide(number);
    std::vector<std::int64_t>& list = free_slots_[wide ? 1 : 0];
    if (list.empty()) {
      s.slot = wide ? frame_.take(32, 32) : frame_.take(8, 8);
    } else {
      s.slot = list.back();
      list.pop_back();
    }
  }
  return {rsp, nowhere, 0, s.slot};
}

// Frees the memory of a number after this instruction.
void Registers::give_slot_back(int number) {
  State& s = state(number);
  if (s.slot < 0 || s.fixed) return;
  freed_[numbers_.wide(number) ? 1 : 0].push_back(s.slot);
  s.slot = -1;
  s.stored = false;
}

void Registers::release() {
  std::sort(used_.begin(), used_.end());
  used_.erase(std::unique(used_.begin(), used_.end()), used_.end());
  for (const int n : used_) {
    State& s = state(n);
    if (!dies(n)) continue;
    if (s.reg >= 0) {
      locked_ &= ~(1U << s.reg);
      holder_[static_cast<std::size_t>(s.reg)] = kNobody;
      s.reg = -1;
    }
    give_slot_back(n);
  }
  used_.clear();
}

int Registers::define(int number) {
  const int reg = take();
  bind(number, reg);
  return reg;
}

bool Registers::rename(int from, int to) {
  const int reg = state(from).reg;
  if (reg < 0 || !dies(from)) return false;
  give_slot_back(from);
  state(from).reg = -1;
  std::erase(used_, from);
  bind(to, reg);
  return true;
}

void Registers::bind(int number, int reg) {
  State& s = state(number);
  s.reg = reg;
  s.stored = false;
  holder_[static_cast<std::size_t>(reg)] = number;
  locked_ |= 1U << reg;
}

void Registers::bind_to_memory(int number, std::int64_t place) {
  State& s = state(number);
  s.slot = place;
  s.stored = s.fixed = true;
}

void Registers::next_part() {
  release();
  locked_ = 0;
}

void Registers::end() {
  next_part();
  for (int k = 0; k < 2; ++k) {
    free_slots_[k].insert(free_slots_[k].end(), freed_[k].begin(), freed_[k].end());
    freed_[k].clear();
  }
  // A number without later uses leaves its register.
  for (int& n : holder_)
    if (n != kNobody && dies(n)) {
      give_slot_back(n);
      state(n).reg = -1;
      n = kNobody;
    }
}

void Registers::store(const llvm::BitVector& living) {
  for (const int n : holder_)
    if (n != kNobody && living.test(static_cast<unsigned>(n)) && !state(n).stored) store_number(n);
}

void Registers::store_all_that_live() {
  for (const int n : holder_)
    if (n != kNobody && !dies(n) && !state(n).stored) store_number(n);
}

void Registers::clear() {
  for (int& n : holder_) {
    if (n != kNobody) state(n).reg = -1;
    n = kNobody;
  }
  locked_ = 0;
}

}  // namespace anholon::jit::x86

#include "jit/x86/translator.h"

#include <algorithm>

#include <llvm/IR/CFG.h>

namespace anholon::jit::x86 {

namespace {

bool has_calls(const llvm::Function& f) {
  for (const llvm::BasicBlock& b : f)
    for (const llvm::Instruction& i : b)
      if (llvm::isa<llvm::CallInst>(i) && !llvm::isa<llvm::IntrinsicInst>(i)) return true;
  return false;
}

bool same(const Operand& a, const Operand& b) {
  if (a.in_memory() != b.in_memory()) return false;
  if (!a.in_memory()) return a.reg == b.reg;
  return a.memory.base == b.memory.base && a.memory.at == b.memory.at;
}

}  // namespace

Translator::Translator(llvm::Function& f, Surroundings& around)
    : function_(f), around_(around), numbers_(f), calls_(has_calls(f)),
      addresses_(f, numbers_, code_, frame_, around.tables, calls_), registers_(numbers_, code_, frame_) {}

Encoder Translator::run() {
  addresses_.begin_function();
  for (std::size_t k = 0; k < numbers_.blocks().size(); ++k) block(k);
  code_.resolve_labels();
  const std::vector<General>& saved = addresses_.saved();
  const std::int64_t size = (frame_.size() + 63) / 64 * 64;
  const bool framed = size > 0 || calls_;
  Encoder whole;
  if (framed) whole.push(rbp), whole.move(rbp, rsp);
  for (const General reg : saved) whole.push(reg);
  if (framed) whole.align_stack(64), whole.lower_stack(static_cast<std::int32_t>(size));
  const std::size_t before = whole.bytes.size();
  whole.bytes.insert(whole.bytes.end(), code_.bytes.begin(), code_.bytes.end());
  for (Distance d : code_.constants) d.at += before, whole.constants.push_back(d);
  for (Distance d : code_.functions) d.at += before, whole.functions.push_back(d);
  // The body ends here.
  if (framed) whole.address(rsp, {rbp, nowhere, 0, -8 * static_cast<std::int64_t>(saved.size())});
  for (std::size_t k = saved.size(); k-- > 0;) whole.pop(saved[k]);
  if (framed) whole.pop(rbp);
  whole.end_of_vectors();
  whole.give_back();
  return whole;
}

// ---- blocks ---------------------------------------------------------------------------------------------------------

bool Translator::inherits(const llvm::BasicBlock* next) const {
  return next == following_ && next->getSinglePredecessor() != nullptr;
}

void Translator::block(std::size_t k) {
  const Numbers::Block& b = numbers_.blocks()[k];
  following_ = k + 1 < numbers_.blocks().size() ? numbers_.blocks()[k + 1].block : nullptr;
  code_.place(static_cast<int>(k));
  if (k > 0 && b.block->getSinglePredecessor() != previous_) {
    registers_.clear();
    addresses_.forget();
    for (const llvm::PHINode& phi : b.block->phis()) {
      if (!numbers_.is_number(&phi)) continue;
      for (unsigned part = 0; part < parts_of(phi.getType()); ++part) {
        const int n = numbers_.number(&phi, part);
        if (const auto found = phi_register_.find(n); found != phi_register_.end())
          registers_.bind(n, found->second);
        else
          registers_.bind_to_memory(n, phi_memory_.lookup(n));
      }
    }
  }
  for (const llvm::Instruction& i : *b.block) {
    if (llvm::isa<llvm::PHINode>(i)) continue;
    registers_.begin(b, numbers_.position(&i));
    if (const auto* end = llvm::dyn_cast<llvm::BranchInst>(&i))
      branch(*end, b);
    else if (!numbers_.folded(&i))
      instruction(i);
    registers_.end();
  }
  previous_ = b.block;
}

void Translator::prepare(const llvm::BasicBlock* next) {
  if (inherits(next)) return;
  registers_.store(numbers_.blocks()[static_cast<std::size_t>(numbers_.block_of(next))].before);
}

std::vector<Translator::Move> Translator::moves_to(const llvm::BasicBlock* next, const Numbers::Block& b) const {
  std::vector<Move> moves;
  for (const llvm::PHINode& phi : next->phis())
    if (numbers_.is_number(&phi))
      for (unsigned part = 0; part < parts_of(phi.getType()); ++part)
        moves.push_back(
            {numbers_.number(&phi, part), Numbers::behind_casts(phi.getIncomingValueForBlock(b.block)), part});
  return moves;
}

// When a block is entered for the first time, its phi nodes take the registers of their values if they can.
void Translator::choose_places(const std::vector<Move>& moves) {
  constexpr std::size_t kForTheBody = 3;
  std::uint32_t taken = 0;
  std::size_t left = Registers::kCount - kForTheBody;
  for (const Move& m : moves) {
    if (!numbers_.is_number(m.from) || left == 0) continue;
    const int reg = registers_.reg(numbers_.number(m.from, m.part));
    if (reg < 0 || taken & (1U << reg)) continue;
    taken |= 1U << reg;
    phi_register_[m.number] = reg;
    --left;
  }
  for (const Move& m : moves) {
    if (phi_register_.count(m.number) || left == 0) continue;
    int reg = 0;
    while (taken & (1U << reg)) ++reg;
    taken |= 1U << reg;
    phi_register_[m.number] = reg;
    --left;
  }
  for (const Move& m : moves)
    if (!phi_register_.count(m.number)) phi_memory_[m.number] = frame_.take(32, 32);
}

Operand Translator::place_of_phi(int number) const {
  const auto found = phi_register_.find(number);
  return found != phi_register_.end() ? Operand::of(found->second)
                                      : Operand::of(Memory{rsp, nowhere, 0, phi_memory_.lookup(number)});
}

Operand Translator::source(const Move& move) {
  const bool wide = numbers_.wide(move.number);
  if (const auto* c = llvm::dyn_cast<llvm::Constant>(move.from)) return Operand::of(constant(*c, move.part, wide));
  if (!numbers_.is_number(move.from)) throw Unknown("a phi node takes what is no number");
  const int n = numbers_.number(move.from, move.part);
  return registers_.held(n) ? Operand::of(registers_.reg(n)) : Operand::of(registers_.slot(n));
}

// Makes all moves with the sources as they are before the first of them.
void Translator::move_at_once(const std::vector<Move>& moves) {
  struct Pending {
    Operand to, from;
    bool wide;
  };
  std::vector<Pending> pending;
  for (const Move& m : moves) {
    const Pending p{place_of_phi(m.number), source(m), numbers_.wide(m.number)};
    if (!same(p.to, p.from)) pending.push_back(p);
  }
  const auto move = [&](const Operand& to, const Operand& from, bool wide) {
    if (!to.in_memory() && !from.in_memory()) return code_.copy(to.reg, from.reg);
    if (!to.in_memory()) return code_.load(wide, to.reg, from.memory);
    if (!from.in_memory()) return code_.store(wide, from.reg, to.memory);
    code_.load(wide, Registers::kSpare, from.memory);
    code_.store(wide, Registers::kSpare, to.memory);
  };
  while (!pending.empty()) {
    const auto ready = std::find_if(pending.begin(), pending.end(), [&](const Pending& p) {
      return std::none_of(pending.begin(), pending.end(),
                          [&](const Pending& other) { return &other != &p && same(other.from, p.to); });
    });
    if (ready != pending.end()) {
      move(ready->to, ready->from, ready->wide);
      pending.erase(ready);
      continue;
    }
    // The moves form a cycle, so the content of one place waits in memory.
    Pending& first = pending.front();
    const Operand aside = Operand::of(Memory{rsp, nowhere, 0, frame_.take(32, 32)});
    move(aside, first.to, true);
    for (Pending& p : pending)
      if (same(p.from, first.to)) p.from = aside;
  }
}

bool Translator::has_moves(const llvm::BasicBlock* next, const Numbers::Block& b) {
  for (const Move& m : moves_to(next, b))
    if (!same(place_of_phi(m.number), source(m))) return true;
  return false;
}

// Enters a block: moves its numbers, then its counts.
void Translator::enter(const llvm::BasicBlock* next, const Numbers::Block& b) {
  move_at_once(moves_to(next, b));
  for (const llvm::PHINode& phi : next->phis())
    if (!phi.getType()->getScalarType()->isDoubleTy()) {
      const llvm::Value* from = phi.getIncomingValueForBlock(b.block);
      // A value that depends on the node itself is computed before the node changes.
      const bool number = llvm::isa<llvm::ConstantInt>(from);
      const General of = number ? nowhere : addresses_.value(from), to = addresses_.phi(&phi);
      number ? addresses_.put(to, from) : code_.move(to, of);
    }
}

Condition Translator::condition(const llvm::ICmpInst& of) {
  const General a = addresses_.value(of.getOperand(0));
  if (const auto* b = llvm::dyn_cast<llvm::ConstantInt>(of.getOperand(1)))
    code_.compare(a, static_cast<std::int32_t>(b->getSExtValue()));
  else
    code_.compare(a, addresses_.value(of.getOperand(1)));
  switch (of.getPredicate()) {
  case llvm::ICmpInst::ICMP_SLT:
    return Condition::less;
  case llvm::ICmpInst::ICMP_SLE:
    return Condition::not_greater;
  case llvm::ICmpInst::ICMP_SGT:
    return Condition::greater;
  case llvm::ICmpInst::ICMP_SGE:
    return Condition::not_less;
  default:
    throw Unknown("a comparison of counts");
  }
}

// Emits a branch; one of the blocks after a condition follows directly in the code.
void Translator::branch(const llvm::BranchInst& i, const Numbers::Block& b) {
  std::vector<const llvm::BasicBlock*> next;
  for (unsigned k = 0; k < i.getNumSuccessors(); ++k) next.push_back(i.getSuccessor(k));
  for (const llvm::BasicBlock* s : next) {
    prepare(s);
    if (const std::vector<Move> moves = moves_to(s, b); !moves.empty() && !places_chosen_[s]) {
      places_chosen_[s] = true;
      choose_places(moves);
    }
  }
  const auto label = [&](const llvm::BasicBlock* s) { return numbers_.block_of(s); };
  if (next.size() == 1) {
    enter(next[0], b);
    if (next[0] != following_) code_.jump(label(next[0]));
    return;
  }
  const auto* compared = llvm::dyn_cast<llvm::ICmpInst>(i.getCondition());
  if (!compared) throw Unknown("a branch that does not compare counts");
  // The block that does not follow is entered first, because its moves change the state that the following block starts
  // from.
  const bool first_follows = next[0] == following_;
  const llvm::BasicBlock *stays = first_follows ? next[0] : next[1], *leaves = first_follows ? next[1] : next[0];
  if (!moves_to(stays, b).empty() || (stays->phis().begin() != stays->phis().end()))
    throw Unknown("a phi node after a condition that falls through");
  Condition c = condition(*compared);
  if (first_follows) c = opposite(c);
  const bool simple = !has_moves(leaves, b) && leaves->phis().begin() == leaves->phis().end();
  if (simple) {
    code_.jump(c, label(leaves));
  } else {
    const int over = static_cast<int>(numbers_.blocks().size()) + numbers_.block_of(b.block);
    code_.jump(opposite(c), over);
    enter(leaves, b);
    code_.jump(label(leaves));
    code_.place(over);
    addresses_.forget();
  }
  if (stays != following_) code_.jump(label(stays));
}

// ---- operands -------------------------------------------------------------------------------------------------------

Memory Translator::splatted(std::uint64_t bits, bool wide) {
  return {nowhere, nowhere, 0, around_.constants.place(std::vector<std::uint64_t>(wide ? kWidth : 1, bits))};
}

Memory Translator::constant(const llvm::Constant& c, unsigned part, bool wide) {
  std::vector<std::uint64_t> bits;
  const unsigned lanes = lanes_of(c.getType());
  for (unsigned lane = 0; lane < (wide ? kWidth : 1U); ++lane)
    bits.push_back(part * kWidth + lane < lanes ? bits_of(element_of(c, part * kWidth + lane)) : 0);
  return {nowhere, nowhere, 0, around_.constants.place(bits)};
}

bool Translator::from_memory(const llvm::Value* v, unsigned part) const {
  v = Numbers::behind_casts(v);
  return llvm::isa<llvm::Constant>(v) || numbers_.is_operand(v) ||
         (numbers_.is_number(v) && !registers_.held(numbers_.number(v, part)) &&
          registers_.dies(numbers_.number(v, part)));
}

int Translator::in_register(const llvm::Value* v, unsigned part, bool wide) {
  v = Numbers::behind_casts(v);
  if (numbers_.is_number(v)) return registers_.in_register(numbers_.number(v, part));
  const int reg = registers_.take();
  const auto* c = llvm::dyn_cast<llvm::Constant>(v);
  if (c && c->isNullValue())
    code_.zero(reg);
  else
    code_.load(wide, reg, anywhere(v, part, wide).memory);
  return reg;
}

Operand Translator::anywhere(const llvm::Value* v, unsigned part, bool wide) {
  v = Numbers::behind_casts(v);
  if (numbers_.is_number(v)) return registers_.anywhere(numbers_.number(v, part));
  if (const auto* c = llvm::dyn_cast<llvm::Constant>(v)) return Operand::of(constant(*c, part, wide));
  if (!numbers_.is_operand(v)) throw Unknown("a value is no number");
  return Operand::of(addresses_.memory(llvm::cast<llvm::LoadInst>(v)->getPointerOperand()));
}

// Makes a new number with the value of another one.
void Translator::copy(const llvm::Value* from, unsigned part, int to) {
  from = Numbers::behind_casts(from);
  const bool wide = numbers_.wide(to);
  if (numbers_.is_number(from)) {
    const int n = numbers_.number(from, part);
    const int reg = registers_.in_register(n);
    if (registers_.rename(n, to)) return;
    return code_.copy(registers_.define(to), reg);
  }
  const auto* c = llvm::dyn_cast<llvm::Constant>(from);
  if (is_poison(from) || (c && c->isNullValue())) return code_.zero(registers_.define(to));
  const Operand at = anywhere(from, part, wide);
  code_.load(wide, registers_.define(to), at.memory);
}

}  // namespace anholon::jit::x86

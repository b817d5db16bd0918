#include "jit/x86/addresses.h"

#include <algorithm>
#include <bit>

#include <llvm/IR/Constants.h>
#include <llvm/IR/Module.h>

namespace anholon::jit::x86 {

namespace {

constexpr std::array<General, 5> kTemporaries{rax, r8, r9, r10, r11};

// Returns x if the value is 0 - x, otherwise nullptr.
const llvm::Value* negated(const llvm::Value* v) {
  const auto* of = llvm::dyn_cast<llvm::BinaryOperator>(v);
  if (!of || of->getOpcode() != llvm::Instruction::Sub) return nullptr;
  const auto* from = llvm::dyn_cast<llvm::ConstantInt>(of->getOperand(0));
  return from && from->isZero() ? of->getOperand(1) : nullptr;
}

}  // namespace

const std::array<General, 4> Addresses::kArguments{rdi, rsi, rdx, rcx};

Addresses::Addresses(llvm::Function& f, const Numbers& numbers, Encoder& code, Frame& frame,
                     const llvm::DenseMap<const llvm::Value*, std::int64_t>& tables, bool calls)
    : function_(f), numbers_(numbers), code_(code), frame_(frame), layout_(f.getParent()->getDataLayout()),
      tables_(tables), calls_(calls), pool_{r15, r14, r13, r12, rbx} {
  if (f.arg_size() > kArguments.size()) throw Unknown("a function has many arguments");
  for (const llvm::BasicBlock& b : f)
    for (const llvm::Instruction& i : b)
      if (const auto* memory = llvm::dyn_cast<llvm::AllocaInst>(&i)) {
        const auto* count = llvm::cast<llvm::ConstantInt>(memory->getArraySize());
        const auto size =
            static_cast<std::int64_t>(layout_.getTypeAllocSize(memory->getAllocatedType()).getFixedValue());
        local_[memory] = frame_.take(size * count->getSExtValue(), 64);
      }
}

void Addresses::save(General reg) {
  const bool is_saved = reg == rbx || (reg >= r12 && reg <= r15);
  if (is_saved && std::find(saved_.begin(), saved_.end(), reg) == saved_.end()) saved_.push_back(reg);
}

General Addresses::from_pool() {
  if (pool_.empty()) throw Unknown("a function counts more than there are registers for");
  const General reg = pool_.back();
  pool_.pop_back();
  save(reg);
  return reg;
}

// Arguments are moved to other registers if the function calls, because calls change the registers of arguments.
void Addresses::begin_function() {
  for (unsigned k = 0; k < function_.arg_size(); ++k) {
    const General reg = calls_ ? from_pool() : kArguments[k];
    fixed_[function_.getArg(k)] = reg;
    code_.move(reg, kArguments[k]);
  }
  if (calls_) return;
  for (std::size_t k = kArguments.size(); k-- > function_.arg_size();) pool_.push_back(kArguments[k]);
}

// Returns the last position at which something is computed from a value.
int Addresses::last_use(const llvm::Value* v) const {
  int last = 0;
  for (const llvm::User* user : v->users()) {
    const auto* i = llvm::cast<llvm::Instruction>(user);
    last = std::max(last, numbers_.position(i));
    if (const auto* phi = llvm::dyn_cast<llvm::PHINode>(i)) {
      for (unsigned k = 0; k < phi->getNumIncomingValues(); ++k)
        if (phi->getIncomingValue(k) == v) {
          const int block = numbers_.block_of(phi->getIncomingBlock(k));
          last = std::max(last, numbers_.blocks()[static_cast<std::size_t>(block)].end);
        }
    } else if (i->getType()->isPointerTy() || i->getType()->isIntegerTy()) {
      last = std::max(last, last_use(i));
    }
  }
  return last;
}

General Addresses::phi(const llvm::PHINode* node) {
  if (const auto found = fixed_.find(node); found != fixed_.end()) return found->second;
  // The registers of phi nodes that are not used any more are free.
  const int now = numbers_.position(node);
  std::vector<const llvm::Value*> old;
  for (const auto& [value, reg] : fixed_)
    if (llvm::isa<llvm::PHINode>(value) && numbers_.position(llvm::cast<llvm::Instruction>(value)) < now &&
        last_use(value) < now)
      old.push_back(value);
  for (const llvm::Value* value : old) {
    pool_.push_back(fixed_.lookup(value));
    fixed_.erase(value);
  }
  std::sort(pool_.begin(), pool_.end(), [](General a, General b) { return a > b; });
  return fixed_[node] = from_pool();
}

General Addresses::fixed(const llvm::Value* v) const {
  const auto found = fixed_.find(v);
  return found != fixed_.end() ? found->second : nowhere;
}

// Returns a free register, or the one whose content was not used for the longest time.
General Addresses::take() {
  for (const General reg : kTemporaries)
    if (std::none_of(temporaries_.begin(), temporaries_.end(), [&](const Temporary& t) { return t.reg == reg; }))
      return reg;
  const General reg = temporaries_.front().reg;
  temporaries_.erase(temporaries_.begin());
  return reg;
}

General Addresses::known(const Content& content) {
  const auto found =
      std::find_if(temporaries_.begin(), temporaries_.end(), [&](const Temporary& t) { return t.content == content; });
  if (found == temporaries_.end()) return nowhere;
  std::rotate(found, found + 1, temporaries_.end());
  return temporaries_.back().reg;
}

General Addresses::remember(const Content& content, General reg) {
  temporaries_.push_back({content, reg});
  return reg;
}

General Addresses::value(const llvm::Value* v) {
  if (const General reg = fixed(v); reg != nowhere) return reg;
  if (const llvm::Value* x = negated(v)) return scaled(x, 0, true);
  const Content content{Content::value, v};
  if (const General reg = known(content); reg != nowhere) return reg;
  return remember(content, compute(nowhere, v));
}

void Addresses::put(General to, const llvm::Value* v) {
  if (const General reg = fixed(v); reg != nowhere) return code_.move(to, reg);
  compute(to, v);
}

// Operands are found before a register is taken; an instruction reads them before it writes.
General Addresses::compute(General to, const llvm::Value* v) {
  const auto target = [&] { return to == nowhere ? to = take() : to; };
  if (const auto* number = llvm::dyn_cast<llvm::ConstantInt>(v)) return code_.set(target(), number->getSExtValue()), to;
  if (llvm::isa<llvm::ConstantPointerNull>(v)) return code_.set(target(), 0), to;
  if (v->getType()->isPointerTy()) {
    const Memory m = memory(v);
    return code_.address(target(), m), to;
  }
  const auto* of = llvm::dyn_cast<llvm::BinaryOperator>(v);
  if (!of) throw Unknown("a count is not computed from others");
  const llvm::Value *a = of->getOperand(0), *b = of->getOperand(1);
  if (of->getOpcode() == llvm::Instruction::Add) {
    Memory m{value(a), nowhere, 0, 0};
    if (const auto* by = llvm::dyn_cast<llvm::ConstantInt>(b))
      m.at = by->getSExtValue();
    else
      m.index = value(b);
    return code_.address(target(), m), to;
  }
  if (const llvm::Value* x = negated(v)) return code_.move(target(), scaled(x, 0, true)), to;
  throw Unknown("a count is neither a sum nor the negative of another one");
}

// Returns a register with a count, or its negative, times 2^shift.
General Addresses::scaled(const llvm::Value* count, int shift, bool negative) {
  const Content content{negative ? Content::negative : Content::count, count, shift};
  if (const General reg = known(content); reg != nowhere) return reg;
  const General from = value(count), to = take();
  code_.move(to, from);
  if (shift > 0) code_.shift_left(to, shift);
  if (negative) code_.negate(to);
  return remember(content, to);
}

// Returns the same memory without an index. Several pointers share a base and an index.
Memory Addresses::with_one_base(const Memory& m, const llvm::Value* pointer) {
  const auto is_fixed = [&](General reg) {
    return std::any_of(fixed_.begin(), fixed_.end(), [&](const auto& of) { return of.second == reg; });
  };
  if (m.base == nowhere || !is_fixed(m.base) || !is_fixed(m.index)) return {value(pointer), nowhere, 0, 0};
  const Content content{Content::sum, nullptr, m.shift, m.base, m.index};
  General reg = known(content);
  if (reg == nowhere) {
    reg = take();
    code_.address(reg, {m.base, m.index, m.shift, 0});
    remember(content, reg);
  }
  return {reg, nowhere, 0, m.at};
}

Memory Addresses::indexed(const llvm::GetElementPtrInst& gep) {
  if (gep.getNumIndices() != 1) throw Unknown("a pointer has several indices");
  const auto size = layout_.getTypeAllocSize(gep.getSourceElementType()).getFixedValue();
  const llvm::Value* index = gep.getOperand(1);
  const llvm::Value* pointer = gep.getPointerOperand();
  if (const auto* at = llvm::dyn_cast<llvm::ConstantInt>(index))
    return memory(pointer) + at->getSExtValue() * static_cast<std::int64_t>(size);
  if (!std::has_single_bit(size)) throw Unknown("a pointer goes by steps that are no power of two");
  const int shift = std::countr_zero(size);
  Memory m = memory(pointer);
  if (m.index != nowhere || m.base == nowhere) m = with_one_base(m, pointer);
  const llvm::Value* x = negated(index);
  if (shift <= 3) {
    m.index = x ? scaled(x, 0, true) : value(index);
    m.shift = shift;
  } else {
    m.index = x ? scaled(x, shift, true) : scaled(index, shift, false);
  }
  return m;
}

Memory Addresses::memory(const llvm::Value* pointer) {
  if (const General reg = fixed(pointer); reg != nowhere) return {reg, nowhere, 0, 0};
  if (const General reg = known({Content::value, pointer}); reg != nowhere) return {reg, nowhere, 0, 0};
  if (const auto found = local_.find(pointer); found != local_.end()) return {rsp, nowhere, 0, found->second};
  if (const auto found = tables_.find(pointer); found != tables_.end()) return {nowhere, nowhere, 0, found->second};
  if (const auto* gep = llvm::dyn_cast<llvm::GetElementPtrInst>(pointer)) return indexed(*gep);
  throw Unknown("a pointer comes from nowhere");
}

}  // namespace anholon::jit::x86

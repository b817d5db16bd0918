#include "jit/x86/numbers.h"

#include <llvm/ADT/PostOrderIterator.h>
#include <llvm/IR/CFG.h>
#include <llvm/IR/Constants.h>
#include <llvm/IR/IntrinsicInst.h>

namespace anholon::jit::x86 {

unsigned lanes_of(const llvm::Type* type) {
  const auto* vector = llvm::dyn_cast<llvm::FixedVectorType>(type);
  return vector ? vector->getNumElements() : 1;
}

bool is_fma(const llvm::Value* v) {
  const auto* call = llvm::dyn_cast<llvm::IntrinsicInst>(v);
  return call && call->getIntrinsicID() == llvm::Intrinsic::fma;
}

namespace {

bool is_first_of_splat(const llvm::Value* v) {
  const auto* insertion = llvm::dyn_cast<llvm::InsertElementInst>(v);
  if (!insertion || !llvm::isa<llvm::PoisonValue>(insertion->getOperand(0))) return false;
  const auto* at = llvm::dyn_cast<llvm::ConstantInt>(insertion->getOperand(2));
  return at && at->isZero();
}

bool is_shuffle_of_zeros(const llvm::Value* v) {
  const auto* shuffle = llvm::dyn_cast<llvm::ShuffleVectorInst>(v);
  return shuffle && shuffle->isZeroEltSplat();
}

bool changes_memory(const llvm::Instruction& i) {
  return llvm::isa<llvm::StoreInst>(i) || (llvm::isa<llvm::CallInst>(i) && !llvm::isa<llvm::IntrinsicInst>(i));
}

bool is_double_type(const llvm::Type* type) { return type->getScalarType()->isDoubleTy(); }

template <class Test>
bool all_users(const llvm::Value& v, const Test& test) {
  for (const llvm::User* user : v.users())
    if (!test(user)) return false;
  return true;
}

}  // namespace

bool is_splat(const llvm::Value* v) {
  return is_shuffle_of_zeros(v) && is_first_of_splat(llvm::cast<llvm::ShuffleVectorInst>(v)->getOperand(0));
}

const llvm::Value* Numbers::behind_casts(const llvm::Value* v) {
  while (const auto* cast = llvm::dyn_cast<llvm::BitCastInst>(v)) v = cast->getOperand(0);
  return v;
}

Numbers::Numbers(llvm::Function& f) {
  order(f);
  find_bits();
  fold();
  number_all();
  find_uses();
  find_life();
}

void Numbers::order(llvm::Function& f) {
  int at = 0;
  for (llvm::BasicBlock* b : llvm::ReversePostOrderTraversal<llvm::Function*>(&f)) {
    index_[b] = static_cast<int>(blocks_.size());
    blocks_.push_back({b, at, 0, {}, {}});
    for (const llvm::Instruction& i : *b) position_[&i] = at++;
    blocks_.back().end = at - 1;
  }
}

// Integers that are the bits of doubles are in vector registers; counts are not.
void Numbers::find_bits() {
  for (const Block& b : blocks_)
    for (const llvm::Instruction& i : *b.block) {
      if (!i.getType()->getScalarType()->isIntegerTy(64)) continue;
      if (llvm::isa<llvm::BitCastInst>(i) || i.getType()->isVectorTy())
        bits_.insert(&i);
      else if (llvm::isa<llvm::BinaryOperator>(i) && (bits_.count(i.getOperand(0)) || bits_.count(i.getOperand(1))))
        bits_.insert(&i);
    }
}

bool Numbers::holds_numbers(const llvm::Instruction& i) const {
  return is_double_type(i.getType()) || bits_.count(&i) != 0;
}

bool Numbers::folds(const llvm::Instruction& i) const {
  switch (i.getOpcode()) {
  case llvm::Instruction::BitCast:
  case llvm::Instruction::FCmp:
  case llvm::Instruction::ICmp:
  case llvm::Instruction::GetElementPtr:
  case llvm::Instruction::Alloca:
  case llvm::Instruction::ZExt:
    return true;
  case llvm::Instruction::FNeg:
    return all_users(i, is_fma);
  case llvm::Instruction::InsertElement:
    return is_first_of_splat(&i) && all_users(i, is_shuffle_of_zeros);
  default:
    break;
  }
  if (const auto* call = llvm::dyn_cast<llvm::IntrinsicInst>(&i);
      call && call->getIntrinsicID() == llvm::Intrinsic::vector_reduce_or)
    return true;
  if (llvm::isa<llvm::BinaryOperator>(i) && !holds_numbers(i)) return true;  // counts
  return i.use_empty() && !i.isTerminator() && !changes_memory(i);
}

// `stores`: the number of instructions before each one in its block that change the memory.
bool Numbers::load_folds(const llvm::LoadInst& load,
                         const llvm::DenseMap<const llvm::Instruction*, int>& stores) const {
  const llvm::Instruction* user = &load;
  do {
    if (!user->hasOneUse()) return false;
    user = llvm::cast<llvm::Instruction>(*user->user_begin());
    if (llvm::isa<llvm::BitCastInst, llvm::FCmpInst, llvm::PHINode>(user)) return false;
  } while (folded(user));
  return parts_of(load.getType()) == 1 && user->getParent() == load.getParent() &&
         stores.lookup(user) == stores.lookup(&load);
}

void Numbers::fold() {
  for (const Block& b : blocks_)
    for (const llvm::Instruction& i : *b.block)
      if (folds(i)) folded_.insert(&i);
  for (const Block& b : blocks_) {
    llvm::DenseMap<const llvm::Instruction*, int> stores;
    int count = 0;
    for (const llvm::Instruction& i : *b.block) {
      stores[&i] = count;
      if (changes_memory(i)) ++count;
    }
    for (const llvm::Instruction& i : *b.block)
      if (const auto* load = llvm::dyn_cast<llvm::LoadInst>(&i); load && !folded(load) && load_folds(*load, stores))
        folded_.insert(load);
  }
}

void Numbers::number_all() {
  for (const Block& b : blocks_)
    for (const llvm::Instruction& i : *b.block) {
      if (folded(&i) || !holds_numbers(i)) continue;
      first_[&i] = count();
      wide_.insert(wide_.end(), parts_of(i.getType()), lanes_of(i.getType()) > 1);
    }
  uses_.resize(wide_.size());
}

// `made`: the numbers that the block makes earlier; a number that is not among them lives before the block.
void Numbers::use(const llvm::Value* v, int position, llvm::BitVector* before, const llvm::BitVector* made) {
  v = behind_casts(v);
  if (const auto found = first_.find(v); found != first_.end()) {
    for (int n = found->second; n < found->second + static_cast<int>(parts_of(v->getType())); ++n) {
      std::vector<int>& list = uses_[static_cast<std::size_t>(n)];
      if (list.empty() || list.back() != position) list.push_back(position);
      if (!made->test(static_cast<unsigned>(n))) before->set(static_cast<unsigned>(n));
    }
    return;
  }
  const auto* i = llvm::dyn_cast<llvm::Instruction>(v);
  if (!i || !folded(i) || llvm::isa<llvm::LoadInst, llvm::GetElementPtrInst, llvm::AllocaInst>(i)) return;
  for (const llvm::Value* operand : i->operands()) use(operand, position, before, made);
}

void Numbers::find_uses() {
  const auto n = static_cast<unsigned>(count());
  for (Block& b : blocks_) {
    b.before.resize(n);
    b.after.resize(n);
    llvm::BitVector made(n);
    const auto make = [&](const llvm::Instruction& i) {
      const auto found = first_.find(&i);
      if (found == first_.end()) return;
      for (unsigned part = 0; part < parts_of(i.getType()); ++part)
        made.set(static_cast<unsigned>(found->second) + part);
    };
    for (const llvm::Instruction& i : *b.block) {
      if (!llvm::isa<llvm::PHINode>(i) && (!folded(&i) || i.isTerminator()))
        for (const llvm::Value* operand : i.operands()) use(operand, position_.lookup(&i), &b.before, &made);
      make(i);
    }
    for (llvm::BasicBlock* next : llvm::successors(b.block))
      for (const llvm::PHINode& phi : next->phis()) use(phi.getIncomingValueForBlock(b.block), b.end, &b.before, &made);
  }
}

// Finds the numbers that live at the end of a block: those that live at the begin of a following block. Numbers that a
// block does not make live at its begin, too.
void Numbers::find_life() {
  std::vector<llvm::BitVector> made(blocks_.size(), llvm::BitVector(static_cast<unsigned>(count())));
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    for (const llvm::Instruction& i : *blocks_[k].block)
      if (const auto found = first_.find(&i); found != first_.end())
        for (unsigned part = 0; part < parts_of(i.getType()); ++part)
          made[k].set(static_cast<unsigned>(found->second) + part);
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t k = blocks_.size(); k-- > 0;) {
      Block& b = blocks_[k];
      for (llvm::BasicBlock* next : llvm::successors(b.block))
        b.after |= blocks_[static_cast<std::size_t>(block_of(next))].before;
      llvm::BitVector passed = b.after;
      passed.reset(made[k]);
      passed |= b.before;
      if (passed != b.before) b.before = passed, changed = true;
    }
  }
}

}  // namespace anholon::jit::x86

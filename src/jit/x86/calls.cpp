// Emits calls of instructions of the processor and of functions of the program, and the end of a function.
#include "jit/x86/translator.h"

namespace anholon::jit::x86 {

void Translator::intrinsic(const llvm::IntrinsicInst& i) {
  switch (i.getIntrinsicID()) {
  case llvm::Intrinsic::fma:
    return fma(i);
  case llvm::Intrinsic::masked_load:
    return masked_load(i);
  case llvm::Intrinsic::fabs:
  case llvm::Intrinsic::sqrt:
    break;
  default:
    throw Unknown("a function of the compiler");
  }
  for (unsigned part = 0; part < parts_of(i.getType()); ++part) {
    const int n = numbers_.number(&i, part);
    const bool wide = numbers_.wide(n);
    const int x = in_register(i.getArgOperand(0), part, wide);
    registers_.release();
    const int to = registers_.define(n);
    if (i.getIntrinsicID() == llvm::Intrinsic::sqrt)
      code_.vector(encodings::square_root, wide, to, wide ? -1 : x, Operand::of(x));
    else
      code_.vector(encodings::bit_and, wide, to, x, Operand::of(splatted(~kSign, true)));
  }
}

void Translator::masked_load(const llvm::IntrinsicInst& i) {
  const auto *mask = llvm::dyn_cast<llvm::Constant>(i.getArgOperand(2)),
             *otherwise = llvm::dyn_cast<llvm::Constant>(i.getArgOperand(3));
  if (!mask || !otherwise || !otherwise->isNullValue() || lanes_of(i.getType()) != kWidth)
    throw Unknown("a load of some elements");
  std::vector<std::uint64_t> bits;
  for (unsigned lane = 0; lane < kWidth; ++lane)
    bits.push_back(bits_of(mask->getAggregateElement(lane)) != 0 ? ~0ULL : 0ULL);
  const int lanes = registers_.take();
  code_.load(true, lanes, {nowhere, nowhere, 0, around_.constants.place(bits)});
  const Memory at = addresses_.memory(i.getArgOperand(0));
  code_.vector(encodings::masked_load, true, registers_.define(numbers_.number(&i, 0)), lanes, Operand::of(at));
}

// Moves the numbers of a call to xmm0 and xmm1.
void Translator::numbers_of_call(const llvm::CallInst& i) {
  std::vector<Operand> from;
  for (const llvm::Value* v : i.args())
    if (v->getType()->isDoubleTy()) from.push_back(anywhere(v, 0, false));
  if (from.size() > 2) throw Unknown("a call with many numbers");
  const auto move = [&](int to, const Operand& of) {
    of.in_memory() ? code_.load(false, to, of.memory) : code_.copy(to, of.reg);
  };
  registers_.store_all_that_live();
  if (from.size() == 2) move(Registers::kSpare, from[1]);
  if (!from.empty()) move(0, from[0]);
  if (from.size() == 2) code_.copy(1, Registers::kSpare);
}

void Translator::call(const llvm::CallInst& i) {
  const llvm::Function* callee = i.getCalledFunction();
  if (!callee) throw Unknown("a call of what is not known");
  numbers_of_call(i);
  std::size_t counts = 0;
  for (const llvm::Value* v : i.args()) {
    if (v->getType()->isDoubleTy()) continue;
    if (counts == Addresses::kArguments.size()) throw Unknown("a call with many arguments");
    addresses_.put(Addresses::kArguments[counts++], v);
  }
  code_.end_of_vectors();
  if (const auto inside = around_.functions.find(callee); inside != around_.functions.end()) {
    code_.call(inside->second);
  } else {
    const auto outside = around_.outside.find(std::string(callee->getName()));
    if (outside == around_.outside.end()) throw Unknown("a call of a function that is nowhere");
    code_.set(rax, outside->second);
    code_.call(rax);
  }
  registers_.release();
  registers_.clear();
  addresses_.forget();
  if (i.getType()->isDoubleTy() && numbers_.is_number(&i)) registers_.bind(numbers_.number(&i, 0), 0);
}

// Returns nothing, or whether a comparison holds in any lane. The end of the code follows.
void Translator::give_back(const llvm::ReturnInst& i) {
  if (i.getParent() != numbers_.blocks().back().block) throw Unknown("an end amid the code");
  const llvm::Value* v = i.getReturnValue();
  if (!v) return;
  if (const auto* widened = llvm::dyn_cast<llvm::ZExtInst>(v)) v = widened->getOperand(0);
  if (const auto* any = llvm::dyn_cast<llvm::IntrinsicInst>(v);
      any && any->getIntrinsicID() == llvm::Intrinsic::vector_reduce_or)
    v = any->getArgOperand(0);
  const auto* test = llvm::dyn_cast<llvm::FCmpInst>(v);
  if (!test || test->getPredicate() != llvm::CmpInst::FCMP_OGT || parts_of(test->getOperand(0)->getType()) != 1)
    throw Unknown("a result that is no comparison");
  const bool wide = lanes_of(test->getOperand(0)->getType()) > 1;
  const int x = in_register(test->getOperand(0), 0, wide);
  const Operand y = anywhere(test->getOperand(1), 0, wide);
  const int mask = registers_.take();
  code_.vector(encodings::compare, wide, mask, x, y, 0x1e);
  code_.any_sign(mask, wide);
}

}  // namespace anholon::jit::x86

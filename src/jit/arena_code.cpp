#include "jit/arena_code.h"

#include <llvm/IR/Intrinsics.h>

namespace anholon::jit {

ArenaCode::ArenaCode(const KernelTables& tables, llvm::Module& module, int lanes)
    : k_(tables), p_(*tables.plan), m_(module), b_(module.getContext()), lanes_(lanes),
      lane_(lanes == 1 ? b_.getDoubleTy()
                       : static_cast<llvm::Type*>(
                             llvm::FixedVectorType::get(b_.getDoubleTy(), static_cast<unsigned>(lanes)))) {}

void ArenaCode::open(const char* name, unsigned places, bool answers) {
  auto* type = llvm::FunctionType::get(answers ? b_.getInt32Ty() : b_.getVoidTy(),
                                       std::vector<llvm::Type*>(1 + places, b_.getPtrTy()), false);
  function_ = llvm::Function::Create(type, llvm::Function::ExternalLinkage, name, m_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  w_ = function_->getArg(0);
  b_.SetInsertPoint(llvm::BasicBlock::Create(m_.getContext(), "entry", function_));
}

// Functions have moderate sizes, because the work of the compiler grows faster than their length.
void ArenaCode::open_part(const std::string& name) {
  auto* type = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), b_.getInt64Ty()}, false);
  function_ = llvm::Function::Create(type, llvm::Function::PrivateLinkage, name, m_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  w_ = function_->getArg(0);
  function_->addParamAttr(1, llvm::Attribute::NoAlias);
  b_.SetInsertPoint(llvm::BasicBlock::Create(m_.getContext(), "entry", function_));
}

void ArenaCode::end(Value* answer) {
  if (answer)
    b_.CreateRet(b_.CreateZExt(answer, b_.getInt32Ty()));
  else
    b_.CreateRetVoid();
}

llvm::Value* ArenaCode::address(std::int64_t slot, bool relative) {
  return b_.CreateConstInBoundsGEP1_64(lane_, relative ? block_ : w_, static_cast<std::uint64_t>(slot));
}

llvm::Value* ArenaCode::fma(Value* a, Value* b, Value* c) {
  return b_.CreateIntrinsic(llvm::Intrinsic::fma, {c->getType()}, {a, b, c});
}

// A product with one is the factor itself.
llvm::Value* ArenaCode::times(Value* v, double x) { return x == 1 ? v : b_.CreateFMul(v, number(x)); }

llvm::Value* ArenaCode::opposite(Value* x) {
  auto* negation = llvm::dyn_cast<llvm::UnaryOperator>(x);
  return negation && negation->getOpcode() == llvm::Instruction::FNeg ? negation->getOperand(0) : b_.CreateFNeg(x);
}

// The quotient by a whole number, as in kernel/tiers/lanes.h.
llvm::Value* ArenaCode::quotient(Value* x, Value* reciprocal, Value* beyond) {
  // The known part may be zero.
  if (const auto* nothing = llvm::dyn_cast<llvm::Constant>(x); nothing && nothing->isZeroValue()) return x;
  return fma(x, reciprocal, b_.CreateFMul(x, beyond));
}

llvm::Value* ArenaCode::larger(Value* a, Value* b) { return b_.CreateSelect(b_.CreateFCmpOLT(a, b), b, a); }

llvm::Value* ArenaCode::smaller(Value* a, Value* b) { return b_.CreateSelect(b_.CreateFCmpOLT(b, a), b, a); }

llvm::Value* ArenaCode::magnitude(Value* v) { return b_.CreateIntrinsic(llvm::Intrinsic::fabs, {lane_}, {v}); }

llvm::Value* ArenaCode::bits(Value* v) { return b_.CreateBitCast(v, lane_->getWithNewType(b_.getInt64Ty())); }

llvm::Value* ArenaCode::of_bits(Value* b) { return b_.CreateBitCast(b, lane_); }

llvm::Value* ArenaCode::pattern(std::uint64_t x) {
  return llvm::ConstantInt::get(lane_->getWithNewType(b_.getInt64Ty()), x);
}

llvm::Value* ArenaCode::line(const double* c, Value* x) { return fma(number(c[1]), x, number(c[0])); }

llvm::Value* ArenaCode::cubic(const double* c, Value* x) {
  Value *high = line(c + 2, x), *square = b_.CreateFMul(x, x);
  return fma(high, square, line(c, x));
}

llvm::Value* ArenaCode::exp2(Value* x) {
  Value *n = b_.CreateFAdd(x, number(kInteger)), *f = b_.CreateFSub(x, b_.CreateFSub(n, number(kInteger)));
  return of_bits(
      b_.CreateAdd(bits(cubic(kExp2, f)), b_.CreateShl(b_.CreateSub(bits(n), bits(number(kInteger))), pattern(52))));
}

llvm::Value* ArenaCode::reach(Value* weight, int by, Value* margin) {
  Value* exponent = b_.CreateAShr(b_.CreateSub(bits(weight), pattern(kRootOfHalf)), pattern(52));
  Value *u = b_.CreateFSub(of_bits(b_.CreateSub(bits(weight), b_.CreateShl(exponent, pattern(52)))), number(1)),
        *each = number(-1.0 / by);
  Value* whole =
      fma(b_.CreateFSub(of_bits(b_.CreateAdd(exponent, bits(number(kInteger)))), number(kInteger)), each, margin);
  return b_.CreateSelect(b_.CreateFCmpOGT(weight, number(0)), fma(cubic(kLog2, u), b_.CreateFMul(u, each), whole),
                         number(kFarthest));
}

// The error of a sum, rounded to the digits that a long double keeps of sum and error.
llvm::Value* ArenaCode::rest(Value* sum, Value* error) {
  Value* grid = b_.CreateFMul(of_bits(b_.CreateAnd(bits(sum), pattern(0x7ff0000000000000ULL))), number(1.5 * 0x1p-11));
  return b_.CreateFSub(b_.CreateFAdd(error, grid), grid);
}

llvm::Value* ArenaCode::constants(const std::string& name, const std::vector<double>& numbers) {
  llvm::GlobalVariable* known = m_.getNamedGlobal(name);
  if (known) return known;
  llvm::Constant* data = llvm::ConstantDataArray::get(m_.getContext(), llvm::ArrayRef<double>(numbers));
  return new llvm::GlobalVariable(m_, data->getType(), true, llvm::GlobalValue::InternalLinkage, data, name);
}

llvm::Value* ArenaCode::call_scalar(const char* name, const std::vector<Value*>& arguments, llvm::Type* result) {
  std::vector<llvm::Type*> types;
  for (Value* v : arguments) types.push_back(v->getType());
  return b_.CreateCall(m_.getOrInsertFunction(name, llvm::FunctionType::get(result, types, false)), arguments);
}

llvm::Value* ArenaCode::call(const char* name, const std::vector<Value*>& arguments) {
  Value* all = llvm::PoisonValue::get(lane_);
  for (int lane = 0; lane < lanes_; ++lane) {
    std::vector<Value*> of;
    for (Value* v : arguments) of.push_back(of_lane(v, lane));
    Value* r = call_scalar(name, of, b_.getDoubleTy());
    if (lanes_ == 1) return r;
    all = b_.CreateInsertElement(all, r, static_cast<std::uint64_t>(lane));
  }
  return all;
}

llvm::Value* ArenaCode::of_lane(Value* v, int lane) {
  return lanes_ == 1 || !v->getType()->isVectorTy() ? v : b_.CreateExtractElement(v, static_cast<std::uint64_t>(lane));
}

}  // namespace anholon::jit

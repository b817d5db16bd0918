#include "jit/x86/constants.h"

#include "jit/x86/numbers.h"

namespace anholon::jit::x86 {

std::uint64_t bits_of(const llvm::Constant* number) {
  if (!number || llvm::isa<llvm::UndefValue>(number) || number->isNullValue()) return 0;
  if (const auto* x = llvm::dyn_cast<llvm::ConstantFP>(number)) return x->getValueAPF().bitcastToAPInt().getZExtValue();
  if (const auto* x = llvm::dyn_cast<llvm::ConstantInt>(number)) return x->getZExtValue();
  throw Unknown("a constant is not a number");
}

const llvm::Constant* element_of(const llvm::Constant& c, unsigned i) {
  return c.getType()->isVectorTy() ? c.getAggregateElement(i) : &c;
}

std::int64_t Constants::place(const std::vector<std::uint64_t>& bits) {
  const auto [found, made] = places_.try_emplace(bits, 0);
  if (made) {
    while (bits.size() > 1 && all_.size() % kWidth != 0) all_.push_back(0);
    found->second = static_cast<std::int64_t>(8 * all_.size());
    all_.insert(all_.end(), bits.begin(), bits.end());
  }
  return found->second;
}

std::int64_t Constants::table(const llvm::GlobalVariable& of) {
  const llvm::Constant* values = of.getInitializer();
  const auto* type = llvm::cast<llvm::ArrayType>(values->getType());
  const auto at = static_cast<std::int64_t>(8 * all_.size());
  for (unsigned i = 0; i < type->getNumElements(); ++i) all_.push_back(bits_of(values->getAggregateElement(i)));
  return at;
}

}  // namespace anholon::jit::x86

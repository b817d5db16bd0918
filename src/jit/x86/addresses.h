// Pointers and counts in general registers. Arguments and phi nodes have registers of their own; everything else is
// computed from them where it is needed, and kept as long as its register is not needed otherwise.
#pragma once
#include <array>
#include <vector>

#include <llvm/ADT/DenseMap.h>
#include <llvm/IR/DataLayout.h>
#include <llvm/IR/Instructions.h>

#include "jit/x86/encoder.h"
#include "jit/x86/numbers.h"
#include "jit/x86/registers.h"

namespace anholon::jit::x86 {

class Addresses {
 public:
  // `tables`: the places of constant tables among the constants of the code.
  Addresses(llvm::Function& f, const Numbers& numbers, Encoder& code, Frame& frame,
            const llvm::DenseMap<const llvm::Value*, std::int64_t>& tables, bool calls);

  // Moves the arguments to their registers.
  void begin_function();
  // Forgets computed values, because other code may run before the code that follows.
  void forget() { temporaries_.clear(); }
  // The memory that a pointer points to.
  Memory memory(const llvm::Value* pointer);
  // A register that holds a pointer or count.
  General value(const llvm::Value* v);
  // Computes a pointer or count into a register that is for the arguments of calls.
  void put(General to, const llvm::Value* v);
  // The register of a phi node that counts.
  General phi(const llvm::PHINode* node);
  const std::vector<General>& saved() const { return saved_; }
  static const std::array<General, 4> kArguments;

 private:
  // The content of a temporary register: a value; a count, or its negative, times 2^shift; or a base plus an index,
  // whose registers are fixed.
  struct Content {
    enum Kind : std::uint8_t { value, count, negative, sum } kind;
    const llvm::Value* of = nullptr;
    int shift = 0;
    General base = nowhere, index = nowhere;
    bool operator==(const Content&) const = default;
  };
  struct Temporary {
    Content content;
    General reg;
  };
  General take();
  General known(const Content& content);
  General remember(const Content& content, General reg);
  General fixed(const llvm::Value* v) const;
  General from_pool();
  int last_use(const llvm::Value* v) const;
  // Computes into a register, or into a temporary one if `to` is nowhere.
  General compute(General to, const llvm::Value* v);
  Memory indexed(const llvm::GetElementPtrInst& gep);
  Memory with_one_base(const Memory& m, const llvm::Value* pointer);
  General scaled(const llvm::Value* count, int shift, bool negative);
  void save(General reg);

  llvm::Function& function_;
  const Numbers& numbers_;
  Encoder& code_;
  Frame& frame_;
  const llvm::DataLayout& layout_;
  const llvm::DenseMap<const llvm::Value*, std::int64_t>& tables_;
  const bool calls_;
  llvm::DenseMap<const llvm::Value*, General> fixed_;
  llvm::DenseMap<const llvm::Value*, std::int64_t> local_;  // in the memory of the function
  std::vector<General> pool_, saved_;
  std::vector<Temporary> temporaries_;  // the latest last
};

}  // namespace anholon::jit::x86

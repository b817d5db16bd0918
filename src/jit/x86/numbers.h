// The numbers that a function of straight-line code computes in vector registers, their uses, and the instructions that
// are parts of others.
#pragma once
#include <vector>

#include <llvm/ADT/BitVector.h>
#include <llvm/ADT/DenseMap.h>
#include <llvm/ADT/DenseSet.h>
#include <llvm/IR/Function.h>
#include <llvm/IR/Instructions.h>
#include <llvm/IR/IntrinsicInst.h>

#include "jit/x86/encoder.h"

namespace anholon::jit::x86 {

inline constexpr unsigned kWidth = 4;  // lanes of a register

// The lanes of a type: 1 for a double or an integer, n for a vector.
unsigned lanes_of(const llvm::Type* type);
inline unsigned parts_of(const llvm::Type* type) { return (lanes_of(type) + kWidth - 1) / kWidth; }

// True if a value is a shuffle that repeats the element 0 of an insertion into a vector without other elements.
bool is_splat(const llvm::Value* v);
// True if a value is a fused product and sum.
bool is_fma(const llvm::Value* v);

// A number is a part of a value: a double, or up to four of them side by side. Positions count the instructions in the
// order in which they are translated.
class Numbers {
 public:
  explicit Numbers(llvm::Function& f);

  struct Block {
    llvm::BasicBlock* block;
    int begin = 0, end = 0;         // positions; of `end`: its terminator
    llvm::BitVector before, after;  // the numbers that live at its begin and end; those of phi nodes begin inside
  };
  const std::vector<Block>& blocks() const { return blocks_; }
  int block_of(const llvm::BasicBlock* b) const { return index_.lookup(b); }

  // The value behind casts between doubles and their bits.
  static const llvm::Value* behind_casts(const llvm::Value* v);
  bool is_number(const llvm::Value* v) const { return first_.count(v) != 0; }
  int number(const llvm::Value* v, unsigned part) const { return first_.lookup(v) + static_cast<int>(part); }
  bool wide(int number) const { return wide_[static_cast<std::size_t>(number)]; }
  int count() const { return static_cast<int>(wide_.size()); }
  // Positions in ascending order.
  const std::vector<int>& uses(int number) const { return uses_[static_cast<std::size_t>(number)]; }

  // True if no code is made at the place of an instruction, because its users do its work or it has no users.
  bool folded(const llvm::Value* v) const { return folded_.count(v) != 0; }
  // True for a load that is an operand of its only user.
  bool is_operand(const llvm::Value* v) const { return llvm::isa<llvm::LoadInst>(v) && folded(v); }
  int position(const llvm::Instruction* i) const { return position_.lookup(i); }

 private:
  void order(llvm::Function& f);
  void find_bits();
  bool holds_numbers(const llvm::Instruction& i) const;
  void fold();
  bool folds(const llvm::Instruction& i) const;
  bool load_folds(const llvm::LoadInst& load, const llvm::DenseMap<const llvm::Instruction*, int>& stores) const;
  void number_all();
  void use(const llvm::Value* v, int position, llvm::BitVector* before, const llvm::BitVector* made);
  void find_uses();
  void find_life();

  std::vector<Block> blocks_;
  llvm::DenseMap<const llvm::BasicBlock*, int> index_;
  llvm::DenseMap<const llvm::Instruction*, int> position_;
  llvm::DenseSet<const llvm::Value*> folded_, bits_;
  llvm::DenseMap<const llvm::Value*, int> first_;
  std::vector<bool> wide_;
  std::vector<std::vector<int>> uses_;
};

}  // namespace anholon::jit::x86

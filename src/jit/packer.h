// Straight code made vectors: operations of a block of scalar code that do the same, each on numbers of its own lane,
// become one. Nothing else changes, so neither do the bits.
//
// It starts from values that are wanted side by side (of one kind, for isomorphic steps), takes in what they are
// computed from and what is computed from them as long as each lane does the same, and leaves the rest as it is: a
// chain along the mechanism, say, where every link waits for the one before.
#pragma once
#include <unordered_map>

#include <llvm/IR/IRBuilder.h>

#include "jit/packed_memory.h"

namespace anholon::jit {

class Packer {
 public:
  // One value in each lane, null where there is none.
  using Lanes = std::vector<llvm::Value*>;
  // `address` gives where in the packed memory a place is; `origins` says of loads what they read.
  Packer(llvm::BasicBlock& block, llvm::IRBuilder<>& builder, PackedMemory& memory,
         const std::unordered_map<llvm::Value*, Origin>& origins,
         std::function<llvm::Value*(PackedMemory::Place)> address);

  void want(Lanes values) { wanted_.push_back(std::move(values)); }
  void keep(Lanes values, PackedMemory::Place place) { kept_.push_back({std::move(values), place}); }
  void run();

 private:
  using Value = llvm::Value;
  using Instruction = llvm::Instruction;
  struct Group {
    std::vector<Instruction*> lanes;
    std::optional<PackedMemory::Place> place;  // of loads
    bool parts = false;                        // the elements of a vector, one after the other
    Value* vector = nullptr;
    std::vector<Value*> scalars;
  };
  struct Kept {
    Lanes values;
    PackedMemory::Place place;
  };
  static constexpr int kNone = -1;

  void read();
  bool form(const Lanes& values);
  bool ready(const Lanes& values) const;
  bool same_operation(const std::vector<Instruction*>& members) const;
  bool independent(const std::vector<Instruction*>& members);
  void grow(std::size_t group);
  Lanes operands(const Group& g, unsigned k) const;
  const Origin* origin(const Value* v) const;
  bool alike(const Value* x, const Value* y) const;
  int group_of(const Value* v) const;

  void write();
  void write_group(Group& g);
  Value* vector(const Lanes& values);
  Value* scalar(Value* v);
  void clear();

  llvm::BasicBlock& block_;
  llvm::IRBuilder<>& b_;
  PackedMemory& memory_;
  const std::unordered_map<Value*, Origin>& origins_;
  const std::function<Value*(PackedMemory::Place)> address_;
  const unsigned width_;
  llvm::Type* const vector_type_;
  std::vector<Lanes> wanted_;
  std::vector<Kept> kept_;
  std::vector<Instruction*> code_;
  std::unordered_map<const Value*, int> index_;
  std::vector<std::vector<int>> needs_, users_;  // by index
  std::vector<int> group_, seen_;                // by index
  int search_ = 0;
  std::vector<Group> groups_;
  std::map<Lanes, Value*> gathered_;
};

// What has no effect and whose value nobody uses.
void erase_dead(llvm::BasicBlock& block);

}  // namespace anholon::jit

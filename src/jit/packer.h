// Vectorizes straight-line code: isomorphic operations of a block of scalar code, each on numbers of its own lane,
// become one operation. Nothing else changes, so the bits stay the same.
//
// The packer starts from values that are needed side by side (of one kind, for isomorphic steps), adds their operands
// and their users as long as all lanes perform the same operation, and leaves the rest scalar: for instance a chain
// along the mechanism, in which every link depends on the one before.
#pragma once
#include <unordered_map>

#include <llvm/IR/IRBuilder.h>

#include "jit/packed_memory.h"

namespace anholon::jit {

class Packer {
 public:
  // One value in each lane; nullptr for an empty lane.
  using Lanes = std::vector<llvm::Value*>;
  // `address` returns the address of a place in the packed memory; `origins` tells from which places loads read.
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
    bool parts = false;                        // the elements of a vector, in order
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

// Removes instructions without effect whose value is unused.
void erase_dead(llvm::BasicBlock& block);

}  // namespace anholon::jit

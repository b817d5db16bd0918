// Translates one function into machine code, instruction by instruction.
#pragma once
#include <string>

#include "jit/x86/addresses.h"
#include "jit/x86/constants.h"

namespace anholon::jit::x86 {

inline bool is_poison(const llvm::Value* v) { return llvm::isa<llvm::UndefValue>(v); }

// The objects outside of a function to which it refers.
struct Surroundings {
  Constants constants;
  llvm::DenseMap<const llvm::Value*, std::int64_t> tables;
  llvm::DenseMap<const llvm::Value*, int> functions;         // with code of their own
  std::map<std::string, std::int64_t, std::less<>> outside;  // addresses of others by name
};

class Translator {
 public:
  Translator(llvm::Function& f, Surroundings& around);
  // Throws Unknown for code that it does not know.
  Encoder run();

 private:
  void block(std::size_t k);
  void instruction(const llvm::Instruction& i);
  void intrinsic(const llvm::IntrinsicInst& i);
  void call(const llvm::CallInst& i);
  void numbers_of_call(const llvm::CallInst& i);
  void load(const llvm::LoadInst& i);
  void store(const llvm::StoreInst& i);
  void binary(const llvm::Instruction& i, const Encoding& e, bool commutes);
  void shift(const llvm::Instruction& i);
  void negate(const llvm::Instruction& i);
  void fma(const llvm::Instruction& i);
  void fma_part(const llvm::Instruction& i, unsigned part);
  void select(const llvm::SelectInst& i);
  void extract(const llvm::ExtractElementInst& i);
  void insert(const llvm::InsertElementInst& i);
  void shuffle(const llvm::ShuffleVectorInst& i);
  void splat(const llvm::ShuffleVectorInst& i);
  void masked_load(const llvm::IntrinsicInst& i);
  void give_back(const llvm::ReturnInst& i);
  void branch(const llvm::BranchInst& i, const Numbers::Block& b);
  void copy(const llvm::Value* from, unsigned part, int to);

  bool inherits(const llvm::BasicBlock* next) const;
  // Stores the numbers that the next block expects in memory.
  void prepare(const llvm::BasicBlock* next);
  struct Move {
    int number;  // of the phi node
    const llvm::Value* from;
    unsigned part;
  };
  std::vector<Move> moves_to(const llvm::BasicBlock* next, const Numbers::Block& b) const;
  bool has_moves(const llvm::BasicBlock* next, const Numbers::Block& b);
  void choose_places(const std::vector<Move>& moves);
  void enter(const llvm::BasicBlock* next, const Numbers::Block& b);
  void move_at_once(const std::vector<Move>& moves);
  Operand place_of_phi(int number) const;
  Operand source(const Move& move);

  // Operands of the present instruction.
  static constexpr std::uint64_t kSign = 1ULL << 63;
  int in_register(const llvm::Value* v, unsigned part, bool wide);
  Operand anywhere(const llvm::Value* v, unsigned part, bool wide);
  bool from_memory(const llvm::Value* v, unsigned part) const;
  Memory constant(const llvm::Constant& c, unsigned part, bool wide);
  Memory splatted(std::uint64_t bits, bool wide);
  Condition condition(const llvm::ICmpInst& of);

  llvm::Function& function_;
  Surroundings& around_;
  Numbers numbers_;
  Encoder code_;
  Frame frame_;
  const bool calls_;
  Addresses addresses_;
  Registers registers_;
  llvm::DenseMap<int, int> phi_register_;         // of a number; a number without one is in memory
  llvm::DenseMap<int, std::int64_t> phi_memory_;  // place on the stack
  llvm::DenseMap<const llvm::BasicBlock*, bool> places_chosen_;
  const llvm::BasicBlock *previous_ = nullptr, *following_ = nullptr;
};

}  // namespace anholon::jit::x86

// Random straight-line code with a loop in LLVM IR, and its results as C++ computes them.
#pragma once
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>

namespace anholon::jit {

// A function of an arena: it reads kInputs numbers and writes others behind them. `expected` is the arena afterwards,
// computed operation by operation in C++.
class RandomCode {
 public:
  static constexpr std::size_t kInputs = 64, kArena = 4096;
  using Arena = std::array<double, kArena>;

  // `lanes`: 1, 4 or 8 elements of the vectors; single numbers are always among the operands. `operations`: their
  // number in each block.
  RandomCode(llvm::Module& module, const char* name, std::uint32_t seed, unsigned lanes, int operations);
  const Arena& begin() const { return begin_; }
  const Arena& expected() const { return expected_; }

 private:
  struct Number {
    llvm::Value* ir;
    std::vector<double> value;  // one element or `lanes_`
  };

  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_()) % n; }
  llvm::Type* type(std::size_t lanes);
  llvm::Value* place(std::size_t at);
  Number& any(std::size_t lanes);
  void keep(Number n) { numbers_.push_back(std::move(n)); }
  template <class F>
  std::vector<double> each(std::size_t lanes, const F& f) const;
  Number load(std::size_t lanes, std::size_t at);
  Number constant(std::size_t lanes);
  void store(const Number& n);
  void arithmetic(std::size_t lanes);
  void fused(std::size_t lanes);
  void choice(std::size_t lanes);
  void function(std::size_t lanes);
  void move_lanes();
  void shuffle();
  void operation();
  void straight_line(int operations);
  // Adds a loop with phi nodes that change places: each takes the value of another one, or a sum.
  void loop(int operations);

  std::mt19937 random_;
  unsigned lanes_;
  llvm::LLVMContext& context_;
  llvm::IRBuilder<> b_;
  llvm::Function* function_;
  std::vector<Number> numbers_;
  Arena begin_{}, expected_{};
  std::size_t next_ = kInputs;
};

}  // namespace anholon::jit

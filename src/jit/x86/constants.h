// The constants of the code of a module: numbers stored beside it.
#pragma once
#include <cstdint>
#include <map>
#include <vector>

#include <llvm/IR/Constants.h>
#include <llvm/IR/GlobalVariable.h>

namespace anholon::jit::x86 {

// Returns the bits of a constant number; 0 for an undefined one. Throws Unknown if the constant is no number.
std::uint64_t bits_of(const llvm::Constant* number);

// An element of a constant vector, or a constant that is no vector.
const llvm::Constant* element_of(const llvm::Constant& c, unsigned i);

class Constants {
 public:
  // Returns the place, in bytes, of these numbers; equal lists have one place. Four numbers are aligned for a vector.
  std::int64_t place(const std::vector<std::uint64_t>& bits);
  // The place of a table.
  std::int64_t table(const llvm::GlobalVariable& of);
  const std::vector<std::uint64_t>& all() const { return all_; }

 private:
  std::vector<std::uint64_t> all_;
  std::map<std::vector<std::uint64_t>, std::int64_t> places_;
};

}  // namespace anholon::jit::x86

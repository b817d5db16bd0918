// LLVM IR for functions over the arena of a kernel: loads and stores, and the arithmetic of lanes, operation by
// operation as in kernel/tiers/.
#pragma once
#include <vector>

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>

#include "kernel/code.h"

namespace anholon::jit {

class ArenaCode {
 protected:
  using Value = llvm::Value;

  ArenaCode(const KernelTables& tables, llvm::Module& module, int lanes);

  // Begins a function of the arena and of `places` places in it; `answers`: it returns a value.
  void open(const char* name, unsigned places, bool answers);
  // Begins a part of another function; its arguments are the arena, the scratch memory and a stage.
  void open_part(const std::string& name);
  void end(Value* answer = nullptr);

  Value* number(double x) { return llvm::ConstantFP::get(lane_, x); }
  double factorial(int k) const { return k_.factorial[static_cast<std::size_t>(k)]; }

  // The address of a place in the arena, counted from its begin or, if `relative`, from the stage with which the
  // present block begins.
  Value* address(std::int64_t slot, bool relative);
  Value* load(std::int64_t slot, bool relative = false) {
    return b_.CreateAlignedLoad(lane_, address(slot, relative), align());
  }
  llvm::StoreInst* store(Value* v, std::int64_t slot, bool relative = false) {
    return b_.CreateAlignedStore(v, address(slot, relative), align());
  }
  Value* load_from(Value* place, std::int64_t i) {
    return b_.CreateAlignedLoad(lane_, b_.CreateConstInBoundsGEP1_64(lane_, place, static_cast<std::uint64_t>(i)),
                                align());
  }
  void store_to(Value* v, Value* place, std::int64_t i) {
    b_.CreateAlignedStore(v, b_.CreateConstInBoundsGEP1_64(lane_, place, static_cast<std::uint64_t>(i)), align());
  }
  llvm::Align align() const { return llvm::Align(8 * static_cast<std::uint64_t>(lanes_)); }

  Value* fma(Value* a, Value* b, Value* c);
  Value* times(Value* v, double x);
  Value* opposite(Value* x);
  Value* quotient(Value* x, Value* reciprocal, Value* beyond);
  Value* larger(Value* a, Value* b);
  Value* smaller(Value* a, Value* b);
  Value* magnitude(Value* v);
  Value* bits(Value* v);
  Value* of_bits(Value* b);
  Value* pattern(std::uint64_t x);
  Value* line(const double* c, Value* x);
  Value* cubic(const double* c, Value* x);
  Value* exp2(Value* x);
  Value* reach(Value* weight, int by, Value* margin);
  Value* rest(Value* sum, Value* error);
  // The address of numbers that are part of the code.
  Value* constants(const std::string& name, const std::vector<double>& numbers);
  // Calls a function of doubles, lane by lane.
  Value* call(const char* name, const std::vector<Value*>& arguments);
  Value* call_scalar(const char* name, const std::vector<Value*>& arguments, llvm::Type* result);

  const KernelTables& k_;
  const Plan& p_;
  llvm::Module& m_;
  llvm::IRBuilder<> b_;
  const int lanes_;
  llvm::Type* const lane_;  // double, or a vector of them
  llvm::Function* function_ = nullptr;
  Value *w_ = nullptr, *block_ = nullptr;  // the arena; the arena + the stage with which the present block begins

 private:
  Value* of_lane(Value* v, int lane);
};

}  // namespace anholon::jit

// Coefficients of the present stage, for code of one stage: which values are known and need not be loaded.
#pragma once
#include <map>
#include <string>
#include <unordered_map>
#include <unordered_set>

#include <llvm/IR/ValueHandle.h>

#include "jit/arena_code.h"
#include "jit/packed_memory.h"

namespace anholon::jit {

class StageCode : public ArenaCode {
 protected:
  using ArenaCode::ArenaCode;

  // Begins code for the block of stages from k0 on; `stage_` then counts from k0.
  void begin_block(Value* k0);
  // Forgets the values, because another stage or another function begins.
  void forget();

  // Orders are relative to the present stage: get() and put() take the coefficient of order stage + lead; earlier() and
  // read() take an order counted like `stage_`.
  Value* get(const Place& place, int lead);
  Value* newest(std::uint32_t at, int lead) { return get({at, true}, lead); }
  void put(const Place& place, int lead, Value* v);
  // Stores a number of the arena that is no coefficient.
  void put_number(std::uint32_t at, Value* v);
  Value* earlier(std::uint32_t at, int order);
  // Loads, with a record of the place that each reads.
  Value* constant(std::int64_t slot);
  Value* read(std::uint32_t at, int order, bool relative);
  Value* noted(Value* v, Origin origin) { return origins_[v] = origin, v; }

  // Element stage + offset of a table, or of row m of several.
  Value* table(const char* name, const std::vector<double>& row, int offset);
  Value* row(const char* name, const std::vector<double>& rows, int m, int offset);
  Value* order(int offset);
  Value* rising(int m, int offset);
  Value* over_order(Value* x, int offset);
  Value* over_rising(Value* x, int m);

  Value* k0_ = nullptr;    // the stage with which the block begins
  bool relative_ = false;  // `stage_` is relative to k0_
  int stage_ = 0;
  static constexpr int kNoOrder = -1000;                        // marks a number that is no coefficient
  std::map<std::pair<std::uint32_t, int>, Value*> known_;       // values by place and order
  std::map<Convolution, std::pair<Value*, Value*>> histories_;  // of the present stage
  std::unordered_map<Value*, Origin> origins_;
  std::unordered_set<std::uint32_t> crossing_;  // numbers of a stage that another function reads
  // Loads and stores of all parts, by series.
  std::vector<std::pair<std::uint32_t, llvm::WeakVH>> reads_, puts_;

 private:
  std::map<std::pair<std::string, int>, Value*> elements_;  // elements of tables, by the offset added to the stage
  std::map<std::pair<std::uint32_t, int>, llvm::StoreInst*> stores_;  // of coefficients, by their order
  std::map<std::string, llvm::GlobalVariable*> tables_;
};

}  // namespace anholon::jit

// LLVM IR for a kernel of one lane or several: the arithmetic of kernel/tiers/sweep.h, operation by operation in the
// same order, so the bits are the same.
//
// The code consists of blocks of four stages. Products of coefficients known before a block are summed for its four
// orders at once, several convolutions side by side; products with new coefficients are added stage by stage. If there
// are few steps, they are unrolled for each of the first four stages and for each place in a block, so that new
// coefficients stay in registers; if there are many, each place in a block is a function, and the first block, where
// little is known, uses the function of the first place. A long elimination is a function of its own. For a single
// motion with many steps, isomorphic steps are lanes of vectors (packs.h).
#pragma once
#include <algorithm>
#include <functional>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <llvm/IR/IRBuilder.h>
#include <llvm/IR/Module.h>
#include <llvm/IR/ValueHandle.h>

#include "jit/packed_memory.h"
#include "kernel/code.h"

namespace anholon::jit {

// The number of convolutions that are summed side by side if four orders of each are four sums of lanes.
inline constexpr std::size_t kSideBySideInLanes = 3;

// Calls `body` for runs [from, to) of at most this length with the same lead.
template <class List, class Body>
void for_runs(const List& list, std::size_t most, const Body& body) {
  for (std::size_t from = 0, to; from < list.size(); from = to) {
    to = from + 1;
    while (to < list.size() && to - from < most && list[to].lead == list[from].lead) ++to;
    body(from, to);
  }
}

class Emitter {
 public:
  // `several_sines`: the number of angles that anholon_several_sines takes.
  Emitter(const KernelTables& tables, llvm::Module& module, int lanes, int several_sines);
  // Emits the parts of kernel/code.h: "values", "factor", "lead" (residual and completion of stage 0), "extend",
  // "measure", "advance", "begin", "go_on", and "level1", …: the solution for the residuals of hidden constraints.
  void run();
  static int levels(const KernelTables& tables) {
    return *std::max_element(tables.plan->c.begin(), tables.plan->c.end());
  }
  static std::string level_name(int level) { return "level" + std::to_string(level); }

 private:
  using Value = llvm::Value;
  // Series and sums of a convolution if orders are vectors: of the first factor from order 0 on, of the second from the
  // order of the block.
  struct InLanes {
    Value *a, *b, *sums;
  };

  // Begins a function of the arena and of `places` places in it; `answers`: it returns a value.
  void begin(const char* name, unsigned places = 0, bool answers = false);
  // Begins a part of another function; its arguments are the arena, the scratch memory and a stage.
  llvm::Function* begin_part(const std::string& name);
  void end(Value* answer = nullptr);
  void values();
  void values_of_stage();
  void several_sines(const std::vector<const Step*>& steps);
  void factor();
  void invert(const std::vector<Value*>& lu, const std::vector<Value*>& reciprocal);
  void invert_sides_at_once(const std::vector<Value*>& lu, const std::vector<Value*>& reciprocal);
  void invert_sides_by_call();
  std::vector<Value*> solution_for(std::vector<Value*> rhs, const std::vector<Value*>& lu,
                                   const std::vector<Value*>& reciprocal);
  std::uint32_t multiply_by_inverse();
  void transpose(std::vector<Value*>& rows);
  Value* minus_entry(std::uint32_t entry, Value* x, Value* s);
  bool unit(std::uint32_t entry) const;  // 1 or -1
  void lead();
  void level(int level);
  void advance();
  std::vector<Value*> increments();
  void extend();
  // Emits all stages from 1 on of a list, in blocks.
  void stages(const std::vector<Step>& steps, bool solved);
  void stages_in_line(const std::vector<Step>& steps, bool solved);
  void stages_in_parts(const std::vector<Step>& steps, bool solved);
  void begin_block(Value* k0);
  void stage(const std::vector<Step>& steps, bool solved);
  // Emits a loop over the blocks after the first; `body` is for stage k0 + i.
  void over_blocks(const std::function<void(Value* k0)>& before, const std::function<void(Value* k0, int i)>& body);
  void bulk();
  llvm::AllocaInst* scratch_memory();
  void known_before(const Convolution* group, std::size_t count);
  void known_before_in_lanes(llvm::Type* lane, std::uint8_t lead, const std::vector<InLanes>& group);
  void pack_histories();
  void pack_stage();
  void fill_packed_memory();
  void leave_out_what_nobody_reads(const std::vector<llvm::Function*>& parts);
  // Emits a loop over j = 4 .. order of the block - 1; `body` takes j and the sums so far, and returns the new ones.
  std::vector<Value*> over_known(std::uint8_t lead, const std::vector<Value*>& sums,
                                 const std::function<std::vector<Value*>(Value*, const std::vector<Value*>&)>& body);

  void value(const Step& s);
  void coefficient(const Step& s);
  void partial(const Partial& d);
  Value* sum(const Step& s, std::uint32_t count);
  Value* beyond_of_sum(const Step& s);
  // The sum over all products older than the newest coefficients; within a block, the products that end with new
  // coefficients of a are a separate sum.
  std::pair<Value*, Value*> history(const Convolution& c);
  Value* whole_history(std::uint32_t a, std::uint32_t b, std::uint8_t lead);
  Value* convolution(std::uint32_t a, std::uint32_t b, std::uint8_t lead, bool first, bool last, bool b_later = false);
  Value* opposite(Value* x);
  void side(std::size_t root);
  void sides();
  void solve();
  void substitute(bool all_sides = false);
  void substitution();
  void complete();

  void begin_motion();
  void judge(const std::vector<Value*>& lu);
  Value* displaced(int level);
  void measure();
  void go_on();
  Value* reach(Value* weight, int by, Value* margin);
  Value* cubic(const double* c, Value* x);
  Value* exp2(Value* x);
  Value* rest(Value* sum, Value* error);
  Value* line(const double* c, Value* x);
  Value* larger(Value* a, Value* b);
  Value* smaller(Value* a, Value* b);
  Value* magnitude(Value* v);
  Value* times(Value* v, double x);
  Value* bits(Value* v);
  Value* of_bits(Value* b);
  Value* pattern(std::uint64_t x);
  Value* coefficient_of(std::size_t j, int order);
  double factorial(int k) const;

  // Orders are given for the present stage: absolute, or relative to it.
  Value* number(double x) { return llvm::ConstantFP::get(lane_, x); }
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
  // Loads, with a record of the place that each reads.
  Value* constant(std::int64_t slot);
  Value* read(std::uint32_t at, int order, bool relative);
  Value* sum_before(const Convolution& c, int order, bool new_of_a);
  Value* noted(Value* v, Origin origin) { return origins_[v] = origin, v; }
  Value* own(std::uint32_t at) { return b_.CreateConstInBoundsGEP1_64(lane_, scratch_, at); }
  std::uint32_t place_of_sum(const Convolution& c, int order, bool new_of_a) const;
  void forget();
  // The coefficient of order stage + lead, or of an order counted like `stage_`.
  Value* get(const Place& place, int lead);
  Value* earlier(std::uint32_t at, int order);
  void put(const Place& place, int lead, Value* v);
  Value* newest(std::uint32_t at, int lead) { return get({at, true}, lead); }
  // Element stage + offset of a table, or of row m of several.
  Value* table(const char* name, const std::vector<double>& row, int offset);
  Value* row(const char* name, const std::vector<double>& rows, int m, int offset);
  Value* order(int offset);
  Value* rising(int m, int offset);
  Value* quotient(Value* x, Value* reciprocal, Value* beyond);
  Value* over_order(Value* x, int offset);
  Value* over_rising(Value* x, int m);
  Value* fma(Value* a, Value* b, Value* c);
  // Calls a function of doubles, lane by lane.
  Value* call(const char* name, const std::vector<Value*>& arguments);
  Value* call_scalar(const char* name, const std::vector<Value*>& arguments, llvm::Type* result);
  Value* of_lane(Value* v, int lane) {
    return lanes_ == 1 || !v->getType()->isVectorTy() ? v
                                                      : b_.CreateExtractElement(v, static_cast<std::uint64_t>(lane));
  }

  const KernelTables& k_;
  const Plan& p_;
  llvm::Module& m_;
  llvm::IRBuilder<> b_;
  const int lanes_, several_sines_;
  llvm::Type* const lane_;   // double, or a vector of them
  std::vector<bool> asked_;  // columns of the solution
  llvm::Function *substitution_ = nullptr, *advance_ = nullptr;
  llvm::Function* function_ = nullptr;
  Value *w_ = nullptr, *block_ = nullptr, *k0_ = nullptr, *scratch_ = nullptr,
        *sines_ = nullptr;  // arena; arena + stage; that stage, or the first of a block
  bool relative_ = false;
  int stage_ = 0;                  // absolute, or counted from the first stage of its block
  bool history_is_whole_ = false;  // the scratch memory holds all sums of a convolution before the newest coefficients
  // Values that need not be loaded, by order, counted like `stage_`.
  static constexpr int kNoOrder = -1000;
  std::map<std::pair<std::uint32_t, int>, Value*> known_;
  std::map<std::pair<std::string, int>, Value*> elements_;  // elements of tables, by the offset added to the stage
  std::optional<PackedMemory> memory_;                      // places in the scratch memory
  std::unordered_map<Value*, Origin> origins_;
  std::map<Convolution, std::pair<Value*, Value*>> histories_;        // of the present stage
  std::map<std::pair<std::uint32_t, int>, llvm::StoreInst*> stores_;  // of coefficients, by their order
  // Loads and stores of all parts, by series.
  std::vector<std::pair<std::uint32_t, llvm::WeakVH>> reads_;
  std::vector<std::pair<std::uint32_t, llvm::WeakVH>> puts_;
  std::map<std::string, llvm::GlobalVariable*> tables_;
  std::vector<Value*> side_, solution_;
};

}  // namespace anholon::jit

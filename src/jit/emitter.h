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
#include <optional>

#include "jit/stage_code.h"

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

class Emitter : StageCode {
 public:
  // `several_sines`: the number of angles that anholon_several_sines takes. The code of a long plan is in several
  // modules; `part` is the number of this one.
  Emitter(const KernelTables& tables, llvm::Module& module, int lanes, int several_sines, std::size_t part = 0);
  static std::size_t parts(const KernelTables& tables) { return tables.sums != 0 ? kParts : 1; }
  // Emits the parts of kernel/code.h: "values", "factor", "lead" (residual and completion of stage 0), "extend",
  // "measure", "advance", "begin", "go_on", and "level1", …: the solution for the residuals of hidden constraints.
  void run();
  static int levels(const KernelTables& tables) {
    return *std::max_element(tables.plan->c.begin(), tables.plan->c.end());
  }

 private:
  // Series and sums of a convolution if orders are vectors: of the first factor from order 0 on, of the second from the
  // order of the block.
  struct InLanes {
    Value *a, *b, *sums;
  };

  // Pieces of long plans (emit_pieces.cpp).
  static constexpr std::size_t kParts = 8;
  struct Run {
    std::uint8_t lead;
    std::size_t from, to;  // histories
  };
  struct Piece {
    llvm::Function* code;
    std::vector<Run> histories;  // the histories that it needs
  };
  void stages_in_pieces();
  void find_crossing_numbers();
  std::vector<std::vector<Run>> list_histories();
  Piece piece(const std::string& name, const std::function<void()>& body);
  std::vector<Piece> pieces_of_steps();
  void pieces_of_solution(std::vector<Piece>& out);
  void pieces_of_substitution(std::vector<Piece>& out, std::int64_t solution, bool all_sides);
  void pieces_of_residual(std::vector<Piece>& out);
  void pieces_of_completion(std::vector<Piece>& out);
  llvm::Function* loop_over_histories(const std::string& name,
                                      const std::function<void(const std::vector<InLanes>&)>& body);
  llvm::Function* histories_known(std::uint8_t lead);
  llvm::Function* histories_of_first(std::uint8_t lead, int stage);
  llvm::Function* histories_of_place(std::uint8_t lead, int place);

  // Begins a function of the arena and of `places` places in it; `answers`: it returns a value.
  void begin(const char* name, unsigned places = 0, bool answers = false);
  // Begins a part of another function; its arguments are the arena, the scratch memory and a stage.
  llvm::Function* begin_part(const std::string& name);
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
  bool unit(std::uint32_t entry) const;  // true for 1 or -1
  void lead();
  void level(int level);
  void advance();
  std::vector<Value*> increments();
  void extend();
  void extend_after();
  // Emits all stages from 1 on of a list, in blocks.
  void stages(const std::vector<Step>& steps, bool solved);
  void stages_in_line(const std::vector<Step>& steps, bool solved);
  void stages_in_parts(const std::vector<Step>& steps, bool solved);
  void stage(const std::vector<Step>& steps, bool solved);
  // Emits a loop over the blocks after the first; `body` is for stage k0 + i.
  void over_blocks(const std::function<void(Value* k0)>& before, const std::function<void(Value* k0, int i)>& body);
  void bulk();
  llvm::AllocaInst* scratch_memory();
  void known_before(std::uint8_t lead, const std::vector<InLanes>& group);
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
  void coefficient_of_power(const Step& s);
  void coefficient_of_sine_cosine(const Step& s);
  void coefficient_of_function(const Step& s);
  void coefficient_of_arctan2(const Step& s);
  void partial(const Partial& d);
  Value* sum(const Step& s, std::uint32_t count);
  Value* beyond_of_sum(const Step& s);
  // The sum over all products older than the newest coefficients; within a block, the products that end with new
  // coefficients of a are a separate sum.
  std::pair<Value*, Value*> history(const Convolution& c);
  Value* whole_history(std::uint32_t a, std::uint32_t b, std::uint8_t lead);
  Value* convolution(std::uint32_t a, std::uint32_t b, std::uint8_t lead, bool first, bool last, bool b_later = false);
  void side(std::size_t root);
  void sides();
  void solve();
  void substitute(bool all_sides = false);
  void substitution();
  void complete();
  void complete_unknown(std::size_t j, Value* solved, bool start);
  void complete_slot(const Completion& c, Value* solved, bool start);

  void begin_motion();
  void judge(const std::vector<Value*>& lu);
  Value* displaced(int level);
  void measure();
  void go_on();
  Value* coefficient_of(std::size_t j, int order);

  Value* sum_before(const Convolution& c, int order, bool new_of_a);
  Value* own(std::uint32_t at) { return b_.CreateConstInBoundsGEP1_64(lane_, scratch_, at); }
  std::uint32_t place_of_sum(const Convolution& c, int order, bool new_of_a) const;

  const int several_sines_;
  const std::size_t part_;
  std::size_t made_ = 0;                            // pieces
  std::vector<Convolution> listed_;                 // histories of long plans
  std::map<Convolution, std::uint32_t> listed_at_;  // places of their sums
  llvm::GlobalVariable* places_ = nullptr;          // of their factors
  std::vector<bool> asked_;                         // columns of the solution
  llvm::Function *substitution_ = nullptr, *advance_ = nullptr;
  std::optional<PackedMemory> memory_;  // places in the scratch memory
  Value *scratch_ = nullptr, *sines_ = nullptr;
  // The scratch memory contains all sums of a convolution before the newest coefficients.
  bool history_is_whole_ = false;
  std::vector<Value*> side_, solution_;
};

}  // namespace anholon::jit

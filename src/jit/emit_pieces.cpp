// Emits stages of long plans, for one lane. The compiler would take more than proportional time for a function as long
// as the plan, so the steps of a stage, its elimination and its completion are functions of bounded length, in several
// modules that are compiled side by side. Functions pass their results through the arena. Histories differ between the
// places in a block only by their newest products, so loops over tables sum them, and the functions of a stage serve
// all stages.
#include <set>

#include "jit/emitter.h"

namespace anholon::jit {

namespace {
// The most operations of an elimination in a function, and the most unknowns to complete or right sides.
constexpr std::size_t kOperations = 150, kUnknowns = 60;

// Calls `body` for parts [from, to) of 0 .. count.
template <class Body>
void for_parts(std::size_t count, std::size_t most, const Body& body) {
  for (std::size_t from = 0; from < count; from += most) body(from, std::min(from + most, count));
}
}  // namespace

// Finds the numbers of a stage that other pieces read than the one that computes them.
void Emitter::find_crossing_numbers() {
  std::unordered_map<std::uint32_t, std::size_t> made;
  for (std::size_t i = 0; i < p_.stage.size(); ++i) {
    const Step& s = p_.stage[i];
    const std::size_t here = i / kStepsOfPiece;
    const auto read = [&](const Place& x) {
      if (x.series) return;
      const auto it = made.find(x.at);
      if (it != made.end() && it->second != here) crossing_.insert(x.at);
    };
    for (const Place& x : {s.a, s.b, s.c, s.d, s.e, s.f}) read(x);
    for (std::uint32_t k = s.first; k < s.first + s.count; ++k) read(p_.terms[k].x);
    if (!s.out.series) made[s.out.at] = here;
  }
  const auto later = [&](const Place& x) {
    if (!x.series && made.count(x.at) != 0) crossing_.insert(x.at);
  };
  for (const Place& x : p_.roots) later(x);
  for (const Completion& c : p_.completions) later(c.out);
  for (const Step& s : p_.weigh_again)
    for (const Place& x : {s.a, s.b, s.c, s.d, s.e, s.f}) later(x);
}

// Lists the histories that each piece is the first to need, in runs of one lead; a run is filled up to a multiple of
// those that are summed at once.
std::vector<std::vector<Emitter::Run>> Emitter::list_histories() {
  std::vector<std::vector<Run>> runs;
  std::set<Convolution> seen;
  std::vector<llvm::Constant*> places;
  for_parts(p_.stage.size(), kStepsOfPiece, [&](std::size_t from, std::size_t to) {
    std::map<std::uint8_t, std::vector<Convolution>> by_lead;
    for (std::size_t i = from; i < to; ++i)
      for (const Convolution& c : convolutions(p_.stage[i]))
        if (seen.insert(c).second) by_lead[c.lead].push_back(c);
    runs.emplace_back();
    for (auto& [lead, list] : by_lead) {
      for (std::size_t i = 0; i < list.size(); ++i)
        listed_at_[list[i]] = kSumsOfHistory * static_cast<std::uint32_t>(listed_.size() + i);
      while (list.size() % kHistoriesAtOnce != 0) list.push_back(list.back());
      runs.back().push_back({lead, listed_.size(), listed_.size() + list.size()});
      listed_.insert(listed_.end(), list.begin(), list.end());
    }
  });
  for (const Convolution& c : listed_) places.push_back(b_.getInt32(c.a)), places.push_back(b_.getInt32(c.b));
  auto* type = llvm::ArrayType::get(b_.getInt32Ty(), places.size());
  places_ = new llvm::GlobalVariable(m_, type, true, llvm::GlobalValue::PrivateLinkage,
                                     llvm::ConstantArray::get(type, places), "places");
  return runs;
}

// Declares a piece; one of the modules contains its code.
Emitter::Piece Emitter::piece(const std::string& name, const std::function<void()>& body) {
  const std::string symbol = name + std::to_string(made_);
  auto* type = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), b_.getInt64Ty()}, false);
  if (made_++ % kParts != part_) return {llvm::Function::Create(type, llvm::Function::ExternalLinkage, symbol, m_), {}};
  begin_part(symbol);
  function_->setLinkage(llvm::Function::ExternalLinkage);
  stage_ = 0;
  histories_.clear();
  side_.clear();
  body();
  end();
  return {function_, {}};
}

std::vector<Emitter::Piece> Emitter::pieces_of_steps() {
  const std::vector<std::vector<Run>> runs = list_histories();
  std::vector<Piece> pieces;
  for_parts(p_.stage.size(), kStepsOfPiece, [&](std::size_t from, std::size_t to) {
    pieces.push_back(piece("steps", [&] {
      for (std::size_t i = from; i < to; ++i) coefficient(p_.stage[i]);
    }));
    pieces.back().histories = runs[pieces.size() - 1];
  });
  return pieces;
}

void Emitter::pieces_of_solution(std::vector<Piece>& out) {
  for_parts(p_.roots.size(), kUnknowns, [&](std::size_t from, std::size_t to) {
    out.push_back(piece("sides", [&] {
      for (std::size_t i = from; i < to; ++i) side(i);
      for (std::size_t i = from; i < to; ++i) store(side_[i - from], k_.side + static_cast<std::int64_t>(i));
    }));
  });
  pieces_of_substitution(out, k_.solution, false);
  if (!k_.refine) return;
  pieces_of_residual(out);
  pieces_of_substitution(out, k_.refined, true);
  for_parts(p_.rows, kOperations, [&](std::size_t from, std::size_t to) {
    out.push_back(piece("refined", [&] {
      for (auto j = static_cast<std::int64_t>(from); j < static_cast<std::int64_t>(to); ++j)
        store(b_.CreateFAdd(load(k_.solution + j), load(k_.refined + j)), k_.solution + j);
    }));
  });
}

// Emits the right sides `rhs` minus the entries of the linearized tape times the solution.
void Emitter::pieces_of_residual(std::vector<Piece>& out) {
  std::vector<std::size_t> order(p_.entries.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return p_.entries[a].row < p_.entries[b].row; });
  std::size_t next = 0;
  for_parts(p_.rows, kUnknowns, [&](std::size_t from, std::size_t to) {
    const std::size_t first = next;
    while (next < order.size() && p_.entries[order[next]].row < to) ++next;
    out.push_back(piece("residual", [&] {
      std::size_t at = first;
      for (auto row = static_cast<std::uint32_t>(from); row < to; ++row) {
        Value* r = row < p_.roots.size() ? load(k_.side + std::int64_t{row}) : number(0);
        for (; at < next && p_.entries[order[at]].row == row; ++at)
          r = fma(b_.CreateFNeg(load(k_.entries + static_cast<std::int64_t>(order[at]))),
                  load(k_.solution + std::int64_t{p_.entries[order[at]].column}), r);
        store(r, k_.rhs + std::int64_t{row});
      }
    }));
  });
}

// Emits forward and backward substitution through the arena. `all_sides`: the right sides are in `rhs`; otherwise they
// are in `side`, and the other rows are zero.
void Emitter::pieces_of_substitution(std::vector<Piece>& out, std::int64_t solution, bool all_sides) {
  const SparseLu& e = *k_.elimination;
  std::vector<bool> written(p_.rows, all_sides);
  std::map<std::uint32_t, Value*> known;
  const auto right_side = [&](std::uint32_t row) -> Value* {
    if (const auto it = known.find(row); it != known.end()) return it->second;
    return written[row]            ? load(k_.rhs + std::int64_t{row})
           : row < p_.roots.size() ? load(k_.side + std::int64_t{row})
                                   : number(0);
  };
  const std::vector<SparseLu::Forward>& forward = all_sides ? e.forward_all : e.forward;
  for_parts(forward.size(), kOperations, [&](std::size_t from, std::size_t to) {
    out.push_back(piece("forward", [&] {
      known.clear();
      for (std::size_t i = from; i < to; ++i) {
        const SparseLu::Forward& f = forward[i];
        known[f.to] = fma(b_.CreateFNeg(load(k_.lu + std::int64_t{f.entry})), right_side(f.from), right_side(f.to));
      }
      for (const auto& [row, v] : known) store(v, k_.rhs + std::int64_t{row});
      known.clear();
    }));
    for (std::size_t i = from; i < to; ++i) written[forward[i].to] = true;
  });
  for (std::size_t from = 0, to; from < e.backward.size(); from = to) {
    std::size_t operations = 0;
    for (to = from; to < e.backward.size() && operations < kOperations; ++to) operations += 1 + e.backward[to].count;
    out.push_back(piece("backward", [&] {
      known.clear();
      std::map<std::uint32_t, Value*> solved;
      const auto y = [&](std::uint32_t column) {
        Value*& v = solved[column];
        return v ? v : v = load(solution + std::int64_t{column});
      };
      for (std::size_t k = from; k < to; ++k) {
        const SparseLu::Backward& back = e.backward[k];
        Value* s = back.zero_side && !all_sides ? number(0) : right_side(back.row);
        for (std::uint32_t i = back.first; i < back.first + back.count; ++i)
          s = fma(b_.CreateFNeg(load(k_.lu + std::int64_t{e.terms[i].entry})), y(e.terms[i].column), s);
        if (!e.pivots[back.pivot].one) s = b_.CreateFMul(s, load(k_.reciprocal + std::int64_t{back.pivot}));
        solved[back.column] = s;
        store(s, solution + std::int64_t{back.column});
      }
    }));
  }
}

void Emitter::pieces_of_completion(std::vector<Piece>& out) {
  const auto solved = [&](std::uint32_t column) { return load(k_.solution + std::int64_t{column}); };
  for_parts(p_.x.size(), kUnknowns, [&](std::size_t from, std::size_t to) {
    out.push_back(piece("unknowns", [&] {
      for (std::size_t j = from; j < to; ++j) complete_unknown(j, solved(static_cast<std::uint32_t>(j)), false);
    }));
  });
  for_parts(p_.completions.size(), 2 * kUnknowns, [&](std::size_t from, std::size_t to) {
    out.push_back(piece("completions", [&] {
      for (std::size_t i = from; i < to; ++i) complete_slot(p_.completions[i], solved(p_.completions[i].column), false);
    }));
  });
  for_parts(p_.weigh_again.size(), 2 * kUnknowns, [&](std::size_t from, std::size_t to) {
    out.push_back(piece("weigh", [&] {
      for (std::size_t i = from; i < to; ++i) coefficient(p_.weigh_again[i]);
    }));
  });
}

// Makes a function of the arena, the sums, a stage, and the histories [from, to).
llvm::Function* Emitter::loop_over_histories(const std::string& name,
                                             const std::function<void(const std::vector<InLanes>&)>& body) {
  auto* index = b_.getInt64Ty();
  auto* type = llvm::FunctionType::get(b_.getVoidTy(), {b_.getPtrTy(), b_.getPtrTy(), index, index, index}, false);
  function_ = llvm::Function::Create(type, llvm::Function::PrivateLinkage, name, m_);
  function_->addFnAttr(llvm::Attribute::NoUnwind);
  auto* entry = llvm::BasicBlock::Create(m_.getContext(), "entry", function_);
  auto* loop = llvm::BasicBlock::Create(m_.getContext(), "loop", function_);
  auto* done = llvm::BasicBlock::Create(m_.getContext(), "done", function_);
  b_.SetInsertPoint(entry);
  w_ = function_->getArg(0);
  scratch_ = function_->getArg(1);
  begin_block(function_->getArg(2));
  b_.CreateBr(loop);
  b_.SetInsertPoint(loop);
  llvm::PHINode* at = b_.CreatePHI(index, 2);
  at->addIncoming(function_->getArg(3), entry);
  std::vector<InLanes> group;
  for (std::size_t u = 0; u < kHistoriesAtOnce; ++u) {
    Value* i = b_.CreateAdd(at, b_.getInt64(u));
    const auto series = [&](std::uint64_t factor) {
      Value* place =
          b_.CreateAlignedLoad(b_.getInt32Ty(),
                               b_.CreateInBoundsGEP(b_.getInt32Ty(), places_,
                                                    b_.CreateAdd(b_.CreateMul(i, b_.getInt64(2)), b_.getInt64(factor))),
                               llvm::Align(4));
      return b_.CreateInBoundsGEP(lane_, w_, b_.CreateZExt(place, index));
    };
    group.push_back(
        {series(0), series(1), b_.CreateInBoundsGEP(lane_, scratch_, b_.CreateMul(i, b_.getInt64(kSumsOfHistory)))});
  }
  body(group);
  Value* next = b_.CreateAdd(at, b_.getInt64(kHistoriesAtOnce));
  at->addIncoming(next, b_.GetInsertBlock());
  b_.CreateCondBr(b_.CreateICmpSLT(next, function_->getArg(4)), loop, done);
  b_.SetInsertPoint(done);
  b_.CreateRetVoid();
  return function_;
}

// Emits the sums that are known before a block.
llvm::Function* Emitter::histories_known(std::uint8_t lead) {
  return loop_over_histories("known" + std::to_string(lead), [&](const std::vector<InLanes>& group) {
    std::vector<InLanes> of_block = group;
    for (InLanes& c : of_block) c.b = b_.CreateInBoundsGEP(lane_, c.b, b_.CreateAdd(k0_, b_.getInt64(lead)));
    known_before(lead, of_block);
    for (const InLanes& c : group) store_to(number(0), c.sums, kBlock);
  });
}

// Emits the sums at one of the stages before the first block, in the order of history().
llvm::Function* Emitter::histories_of_first(std::uint8_t lead, int stage) {
  const int p = stage + lead, known = 1 + lead, i = p - known;
  return loop_over_histories(
      "first" + std::to_string(stage) + "_" + std::to_string(lead), [&](const std::vector<InLanes>& group) {
        for (const InLanes& c : group) {
          Value *s = number(0), *t = number(0);
          const auto product = [&](int j, Value* sum) { return fma(load_from(c.a, j), load_from(c.b, p - j), sum); };
          for (int j = kBlock; j < known; ++j) s = product(j, s);
          for (int j = std::min(known, kBlock) - 1; j > i; --j) s = product(j, s);
          for (int j = i < known ? i : known - 1; j >= 1; --j) s = product(j, s);
          for (int j = std::max(known, 1); j < p; ++j) t = product(j, t);
          store_to(s, c.sums, 0);
          store_to(t, c.sums, kBlock);
        }
      });
}

// Emits the sums at the stage k0 + place of a block.
llvm::Function* Emitter::histories_of_place(std::uint8_t lead, int place) {
  return loop_over_histories("place" + std::to_string(place) + "_" + std::to_string(lead),
                             [&](const std::vector<InLanes>& group) {
                               Value* first_of_block = b_.CreateAdd(k0_, b_.getInt64(lead));
                               for (const InLanes& c : group) {
                                 Value *new_a = b_.CreateInBoundsGEP(lane_, c.a, first_of_block),
                                       *new_b = b_.CreateInBoundsGEP(lane_, c.b, first_of_block);
                                 Value *s = load_from(c.sums, place), *t = number(0);
                                 for (int j = place; j >= 1; --j)
                                   s = fma(load_from(c.a, j), load_from(new_b, place - j), s);
                                 for (int j = 0; j < place; ++j)
                                   t = fma(load_from(new_a, j), load_from(c.b, place - j), t);
                                 store_to(s, c.sums, 0);
                                 store_to(t, c.sums, kBlock);
                               }
                             });
}

void Emitter::stages_in_pieces() {
  llvm::Function* const whole = function_;
  Value* const arena = w_;
  const auto back = b_.saveIP();
  find_crossing_numbers();
  history_is_whole_ = true;
  std::vector<Piece> pieces = pieces_of_steps();
  pieces_of_solution(pieces);
  pieces_of_completion(pieces);
  history_is_whole_ = false;
  listed_at_.clear();
  std::set<std::uint8_t> leads;
  for (const Convolution& c : listed_) leads.insert(c.lead);
  std::map<std::uint8_t, std::vector<llvm::Function*>> first, places;  // by lead
  if (part_ == 0)
    for (const std::uint8_t lead : leads) {
      for (int stage = 1; stage <= std::min(kBlock, p_.stages); ++stage)
        first[lead].push_back(histories_of_first(lead, stage));
      if (p_.stages <= kBlock) continue;
      places[lead].push_back(histories_known(lead));
      for (int place = 1; place < kBlock; ++place) places[lead].push_back(histories_of_place(lead, place));
    }
  crossing_.clear();
  function_ = whole;
  w_ = arena;
  b_.restoreIP(back);
  relative_ = false;
  forget();
  if (part_ != 0) return;
  Value* sums = address(k_.sums, false);
  const auto run = [&](const std::map<std::uint8_t, std::vector<llvm::Function*>>& histories, std::size_t which,
                       Value* block, Value* stage) {
    for (const Piece& piece : pieces) {
      for (const Run& r : piece.histories)
        b_.CreateCall(histories.at(r.lead)[which], {w_, sums, block, b_.getInt64(r.from), b_.getInt64(r.to)});
      b_.CreateCall(piece.code, {w_, sums, stage});
    }
  };
  for (int stage = 1; stage <= std::min(kBlock, p_.stages); ++stage) {
    Value* k = b_.getInt64(static_cast<std::uint64_t>(stage));
    run(first, static_cast<std::size_t>(stage - 1), k, k);
  }
  if (p_.stages <= kBlock) return;
  over_blocks([](Value*) {},
              [&](Value* k0, int i) {
                run(places, static_cast<std::size_t>(i), k0,
                    b_.CreateAdd(k0, b_.getInt64(static_cast<std::uint64_t>(i))));
              });
}

}  // namespace anholon::jit

// Stages in blocks of four, and the sums known before a block.
#include <set>

#include <llvm/IR/Intrinsics.h>

#include "jit/emitter.h"

namespace anholon::jit {

namespace {
// The number of convolutions summed side by side: enough to hide the latency of a fused multiplication, few enough for
// the registers.
constexpr std::size_t kSideBySide = 8;
// The number of isomorphic steps in a vector. Eight are not faster on machines with such vectors: more lanes stay
// empty.
constexpr unsigned kWidth = 4;
// Up to these numbers of steps, code is unrolled for the first four stages and for every place in a block: for a single
// motion, packed code in parts is faster.
constexpr std::size_t kFewSteps = 16, kFewStepsInLanes = 64;
}  // namespace

void Emitter::stage(const std::vector<Step>& steps, bool solved) {
  histories_.clear();
  for (const Step& s : steps) coefficient(s);
  if (!solved) return;
  sides();
  solve();
  complete();
}

std::vector<llvm::Value*>
Emitter::over_known(std::uint8_t lead, const std::vector<Value*>& sums,
                    const std::function<std::vector<Value*>(Value*, const std::vector<Value*>&)>& body) {
  // A block begins at stage 5 or later, so the loop runs at least once.
  llvm::BasicBlock* before = b_.GetInsertBlock();
  auto* loop = llvm::BasicBlock::Create(m_.getContext(), "known", function_);
  auto* after = llvm::BasicBlock::Create(m_.getContext(), "new", function_);
  Value* last = b_.CreateAdd(k0_, b_.getInt64(lead));
  b_.CreateBr(loop);
  b_.SetInsertPoint(loop);
  llvm::PHINode* j = b_.CreatePHI(b_.getInt64Ty(), 2);
  j->addIncoming(b_.getInt64(kBlock), before);
  std::vector<llvm::PHINode*> running;
  for (Value* s : sums) {
    running.push_back(b_.CreatePHI(s->getType(), 2));
    running.back()->addIncoming(s, before);
  }
  const std::vector<Value*> next_sums = body(j, {running.begin(), running.end()});
  for (std::size_t k = 0; k < sums.size(); ++k) running[k]->addIncoming(next_sums[k], loop);
  Value* next = b_.CreateAdd(j, b_.getInt64(1));
  j->addIncoming(next, loop);
  b_.CreateCondBr(b_.CreateICmpSLT(next, last), loop, after);
  b_.SetInsertPoint(after);
  return next_sums;
}

// Computes, for the four orders of a block at once, the sum over j of a_j b_(p-j) with both factors known before the
// block.
void Emitter::known_before(std::uint8_t lead, const std::vector<InLanes>& group) {
  auto* four = llvm::FixedVectorType::get(b_.getDoubleTy(), kBlock);
  const std::size_t count = group.size();
  Value* zero = llvm::ConstantAggregateZero::get(four);
  std::vector<Value*> sums(count, zero);
  const auto b_at = [&](Value* b, Value* j) {  // b_(K-j) .. b_(K-j+3), K = k0 + lead
    Value* base = b_.CreateInBoundsGEP(b_.getDoubleTy(), b, b_.CreateNeg(j));
    return b_.CreateAlignedLoad(four, base, llvm::Align(8));
  };
  const auto a_at = [&](Value* a, Value* j) {
    Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), a, j);
    return b_.CreateVectorSplat(kBlock, b_.CreateAlignedLoad(b_.getDoubleTy(), at, llvm::Align(8)));
  };
  sums = over_known(lead, sums, [&](Value* j, const std::vector<Value*>& so_far) {
    std::vector<Value*> r;
    for (std::size_t k = 0; k < count; ++k) r.push_back(fma(a_at(group[k].a, j), b_at(group[k].b, j), so_far[k]));
    return r;
  });
  // The nearest orders come last: only the first j orders of the block have both factors.
  for (int j = kBlock - 1; j >= 1; --j)
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<int> mask;
      for (int lane = 0; lane < kBlock; ++lane) mask.push_back(lane < j ? lane : kBlock + lane);
      Value* b = b_.CreateShuffleVector(b_at(group[k].b, b_.getInt64(static_cast<std::uint64_t>(j))), zero, mask);
      sums[k] = fma(a_at(group[k].a, b_.getInt64(static_cast<std::uint64_t>(j))), b, sums[k]);
    }
  for (std::size_t k = 0; k < count; ++k) b_.CreateAlignedStore(sums[k], group[k].sums, llvm::Align(32));
}

// Like known_before(), if every order is a vector of lanes: b_(K-j) .. b_(K-j+3) move by one with j. Machines with
// vectors of eight have registers for values that are used again; others load them again.
void Emitter::known_before_in_lanes(llvm::Type* lane, std::uint8_t lead, const std::vector<InLanes>& group) {
  constexpr std::size_t n = kBlock;
  const std::size_t count = group.size(),
                    kept = llvm::cast<llvm::FixedVectorType>(lane)->getNumElements() > kBlock ? n - 1 : 0;
  const llvm::Align align(m_.getDataLayout().getTypeStoreSize(lane).getFixedValue());
  std::vector<Value*> sums(count * n, llvm::ConstantFP::get(lane, 0));
  const auto b_at = [&](const InLanes& c, Value* j, int i) {
    return b_.CreateAlignedLoad(
        lane,
        b_.CreateInBoundsGEP(lane, b_.CreateConstInBoundsGEP1_64(lane, c.b, static_cast<std::uint64_t>(i)),
                             b_.CreateNeg(j)),
        align);
  };
  const auto a_at = [&](const InLanes& c, Value* j) {
    return b_.CreateAlignedLoad(lane, b_.CreateInBoundsGEP(lane, c.a, j), align);
  };
  // After the sums: b of the first orders of the block for the present j.
  for (const InLanes& c : group)
    for (std::size_t i = 0; i < kept; ++i) sums.push_back(b_at(c, b_.getInt64(kBlock), static_cast<int>(i) + 1));
  sums = over_known(lead, sums, [&](Value* j, const std::vector<Value*>& so_far) {
    std::vector<Value*> r(so_far.size(), nullptr);
    for (std::size_t k = 0; k < count; ++k) {
      Value* a = a_at(group[k], j);
      Value* const* window = so_far.data() + count * n + k * kept;
      Value* newest = kept > 0 ? b_at(group[k], j, 0) : nullptr;
      for (std::size_t i = 0; i < n; ++i) {
        Value* b = kept == 0 ? b_at(group[k], j, static_cast<int>(i)) : i == 0 ? newest : window[i - 1];
        r[k * n + i] = fma(a, b, so_far[k * n + i]);
      }
      for (std::size_t i = 0; i < kept; ++i) r[count * n + k * kept + i] = i == 0 ? newest : window[i - 1];
    }
    return r;
  });
  for (int j = kBlock - 1; j >= 1; --j)
    for (std::size_t k = 0; k < count; ++k) {
      Value* at = b_.getInt64(static_cast<std::uint64_t>(j));
      Value* a = a_at(group[k], at);
      for (int i = 0; i < j; ++i)
        sums[k * n + static_cast<std::size_t>(i)] =
            fma(a, b_at(group[k], at, i), sums[k * n + static_cast<std::size_t>(i)]);
    }
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < n; ++i)
      b_.CreateAlignedStore(sums[k * n + i], b_.CreateConstInBoundsGEP1_64(lane, group[k].sums, i), align);
}

void Emitter::bulk() {
  const std::vector<Convolution>& all = memory_->alone();
  for_runs(all, lanes_ == 1 ? kSideBySide : kSideBySideInLanes, [&](std::size_t from, std::size_t to) {
    std::vector<InLanes> group;
    for (std::size_t i = from; i < to; ++i)
      group.push_back({address(all[i].a, false), address(std::int64_t{all[i].b} + all[i].lead, true),
                       own(place_of_sum(all[i], 0, false))});
    lanes_ == 1 ? known_before(all[from].lead, group) : known_before_in_lanes(lane_, all[from].lead, group);
  });
  if (lanes_ == 1) pack_histories();
}

std::uint32_t Emitter::place_of_sum(const Convolution& c, int order, bool new_of_a) const {
  if (!listed_at_.empty()) return listed_at_.at(c) + static_cast<std::uint32_t>(order + kBlock * new_of_a);
  const PackedMemory::Sums& sums = memory_->sums(c);
  return sums.at + sums.step * static_cast<std::uint32_t>(order + kBlock * new_of_a);
}

// Scratch memory for the sums of all convolutions, and for packed numbers.
llvm::AllocaInst* Emitter::scratch_memory() {
  llvm::BasicBlock& entry = function_->getEntryBlock();
  llvm::IRBuilder<> top(&entry, entry.begin());
  auto* memory = top.CreateAlloca(lane_, top.getInt32(std::max(memory_->size(), 1U)));
  memory->setAlignment(llvm::Align(64));
  return memory;
}

void Emitter::over_blocks(const std::function<void(Value*)>& before, const std::function<void(Value*, int)>& body) {
  llvm::BasicBlock* from = b_.GetInsertBlock();
  auto* loop = llvm::BasicBlock::Create(m_.getContext(), "block", function_);
  auto* done = llvm::BasicBlock::Create(m_.getContext(), "done", function_);
  b_.CreateBr(loop);
  b_.SetInsertPoint(loop);
  llvm::PHINode* k0 = b_.CreatePHI(b_.getInt64Ty(), 2);
  k0->addIncoming(b_.getInt64(kBlock + 1), from);
  Value* last = b_.getInt64(static_cast<std::uint64_t>(p_.stages));
  before(k0);
  for (int i = 0; i < kBlock; ++i) {
    if (i > 0) {
      auto* next = llvm::BasicBlock::Create(m_.getContext(), "stage", function_);
      b_.CreateCondBr(b_.CreateICmpSLE(b_.CreateAdd(k0, b_.getInt64(static_cast<std::uint64_t>(i))), last), next, done);
      b_.SetInsertPoint(next);
    }
    body(k0, i);
  }
  Value* next = b_.CreateAdd(k0, b_.getInt64(kBlock));
  k0->addIncoming(next, b_.GetInsertBlock());
  b_.CreateCondBr(b_.CreateICmpSLE(next, last), loop, done);
  b_.SetInsertPoint(done);
}

void Emitter::stages(const std::vector<Step>& steps, bool solved) {
  const bool in_parts = steps.size() > (lanes_ == 1 ? kFewSteps : kFewStepsInLanes),
             packed = in_parts && solved && lanes_ == 1 && p_.stages > 2 * kBlock;
  std::set<Convolution> all;
  for (const Step& s : steps)
    for (const Convolution& c : convolutions(s)) all.insert(c);
  memory_.emplace(p_, packed ? choose_packs(p_, kWidth) : Packs{}, kWidth,
                  std::vector<Convolution>(all.begin(), all.end()));
  llvm::AllocaInst* const memory = scratch_memory();
  scratch_ = memory;
  forget();
  if (in_parts)
    stages_in_parts(steps, solved);
  else
    stages_in_line(steps, solved);
  memory->setOperand(0, b_.getInt32(std::max(memory_->size(), 1U)));
  relative_ = false;
  forget();
}

// Keeps the new coefficients of a block in registers.
void Emitter::stages_in_line(const std::vector<Step>& steps, bool solved) {
  for (stage_ = 1; stage_ <= std::min(p_.stages, kBlock); ++stage_) stage(steps, solved);
  if (p_.stages <= kBlock) return;
  over_blocks([&](Value* k0) { begin_block(k0), bulk(); },
              [&](Value*, int i) {
                stage_ = i;
                stage(steps, solved);
              });
}

// Makes a function for each place in a block. The function of the first place also serves the first block, whose
// histories are computed stage by stage.
void Emitter::stages_in_parts(const std::vector<Step>& steps, bool solved) {
  const std::string list = solved ? "stage" : "after";
  llvm::Function* const whole = function_;
  Value *const arena = w_, *const scratch_of_whole = scratch_;
  const auto back = b_.saveIP();
  llvm::Function *first[kBlock] = {}, *in_block[kBlock] = {}, *before_block = nullptr;
  reads_.clear();
  puts_.clear();
  for (stage_ = 1; stage_ <= std::min(p_.stages, kBlock); ++stage_) {
    first[stage_ - 1] = begin_part(list + "_first" + std::to_string(stage_));
    relative_ = false;
    for (const Convolution& c : memory_->alone()) {
      const auto [old, new_of_a] = history(c);
      b_.CreateAlignedStore(old, own(place_of_sum(c, 0, false)), align());
      b_.CreateAlignedStore(new_of_a, own(place_of_sum(c, 0, true)), align());
    }
    for (const Packs::Pack& pack : memory_->packs().packs)
      for (const std::optional<Convolution>& c : pack.lanes)
        if (c) history(*c);
    end();
    pack_stage();
  }
  if (p_.stages > kBlock) {
    before_block = begin_part(list + "_known");
    bulk();
    for (const Convolution& c : memory_->alone())
      b_.CreateAlignedStore(number(0), own(place_of_sum(c, 0, true)), align());
    end();
  }
  for (stage_ = 0; stage_ < (before_block ? kBlock : 1); ++stage_) {
    history_is_whole_ = stage_ == 0;
    in_block[stage_] = begin_part(list + std::to_string(stage_));
    stage(steps, solved);
    end();
    pack_stage();
  }
  history_is_whole_ = false;
  function_ = whole;
  w_ = arena;
  scratch_ = scratch_of_whole;
  b_.restoreIP(back);
  fill_packed_memory();
  leave_out_what_nobody_reads({in_block, in_block + (before_block ? kBlock : 1)});
  for (int k = 1; k <= std::min(kBlock, p_.stages); ++k) {
    b_.CreateCall(first[k - 1], {w_, scratch_of_whole, b_.getInt64(static_cast<std::uint64_t>(k))});
    b_.CreateCall(in_block[0], {w_, scratch_of_whole, b_.getInt64(static_cast<std::uint64_t>(k))});
  }
  if (!before_block) return;
  over_blocks([&](Value* k0) { b_.CreateCall(before_block, {w_, scratch_of_whole, k0}); },
              [&](Value* k0, int i) { b_.CreateCall(in_block[i], {w_, scratch_of_whole, k0}); });
}

void Emitter::extend() {
  begin("extend");
  if (k_.sums != 0) {
    if (part_ != 0) function_->setLinkage(llvm::Function::PrivateLinkage);
    stages_in_pieces();
    if (part_ == 0) extend_after();
    return end();
  }
  stages(p_.stage, true);
  extend_after();
  end();
}

void Emitter::extend_after() {
  if (p_.after.empty()) return;
  stage_ = 0;
  forget();
  for (const Step& s : p_.after) value(s);
  stages(p_.after, false);
}

}  // namespace anholon::jit

// Stages in blocks of four, and what is known before a block.
#include <llvm/IR/Intrinsics.h>

#include "jit/emitter.h"

namespace anholon::jit {

namespace {
// Convolutions summed side by side: enough to hide the latency of a fused multiplication, few enough for the registers.
constexpr std::size_t kSideBySide = 8;
// The same where four orders of a convolution are four sums of lanes.
constexpr std::size_t kSideBySideInLanes = 3;
}  // namespace

void Emitter::stage(const std::vector<Step>& steps, bool solved) {
  known_.clear();
  for (const Step& s : steps) coefficient(s);
  if (!solved) return;
  sides();
  solve();
  complete();
}

std::vector<llvm::Value*> Emitter::over_known(std::uint8_t lead, const std::vector<Value*>& sums, const std::function<std::vector<Value*>(Value*, const std::vector<Value*>&)>& body) {
  // A block begins at stage 5 or later, so there is at least one.
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

// For the four orders of a block at once: sum over j of a_j b_(p-j) with both known before the block.
void Emitter::known_before(const Convolution* group, std::size_t count) {
  auto* four = llvm::FixedVectorType::get(b_.getDoubleTy(), kBlock);
  const std::uint8_t l = group[0].lead;
  Value* zero = llvm::ConstantAggregateZero::get(four);
  std::vector<Value*> sums(count, zero);
  const auto b_at = [&](std::uint32_t b, Value* j) {  // b_(K-j) .. b_(K-j+3), K = k0 + lead
    Value* base = b_.CreateInBoundsGEP(b_.getDoubleTy(), address(std::int64_t{b} + l, true), b_.CreateNeg(j));
    return b_.CreateAlignedLoad(four, base, llvm::Align(8));
  };
  const auto a_at = [&](std::uint32_t a, Value* j) {
    Value* at = b_.CreateInBoundsGEP(b_.getDoubleTy(), address(a, false), j);
    return b_.CreateVectorSplat(kBlock, b_.CreateAlignedLoad(b_.getDoubleTy(), at, llvm::Align(8)));
  };
  sums = over_known(l, sums, [&](Value* j, const std::vector<Value*>& so_far) {
    std::vector<Value*> r;
    for (std::size_t k = 0; k < count; ++k) r.push_back(fma(a_at(group[k].a, j), b_at(group[k].b, j), so_far[k]));
    return r;
  });
  // The nearest ones last: only the first j orders of the block have both.
  for (int j = kBlock - 1; j >= 1; --j)
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<int> mask;
      for (int lane = 0; lane < kBlock; ++lane) mask.push_back(lane < j ? lane : kBlock + lane);
      Value* b = b_.CreateShuffleVector(b_at(group[k].b, b_.getInt64(static_cast<std::uint64_t>(j))), zero, mask);
      sums[k] = fma(a_at(group[k].a, b_.getInt64(static_cast<std::uint64_t>(j))), b, sums[k]);
    }
  for (std::size_t k = 0; k < count; ++k) b_.CreateAlignedStore(sums[k], scratch(bulk_.at(group[k]), 0), llvm::Align(32));
}

// The same where every order is a vector of lanes: b_(K-j) .. b_(K-j+3) move on by one with j.
void Emitter::known_before_in_lanes(const Convolution* group, std::size_t count) {
  const std::uint8_t l = group[0].lead;
  constexpr std::size_t n = kBlock;
  std::vector<Value*> sums(count * n, number(0));
  const auto b_at = [&](std::uint32_t b, Value* j, int i) {
    return b_.CreateAlignedLoad(lane_, b_.CreateInBoundsGEP(lane_, address(std::int64_t{b} + l + i, true), b_.CreateNeg(j)), align());
  };
  const auto a_at = [&](std::uint32_t a, Value* j) { return b_.CreateAlignedLoad(lane_, b_.CreateInBoundsGEP(lane_, address(a, false), j), align()); };
  // After the sums: b of the orders 0 .. 2 of the block for the present j.
  for (std::size_t k = 0; k < count; ++k)
    for (int i = 0; i + 1 < kBlock; ++i) sums.push_back(b_at(group[k].b, b_.getInt64(kBlock), i + 1));
  sums = over_known(l, sums, [&](Value* j, const std::vector<Value*>& so_far) {
    std::vector<Value*> r(so_far.size(), nullptr);
    for (std::size_t k = 0; k < count; ++k) {
      Value* a = a_at(group[k].a, j);
      Value* const* window = &so_far[count * n + k * (n - 1)];
      Value* newest = b_at(group[k].b, j, 0);
      for (std::size_t i = 0; i < n; ++i) r[k * n + i] = fma(a, i == 0 ? newest : window[i - 1], so_far[k * n + i]);
      for (std::size_t i = 0; i + 1 < n; ++i) r[count * n + k * (n - 1) + i] = i == 0 ? newest : window[i - 1];
    }
    return r;
  });
  for (int j = kBlock - 1; j >= 1; --j)
    for (std::size_t k = 0; k < count; ++k) {
      Value* at = b_.getInt64(static_cast<std::uint64_t>(j));
      Value* a = a_at(group[k].a, at);
      for (int i = 0; i < j; ++i) sums[k * n + static_cast<std::size_t>(i)] = fma(a, b_at(group[k].b, at, i), sums[k * n + static_cast<std::size_t>(i)]);
    }
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t i = 0; i < n; ++i) b_.CreateAlignedStore(sums[k * n + i], scratch(bulk_.at(group[k]), static_cast<unsigned>(i)), align());
}

void Emitter::bulk() {
  std::vector<Convolution> all;
  for (const auto& [c, place] : bulk_) all.push_back(c);
  for (std::size_t from = 0; from < all.size();) {
    std::size_t to = from + 1;
    while (to < all.size() && to - from < (lanes_ == 1 ? kSideBySide : kSideBySideInLanes) && all[to].lead == all[from].lead) ++to;
    if (lanes_ == 1) known_before(&all[from], to - from);
    else known_before_in_lanes(&all[from], to - from);
    from = to;
  }
}

// Scratch memory for the sums of all convolutions.
llvm::Value* Emitter::scratch_memory() {
  llvm::BasicBlock& entry = function_->getEntryBlock();
  llvm::IRBuilder<> top(&entry, entry.begin());
  auto* memory = top.CreateAlloca(lane_, top.getInt32(static_cast<std::uint32_t>(2 * kBlock * (bulk_.size() + 1))));
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

// One function for all stages: four of them, one for each place in a block, were no faster and took twice as long to make. What is new in a block is
// added to the sums as it comes.
void Emitter::stages(const std::vector<Step>& steps, bool solved) {
  const std::string list = solved ? "stage" : "after";
  bulk_.clear();
  for (const Step& s : steps)
    for (const Convolution& c : convolutions(s)) bulk_.try_emplace(c, 0U);
  unsigned count = 0;
  for (auto& [c, place] : bulk_) place = count++;

  llvm::Function* const whole = function_;
  Value* const arena = w_;
  const auto back = b_.saveIP();

  // The first block knows little before it: its histories are made stage by stage.
  llvm::Function *first[kBlock] = {}, *add[kBlock - 1] = {}, *before_block = nullptr;
  for (stage_ = 1; stage_ <= std::min(p_.stages, kBlock); ++stage_) {
    first[stage_ - 1] = begin_part(list + "_first" + std::to_string(stage_));
    for (const auto& [c, place] : bulk_) {
      const auto [old, new_of_a] = history(c);
      b_.CreateAlignedStore(old, scratch(place, static_cast<unsigned>(stage_ - 1)), align());
      b_.CreateAlignedStore(new_of_a, scratch(place, static_cast<unsigned>(stage_ - 1), true), align());
    }
    end();
  }
  relative_ = true;
  if (p_.stages > kBlock) {
    before_block = begin_part(list + "_known");
    bulk();
    for (const auto& [c, place] : bulk_)
      for (unsigned i = 0; i < kBlock; ++i) b_.CreateAlignedStore(number(0), scratch(place, i, true), align());
    end();
    for (int m = 0; m + 1 < kBlock; ++m) {
      add[m] = begin_part(list + "_add" + std::to_string(m));
      add_newest(m);
      end();
    }
  }
  llvm::Function* const any = begin_part(list + "_any");
  stage(steps, solved);
  relative_ = false;
  end();

  function_ = whole;
  w_ = arena;
  b_.restoreIP(back);
  known_.clear();
  Value* scratch = scratch_memory();
  const auto make = [&](Value* k, int i) { b_.CreateCall(any, {w_, b_.CreateConstInBoundsGEP1_64(lane_, scratch, static_cast<std::uint64_t>(i)), k}); };
  for (int i = 0; i < std::min(kBlock, p_.stages); ++i) {
    Value* k = b_.getInt64(static_cast<std::uint64_t>(i + 1));
    b_.CreateCall(first[i], {w_, scratch, k});
    make(k, i);
  }
  if (!before_block) return;
  over_blocks([&](Value* k0) { b_.CreateCall(before_block, {w_, scratch, k0}); },
              [&](Value* k0, int i) {
                Value* k = b_.CreateAdd(k0, b_.getInt64(static_cast<std::uint64_t>(i)));
                make(k, i);
                if (i + 1 < kBlock) b_.CreateCall(add[i], {w_, scratch, k});
              });
}

// After stage m of a block: what its coefficients, the newest, add to the orders after it.
void Emitter::add_newest(int m) {
  // For one lane, four orders at once: those up to m are done with.
  auto* orders = lanes_ == 1 ? static_cast<llvm::Type*>(llvm::FixedVectorType::get(b_.getDoubleTy(), kBlock)) : lane_;
  const llvm::Align at_any = lanes_ == 1 ? llvm::Align(8) : align(), at_four = lanes_ == 1 ? llvm::Align(32) : align();
  for (const auto& [c, place] : bulk_) {
    Value *a = load(std::int64_t{c.a} + c.lead, true), *b = load(std::int64_t{c.b} + c.lead, true);
    if (lanes_ == 1) a = b_.CreateVectorSplat(kBlock, a), b = b_.CreateVectorSplat(kBlock, b);
    for (int i = lanes_ == 1 ? 0 : m + 1; i < (lanes_ == 1 ? 1 : kBlock); ++i) {
      const auto add = [&](bool new_of_a, std::uint32_t older, Value* newest) {
        Value* sum = scratch(place, static_cast<unsigned>(i), new_of_a);
        Value* x = b_.CreateAlignedLoad(orders, address(std::int64_t{older} + i - m, false), at_any);
        b_.CreateAlignedStore(fma(x, newest, b_.CreateAlignedLoad(orders, sum, at_four)), sum, at_four);
      };
      add(false, c.a, b);
      add(true, c.b, a);
    }
  }
}

void Emitter::extend() {
  begin("extend");
  stages(p_.stage, true);
  if (!p_.after.empty()) {
    stage_ = 0;
    known_.clear();
    for (const Step& s : p_.after) value(s);
    stages(p_.after, false);
  }
  end();
}

}  // namespace anholon::jit

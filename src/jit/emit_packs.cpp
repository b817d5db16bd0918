// Code for isomorphic steps of one motion in lanes (packs.h): histories, their part of a stage, packed memory.
#include <set>

#include "jit/emitter.h"
#include "jit/packer.h"

namespace anholon::jit {

llvm::Value* Emitter::sum_before(const Convolution& c, int order, bool new_of_a) {
  const std::uint32_t at = place_of_sum(c, order, new_of_a);
  return noted(b_.CreateAlignedLoad(lane_, own(at), align()), {Origin::Kind::own, at});
}

// Emits the part of the sums that is known before a block.
void Emitter::pack_histories() {
  const std::vector<Packs::Pack>& packs = memory_->packs().packs;
  if (packs.empty()) return;
  auto* lane = llvm::FixedVectorType::get(b_.getDoubleTy(), memory_->width());
  for_runs(packs, kSideBySideInLanes, [&](std::size_t from, std::size_t to) {
    std::vector<InLanes> group;
    for (std::size_t i = from; i < to; ++i) {
      Value* b = own(memory_->coefficient(packs[i].b, packs[i].lead, false).at);
      group.push_back({own(memory_->coefficient(packs[i].a, 0, false).at), b_.CreateInBoundsGEP(lane, b, k0_),
                       own(memory_->sums_of_pack(i))});
    }
    known_before_in_lanes(lane, packs[from].lead, group);
    // At the first place in a block there are no new coefficients.
    for (std::size_t i = from; i < to; ++i)
      b_.CreateAlignedStore(llvm::ConstantAggregateZero::get(lane),
                            own(memory_->sums_of_pack(i) + kBlock * memory_->width()),
                            llvm::Align(8 * memory_->width()));
  });
}

// For the block just emitted: stores histories in lanes if the block computes nothing else, otherwise the newest
// coefficients of the series.
void Emitter::pack_stage() {
  const Packs& packs = memory_->packs();
  if (packs.packs.empty()) return;
  const unsigned width = memory_->width();
  Value* relative = nullptr;
  Packer packer(*b_.GetInsertBlock(), b_, *memory_, origins_, [&](PackedMemory::Place place) -> Value* {
    if (!place.relative) return own(place.at);
    if (!relative) relative = b_.CreateInBoundsGEP(llvm::FixedVectorType::get(b_.getDoubleTy(), width), scratch_, k0_);
    return b_.CreateConstInBoundsGEP1_64(b_.getDoubleTy(), relative, place.at);
  });
  for (std::size_t i = 0; i < packs.packs.size(); ++i) {
    Packer::Lanes old, new_of_a;
    for (const std::optional<Convolution>& c : packs.packs[i].lanes) {
      old.push_back(c ? histories_.at(*c).first : nullptr);
      new_of_a.push_back(c ? histories_.at(*c).second : nullptr);
    }
    if (relative_) {
      packer.want(old);
      packer.want(new_of_a);
    } else {
      packer.keep(old, {memory_->sums_of_pack(i)});
      packer.keep(new_of_a, {memory_->sums_of_pack(i) + kBlock * width});
    }
  }
  for (std::size_t i = 0; i < packs.bundles.size() && relative_; ++i) {
    const Packs::Bundle& bundle = packs.bundles[i];
    Packer::Lanes newest;
    for (const std::uint32_t at : bundle.at)
      newest.push_back(at == Packs::kNobody ? nullptr : known_.at({at, stage_ + bundle.newest}));
    packer.keep(newest, memory_->coefficient(i, stage_ + bundle.newest, true));
  }
  packer.run();
}

// Before the stages: stores the known coefficients and the constants.
void Emitter::fill_packed_memory() {
  const unsigned width = memory_->width();
  const auto fill = [&](const Packs::Lanes& from, int order, std::uint32_t to) {
    Value* all = llvm::ConstantAggregateZero::get(llvm::FixedVectorType::get(b_.getDoubleTy(), width));
    for (unsigned lane = 0; lane < width; ++lane)
      if (from[lane] != Packs::kNobody) all = b_.CreateInsertElement(all, load(std::int64_t{from[lane]} + order), lane);
    b_.CreateAlignedStore(all, own(to), llvm::Align(8 * width));
  };
  const std::vector<Packs::Bundle>& bundles = memory_->packs().bundles;
  for (std::size_t i = 0; i < bundles.size(); ++i)
    for (int order = 0; order <= bundles[i].newest; ++order)
      fill(bundles[i].at, order, memory_->coefficient(i, order, false).at);
  for (const auto& [slots, to] : memory_->constants()) fill(slots, 0, to);
}

// Omits the stores of series that only vectors read.
void Emitter::leave_out_what_nobody_reads(const std::vector<llvm::Function*>& parts) {
  std::set<std::uint32_t> read(p_.x.begin(), p_.x.end());
  for (const Convolution& c : memory_->alone()) read.insert({c.a, c.b});
  for (const Step& s : p_.after) {
    for (const Place& x : {s.a, s.b, s.c, s.d, s.e, s.f}) read.insert(x.at);
    for (std::uint32_t k = s.first; k < s.first + s.count; ++k) read.insert(p_.terms[k].x.at);
  }
  for (const Place& x : p_.quadratures) read.insert(x.at);
  for (const Plan::Deciding& d : p_.deciding) read.insert(d.place.at);
  for (const auto& [at, load] : reads_)
    if (Value* const alive = load; alive && !alive->use_empty()) read.insert(at);
  for (const auto& [at, store] : puts_)
    if (Value* const alive = store; alive && read.count(at) == 0) llvm::cast<llvm::StoreInst>(alive)->eraseFromParent();
  for (llvm::Function* f : parts)
    for (llvm::BasicBlock& block : *f) erase_dead(block);
}

}  // namespace anholon::jit

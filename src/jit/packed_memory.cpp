#include "jit/packed_memory.h"

namespace anholon::jit {

PackedMemory::PackedMemory(const Plan& plan, Packs packs, unsigned width, const std::vector<Convolution>& all)
    : packs_(std::move(packs)), width_(width) {
  for (const Packs::Pack& pack : packs_.packs) {
    const std::uint32_t at = take(2 * kBlock * width_);
    sums_of_packs_.push_back(at);
    for (unsigned lane = 0; lane < width_; ++lane)
      if (pack.lanes[lane]) sums_.try_emplace(*pack.lanes[lane], Sums{at + lane, width_});
  }
  for (const Packs::Bundle& bundle : packs_.bundles)
    bundles_.push_back(take(width_ * static_cast<std::uint32_t>(plan.stages + bundle.newest + 1)));
  for (const Convolution& c : all)
    if (sums_.count(c) == 0) {
      sums_[c] = {take(2 * kBlock), 1};
      alone_.push_back(c);
    }
}

PackedMemory::Place PackedMemory::coefficient(std::size_t bundle, int order, bool relative) const {
  return {bundles_[bundle] + width_ * static_cast<std::uint32_t>(order), relative};
}

std::optional<PackedMemory::Place> PackedMemory::find(const std::vector<const Origin*>& lanes) {
  const Origin* first = nullptr;
  unsigned first_lane = 0;
  for (unsigned l = width_; l-- > 0;)
    if (lanes[l]) first = lanes[l], first_lane = l;
  if (!first) return {};
  Packs::Lanes at;
  for (const Origin* o : lanes) {
    if (o && (o->kind != first->kind || o->order != first->order || o->relative != first->relative)) return {};
    at.push_back(o ? o->at : Packs::kNobody);
  }
  const auto all = [&](const auto& in_lane) {
    for (unsigned l = 0; l < width_; ++l)
      if (lanes[l] && !in_lane(l)) return false;
    return true;
  };
  switch (first->kind) {
  case Origin::Kind::own:
    if (first->at < first_lane || (first->at - first_lane) % width_ != 0 ||
        !all([&](unsigned l) { return at[l] == first->at - first_lane + l; }))
      return {};
    return Place{first->at - first_lane};
  case Origin::Kind::series:
    for (std::size_t i = 0; i < packs_.bundles.size(); ++i)
      if (all([&](unsigned l) { return packs_.bundles[i].at[l] == at[l]; }))
        return coefficient(i, first->order, first->relative);
    return {};
  case Origin::Kind::constant: {
    const auto it = constants_.find(at);
    return Place{it != constants_.end() ? it->second : constants_.emplace(at, take(width_)).first->second};
  }
  }
  return {};
}

}  // namespace anholon::jit

// The machine code's own memory for numbers that vectors take side by side: the sums of histories, copies of series,
// copies of what is constant while an expansion is extended. Places are counted in numbers from its beginning, those
// for vectors multiples of the width.
#pragma once
#include "jit/packs.h"

namespace anholon::jit {

// Where a number of the stages' code was read.
struct Origin {
  enum class Kind : std::uint8_t { constant, series, own } kind;
  std::uint32_t at = 0;   // in the arena; of a series, its begin; of own memory, the place
  int order = 0;          // of a coefficient
  bool relative = false;  // counted from the first stage of the block
  bool operator==(const Origin& o) const {
    return kind == o.kind && at == o.at && order == o.order && relative == o.relative;
  }
};

class PackedMemory {
 public:
  struct Place {
    std::uint32_t at;
    bool relative = false;  // `width` times the first stage of the block further
  };
  struct Sums {
    std::uint32_t at,
        step;  // of the order i of a block at + step i, what is new of the first factor kBlock steps further
  };

  // For the histories of these, as packs and alone.
  PackedMemory(const Plan& plan, Packs packs, unsigned width, const std::vector<Convolution>& all);

  unsigned width() const { return width_; }
  const Packs& packs() const { return packs_; }
  const Sums& sums(const Convolution& c) const { return sums_.at(c); }
  std::uint32_t sums_of_pack(std::size_t pack) const { return sums_of_packs_[pack]; }
  const std::vector<Convolution>& alone() const { return alone_; }
  Place coefficient(std::size_t bundle, int order, bool relative) const;

  // Where all these lie side by side, null where a lane has none. Constants are given a place.
  std::optional<Place> find(const std::vector<const Origin*>& lanes);
  // Constants with a place, and where.
  const std::map<Packs::Lanes, std::uint32_t>& constants() const { return constants_; }
  std::uint32_t size() const { return size_; }

 private:
  std::uint32_t take(std::uint32_t size) { return size_ += size, size_ - size; }

  Packs packs_;
  unsigned width_;
  std::uint32_t size_ = 0;
  std::map<Convolution, Sums> sums_;
  std::vector<Convolution> alone_;
  std::vector<std::uint32_t> sums_of_packs_, bundles_;  // where
  std::map<Packs::Lanes, std::uint32_t> constants_;
};

}  // namespace anholon::jit

// Memory of the machine code for numbers that vectors load side by side: sums of histories, copies of series, and
// copies of numbers that are constant while an expansion is extended. Places are counted in numbers from the beginning;
// those for vectors are multiples of the width.
#pragma once
#include "jit/packs.h"

namespace anholon::jit {

// The place from which the code of the stages reads a number.
struct Origin {
  enum class Kind : std::uint8_t { constant, series, own } kind;
  std::uint32_t at = 0;   // in the arena; for a series, its begin; for own memory, the place
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
        step;  // order i of a block is at + step i; new coefficients of the first factor are kBlock steps further
  };

  // Makes the memory for the histories of these convolutions, in packs and single.
  PackedMemory(const Plan& plan, Packs packs, unsigned width, const std::vector<Convolution>& all);

  unsigned width() const { return width_; }
  const Packs& packs() const { return packs_; }
  const Sums& sums(const Convolution& c) const { return sums_.at(c); }
  std::uint32_t sums_of_pack(std::size_t pack) const { return sums_of_packs_[pack]; }
  const std::vector<Convolution>& alone() const { return alone_; }
  Place coefficient(std::size_t bundle, int order, bool relative) const;

  // Returns the place at which all these numbers are side by side; a lane without a number is nullptr. Constants get a
  // place.
  std::optional<Place> find(const std::vector<const Origin*>& lanes);
  // Constants with their places.
  const std::map<Packs::Lanes, std::uint32_t>& constants() const { return constants_; }
  std::uint32_t size() const { return size_; }

 private:
  std::uint32_t take(std::uint32_t size) { return size_ += size, size_ - size; }

  Packs packs_;
  unsigned width_;
  std::uint32_t size_ = 0;
  std::map<Convolution, Sums> sums_;
  std::vector<Convolution> alone_;
  std::vector<std::uint32_t> sums_of_packs_, bundles_;  // places
  std::map<Packs::Lanes, std::uint32_t> constants_;
};

}  // namespace anholon::jit

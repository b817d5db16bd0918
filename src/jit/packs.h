// Series side by side: the choice of convolutions of one motion that are summed in the lanes of vectors, one
// convolution in each lane.
//
// A mechanism repeats itself: links, wheels, trailers. In isomorphic steps, the histories of the convolutions (all but
// the newest coefficients) never wait for each other, so those of up to `width` steps are summed as one vector. For
// that the coefficients of their factors are stored side by side, [order][lane], in own memory of the machine code; in
// the arena they are stored series by series. Lanes are assigned so that a step that uses the result of another one is
// in the same lane.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "kernel/plan/plan.h"

namespace anholon::jit {

// The series of the places a and b; the product's order p is the stage + lead.
struct Convolution {
  std::uint32_t a, b;
  std::uint8_t lead;
  bool operator<(const Convolution& o) const { return std::tie(lead, a, b) < std::tie(o.lead, o.a, o.b); }
};

// The one or two convolutions that a coefficient sums.
std::vector<Convolution> convolutions(const Step& s);

struct Packs {
  // One place in each lane; kNobody for an empty lane.
  static constexpr std::uint32_t kNobody = ~0U;
  using Lanes = std::vector<std::uint32_t>;
  // Series whose coefficients of order stage + newest are computed in a stage.
  struct Bundle {
    Lanes at;
    int newest = 0;
  };
  struct Pack {
    std::vector<std::optional<Convolution>> lanes;
    std::uint8_t lead = 0;     // common lead
    std::size_t a = 0, b = 0;  // bundles
  };
  std::vector<Bundle> bundles;
  std::vector<Pack> packs;
};

// The least number of lanes for which a vector of `width` pays.
constexpr unsigned fewest_lanes(unsigned width) { return width / 2 < 3 ? 3 : width / 2; }

// Chooses packs for the stages of a plan and vectors of `width` numbers.
Packs choose_packs(const Plan& plan, unsigned width);

}  // namespace anholon::jit

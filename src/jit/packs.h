// Series side by side: which convolutions of one motion are summed in the lanes of vectors, one convolution in each.
//
// A mechanism repeats itself: links, wheels, trailers. Of steps that do the same, the histories of the convolutions
// (all but the newest coefficients) never wait for each other, so those of up to `width` steps are one. For that the
// coefficients of their factors lie side by side, [order][lane], in memory of the machine code's own, beside the arena,
// where they lie series by series. Lanes are given so that who works on the other's result is in its lane.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "kernel/plan.h"

namespace anholon::jit {

// The series of the places a and b; the product's order p is the stage + lead.
struct Convolution {
  std::uint32_t a, b;
  std::uint8_t lead;
  bool operator<(const Convolution& o) const { return std::tie(lead, a, b) < std::tie(o.lead, o.a, o.b); }
};

// Of a coefficient: what it sums, one or two.
std::vector<Convolution> convolutions(const Step& s);

struct Packs {
  // One place in each lane; kNobody where there is none.
  static constexpr std::uint32_t kNobody = ~0U;
  using Lanes = std::vector<std::uint32_t>;
  // Series of which a stage makes the coefficients of order stage + newest.
  struct Bundle {
    Lanes at;
    int newest = 0;
  };
  struct Pack {
    std::vector<std::optional<Convolution>> lanes;
    std::uint8_t lead = 0;     // of all
    std::size_t a = 0, b = 0;  // bundles
  };
  std::vector<Bundle> bundles;
  std::vector<Pack> packs;
};

// Fewer lanes than this are not worth a vector of `width`.
constexpr unsigned fewest_lanes(unsigned width) { return width / 2 < 3 ? 3 : width / 2; }

// For the stages of a plan and vectors of `width` numbers.
Packs choose_packs(const Plan& plan, unsigned width);

}  // namespace anholon::jit

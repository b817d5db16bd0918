// What the pivots of a kernel say of how regular J is (theory: kernels, health).
#pragma once
#include <cstdint>

namespace anholon {

// The pivots of a kernel at a point, in relation to those where they were chosen.
struct Pivots {
  double health = 0;        // the smallest, by its absolute value
  std::uint64_t signs = 0;  // a hash of their signs
};
// Below this health they are no longer trusted.
inline constexpr double kHealthy = 2e-3;
// Whether one may have passed zero between two points, so that J may have been singular: it has another sign, or one of them has shrunk by much (a
// square keeps its sign). Or not: as a pivot passes zero, the next one passes infinity.
inline bool may_have_vanished(const Pivots& before, const Pivots& after) {
  constexpr double kMuch = 0.6;
  return before.signs != after.signs || after.health < before.health * kMuch;
}

}  // namespace anholon

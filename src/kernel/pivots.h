// What the pivots of a kernel say of how regular J is (theory: kernels, health).
#pragma once
#include <cmath>

namespace anholon {

// The pivots of a kernel at a point, in relation to those where they were chosen.
struct Pivots {
  double health = 0;       // the smallest, by its absolute value
  double determinant = 0;  // their product: that of J
};
// Below this health they are no longer trusted.
inline constexpr double kHealthy = 2e-3;
// Whether J may have been singular between two points: its determinant has another sign, or has shrunk by much together
// with a pivot (a square keeps its sign). A pivot alone says nothing: as one passes zero, the next one passes infinity.
inline bool may_have_vanished(const Pivots& before, const Pivots& after) {
  constexpr double kMuch = 0.6;
  if ((before.determinant < 0) != (after.determinant < 0)) return true;
  return after.health < before.health * kMuch && !(std::abs(after.determinant) >= std::abs(before.determinant) * kMuch);
}

}  // namespace anholon

// The regularity of J as the pivots of a kernel show it (theory: kernels, health).
#pragma once
#include <cmath>

namespace anholon {

// The pivots of a kernel at a point, relative to their values at the choice of pivots.
struct Pivots {
  double health = 0;       // the smallest ratio, by absolute value
  double determinant = 0;  // the product of the ratios: the ratio of det J
};
// Pivots of smaller health are not trusted; if solutions are refined, pivots are trusted unless they leave few digits
// to refinement.
inline constexpr double kHealthy = 2e-3, kHealthyIfRefined = 1e-5;
// True if J may have been singular between two points: its determinant has changed its sign, or has become much smaller
// together with a pivot (a square keeps its sign). A single pivot proves nothing: if one passes zero, the next one
// passes infinity.
inline bool may_have_vanished(const Pivots& before, const Pivots& after) {
  constexpr double kMuch = 0.6;
  if ((before.determinant < 0) != (after.determinant < 0)) return true;
  return after.health < before.health * kMuch && !(std::abs(after.determinant) >= std::abs(before.determinant) * kMuch);
}

}  // namespace anholon

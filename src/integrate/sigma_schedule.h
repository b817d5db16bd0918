// The schedule by which the smallest singular value sigma of the system Jacobian is measured again, which only the
// reference does.
#pragma once
#include <algorithm>
#include <bit>
#include <cstddef>

namespace anholon {

// True if sigma is due after so many steps: at powers of two, at every 256th step up to 4096, and sixteen times up to
// each further power of two.
constexpr bool sigma_is_due(std::size_t steps) {
  constexpr std::size_t kOften = 256, kTimes = 16;
  return steps % std::max(kOften, std::bit_floor(steps) / kTimes) == 0 || std::has_single_bit(steps);
}
// Sigma is also due when the pivots of the kernel have become this much smaller.
inline constexpr double kPivotDropToRecheck = 0.8;

}  // namespace anholon

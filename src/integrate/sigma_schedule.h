// When the smallest singular value sigma of the system Jacobian is measured again, which only the reference does.
#pragma once
#include <cstddef>

namespace anholon {

// After so many steps, ever more rarely, but at least at every 256th.
constexpr bool sigma_is_due(std::size_t steps) { return steps % 256 == 0 || (steps & (steps - 1)) == 0; }
// And whenever the pivots of the kernel have become this much smaller than they were before.
inline constexpr double kPivotDropToRecheck = 0.8;

}  // namespace anholon

// The sequence of Sobol, whose points fill the unit cube more evenly than random points do.
//
// Direction numbers: S. Joe and F. Y. Kuo, Constructing Sobol sequences with better two-dimensional projections, SIAM J.
// Sci. Comput. 30 (2008), the first dimensions of their table new-joe-kuo-6.
#pragma once
#include <cstdint>

namespace anholon {

inline constexpr std::uint32_t kSobolDimensions = 21;

// Returns coordinate `dimension` of point `number` < 2^52, in (0, 1). The shift, the same for all points, is added to
// the bits without carry (a digital shift), which keeps the evenness of the points. REQUIRES: dimension <
// kSobolDimensions.
double sobol(std::uint64_t number, std::uint32_t dimension, std::uint64_t shift = 0);

// Returns the number below which a standard normal variable stays with probability p in (0, 1), to about 16 digits.
double normal_quantile(double p);

}  // namespace anholon

// The pseudo-random bits behind the points that proofs try.
//
// Reports print values at these points, so these bits must not change; expr/generic_point.h serves all other uses.
#pragma once
#include <cstdint>

namespace anholon {

inline std::uint64_t scattered_bits(std::uint64_t key) {
  for (int i = 0; i < 3; ++i) key = (key ^ (key >> 29)) * 0xbf58476d1ce4e5b9ULL + 0x9e3779b97f4a7c15ULL;
  return key;
}

// Returns a number in [0, 1) from the upper 24 bits.
inline double unit_of(std::uint64_t bits) { return static_cast<double>(bits >> 40) / 16777216.0; }

}  // namespace anholon

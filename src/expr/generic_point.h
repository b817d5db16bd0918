// Values at which nothing is special: a generic point for ranks and zeros.
#pragma once
#include "expr/expr.h"
#include "numeric/random/philox.h"

namespace anholon {

// Returns a pseudo-random number in (0, 1) that depends on the symbol (kind, index, order) and the seed alone. Two
// symbols have different values.
inline double generic_value(const Node& symbol, std::uint64_t seed) {
  const std::uint32_t sort = static_cast<std::uint32_t>(symbol.kind) << 8 | symbol.order;
  return Draw(seed, static_cast<std::uint64_t>(sort) << 32 | symbol.index, 0).uniform();
}

}  // namespace anholon

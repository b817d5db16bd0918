// Chooses cases of a sweep that represent all of them: spread evenly over its map, and on both sides of borders.
#pragma once
#include <cstddef>
#include <vector>

#include "plot/drawing.h"

namespace anholon::plot {

struct SpreadCase {
  Point at;                 // in units of the axes
  unsigned generation = 0;  // of a refined sweep: further generations are at borders
  double outcome = 0;       // cases on both sides of a border have different ones
};

// Returns the indices of at most `most` cases, ascending. In a refined sweep, half of them are pairs of a case of the
// last generation and the next case with another outcome, far from each other. The others are those nearest to the
// middles of the cells of an even grid over the different values along each axis, and then those farthest from all
// chosen ones.
std::vector<std::size_t> spread(const std::vector<SpreadCase>& cases, std::size_t most);

}  // namespace anholon::plot

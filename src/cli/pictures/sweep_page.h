// A page of a sweep: cells over two variations, or points over one; a click tells the numbers of a case and the command
// that computes its motion. (doc/sweeps.md)
#pragma once
#include "cli/input.h"

namespace anholon::cli {

// The map of a sweep for src/report/map.js.
struct SweepMap {
  std::string title;
  std::string data;                       // JSON
  std::vector<std::size_t> cases;         // the numbers of the cases that the map shows
  std::vector<std::vector<double>> axes;  // their values along each axis
};
// Throws Failure without a place.
SweepMap map_of_sweep(const PlotCommand& o);

// The page as HTML that needs no other file. Throws Failure without a place.
std::string page_of_sweep(const PlotCommand& o);

}  // namespace anholon::cli

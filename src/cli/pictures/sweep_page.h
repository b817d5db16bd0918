// A page of a sweep: cells over two variations, or points over one. A click on a case shows its numbers, the command
// that computes its motion, and the motion if the page holds it. (doc/sweeps.md)
#pragma once
#include "cli/pictures/sweep_motions.h"

namespace anholon::cli {

// The map of a sweep for src/report/map.js.
struct SweepMap {
  std::string title;
  std::string data;               // JSON
  std::vector<MappedCase> cases;  // the cases that the map shows
};
// Returns the map of the sweep o.run. Throws Failure without a place.
SweepMap map_of_sweep(const PlotCommand& o);

// Writes the page as HTML that needs no other file, and returns the exit status. Throws UsageError, and Failure without
// a place.
int write_page_of_sweep(const PlotCommand& o);

}  // namespace anholon::cli

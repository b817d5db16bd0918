// A page of a sweep: cells over two variations, or points over one; a click tells the numbers of a case and the command
// that computes its motion, and shows the motion of a case that the page holds. (doc/sweeps.md)
#pragma once
#include "cli/pictures/sweep_motions.h"

namespace anholon::cli {

// The map of a sweep for src/report/map.js.
struct SweepMap {
  std::string title;
  std::string data;               // JSON
  std::vector<MappedCase> cases;  // that the map shows
};
// Throws Failure without a place.
SweepMap map_of_sweep(const PlotCommand& o);

// Writes the page as HTML that needs no other file, and returns the exit status. Throws UsageError, and Failure without a
// place.
int write_page_of_sweep(const PlotCommand& o);

}  // namespace anholon::cli

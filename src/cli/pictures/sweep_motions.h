// The motions that a page of a sweep holds: of some cases, spread over the map.
#pragma once
#include "cli/input.h"
#include "plot/spread.h"

namespace anholon::cli {

struct HeldMotions {
  std::string data;       // JSON: of each motion the "number" of its case, its "outcome" in words and its "data"
  std::size_t count = 0;  // of the motions
  bool stopped = false;   // by Ctrl-C
};
// A case of the map: its number, and where it lies.
struct MappedCase {
  std::size_t number = 0;
  plot::SpreadCase place;
};
// Computes the motions of o.motions of the cases, and tells the progress on stderr. A case that has no motion is told and left out. Throws
// UsageError if the sweep is no folder, or if no case has a motion.
HeldMotions held_motions(const PlotCommand& o, const std::vector<MappedCase>& cases);

}  // namespace anholon::cli

// The motions in a page of a sweep: those of some cases, spread over the map.
#pragma once
#include "cli/input.h"
#include "plot/spread.h"

namespace anholon::cli {

struct HeldMotions {
  std::string data;       // a JSON list: for each motion the "number" of its case, its "outcome" and its "data"
  std::size_t count = 0;  // of the motions
  bool stopped = false;   // Ctrl-C ended the computation
};
// A case of the map: its number and its place.
struct MappedCase {
  std::size_t number = 0;
  plot::SpreadCase place;
};
// Computes the motions of o.motions of the cases, and prints the progress on stderr. A case without a motion is noted
// on stderr and left out. Throws UsageError if the sweep is not in a folder, or if no case has a motion.
HeldMotions held_motions(const PlotCommand& o, const std::vector<MappedCase>& cases);

}  // namespace anholon::cli

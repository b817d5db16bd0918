// A page of a sweep: cells over two variations, or points over one; a click tells the numbers of a case and the command
// that computes its motion. (doc/sweeps.md)
#pragma once
#include "cli/input.h"

namespace anholon::cli {

// The page as HTML that needs no other file. Throws Failure without a place.
std::string page_of_sweep(const PlotCommand& o);

}  // namespace anholon::cli

// Figures of sweeps: cells over two variations, curves and quantiles over one. (doc/sweeps.md)
#pragma once
#include "cli/input.h"
#include "plot/heat_map.h"
#include "plot/histogram.h"

namespace anholon::cli {

// A map over two variations, a histogram, or a table over one variation.
struct SweepPicture {
  std::optional<plot::HeatMap> map;
  std::optional<plot::Histogram> histogram;
  RunFile table;         // without these: the variation, and what is shown over it
  std::string abscissa;  // of the table
};

// What a sweep in a folder or a file shows: the column that --column names (default: how the cases ended) over --x and --y
// (default: the first two that vary). Throws Failure without a place.
SweepPicture picture_of_sweep(const PlotCommand& o);

}  // namespace anholon::cli

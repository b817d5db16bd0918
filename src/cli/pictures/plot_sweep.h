// Figures of sweeps: cells over two variations, curves and quantiles over one. (doc/sweeps.md)
#pragma once
#include "cli/input.h"
#include "plot/heat_map.h"

namespace anholon::cli {

// Whether a path is the folder of a sweep.
bool is_sweep_folder(const std::string& path);

// Either a map over two variations or a table over one.
struct SweepPicture {
  std::optional<plot::HeatMap> map;
  RunFile table;         // without a map: the variation, and what is shown over it
  std::string abscissa;  // of the table
};

// What a sweep in a folder shows: the column that --column names (default: how the cases ended) over --x and --y
// (default: the first two that vary). Throws Failure without a place.
SweepPicture picture_of_sweep(const Options& o);

}  // namespace anholon::cli

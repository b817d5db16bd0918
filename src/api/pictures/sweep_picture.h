// Figures of sweeps: cells over two variations, curves and quantiles over one, curves over the time. (doc/sweeps.md)
#pragma once
#include "api/pictures/sweep_cases.h"
#include "plot/figure.h"
#include "plot/heat_map.h"
#include "plot/histogram.h"

namespace anholon::v1 {

// The request for a figure: its columns (empty: the outcomes), the columns along the axes (empty: those that vary), or
// a column whose histogram is shown. `dashes` stand before the names of options in hints.
struct SweepPictureRequest {
  std::vector<std::string> columns;
  std::string x, y, histogram, title, dashes;
};

// A map over two variations, a histogram, or curves.
struct SweepPicture {
  std::optional<inner::plot::HeatMap> map;
  std::optional<inner::plot::Histogram> histogram;
  std::vector<inner::plot::NamedRun> curves;  // without these: a run of each case, or one without a name
  inner::plot::FigureOptions options;         // options of the curves
  std::string note;                           // "1 of 20 parts", also part of the title; empty if all parts are present
};

// Draws columns over x, or one column over x and y (default: the first two columns that vary). If cases have rows at
// several times, the columns are drawn over x (default: t), with a curve for each of up to kMostCurves cases; if there
// are more cases, their quantiles are drawn over t. Throws Failure without a place.
inline constexpr std::size_t kMostCurves = 8;
SweepPicture picture_of_sweep(const SweepCases& cases, const SweepPictureRequest& o);

}  // namespace anholon::v1

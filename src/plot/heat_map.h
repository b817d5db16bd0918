// Cells over two variables, coloured by a number or a word: how the motions of a sweep ended, and where.
#pragma once
#include <cstdint>

#include "plot/drawing.h"

namespace anholon::plot {

struct NamedColumn {
  std::string name, unit;
  std::vector<double> values;
};

struct HeatMap {
  std::string title;
  NamedColumn x, y;                // `values`: the middles of the cells, ascending
  std::string name, unit;          // of what is shown
  std::vector<double> values;      // of the cell (i, k) at k * x.values.size() + i; NaN if no case lies in it
  std::vector<std::string> words;  // values are indices of these; empty: values are numbers
  LabelStyle labels = LabelStyle::unicode;
  double width = 16, height = 11;  // cm
};

// A cell for each pair of values that occurs; of a column with more than kMostCells different values, evenly spaced
// cells. A cell with several cases has their mean, or their most frequent word. Throws Failure without a place if no case
// has finite coordinates.
inline constexpr std::size_t kMostCells = 256;
HeatMap make_heat_map(NamedColumn x, NamedColumn y, const NamedColumn& of, std::vector<std::string> words);

Drawing lay_out(const HeatMap& map);

}  // namespace anholon::plot

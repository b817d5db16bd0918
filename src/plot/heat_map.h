// Cells over two variables, coloured by a number or a word: how the motions of a sweep ended, depending on both.
#pragma once
#include <cstdint>

#include "plot/drawing.h"

namespace anholon::plot {

struct NamedColumn {
  std::string name, unit;
  std::vector<double> values;
  std::string meaning = {};  // in words
  // The values that the column of an axis has in the whole sweep, if cases are missing: the axis shows these values,
  // too.
  std::vector<double> points = {};
};
// The label of the axis of a column: "m (kg), mass of the disc". An initial value x(0) has the name of its variable.
RichText axis_label(const NamedColumn& column, const std::string& note, LabelStyle style);

inline constexpr double kPointsInCm = 72 / 2.54;
std::uint32_t colour_of_word(std::size_t word);

struct HeatMap {
  std::string title;
  NamedColumn x, y;            // `values`: the middles of the cells, ascending
  std::string name, unit;      // of the quantity shown
  std::vector<double> values;  // of the cell (i, k) at k * x.values.size() + i; NaN if the cell has no case
  struct Finer {
    Point from, to;  // corners in units of the axes
    double value = 0;
  };
  std::vector<Finer> finer;        // drawn over the cells, in this order
  std::vector<std::string> words;  // values are indices of these; empty: values are numbers
  LabelStyle labels = LabelStyle::unicode;
  double width = 16, height = 11;  // cm
};

// Makes a cell for each pair of values that occurs or is among the points of the axes; for a column with more than
// kMostCells different values, evenly spaced cells. A cell with several cases gets their mean, or their most frequent
// word. Throws Failure without a place if no case has finite coordinates. A case of generation g > 0 (plot of a refined
// sweep) lies between the values of the first generation and gets a cell that is 2^g times as small; without
// `generations` all cases belong to the first one.
inline constexpr std::size_t kMostCells = 256;
HeatMap make_heat_map(NamedColumn x, NamedColumn y, const NamedColumn& of, std::vector<std::string> words,
                      const std::vector<unsigned>& generations = {});

// Returns the cell of each case separately, with value 0: at its place, with the size of its generation.
std::vector<HeatMap::Finer> cells_of_cases(const NamedColumn& x, const NamedColumn& y,
                                           const std::vector<unsigned>& generations);

Drawing lay_out(const HeatMap& map);

}  // namespace anholon::plot

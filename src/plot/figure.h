// A figure: columns of a table over one abscissa, in panels. What it shows, not how it looks; `draw_terminal`,
// `draw_svg`, `draw_tex` and `draw_cairo` give it a shape.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "plot/labels.h"
#include "plot/ticks.h"
#include "result/run_file.h"

namespace anholon::plot {

struct FigureOptions {
  std::vector<std::string> names;  // of columns, or patterns with * and ?; none: the coordinates
  std::string x;                   // the abscissa; empty: t, or the first column
  std::optional<double> from, to;  // only rows with t between these
  bool log = false, each = false;
  bool equal = false;   // one unit is as long along both axes
  bool smooth = false;  // few rows over t: the curves go between them as their derivatives say
  LabelStyle labels = LabelStyle::unicode;
  std::string title;
  double width = 16, height = 9;  // cm
};

struct Series {
  std::string name, unit;
  std::vector<double> y;
  std::size_t number = 0;  // its colour
};

struct Panel {
  std::vector<Series> series;
  Axis y;
};

struct Figure {
  std::string title, x_name, x_unit;
  std::size_t rows = 0;  // that are shown; smooth curves have more points
  std::vector<double> x;
  Axis x_axis;
  std::vector<Panel> panels;
  LabelStyle labels = LabelStyle::unicode;
  double width = 16, height = 9;
  bool equal = false;
};

// Throws Failure with the columns there are, where a name is not one of them, or where nothing is left to be shown.
Figure make_figure(const RunFile& run, const FigureOptions& options);

// Axes that are long enough for what they show, and on which one unit is as long along x as along y, where each panel
// is a box so wide and high.
void make_equal(Figure& figure, double width, double height);

// The columns that a list of names and patterns means, in the order of the list.
std::vector<std::size_t> select_columns(const RunTable& table, const std::vector<std::string>& names, std::size_t x);
// Whether * and ? in the pattern can stand for the rest of the name.
bool matches(const std::string& pattern, const std::string& name);

struct Point {
  double x, y;
};
// The curve in a box of that many points of the output, y upwards: a piece for every stretch without gaps. Where many
// rows fall on one column of points, the first, least, greatest and last of them stay, so that nothing that can be seen
// is lost.
std::vector<std::vector<Point>> curve(const Figure& figure, const Panel& panel, const Series& series, double width,
                                      double height);

}  // namespace anholon::plot

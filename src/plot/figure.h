// A figure: columns of a table over one abscissa, in panels. It is the content, which `draw_terminal`, `draw_svg`,
// `draw_tex` and `draw_cairo` draw.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "plot/labels.h"
#include "plot/ticks.h"
#include "result/run_file.h"

namespace anholon::plot {

struct FigureOptions {
  std::vector<std::string> names;  // of columns, or patterns with * and ?; empty: the coordinates
  std::string x;                   // the abscissa; empty: t, or the first column
  std::optional<double> from, to;  // only rows with t between these
  bool log = false, each = false;
  bool equal = false;   // one unit has the same length along both axes
  bool smooth = false;  // few rows over t: curves between them follow their derivatives
  LabelStyle labels = LabelStyle::unicode;
  std::string title;
  double width = 16, height = 9;  // cm
};

struct Series {
  std::string name, unit;
  std::vector<double> y;
  std::size_t number = 0;      // the number of its colour
  std::string of = {};         // the run or the case to which it belongs, in a figure of several
  std::vector<double> x = {};  // its own abscissa; empty: that of the figure
};
// The label of a series: its name with its unit, and the run or case to which it belongs.
RichText series_label(const Series& series, LabelStyle style);
// Like series_label(), in one line of a terminal, or for TeX.
std::string series_text(const Series& series, LabelStyle style);
std::string series_latex(const Series& series);

struct Panel {
  std::vector<Series> series;
  Axis y;
};

struct Figure {
  std::string title, x_name, x_unit;
  std::size_t rows = 0;   // the number of rows shown; smooth curves have more points
  std::vector<double> x;  // empty if each series has its own
  Axis x_axis;
  std::vector<Panel> panels;
  LabelStyle labels = LabelStyle::unicode;
  double width = 16, height = 9;
  bool equal = false;
};

// Throws Failure with the existing columns if a name is not one of them, or if no row is left to show.
Figure make_figure(const RunFile& run, const FigureOptions& options);

struct NamedRun {
  RunFile run;
  std::string name;
};
// Puts the same columns of several runs into the same panels. Throws Failure like the other make_figure(), also if a
// run has no rows to show; a message about one of the runs names it.
Figure make_figure(const std::vector<NamedRun>& runs, const FigureOptions& options);

// Extends the axes so that one unit has the same length along x as along y, if each panel is a box of this width and
// height.
void make_equal(Figure& figure, double width, double height);

// The columns that a list of names and patterns selects, in the order of the list.
std::vector<std::size_t> select_columns(const RunTable& table, const std::vector<std::string>& names, std::size_t x);

struct Point {
  double x, y;
};
// Returns the curve in a box of that many points of the output, y upwards: one piece for every interval without gaps.
// If many rows fall on one column of points, the first, least, greatest and last of them are kept, so that no visible
// part is lost.
std::vector<std::vector<Point>> curve(const Figure& figure, const Panel& panel, const Series& series, double width,
                                      double height);

}  // namespace anholon::plot

// The panels of a page: columns that are plotted over one axis.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

namespace anholon {

struct PlotColumn {
  std::string name, math, unit, group;  // math: MathML of the name; an empty group: only for the picture
  std::vector<double> t, values;        // an empty t: the common times
};

struct PlotGroup {
  std::string id, title;
  bool log = false;
  std::size_t columns = 0;  // the number of columns, those included that are not plotted
};

// All kinds of panels, in their order on a page.
const std::vector<PlotGroup>& all_plot_groups();

// For each column a word for its dimension, such as its unit. Columns of one kind with different words get a panel for
// each word.
using Dimensions = std::vector<std::string>;

// Divides the panels of columns by dimension, because small numbers are a flat line beside large ones. `dimensions` is
// as long as `columns`. The id of a part begins with that of its kind and a space. Returns all panels that may have
// columns.
std::vector<PlotGroup> parted_groups(std::vector<PlotColumn>& columns, const Dimensions& dimensions);

}  // namespace anholon

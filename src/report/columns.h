// What a page plots: the columns of a run in groups, with what follows from them, and as few rows as show everything.
//
// Beside the columns of the run: kinetic energy, potentials and integrals of the motion, the constraints with their
// derivatives that must vanish, evaluated in double at the rows as they are stored, and the size of the steps.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "mechanics/conserved.h"
#include "report/scene.h"
#include "result/run_file.h"
#include "setup/scenario.h"

namespace anholon {

struct PlotColumn {
  std::string name, math, unit, group;  // math: MathML of the name; group empty: for the picture only
  std::vector<double> t, values;        // t empty: the common times
};

struct PlotGroup {
  std::string id, title;
  bool log = false;
};

struct PlotData {
  std::vector<double> t;
  std::size_t rows = 0, shown = 0;
  std::vector<PlotColumn> columns;
  std::vector<PlotGroup> groups;  // those that have columns
  std::size_t left_out = 0;       // columns that are not plotted, there being too many
  // Rows for the picture, where the columns above have lost theirs: times, and values by column.
  std::vector<double> frame_t;
  std::map<int, std::vector<double>> frames;
};

// The place in the table of a symbol of the model: -1 the time, none if the run does not hold it.
ColumnOf column_of(const Model& model, const RunTable& table);

// The values of an expression at the rows of a run, with the modes that events had set; false if it needs what the run
// does not hold.
bool at_rows(const Model& model, const RunFile& run, Expr e, std::vector<double>& values);

PlotData plot_data(Workspace& scenario, const std::vector<Conserved>& conserved, const RunFile& run,
                   const Scene& scene);

// At most about `most` of the rows: of each stretch the least and the greatest, of all the first and the last, and
// every gap.
std::vector<std::size_t> keep_extremes(const std::vector<double>& values, std::size_t most);

// The numbers as little-endian doubles, in base64.
std::string packed(const std::vector<double>& values);

}  // namespace anholon

// The columns that a page plots: those of the run in groups, and derived ones; and the few rows that show everything.
//
// The derived columns are kinetic energy, potentials and integrals of the motion, the constraints with their
// derivatives that must vanish, evaluated in double at the stored rows, and the step size.
#pragma once
#include <map>
#include <string>
#include <vector>

#include "mechanics/conserved.h"
#include "report/plot_groups.h"
#include "report/scene.h"
#include "result/run_file.h"
#include "setup/scenario.h"

namespace anholon {

struct PlotData {
  std::vector<double> t;
  std::size_t rows = 0, shown = 0;
  std::vector<PlotColumn> columns;
  std::vector<PlotGroup> groups;  // groups that have columns
  std::size_t left_out = 0;       // number of columns that are not plotted because there are too many
  // Rows for the picture, if the columns above are reduced: times, and values by column.
  std::vector<double> frame_t;
  std::map<int, std::vector<double>> frames;
  // A warning about the picture: its rows are too few for the motion; otherwise empty.
  std::string caution;
  bool rough = false;  // the rows are so few that paths would be wrong
};

// Returns the formula of a column of a run: its symbol in LaTeX or MathML, in the notation of the model. It may build
// expressions in the graph of the model.
std::string column_formula(const Model& model, const RunColumn& column, Format format);

// The index in the table of a symbol of the model: -1 for the time, nullopt if the run does not contain the symbol.
ColumnOf column_of(const Model& model, const RunTable& table);

// Computes the values of an expression at the rows of a run, with the modes set by events; returns false if the run
// does not contain a required symbol.
bool at_rows(const Model& model, const RunFile& run, Expr e, std::vector<double>& values);

// `chosen`: the names of the columns of the run that are plotted; empty: as many as there is room for.
PlotData plot_data(Workspace& scenario, const std::vector<Conserved>& conserved, const RunFile& run, const Scene& scene,
                   const std::vector<std::string>& chosen = {});

// The number of rows of a drawn motion: as many as a page can contain without reduction.
int rows_to_look_at(std::size_t coordinates, std::size_t constraints);

// The numbers as little-endian doubles, in base64.
std::string packed(const std::vector<double>& values);
// The numbers in single precision, in base64 after "f:": for pictures alone.
std::string packed_for_pictures(const std::vector<double>& values);

}  // namespace anholon

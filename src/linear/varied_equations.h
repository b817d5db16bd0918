// The equations of a scenario with their derivatives by all entries in them, made once for all states and parameters.
#pragma once
#include "linear/linear_model.h"

namespace anholon {

// The varied equations. REQUIRES: the precision of the thread is that at the construction.
struct VariedEquations {
  // Inputs and outputs whose rates the linear model would need are left out, with a note.
  VariedEquations(Workspace& of, Signals wanted);

  struct Entry {
    std::size_t variable;
    int order;
  };
  struct Partial {
    std::size_t row, column;  // rows: E_i^(k), then outputs; columns: entries, then inputs
  };
  std::size_t entry(std::size_t variable, int order) const { return first[variable] + static_cast<std::size_t>(order); }
  bool leading(std::size_t e) const { return entries[e].order == scenario.structure.d[entries[e].variable]; }
  std::string entry_name(std::size_t e) const;

  const Scenario& scenario;
  Signals signals;
  std::vector<std::string> notes;
  std::vector<Entry> entries;                     // x_j^(k), k <= d_j
  std::vector<std::size_t> first;                 // the first entry of each variable
  std::vector<std::pair<std::size_t, int>> rows;  // E_i^(k), k <= c_i
  std::vector<Partial> partials;
  Tape tape;       // values of the rows, outputs, then the partial derivatives
  OneSided sides;  // sides of the rows and outputs
};

}  // namespace anholon

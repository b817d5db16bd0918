#include "observe/rows/quad_row.h"

#include <algorithm>

#include "integrate/motion_state.h"

namespace anholon {

QuadRow::QuadRow(Workspace& s, int highest, int stages)
    : s_(s), highest_(highest), stages_(stages), outputs_(s, parameter_values<Quad>(*s.model)) {}

bool QuadRow::see(const Expansion<long double>& point, std::vector<long double>& values) {
  // What an event has set is known in long double alone.
  std::vector<Quad> parameters = parameter_values<Quad>(*s_.model);
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (s_.model->parameters[i].mode) parameters[i] = convert<Quad>(point.parameters()[i]);
  std::vector<long double> narrow;
  std::vector<Quad> state, leading, row;
  point.state(narrow);
  convert_all(narrow, state);
  point.leading(narrow);
  convert_all(narrow, leading);
  Expansion<Quad> here(point.program(), parameters, std::max(1, stages_));
  here.load(convert<Quad>(point.time()), state, leading);
  if (!here.prepare().ok() || !here.project().ok() || !here.solve().ok()) return false;
  if (stages_ > 0 && !here.extend().ok()) return false;
  outputs_.set_parameters(parameters);
  outputs_.see(here);
  row_values(s_, highest_, here, outputs_, row);
  convert_all(row, values);
  return true;
}

}  // namespace anholon

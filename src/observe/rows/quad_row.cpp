#include "observe/rows/quad_row.h"

#include <algorithm>
#include <cmath>

#include "integrate/motion_state.h"

namespace anholon {

QuadRow::QuadRow(Workspace& s, int highest, int stages)
    : s_(s), highest_(highest), stages_(stages), parameters_(parameter_values<Quad>(*s.model)) {}

// Solves with the factors of J in long double: each iteration gains the digits of long double.
bool QuadRow::solve(const Expansion<long double>& point) {
  // The values that an event has set are known in long double only.
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (s_.model->parameters[i].mode) parameters_[i] = convert<Quad>(point.parameters()[i]);
  std::vector<long double> narrow, narrow_y;
  std::vector<Quad> state, leading;
  point.state(narrow);
  convert_all(narrow, state);
  point.leading(narrow);
  convert_all(narrow, leading);
  here_.emplace(point.program(), parameters_, std::max(1, stages_));
  here_->load(convert<Quad>(point.time()), state, leading);
  here_->evaluate();
  here_->adopt_jacobian(point.system_jacobian());
  const auto solver = [&](const std::vector<Quad>& r, std::vector<Quad>& y) {
    convert_all(r, narrow);
    point.system_jacobian().solve(narrow, narrow_y);
    convert_all(narrow_y, y);
  };
  if (!here_->project(solver).ok() || !here_->solve(solver).ok()) return false;
  differences_.clear();
  for (std::size_t j = 0; j < point.program().unknowns(); ++j) {
    const int d = point.program().d[j];
    differences_.push_back(std::abs(to_double(Quad(here_->derivative(j, d) - convert<Quad>(point.derivative(j, d))))));
  }
  return true;
}

bool QuadRow::values(std::vector<long double>& values) {
  if (stages_ > 0 && !(here_->prepare().ok() && here_->extend().ok())) return false;
  if (!outputs_) outputs_.emplace(s_, parameters_);
  outputs_->set_parameters(parameters_);
  outputs_->see(*here_);
  std::vector<Quad> row;
  row_values(s_, highest_, *here_, *outputs_, row);
  convert_all(row, values);
  return true;
}

}  // namespace anholon

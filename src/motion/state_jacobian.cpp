#include "motion/state_jacobian.h"

#include <cmath>
#include <limits>

#include "expr/diff.h"
#include "numeric/linear.h"
#include "tape/bind.h"

namespace anholon {

StateJacobian::StateJacobian(Workspace& s)
    : unknowns_(s.system.size()), states_(0), parameters_(s.model->parameters.size()) {
  Graph& g = *s.model->graph;
  std::vector<std::size_t> first;
  Column columns, leading;
  for (std::size_t j = 0; j < unknowns_; ++j) {
    first.push_back(states_);
    for (int k = 0; k < s.structure.d[j]; ++k, ++states_)
      columns.push_back(s.system.symbol(j, static_cast<unsigned>(k)));
    leading.push_back(s.system.symbol(j, static_cast<unsigned>(s.structure.d[j])));
  }
  columns.insert(columns.end(), leading.begin(), leading.end());
  for (std::size_t p = 0; p < parameters_; ++p) columns.push_back(g.parameter(static_cast<std::uint32_t>(p)));
  Column es;
  for (std::size_t i = 0; i < unknowns_; ++i) {
    const Expr e = total_derivative(s.system.equations[i], static_cast<unsigned>(s.structure.c[i]));
    const Column d = gradient(e, columns);
    for (std::size_t c = 0; c < d.size(); ++c) {
      if (is_zero(d[c])) continue;
      partials_.push_back({i, c});
      es.push_back(d[c]);
    }
  }
  tape_ = compile(es);
  for (const Input& in : tape_.inputs) {
    const Node& n = g.node(in.symbol);
    const auto j = s.system.variable(in.symbol);
    if (n.kind == Kind::time)
      inputs_.push_back({Place::Kind::time, 0});
    else if (j && static_cast<int>(n.order) < s.structure.d[*j])
      inputs_.push_back({Place::Kind::state, first[*j] + n.order});
    else if (j && static_cast<int>(n.order) == s.structure.d[*j])
      inputs_.push_back({Place::Kind::leading, *j});
    else
      inputs_.push_back({Place::Kind::none, 0});  // multipliers of redundant constraints
  }
}

StateJacobian::Derivatives StateJacobian::at(double t, const std::vector<double>& state,
                                             const std::vector<double>& leading,
                                             const std::vector<double>& parameters) const {
  Machine<double> machine(tape_, 0, parameters);
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const Place& p = inputs_[i];
    machine.series(tape_.inputs[i].slot)[0] = p.kind == Place::Kind::time      ? t
                                              : p.kind == Place::Kind::state   ? state[p.index]
                                              : p.kind == Place::Kind::leading ? leading[p.index]
                                                                               : 0;
  }
  machine.evaluate();
  Matrix<double> of_leading(unknowns_, unknowns_), others(unknowns_, states_ + parameters_);
  for (std::size_t k = 0; k < partials_.size(); ++k) {
    const auto [row, column] = partials_[k];
    const double value = machine.value(k);
    if (column < states_)
      others(row, column) = -value;
    else if (column < states_ + unknowns_)
      of_leading(row, column - states_) = value;
    else
      others(row, column - unknowns_) = -value;
  }
  Derivatives out{states_, parameters_, {}, {}};
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  out.by_state.assign(unknowns_ * states_, nothing);
  out.by_parameter.assign(unknowns_ * parameters_, nothing);
  Lu<double> lu;
  if (!lu.factor(of_leading)) return out;
  std::vector<double> b(unknowns_), x;
  for (std::size_t c = 0; c < states_ + parameters_; ++c) {
    for (std::size_t i = 0; i < unknowns_; ++i) b[i] = others(i, c);
    lu.solve(b, x);
    for (std::size_t j = 0; j < unknowns_; ++j)
      (c < states_ ? out.by_state[j * states_ + c] : out.by_parameter[j * parameters_ + c - states_]) = x[j];
  }
  return out;
}

}  // namespace anholon

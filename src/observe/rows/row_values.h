// The contents of a row: its columns by name and kind, and their values at a point of a motion.
#pragma once
#include <map>

#include "result/columns.h"
#include "setup/outputs/redundant.h"

namespace anholon {

// The units of columns by name, as far as the model has them.
std::map<std::string, std::string> column_units(const Model& model);

// The columns of a row after t: derivatives of the coordinates up to order `highest`, multipliers with their
// derivatives, inputs, states, reactions, monitors. `highest`: the highest derivative of any coordinate that is solved
// for.
std::vector<RunColumn> columns_after_time(const Scenario& scenario, int highest);
// The columns of a row with t.
std::vector<RunColumn> run_columns(const Scenario& scenario, int highest);

// Computes the numbers of the columns after t at a point. `outputs` has the multipliers, reactions and monitors there.
template <Number W, class Point, class Outputs>
void row_values(const Scenario& s, int highest, const Point& here, const Outputs& outputs, std::vector<W>& values) {
  const std::size_t n = s.system.coordinates;
  values.clear();
  for (int k = 0; k <= highest; ++k)
    for (std::size_t a = 0; a < n; ++a) values.push_back(here.derivative(a, k));
  for (int k = 0; k <= multiplier_orders(s); ++k)
    for (std::size_t r = 0; r < s.model->constraints.size(); ++r) {
      const auto j = s.system.variable(s.mechanics->lambda[r].id);
      values.push_back(k == 0 ? outputs.multiplier(r) : j ? here.derivative(*j, k) : W(0));
    }
  for (std::size_t j = s.system.mechanical(); j < s.system.size(); ++j) values.push_back(here.derivative(j, 0));
  for (std::size_t a = 0; a < n; ++a) values.push_back(outputs.reaction(a));
  for (std::size_t i = 0; i < s.model->monitors.size(); ++i) values.push_back(outputs.monitor(i));
}
template <Number W, class Outputs>
std::vector<W> row_values(const Scenario& s, int highest, const Expansion<W>& here, const Outputs& outputs) {
  std::vector<W> values;
  row_values(s, highest, here, outputs, values);
  return values;
}

// The columns of a row that are not derivatives of unknowns, as a list of expressions: the reactions N, the monitors,
// and further numbers that are watched. Monitors and further numbers are each followed by their terms, if they are
// sums.
struct RowExpressions {
  RowExpressions(const Scenario& scenario, const Column& further);
  struct Sum {
    std::size_t at;               // the place of the number in `all`; its terms follow
    std::vector<double> weights;  // the magnitudes of the coefficients of the terms; empty if the number is no sum
  };
  Column all;
  std::vector<Sum> monitors, further;

  // The sum of the magnitudes of the terms; value(k): the value of expression k.
  template <Number N, class F>
  static N terms(const Sum& s, F value) {
    if (s.weights.empty()) return abs(N(value(s.at)));
    N sum(0);
    for (std::size_t k = 0; k < s.weights.size(); ++k) sum += N(s.weights[k]) * abs(N(value(s.at + 1 + k)));
    return sum;
  }
};

// The values of these expressions at a point, without the residuals that a Watch computes.
template <Number W>
class RowOutputs {
 public:
  RowOutputs(Workspace& scenario, const std::vector<W>& parameters);
  void see(const Expansion<W>& point);
  void set_parameters(const std::vector<W>& parameters) {
    outputs_.set_parameters(parameters);
    redundant_.set_parameters(parameters);
  }

  const W& multiplier(std::size_t constraint) const { return multipliers_[constraint]; }
  const W& reaction(std::size_t coordinate) const { return outputs_[coordinate]; }
  const W& monitor(std::size_t i) const { return outputs_[expressions_.monitors[i].at]; }
  // The sum of the magnitudes of a monitor's terms: a difference of large terms has no smaller error than they have.
  W monitor_terms(std::size_t i) const;

 private:
  RowExpressions expressions_;
  OutputTape<W> outputs_;
  Redundant<W> redundant_;
  std::vector<W> multipliers_;
};

extern template class RowOutputs<long double>;
extern template class RowOutputs<Quad>;
extern template class RowOutputs<Multi>;

}  // namespace anholon

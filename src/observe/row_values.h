// What a row holds: its columns by name and kind, and their values at a point of a motion.
#pragma once
#include <map>

#include "result/columns.h"
#include "setup/redundant.h"

namespace anholon {

// Units of columns by name, where the model names them.
std::map<std::string, std::string> column_units(const Model& model);

// The columns of a row after t: derivatives of the coordinates up to order `highest`, multipliers with their derivatives,
// inputs, states, reactions, monitors. `highest` is the highest derivative that is solved for of any coordinate.
std::vector<RunColumn> columns_after_time(const Scenario& scenario, int highest);
// The same after t.
std::vector<RunColumn> run_columns(const Scenario& scenario, int highest);

// The numbers of the columns after t at a point. `outputs` knows multipliers, reactions and monitors there.
template <Number W, class Outputs>
std::vector<W> row_values(const Scenario& s, int highest, const Expansion<W>& here, const Outputs& outputs) {
  const std::size_t n = s.system.coordinates;
  std::vector<W> values;
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
  return values;
}

// What of a row is no derivative of an unknown, without the residuals that a Watch computes beside it.
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
  const W& monitor(std::size_t i) const { return outputs_[reactions_ + monitors_[i].value]; }
  // The sum of the magnitudes of what a monitor is the sum of: a difference of large terms is known no better than they
  // are.
  W monitor_terms(std::size_t i) const;

 private:
  struct MonitorPlace {
    std::size_t value = 0;   // its terms follow
    std::vector<W> weights;  // of the terms
  };
  Column expressions();

  const Scenario& s_;
  std::size_t reactions_ = 0;
  std::vector<MonitorPlace> monitors_;
  OutputTape<W> outputs_;
  Redundant<W> redundant_;
  std::vector<W> multipliers_;
};

extern template class RowOutputs<long double>;
extern template class RowOutputs<Quad>;
extern template class RowOutputs<Multi>;

}  // namespace anholon

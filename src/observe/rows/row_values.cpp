#include "observe/rows/row_values.h"

#include <cmath>

namespace anholon {

// Returns the unit of the derivative of this order.
static std::string rate(const std::string& unit, unsigned order) {
  if (order == 0) return unit;
  const std::string over = order == 1 ? "s" : "s^" + std::to_string(order);
  if (unit == "1") return "1/" + over;
  return (unit.find_first_of(" */") == std::string::npos ? unit : "(" + unit + ")") + "/" + over;
}

std::map<std::string, std::string> column_units(const Model& model) {
  constexpr unsigned kHighest = 12;  // derivative of a column
  std::map<std::string, std::string> units;
  for (std::size_t i = 0; i < model.coordinate_units.size() && i < model.coordinates.size(); ++i) {
    const std::string& unit = model.coordinate_units[i];
    if (unit.empty()) continue;
    for (unsigned k = 0; k <= kHighest; ++k)
      units[derivative_name(model.coordinates[i].name, k, Format::text)] = rate(unit, k);
  }
  if (!units.empty()) units["t"] = "s";
  for (const OutputQuantity& o : model.outputs)
    for (const Monitor& m : model.monitors)
      if (!o.unit.empty() && (m.name == o.name || (o.values.size() == 3 && m.name.rfind(o.name + ".", 0) == 0)))
        units[m.name] = o.unit;
  for (const OutputQuantity& o : model.outputs)
    for (const StateVariable& z : model.states)
      if (z.name == o.name) units[z.name] = o.unit;
  return units;
}

std::vector<RunColumn> columns_after_time(const Scenario& s, int highest) {
  const Model& model = *s.model;
  constexpr ColumnKind kByOrder[] = {ColumnKind::coordinate, ColumnKind::velocity, ColumnKind::acceleration,
                                     ColumnKind::higher_derivative};
  const std::map<std::string, std::string> units = column_units(model);
  std::vector<RunColumn> columns;
  const auto add = [&](std::string name, ColumnKind kind, std::size_t index, unsigned order = 0) {
    const auto unit = units.find(name);
    columns.push_back({std::move(name), kind, index, order, unit == units.end() ? "" : unit->second});
  };
  for (unsigned k = 0; static_cast<int>(k) <= highest; ++k)
    for (std::size_t a = 0; a < model.coordinates.size(); ++a)
      add(derivative_name(model.coordinates[a].name, k, Format::text), kByOrder[std::min(k, 3U)], a, k);
  for (unsigned k = 0; static_cast<int>(k) <= multiplier_orders(s); ++k)
    for (std::size_t r = 0; r < model.constraints.size(); ++r)
      add(derivative_name(multiplier_name(model, r), k, Format::text),
          k > 0                     ? ColumnKind::multiplier_rate
          : model.constraints[r].by ? ColumnKind::input
                                    : ColumnKind::multiplier,
          r, k);
  for (std::size_t z = 0; z < model.states.size(); ++z) add(model.states[z].name, ColumnKind::state, z);
  for (std::size_t a = 0; a < model.coordinates.size(); ++a)
    add("N." + model.coordinates[a].name, ColumnKind::reaction, a);
  for (std::size_t i = 0; i < model.monitors.size(); ++i) add(model.monitors[i].name, ColumnKind::monitor, i);
  return columns;
}

std::vector<RunColumn> run_columns(const Scenario& s, int highest) {
  std::vector<RunColumn> columns = columns_after_time(s, highest);
  const std::map<std::string, std::string> units = column_units(*s.model);
  const auto unit = units.find("t");
  columns.insert(columns.begin(), {"t", ColumnKind::time, 0, 0, unit == units.end() ? "" : unit->second});
  return columns;
}

RowExpressions::RowExpressions(const Scenario& s, const Column& others) {
  const Model& model = *s.model;
  Graph& g = *model.graph;
  all = put_masses(model, s.mechanics->N);
  const auto add = [&](Expr e) {
    Sum sum{all.size(), {}};
    all.push_back(e);
    if (g.node(e.id).kind == Kind::sum)
      for (const Term& t : g.summands(e.id)) {
        all.push_back({&g, t.node});
        sum.weights.push_back(std::abs(from_rational<double>(g.rational(t.weight))));
      }
    return sum;
  };
  for (const Monitor& m : model.monitors) monitors.push_back(add(m.value));
  for (const Expr& e : others) further.push_back(add(e));
}

template <Number W>
RowOutputs<W>::RowOutputs(Workspace& s, const std::vector<W>& parameters)
    : expressions_(s, {}), outputs_(s, expressions_.all, parameters), redundant_(s, parameters) {}

template <Number W>
void RowOutputs<W>::see(const Expansion<W>& point) {
  outputs_.evaluate(point);
  multipliers_ = redundant_.multipliers(point);
}

template <Number W>
W RowOutputs<W>::monitor_terms(std::size_t i) const {
  return RowExpressions::terms<W>(expressions_.monitors[i], [&](std::size_t k) -> const W& { return outputs_[k]; });
}

template class RowOutputs<long double>;
template class RowOutputs<Quad>;
template class RowOutputs<Multi>;

}  // namespace anholon

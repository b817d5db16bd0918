#include "observe/row_values.h"

namespace anholon {

const char* name(ColumnKind kind) {
  switch (kind) {
  case ColumnKind::coordinate:
    return "coordinates";
  case ColumnKind::velocity:
    return "velocities";
  case ColumnKind::acceleration:
    return "accelerations";
  case ColumnKind::higher_derivative:
    return "higher derivatives";
  case ColumnKind::multiplier:
    return "multipliers";
  case ColumnKind::multiplier_rate:
    return "rates of multipliers";
  case ColumnKind::input:
    return "inputs";
  case ColumnKind::state:
    return "states";
  case ColumnKind::reaction:
    return "reactions";
  case ColumnKind::monitor:
    return "monitors";
  case ColumnKind::event_time:
    return "times of events";
  }
  return "";
}

std::vector<RowColumn> row_columns(const Scenario& s, int highest) {
  const Model& model = *s.model;
  constexpr ColumnKind kByOrder[] = {ColumnKind::coordinate, ColumnKind::velocity, ColumnKind::acceleration,
                                     ColumnKind::higher_derivative};
  std::vector<RowColumn> columns;
  for (int k = 0; k <= highest; ++k)
    for (const Coordinate& c : model.coordinates)
      columns.push_back({derivative_name(c.name, static_cast<unsigned>(k), Format::text), kByOrder[std::min(k, 3)]});
  for (int k = 0; k <= multiplier_orders(s); ++k)
    for (std::size_t r = 0; r < model.constraints.size(); ++r)
      columns.push_back({derivative_name(multiplier_name(model, r), static_cast<unsigned>(k), Format::text),
                         k > 0                     ? ColumnKind::multiplier_rate
                         : model.constraints[r].by ? ColumnKind::input
                                                   : ColumnKind::multiplier});
  for (const StateVariable& z : model.states) columns.push_back({z.name, ColumnKind::state});
  for (const Coordinate& c : model.coordinates) columns.push_back({"N." + c.name, ColumnKind::reaction});
  for (const Monitor& m : model.monitors) columns.push_back({m.name, ColumnKind::monitor});
  return columns;
}

template <Number W>
RowOutputs<W>::RowOutputs(Workspace& s, const std::vector<W>& parameters)
    : s_(s), outputs_(s, expressions(), parameters), redundant_(s, parameters) {}

// N, then the monitors, each followed by its terms where it is a sum.
template <Number W>
Column RowOutputs<W>::expressions() {
  const Model& model = *s_.model;
  Graph& g = *model.graph;
  Column es = put_masses(model, s_.mechanics->N);
  reactions_ = es.size();
  for (const Monitor& m : model.monitors) {
    MonitorPlace place{es.size() - reactions_, {}};
    es.push_back(m.value);
    if (g.node(m.value.id).kind == Kind::sum)
      for (const Term& t : g.summands(m.value.id))
        es.push_back({&g, t.node}), place.weights.push_back(abs(from_rational<W>(g.rational(t.weight))));
    monitors_.push_back(std::move(place));
  }
  return es;
}

template <Number W>
void RowOutputs<W>::see(const Expansion<W>& point) {
  outputs_.evaluate(point);
  multipliers_ = redundant_.multipliers(point);
}

template <Number W>
W RowOutputs<W>::monitor_terms(std::size_t i) const {
  const MonitorPlace& m = monitors_[i];
  if (m.weights.empty()) return abs(monitor(i));
  W sum(0);
  for (std::size_t k = 0; k < m.weights.size(); ++k) sum += m.weights[k] * abs(outputs_[reactions_ + m.value + 1 + k]);
  return sum;
}

template class RowOutputs<long double>;
template class RowOutputs<Quad>;
template class RowOutputs<Multi>;

}  // namespace anholon

#include "linear/varied_equations.h"

#include "expr/derivatives/point_gradient.h"

namespace anholon {

VariedEquations::VariedEquations(Workspace& of, Signals wanted) : scenario(of), signals(std::move(wanted)) {
  const Graph& g = *scenario.model->graph;
  notes = signals.notes;
  Column columns, es;
  for (std::size_t j = 0; j < scenario.system.size(); ++j) {
    first.push_back(entries.size());
    for (int k = 0; k <= scenario.structure.d[j]; ++k) {
      entries.push_back({j, k});
      columns.push_back(scenario.system.symbol(j, static_cast<unsigned>(k)));
    }
  }
  for (std::size_t i = 0; i < scenario.system.size(); ++i)
    for (int k = 0; k <= scenario.structure.c[i]; ++k) {
      rows.push_back({i, k});
      es.push_back(total_derivative(scenario.system.equations[i], static_cast<unsigned>(k)));
    }
  // An input on which an equation depends that is differentiated would enter with its rate.
  for (std::size_t u = signals.u.size(); u-- > 0;) {
    std::optional<std::size_t> in;
    for (std::size_t r = 0; r < rows.size() && !in; ++r)
      if (rows[r].second < scenario.structure.c[rows[r].first] && !is_zero(partial(es[r], signals.u[u])))
        in = rows[r].first;
    if (!in) continue;
    notes.push_back("the input '" + signals.inputs[u] + "' stands in " +
                    (*in < scenario.system.coordinates
                         ? "the equation of motion of '" + scenario.system.equation_names[*in] +
                               "', which is differentiated, as a constraint asks for derivatives of accelerations"
                         : std::string("a constraint that holds at every time")) +
                    ": its rate would be an input, too; it is left out");
    signals.u.erase(signals.u.begin() + static_cast<std::ptrdiff_t>(u));
    signals.inputs.erase(signals.inputs.begin() + static_cast<std::ptrdiff_t>(u));
  }
  for (std::size_t y = signals.y.size(); y-- > 0;) {
    bool beyond = false;
    for (NodeId id : symbols({&signals.y[y], 1}))
      if (const auto j = scenario.system.variable(id)) beyond = beyond || g.node(id).order > scenario.structure.d[*j];
    if (!beyond) continue;
    notes.push_back("the output '" + signals.outputs[y] +
                    "' holds derivatives beyond those of the equations; it is left out");
    signals.y.erase(signals.y.begin() + static_cast<std::ptrdiff_t>(y));
    signals.outputs.erase(signals.outputs.begin() + static_cast<std::ptrdiff_t>(y));
  }
  columns.insert(columns.end(), signals.u.begin(), signals.u.end());
  const Column outputs = put_masses(*scenario.model, signals.y);
  es.insert(es.end(), outputs.begin(), outputs.end());
  const std::size_t values = es.size();
  sides = {es, columns, scenario.model->parameters.size()};
  for (std::size_t r = 0; r < values; ++r) {
    const Column d = point_gradient(es[r], columns, AtKinks::no_value);
    for (std::size_t c = 0; c < d.size(); ++c) {
      if (is_zero(d[c])) continue;
      partials.push_back({r, c});
      es.push_back(d[c]);
    }
  }
  tape = compile(es);
}

std::string VariedEquations::entry_name(std::size_t e) const {
  return derivative_name(scenario.system.variable_names[entries[e].variable], static_cast<unsigned>(entries[e].order),
                         Format::text);
}

}  // namespace anholon

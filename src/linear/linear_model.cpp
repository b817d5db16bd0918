#include "linear/linear_model.h"

#include <algorithm>

#include "linear/linear_point.h"
#include "linear/steadiness.h"
#include "numeric/more_digits.h"

namespace anholon {

const char* name(LinearModel::Motion motion) {
  switch (motion) {
  case LinearModel::Motion::equilibrium:
    return "equilibrium";
  case LinearModel::Motion::steady:
    return "steady";
  case LinearModel::Motion::unsteady:
    return "unsteady";
  case LinearModel::Motion::unchecked:
    return "unchecked";
  }
  return "";
}

Linearizer::Linearizer(Workspace& scenario, const StateChoice& choice, Signals signals)
    : s_(scenario), choice_(choice), signals_(std::move(signals)), mass_(mass_matrix(*scenario.mechanics)) {
  const Graph& g = *s_.model->graph;
  notes_ = signals_.notes;
  Column columns, es;
  for (std::size_t j = 0; j < s_.system.size(); ++j) {
    first_.push_back(entries_.size());
    for (int k = 0; k <= s_.structure.d[j]; ++k) {
      entries_.push_back({j, k});
      columns.push_back(s_.system.symbol(j, static_cast<unsigned>(k)));
    }
  }
  for (std::size_t i = 0; i < s_.system.size(); ++i)
    for (int k = 0; k <= s_.structure.c[i]; ++k) {
      rows_.push_back({i, k});
      es.push_back(total_derivative(s_.system.equations[i], static_cast<unsigned>(k)));
    }
  // An input on which a hidden constraint depends would enter with its rate.
  for (std::size_t u = signals_.u.size(); u-- > 0;) {
    bool hidden = false;
    for (std::size_t r = 0; r < rows_.size(); ++r)
      hidden = hidden || (rows_[r].second < s_.structure.c[rows_[r].first] && !is_zero(partial(es[r], signals_.u[u])));
    if (!hidden) continue;
    notes_.push_back(
        "the input '" + signals_.inputs[u] +
        "' stands in a constraint that holds at every time: its rate would be an input, too; it is left out");
    signals_.u.erase(signals_.u.begin() + static_cast<std::ptrdiff_t>(u));
    signals_.inputs.erase(signals_.inputs.begin() + static_cast<std::ptrdiff_t>(u));
  }
  for (std::size_t y = signals_.y.size(); y-- > 0;) {
    bool beyond = false;
    for (NodeId id : symbols({&signals_.y[y], 1}))
      if (const auto j = s_.system.variable(id)) beyond = beyond || g.node(id).order > s_.structure.d[*j];
    if (!beyond) continue;
    notes_.push_back("the output '" + signals_.outputs[y] +
                     "' holds derivatives beyond those of the equations; it is left out");
    signals_.y.erase(signals_.y.begin() + static_cast<std::ptrdiff_t>(y));
    signals_.outputs.erase(signals_.outputs.begin() + static_cast<std::ptrdiff_t>(y));
  }
  columns.insert(columns.end(), signals_.u.begin(), signals_.u.end());
  const Column outputs = put_masses(*s_.model, signals_.y);
  es.insert(es.end(), outputs.begin(), outputs.end());
  const std::size_t rows = es.size();
  sides_ = {es, columns, s_.model->parameters.size()};
  for (std::size_t r = 0; r < rows; ++r) {
    const Column d = gradient(es[r], columns);
    for (std::size_t c = 0; c < d.size(); ++c) {
      if (is_zero(d[c])) continue;
      partials_.push_back({r, c});
      es.push_back(d[c]);
    }
  }
  tape_ = compile(es);
}

std::string Linearizer::entry_name(std::size_t e) const {
  return derivative_name(s_.system.variable_names[entries_[e].variable], static_cast<unsigned>(entries_[e].order),
                         Format::text);
}

static std::string text_of(const Branch& b, const SymbolNames& names) {
  const std::string condition = print(b.condition, names, Format::text);
  return b.table.empty() ? "where " + condition + " passes 0"
                         : "where " + condition + " passes a knot of the table '" + b.table + "'";
}

Outcome Linearizer::look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                                   std::vector<std::string>& rough) const {
  const Multi part = round_off(kZeroPart), near = part * (Multi(1) + largest(point.x));
  const std::size_t rows = rows_.size() + signals_.y.size();
  for (const auto& side : sides_.sides(parameters, near, [&](Machine<Multi>& m) { point.set(m); })) {
    const std::string where = text_of(sides_.branches()[side.branch], s_.model->names);
    for (std::size_t k = 0; k < side.below.size(); ++k) {
      const Multi &a = side.below[k], &b = side.above[k];
      if (!a.finite() && !b.finite()) continue;
      if (a.finite() && b.finite() && !(abs(Multi(a - b)) > part * (Multi(1) + abs(a) + abs(b)))) continue;
      const std::size_t row = k < rows ? k : sides_.partials()[k - rows].row;
      if (row >= rows_.size()) {
        rough[row - rows_.size()] = where;
        continue;
      }
      return {OutcomeKind::not_a_number,
              "the equations have no derivative at this state: the equation of " +
                  s_.system.equation_names[rows_[row].first] + " has a kink or a jump " + where,
              "linearize at a state on one side of it, --about state with other initial values, or replace min, max, "
              "abs, sign, piecewise or the table there by a smooth formula"};
    }
  }
  return {};
}

// Outputs without a derivative at the point.
static void leave_out(const std::vector<std::string>& rough, LinearModel& m) {
  for (std::size_t o = rough.size(); o-- > 0;) {
    if (rough[o].empty()) continue;
    m.notes.push_back("the output '" + m.outputs[o] + "' has a kink or a jump at this state, " + rough[o] +
                      "; it is left out");
    m.outputs.erase(m.outputs.begin() + static_cast<std::ptrdiff_t>(o));
    for (Matrix<Multi>* of : {&m.C, &m.D}) {
      Matrix<Multi> fewer(of->rows - 1, of->cols);
      for (std::size_t r = 0; r < fewer.rows; ++r)
        for (std::size_t c = 0; c < fewer.cols; ++c) fewer(r, c) = (*of)(r < o ? r : r + 1, c);
      *of = std::move(fewer);
    }
  }
}

Outcome Linearizer::at(const std::vector<Multi>& parameters, bool check, LinearModel& out) const {
  const InitialProblem<Multi> problem{s_.mechanics.get(), parameters, choice_.overrides, choice_.t, &mass_, nullptr,
                                      &s_.state};
  InitialState<Multi> state;
  if (Outcome o = consistent_state(problem, state); !o.ok()) return o;
  if (s_.routh)
    if (Outcome o = complete_state(problem, *s_.routh, s_.routh_structure, state); !o.ok()) return o;
  const Outcome singular{OutcomeKind::singular,
                         "the equations do not determine the motion at this state: it has no linear model",
                         "choose another state"};
  LinearPoint point(*this, parameters);
  point.load(state);
  if (!point.evaluate())
    return {OutcomeKind::not_a_number, "a derivative of the equations has no value at this state",
            "choose another state"};
  if (!point.choose() || !point.settle()) return singular;
  std::vector<std::string> rough(signals_.y.size());
  if (Outcome o = look_for_kinks(point, parameters, rough); !o.ok()) return o;
  point.linear(out);
  leave_out(rough, out);

  look_for_steadiness(point, check, out);
  Matrix<Multi> core(out.core.size(), out.core.size());
  for (std::size_t i = 0; i < core.rows; ++i)
    for (std::size_t k = 0; k < core.cols; ++k) core(i, k) = out.A(out.core[i], out.core[k]);
  if (!eigenvalues(core, out.spectrum))
    return {OutcomeKind::no_convergence, "the eigenvalues of A were not found",
            "ask for more digits: --digits " + std::to_string(more_digits<Multi>())};
  return {};
}

}  // namespace anholon

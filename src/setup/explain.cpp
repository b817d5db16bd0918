#include "setup/explain.h"

#include <algorithm>

#include "mechanics/work.h"
#include "structure/stage.h"

namespace anholon {

namespace {

// If there are more constraints, those that make one redundant are not searched.
constexpr std::size_t kManyConstraints = 60;

Hypothesis hypothesis(const ConstraintClass& c, int order) {
  if (order >= 2) return Hypothesis::niu;
  return order == 1 && c.kind == "nonlinear" ? Hypothesis::chetaev : Hypothesis::dalembert;
}

// Returns the independent constraints without which row r would be independent as well.
std::vector<std::size_t> made_of(const Scenario& s, std::size_t r, PointValues& at) {
  const std::size_t n = s.mechanics->q.size();
  std::vector<std::size_t> out;
  if (s.independent.size() > kManyConstraints) return out;
  for (std::size_t left_out : s.independent) {
    std::vector<std::size_t> rows = s.independent;
    *std::find(rows.begin(), rows.end(), left_out) = r;
    Matrix<double> phi(rows.size(), n);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t a = 0; a < n; ++a) phi(i, a) = at(put_masses(*s.model, s.mechanics->Phi[rows[i]][a]));
    if (choose_rows(phi, kDependent).independent.size() == rows.size()) out.push_back(left_out);
  }
  return out;
}

}  // namespace

const char* name(Hypothesis h) {
  switch (h) {
  case Hypothesis::dalembert:
    return "d'Alembert-Lagrange";
  case Hypothesis::chetaev:
    return "Chetaev";
  case Hypothesis::niu:
    return "Chetaev-Niu";
  }
  return "";
}

std::vector<ConstraintFacts> constraint_facts(Workspace& s) {
  PointValues at = values_near(*s.model, parameter_values<double>(*s.model), s.state);
  std::vector<ConstraintFacts> list;
  for (std::size_t r = 0; r < s.classes.size(); ++r) {
    ConstraintFacts c{hypothesis(s.classes[r], s.mechanics->order[r]), power_factor(*s.mechanics, r), {}};
    if (s.classes[r].redundant) c.follows_from = made_of(s, r, at);
    list.push_back(std::move(c));
  }
  return list;
}

Explanation explain(Workspace& s) {
  Explanation x;
  x.constraints = constraint_facts(s);
  PointValues at = values_near(*s.model, parameter_values<double>(*s.model), s.state);
  std::vector<std::size_t> linear;
  for (std::size_t r = 0; r < s.classes.size(); ++r)
    if (s.mechanics->order[r] == 1 && x.constraints[r].hypothesis == Hypothesis::dalembert) linear.push_back(r);
  x.integrability = integrability(*s.mechanics, linear, at);
  if (!s.structure.c.empty()) {
    x.blocks = blocks(s.structure);
    x.hidden = hidden_constraints(s.system, s.structure);
    const bool known = x.integrability.undecided.empty() && x.integrability.proved;
    if (known && std::all_of(x.constraints.begin(), x.constraints.end(),
                             [](const ConstraintFacts& c) { return c.hypothesis == Hypothesis::dalembert; }))
      x.accessible = s.structure.configuration_dimension - x.integrability.integrable();
  }
  return x;
}

}  // namespace anholon

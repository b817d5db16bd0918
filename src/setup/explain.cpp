#include "setup/explain.h"

#include <algorithm>

#include "mechanics/work.h"

namespace anholon {

namespace {

Hypothesis hypothesis(const ConstraintClass& c, int order) {
  if (order >= 2) return Hypothesis::niu;
  return order == 1 && c.kind == "nonlinear" ? Hypothesis::chetaev : Hypothesis::dalembert;
}

// Returns the constraints of which a redundant one is a combination.
std::vector<std::size_t> made_of(const UndeterminedMultipliers& shared, std::size_t r) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < shared.redundant.size(); ++k)
    for (std::size_t i = 0; shared.redundant[k] == r && i < shared.dependencies[k].size(); ++i)
      if (i != r && shared.dependencies[k][i] != 0) out.push_back(i);
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
  std::vector<ConstraintFacts> list;
  for (std::size_t r = 0; r < s.classes.size(); ++r) {
    ConstraintFacts c{hypothesis(s.classes[r], s.mechanics->order[r]), power_factor(*s.mechanics, r), {}};
    if (s.classes[r].redundant) c.follows_from = made_of(s.undetermined, r);
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

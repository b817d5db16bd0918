#include "formulation/formulation.h"

namespace anholon {

std::string no_obstacle(const Mechanics&) { return {}; }

std::string first_order_only(const Mechanics& M) {
  for (std::size_t r = 0; r < M.order.size(); ++r)
    if (M.order[r] > 1)
      return "the constraint '" + M.model->constraints[r].name + "' is of order " + std::to_string(M.order[r]) +
             "; this form is for constraints of order 1 (and 0)";
  return {};
}

std::string obstacle(const Formulation& form, const Mechanics& M) {
  if (form.unknowns != Unknowns::multipliers)
    for (const Constraint& c : M.model->constraints)
      if (c.by)
        return "the constraint '" + c.name + "' is kept by the input '" + M.model->controls[*c.by].name +
               "', not by an ideal reaction; this form eliminates ideal reactions";
  return form.obstacle(M);
}

std::string order_obstacle(const Formulation& form, const Mechanics& M, unsigned m) {
  const auto is_of_order = [](int order) {
    return "is of order " + std::to_string(order) + ": it is lifted to a higher order, never to a lower one";
  };
  if (form.highest_m == 0) return "its equations do not depend on an order";
  if (m > form.highest_m)
    return "its equations are of order " + std::to_string(form.highest_m) + (form.highest_m > 1 ? " at most" : "");
  if (!form.eliminates()) return {};
  for (std::size_t r = 0; r < M.order.size(); ++r)
    if (M.order[r] > static_cast<int>(m))
      return "the constraint '" + M.model->constraints[r].name + "' " + is_of_order(M.order[r]);
  if (form.unknowns == Unknowns::quasi_velocities)
    for (const QuasiVelocity& u : M.model->quasi)
      if (u.order > static_cast<int>(m)) return "the quasi-velocity '" + u.name + "' " + is_of_order(u.order);
  return {};
}

// These aliases contain a misspelling of Mićević.
constexpr std::pair<const char*, const char*> kAliases[] = {
    {"misevic-rusov", "micevic-rusov"},
    {"misevic-rusov-maggi", "micevic-rusov-maggi"},
    {"misevic-rusov-reduced", "micevic-rusov-reduced"},
    {"misevic-rusov-quasi", "micevic-rusov-quasi"},
    {"misevic-rusov-quasi-reduced", "micevic-rusov-quasi-reduced"}};

const Formulation* find_formulation(const std::string& name) {
  for (const auto& [alias, now] : kAliases)
    if (name == alias) return find_formulation(now);
  for (const Formulation* f : formulations())
    if (name == f->name) return f;
  return nullptr;
}

std::string citation(const Formulation& f) {
  return f.equation[0] ? f.equation + (" of " + std::string(f.source)) : f.source;
}

}  // namespace anholon

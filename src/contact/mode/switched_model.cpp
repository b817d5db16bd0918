#include "contact/mode/switched_model.h"

#include <algorithm>
#include <set>

#include "tape/tape.h"

namespace anholon {

std::vector<bool> constraints_that_hold(const Model& model, const std::vector<Contact>& contacts) {
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  for (const Contact& c : contacts)
    if (c.held) values.push_back(model.graph->own(c.held->active));
  const std::vector<double> numbers = evaluate_parameters<double>(*model.graph, values);
  std::vector<bool> holds;
  std::size_t k = model.parameters.size();
  for (const Contact& c : contacts) holds.push_back(c.held && numbers[k++] > 0);
  return holds;
}

std::vector<std::size_t> switching_parameters(const Model& model, const std::vector<Contact>& contacts) {
  std::set<std::size_t> found;
  std::vector<Expr> open;
  for (const Contact& c : contacts)
    if (c.held) open.push_back(c.held->active);
  while (!open.empty()) {
    const Expr e = open.back();
    open.pop_back();
    for (const NodeId id : symbols({&e, 1}))
      if (const Node& n = e.graph->node(id); n.kind == Kind::parameter && found.insert(n.index).second)
        open.push_back(model.parameters[n.index].value);
  }
  return {found.begin(), found.end()};
}

void put_constraints_that_hold(Model& model, const std::vector<Contact>& contacts) {
  Graph& g = *model.graph;
  const auto switched = [&](const std::string& constraint) {
    return std::any_of(contacts.begin(), contacts.end(),
                       [&](const Contact& c) { return c.held && c.name == constraint; });
  };
  std::erase_if(model.constraints, [&](const Constraint& c) { return switched(c.name); });
  model.names.multipliers.resize(model.constraints.size());
  const std::vector<bool> holds = constraints_that_hold(model, contacts);
  std::vector<Expr> forces;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    forces.push_back(g.zero());
    if (!holds[c]) continue;
    const Contact& held = contacts[c];
    forces.back() = g.multiplier(static_cast<std::uint32_t>(model.constraints.size()), 0);
    model.constraints.push_back({held.name, g.own(held.gap), held.held->order, held.held->equation, held.span});
    model.names.multipliers.push_back(held.name);
  }
  if (!contacts.empty() && contacts[0].forces)
    put_forces(*contacts[0].forces, forces, std::vector<std::vector<Expr>>(contacts.size()), model);
  std::erase_if(model.notes, [](const ModelNote& n) { return n.of_modes(); });
}

void put_modes(Model& model, const std::vector<Contact>& contacts, const std::vector<Rational>& modes) {
  for (std::size_t i = 0; i < model.parameters.size(); ++i)
    if (model.parameters[i].mode) model.parameters[i].value = model.graph->number(modes[i]);
  put_constraints_that_hold(model, contacts);
}

}  // namespace anholon

#include "structure/parameters_of_order.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "structure/redundancy.h"
#include "tape/bind.h"

namespace anholon {

namespace {

// True if terms may be absent: most equations of motion have accelerations of all coordinates, and c derivatives of a
// constraint of order m reach m + c.
bool may_lack_terms(const System& s, const Structure& t) {
  const auto coordinates = t.d.begin() + static_cast<std::ptrdiff_t>(s.coordinates);
  if (std::any_of(t.d.begin(), coordinates, [](int order) { return order != 2; })) return true;
  for (std::size_t k = 0; k < s.constraints.size(); ++k)
    if (s.model->constraints[s.constraints[k]].order + t.c[s.coordinates + k] > 2) return true;
  return false;
}

// Returns e in terms of the parameters that do not follow from others.
Expr in_free_parameters(const Model& model, Expr e) {
  const auto follows = [&](const Node& n) {
    return n.kind == Kind::parameter && !symbols({&model.parameters[n.index].value, 1}).empty();
  };
  for (std::size_t depth = 0; depth < model.parameters.size(); ++depth)
    e = substitute({&e, 1}, [&](NodeId id) {
      const Node& n = model.graph->node(id);
      return follows(n) ? model.parameters[n.index].value : Expr{};
    })[0];
  return e;
}

// True if the coefficient, which is 0, gets another value if these parameters change. Other symbols have random values.
bool changes(const Model& model, Expr coefficient, const std::vector<std::size_t>& parameters) {
  // The relative error of terms that cancel each other; parameters change by 1 or more.
  constexpr double kRoundOff = 1e-12;
  Column formulas;
  for (const Parameter& p : model.parameters) formulas.push_back(p.value);
  std::vector<double> values = evaluate_parameters<double>(*model.graph, formulas);
  std::mt19937_64 random(20261129);
  const auto some = [&] { return std::uniform_real_distribution<double>(0.3, 1.3)(random); };
  for (const std::size_t i : parameters) values[i] += std::max(1.0, std::abs(values[i])) * some();
  const Tape tape = compile({&coefficient, 1});
  Machine<double> machine(tape, 0, values);
  bind(machine, *model.graph, [&](const Node&, NodeId) { return some(); });
  machine.evaluate();
  return !(std::abs(machine.value(0)) < kRoundOff);
}

// Adds the parameters that change the coefficient: each of them alone, or all together.
void add_those_that_matter(const Model& model, Expr coefficient, std::set<std::size_t>& found) {
  std::vector<std::size_t> in_it;
  for (NodeId id : symbols({&coefficient, 1}))
    if (const Node& n = model.graph->node(id); n.kind == Kind::parameter) in_it.push_back(n.index);
  bool alone = false;
  for (const std::size_t i : in_it)
    if (changes(model, coefficient, {i})) found.insert(i), alone = true;
  if (!alone && changes(model, coefficient, in_it)) found.insert(in_it.begin(), in_it.end());
}

}  // namespace

std::vector<std::size_t> parameters_of_order(const Mechanics& mechanics, const Elimination& elimination,
                                             const System& system, const Structure& t) {
  const Model& model = *system.model;
  std::set<std::size_t> found;
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  const std::vector<double> parameters = evaluate_parameters<double>(*model.graph, values);
  for (std::size_t r = 0; r < mechanics.phi.size(); ++r)
    if (std::find(system.constraints.begin(), system.constraints.end(), r) == system.constraints.end() &&
        vanishes_identically(mechanics, parameters, r))
      add_those_that_matter(model, in_free_parameters(model, put_masses(model, mechanics.phi[r])), found);
  if (!may_lack_terms(system, t)) return {found.begin(), found.end()};
  const System whole = implicit_system(system.model, mechanics, *system.form, system.constraints, elimination);
  for (std::size_t i = 0; i < whole.size(); ++i)
    for (NodeId id : symbols({&whole.equations[i], 1})) {
      const auto j = whole.variable(id);
      if (!j || static_cast<int>(model.graph->node(id).order) + t.c[i] <= t.d[*j]) continue;
      const Expr coefficient = partial(whole.equations[i], Expr{model.graph.get(), id});
      if (!is_zero(coefficient)) add_those_that_matter(model, in_free_parameters(model, coefficient), found);
    }
  return {found.begin(), found.end()};
}

}  // namespace anholon

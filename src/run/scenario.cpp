#include "run/scenario.h"

#include <algorithm>

#include "expr/normal.h"

namespace anholon {

namespace {

bool all_proved_zero(const Column& es) {
  for (Expr e : es)
    if (!proved_zero(e)) return false;
  return true;
}

ConstraintClass classify_one(const Mechanics& m, std::size_t r) {
  Graph& g = m.graph();
  const int order = m.order[r];
  ConstraintClass c;
  for (NodeId id : symbols({&m.phi[r], 1})) c.rheonomic = c.rheonomic || g.node(id).kind == Kind::time;
  if (order == 0) {
    c.kind = "holonomic";
    return c;
  }
  const Column top = jets(*m.model, static_cast<unsigned>(order));
  bool linear = true;
  Expr radial = g.zero();  // q^(m) dphi/dq^(m): equals d phi for phi homogeneous of degree d
  for (std::size_t a = 0; a < top.size(); ++a) {
    if (is_zero(m.Phi[r][a])) continue;
    if (linear && !all_proved_zero(gradient(m.Phi[r][a], top))) linear = false;
    radial += top[a] * m.Phi[r][a];
  }
  for (int degree = 1; degree <= (linear ? 1 : 6) && !c.homogeneous; ++degree)
    c.homogeneous = proved_zero(radial - Rational(degree) * m.phi[r]);
  c.kind = !linear ? "nonlinear" : c.homogeneous ? "linear" : "affine";
  return c;
}

}  // namespace

std::vector<ConstraintClass> classify(const Mechanics& m) {
  std::vector<ConstraintClass> classes;
  for (std::size_t r = 0; r < m.phi.size(); ++r) classes.push_back(classify_one(m, r));
  return classes;
}

std::optional<Diagnostic> not_integrated(const Model& model, const std::vector<ConstraintClass>& classes) {
  if (!model.unknown_functions.empty())
    return Diagnostic{Severity::error, {}, "the given function '" + model.unknown_functions[0] + "' has no formula",
                      "numbers need one: [functions] " + model.unknown_functions[0] + " = \"…\""};
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    if (c.order > 2 || (c.order == 2 && classes[r].kind == "nonlinear"))
      return Diagnostic{Severity::error, c.span,
                        "the constraint '" + c.name + "' of order " + std::to_string(c.order) + " (" + classes[r].kind +
                            ") is derived and checked, but not integrated yet",
                        "orders 0 and 1, and 2 where it is linear in the accelerations, are integrated"};
  }
  return std::nullopt;
}

// Positions and velocities in the order of an Expansion's state.
template <Number N>
static std::vector<N> state_vector(const Scenario& s, const InitialState<N>& named) {
  std::vector<N> state;
  for (std::size_t j = 0; j < s.system.size(); ++j)
    for (int k = 0; k < s.structure.d[j]; ++k) {
      const bool coordinate = j < s.system.coordinates;
      state.push_back(coordinate && k == 0 ? named.q[j] : coordinate && k == 1 ? named.qd[j] : N(0));
    }
  return state;
}

Outcome regular_at_start(const Scenario& s) {
  const Program p = program(s.system, s.structure);
  const std::vector<double> state = state_vector(s, s.state);
  Expansion<double> point(p, parameter_values<double>(*s.model), 1);
  point.load(s.state.t, state, {});
  if (Outcome o = point.prepare(); !o.ok()) return o;
  if (Outcome o = point.project(); !o.ok()) return o;
  return point.solve();
}

Outcome make_scenario(std::shared_ptr<const Model> model, const Formulation& form, const StateChoice& choice,
                      Scenario& s) {
  s.model = model;
  s.mechanics = std::make_unique<Mechanics>(mechanics(*model));
  s.classes = classify(*s.mechanics);
  s.notes = model->notes;
  const std::vector<double> parameters = parameter_values<double>(*model);
  const InitialProblem<double> problem{s.mechanics.get(), parameters, choice.overrides, choice.t};
  // Without formulas for all given functions there are no numbers, but there is a structure.
  const bool numbers = model->unknown_functions.empty();
  const Outcome initial = numbers ? consistent_state(problem, s.state) : Outcome{};
  s.independent.clear();
  if (initial.ok() && numbers) {
    const RowChoice<double> rows = independent_constraints(*s.mechanics, parameters, s.state);
    s.independent = rows.independent;
    // Rows that vanish are a lost hold, not a redundancy: they stay in, and the Jacobian will tell.
    for (std::size_t r : rows.dependent)
      (std::find(rows.vanishing.begin(), rows.vanishing.end(), r) == rows.vanishing.end() ? s.redundant : s.independent)
          .push_back(r);
    std::sort(s.independent.begin(), s.independent.end());
    for (std::size_t r : s.redundant) {
      s.classes[r].redundant = true;
      s.notes.push_back("constraint '" + model->constraints[r].name +
                        "' follows from the others at the initial state: it is left out, and watched");
    }
  } else {
    for (std::size_t r = 0; r < model->constraints.size(); ++r) s.independent.push_back(r);
  }
  s.elimination = Elimination();
  if (form.eliminates()) {
    const auto at = std::make_shared<PointValues>(values_near(*model, parameters, s.state));
    s.elimination = Elimination(*s.mechanics, choose_elimination(*s.mechanics, s.independent, form.unknowns, choice.eliminate, *at), at);
  }
  s.system = implicit_system(model, *s.mechanics, form, s.independent, s.elimination);
  if (!numbers)
    s.system.equations = substitute(s.system.equations, [&](NodeId id) {
      const Node& n = model->graph->node(id);
      return n.kind == Kind::given ? model->graph->number(Rational(17 + 3 * static_cast<int>(n.index) + static_cast<int>(n.order), 19)) : Expr{};
    });
  ProbeHints hints;
  hints.t = s.state.t;
  hints.derivatives = {s.state.q, s.state.qd};
  const Outcome structured = analyse(s.system, parameters, hints, s.structure);
  if (structured.ok()) drop_absent(s.system, s.structure);
  if (!initial.ok()) return initial;
  return structured;
}

template <Number N>
Outcome initial_state(const Scenario& s, const StateChoice& choice, N& t, std::vector<N>& state,
                      InitialState<N>& named) {
  const InitialProblem<N> problem{s.mechanics.get(), parameter_values<N>(*s.model), choice.overrides, choice.t};
  if (Outcome o = consistent_state(problem, named); !o.ok()) return o;
  t = named.t;
  state = state_vector(s, named);
  return {};
}

template Outcome initial_state<double>(const Scenario&, const StateChoice&, double&, std::vector<double>&, InitialState<double>&);
template Outcome initial_state<long double>(const Scenario&, const StateChoice&, long double&, std::vector<long double>&, InitialState<long double>&);
template Outcome initial_state<Multi>(const Scenario&, const StateChoice&, Multi&, std::vector<Multi>&, InitialState<Multi>&);

}  // namespace anholon

#include "setup/scenario.h"

#include <algorithm>
#include <cmath>

#include "expr/degree.h"
#include "expr/normal.h"
#include "expr/table.h"
#include "model/exponents.h"
#include "setup/notes_on_multipliers.h"
#include "setup/start/large_angles.h"
#include "setup/start/orientations.h"
#include "structure/branch.h"
#include "structure/redundancy.h"

namespace anholon {

namespace {

bool all_proved_zero(const Column& es) {
  for (Expr e : es)
    if (!proved_zero(e)) return false;
  return true;
}

// True if e changes with one of the symbols, also by steps, which have no derivative: sign(x'), a choice by x' > 0.
bool depends_on(Expr e, const Column& on) {
  if (!all_proved_zero(gradient(e, on))) return true;
  const Graph& g = *e.graph;
  for (NodeId id : reachable({&e, 1})) {
    const Node& n = g.node(id);
    const bool steps = n.kind == Kind::select || n.kind == Kind::lookup ||
                       (n.kind == Kind::function && (n.index == static_cast<std::uint32_t>(Function::sign) ||
                                                     n.index == static_cast<std::uint32_t>(Function::abs)));
    if (!steps) continue;
    const Expr decides{e.graph, g.terms(id)[0].node};
    for (NodeId symbol : symbols({&decides, 1}))
      if (std::any_of(on.begin(), on.end(), [&](Expr x) { return x.id == symbol; })) return true;
  }
  return false;
}

ConstraintClass classify_one(const Mechanics& m, std::size_t r) {
  Graph& g = m.graph();
  const int order = m.order[r];
  ConstraintClass c;
  for (NodeId id : symbols({&m.phi[r], 1})) {
    const Kind k = g.node(id).kind;
    c.rheonomic = c.rheonomic || k == Kind::time || k == Kind::state || k == Kind::control;
  }
  if (order == 0) {
    c.kind = "holonomic";
    return c;
  }
  const Column top = jets(*m.model, static_cast<unsigned>(order));
  bool linear = true;
  Expr radial = g.zero();  // q^(m) dphi/dq^(m), which equals d phi for phi homogeneous of degree d
  for (std::size_t a = 0; a < top.size(); ++a) {
    if (is_zero(m.Phi[r][a])) continue;
    linear = linear && !depends_on(m.Phi[r][a], top);
    radial += top[a] * m.Phi[r][a];
  }
  constexpr int kMost = 6;
  const auto by_structure =
      homogeneous_degree(m.phi[r], [&](const Node& n) { return n.kind == Kind::jet && n.order == order; });
  c.homogeneous = by_structure && by_structure->is_integer() && *by_structure >= 1 && *by_structure <= kMost;
  for (int degree = 1; degree <= (linear ? 1 : kMost) && !c.homogeneous; ++degree)
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

std::optional<Diagnostic> not_integrated(const Model& model) {
  if (!model.unknown_functions.empty())
    return Diagnostic{Severity::error,
                      {},
                      "the given function '" + model.unknown_functions[0] + "' has no formula",
                      "numbers need one: [functions] " + model.unknown_functions[0] + " = \"…\""};
  for (const Control& u : model.controls)
    if (!u.value && !u.constraint)
      return Diagnostic{Severity::error, u.span,
                        "the input '" + u.name + "' has no formula, and no constraint is kept by it",
                        "[input] " + u.name + " = \"…\", or by = \"" + u.name + "\" in a constraint"};
  return std::nullopt;
}

std::vector<std::string> notes_of_redundancy(const Scenario& s) {
  const Model& m = *s.model;
  std::vector<std::string> list;
  for (const bool vanish : {true, false}) {
    std::vector<std::string> names;
    for (const std::size_t r : s.redundant)
      if (s.classes[r].vanishes == vanish) names.push_back("'" + m.constraints[r].name + "'");
    if (names.empty()) continue;
    const bool one = names.size() == 1;
    list.push_back((one ? "constraint " : "constraints ") + joined_names(names) +
                   (vanish ? one ? " vanishes identically with these values of the parameters: it is left out"
                                 : " vanish identically with these values of the parameters: they are left out"
                    : one  ? " depends on the others at the initial state: it is left out of the equations, and watched"
                           : " depend on the others at the initial state: they are left out of the equations, and "
                             "watched"));
  }
  for (const std::vector<std::size_t>& group : s.undetermined.groups())
    list.push_back(note_of_undetermined(m, s.undetermined, group, multiplier_orders(s) == 0));
  for (const NamedFormula& f : formulas_with_multipliers(m))
    if (const std::string text = note_of_formula(m, s.undetermined, s.state, f); !text.empty()) list.push_back(text);
  return list;
}

int multiplier_orders(const Scenario& s) {
  if (!s.routh) return 0;
  int highest = 0;
  for (std::size_t j = s.routh->coordinates; j < s.routh->mechanical(); ++j)
    highest = std::max(highest, s.routh_structure.d[j]);
  return highest;
}

int largest_order(const Scenario& s, const std::vector<int>& d) {
  return *std::max_element(d.begin(), d.begin() + static_cast<std::ptrdiff_t>(s.system.coordinates));
}

int orders_beyond(const Scenario& s, const std::vector<int>& d) {
  int beyond = 0;
  const int coordinates = largest_order(s, d), multipliers = multiplier_orders(s);
  for (std::size_t j = 0; j < s.system.mechanical(); ++j)
    beyond = std::max(beyond, (j < s.system.coordinates ? coordinates : multipliers) - d[j]);
  return beyond;
}

// Returns the start that the system's form needs, from the named values.
template <Number N>
static Start<N> start_of(const Scenario& s, const InitialState<N>& named) {
  // The multipliers of a variational principle are not those of the reactions.
  const bool reactions = s.system.form->unknowns != Unknowns::variational;
  const auto value = [&](std::size_t j, int k) {
    if (j >= s.system.coordinates && j < s.system.mechanical() && !reactions) return N(0);
    const N* known = named.value(s.system.symbol_node(j, static_cast<unsigned>(k)));
    return known ? *known : N(0);
  };
  Start<N> start;
  start.t = named.t;
  for (std::size_t j = 0; j < s.system.size(); ++j) {
    for (int k = 0; k < s.structure.d[j]; ++k) start.state.push_back(value(j, k));
    if (s.routh) start.leading.push_back(value(j, s.structure.d[j]));
  }
  return start;
}

Start<double> start_of(const Scenario& s) { return start_of(s, s.state); }

ProbeHints hints_at(const InitialState<double>& state) {
  ProbeHints hints;
  if (state.q.empty()) return hints;
  hints.t = state.t;
  hints.derivatives = {state.q, state.qd};
  hints.states = state.states;
  for (const Level<double>& level : state.higher) hints.derivatives.push_back(level.value);
  return hints;
}

// Chooses independent constraints at the state; those that follow from them are left out.
static void choose_constraints(const std::vector<double>& parameters, Scenario& s) {
  IndependentConstraints rows = independent_constraints(*s.mechanics, parameters, s.state);
  s.undetermined = undetermined_multipliers(*s.mechanics, parameters, s.state, rows);
  s.independent = std::move(rows.independent);
  s.redundant = std::move(rows.redundant);
  for (std::size_t r : rows.vanishing) s.classes[r].vanishes = true;
  for (std::size_t r : s.redundant) s.classes[r].redundant = true;
}

// Refuses a start with a number beyond double, a deformed body, or a negative mass.
static Outcome admissible(const Model& model, const std::vector<double>& parameters,
                          const InitialState<double>& state) {
  for (std::size_t a = 0; a < state.q.size(); ++a)
    for (const unsigned k : {0U, 1U})
      if (!is_finite(k ? state.qd[a] : state.q[a]))
        return {OutcomeKind::not_a_number,
                "at the start " + derivative_name(model.coordinates[a].name, k, Format::text) +
                    " has no value in double precision",
                "give another initial value, or choose units in which it is of moderate size"};
  PointValues at = values_near(model, parameters, state);
  if (Outcome o = oriented(model, at); !o.ok()) return o;
  for (const VaryingMass& m : model.masses) {
    if (m.weight || jet_order(m.value) > 1) continue;
    if (const double value = at(m.value); value < 0)
      return {OutcomeKind::negative_mass, "the mass of '" + m.name + "' is " + number_text(value, 6) + " at the start",
              "a mass is not negative: start at another time or place, or change its formula"};
  }
  return {};
}

// Completes the state with Routh's equations, which contain all multipliers, whatever the form.
static Outcome complete(const InitialProblem<double>& problem, Scenario& s) {
  auto routh =
      std::make_shared<System>(implicit_system(s.model, *s.mechanics, *find_formulation("routh"), s.independent, {}));
  Structure structure;
  if (Outcome o = analyse(*routh, problem.parameters, hints_at(s.state), structure); !o.ok()) return o;
  drop_absent(*routh, structure);
  if (!needs_completion(*s.mechanics, *routh, structure)) return {};
  s.routh = std::move(routh);
  s.routh_structure = std::move(structure);
  return complete_state(problem, *s.routh, s.routh_structure, s.state);
}

// True if the model has constraints on accelerations or conditions on them, which may need more than positions and
// velocities.
static bool may_need_completion(const Model& model) {
  const auto high = [](Expr e) {
    for (NodeId id : symbols({&e, 1}))
      if (const Node& n = e.graph->node(id); n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order > 1))
        return true;
    return false;
  };
  return std::any_of(model.constraints.begin(), model.constraints.end(),
                     [](const Constraint& c) { return c.order >= 2; }) ||
         std::any_of(model.initial.conditions.begin(), model.initial.conditions.end(),
                     [&](const Condition& c) { return high(c.residual); });
}

// True if a given force is nonlinear in leading derivatives. A form that eliminates coordinates has lower orders for these.
static bool forces_are_nonlinear(const Formulation& form, const Scenario& s) {
  std::vector<int> d(s.structure.d.begin(), s.structure.d.begin() + static_cast<std::ptrdiff_t>(s.system.coordinates));
  if (form.eliminates())
    for (int& order : d) order = std::max(order, 2);
  return !nonlinear_in_forces(*s.mechanics, d).empty();
}

// Refuses a constraint of which the structure needs derivatives that the fits of its tables do not have.
static void smooth_enough(const Scenario& s) {
  for (std::size_t k = 0; k < s.system.constraints.size(); ++k) {
    const int c = s.structure.c[s.system.coordinates + k];
    const Constraint& constraint = s.model->constraints[s.system.constraints[k]];
    if (const auto name = too_rough(put_masses(*s.model, constraint.phi), c))
      throw Failure(constraint.span,
                    "the constraint '" + constraint.name + "' is differentiated " +
                        (c == 1   ? "once"
                         : c == 2 ? "twice"
                                  : std::to_string(c) + " times") +
                        ", and the table '" + *name + "' in it has a fit that jumps before",
                    "fit = \"linear\" goes into velocities, \"monotone\" and \"spline\" into positions, too");
  }
}

// Notes values given for coordinates without inertia, which follow from the equations. Forms that eliminate have lower
// orders for their dependent coordinates as well, so they have no such note.
static void note_unused_values(const Formulation& form, Scenario& s) {
  if (form.eliminates() || s.state.q_origin.empty()) return;
  for (std::size_t a = 0; a < s.system.coordinates; ++a)
    for (const unsigned k : {0U, 1U}) {
      const Origin origin = k ? s.state.qd_origin[a] : s.state.q_origin[a];
      if (static_cast<int>(k) < s.structure.d[a] || origin != Origin::given) continue;
      const std::string& name = s.model->coordinates[a].name;
      s.state.notes.push_back("the initial value of " + derivative_name(name, k, Format::text) +
                              " is not used: " + name + " has no inertia here, and it follows from the equations");
    }
}

static Outcome prepare(std::shared_ptr<const Model> model, const Formulation& form, const StateChoice& choice,
                       Scenario& s) {
  s.model = model;
  s.given_nodes = model->graph->size();
  s.mechanics = std::make_unique<Mechanics>(mechanics(*model));
  s.classes = classify(*s.mechanics);
  s.notes.clear();
  for (const ModelNote& n : model->notes) s.notes.push_back(n.text);
  const std::vector<double> parameters = parameter_values<double>(*model);
  // Without formulas for all given functions there are no numbers, but there is a structure.
  const bool numbers = model->unknown_functions.empty();
  s.start = numbers ? std::make_shared<StartPlan>(*s.mechanics) : nullptr;
  const InitialProblem<double> problem{s.mechanics.get(), parameters, choice.overrides,
                                       choice.t,          nullptr,    s.start.get()};
  Outcome initial = numbers ? consistent_state(problem, s.state) : Outcome{};
  if (initial.ok() && numbers) initial = admissible(*model, parameters, s.state);
  s.independent.clear();
  s.redundant.clear();
  s.undetermined = {};
  if (initial.ok() && numbers)
    choose_constraints(parameters, s);
  else
    for (std::size_t r = 0; r < model->constraints.size(); ++r) s.independent.push_back(r);
  if (initial.ok() && numbers && may_need_completion(*model)) initial = complete(problem, s);
  s.elimination = Elimination();
  if (form.eliminates()) {
    const auto at = std::make_shared<PointValues>(values_near(*model, parameters, s.state));
    s.elimination = Elimination(
        *s.mechanics, choose_elimination(*s.mechanics, s.independent, form.unknowns, choice.eliminate, *at), at);
  }
  s.system = implicit_system(model, *s.mechanics, form, s.independent, s.elimination);
  if (!numbers)
    s.system.equations = substitute(s.system.equations, [&](NodeId id) {
      const Node& n = model->graph->node(id);
      return n.kind == Kind::given
                 ? model->graph->number(Rational(17 + 3 * static_cast<int>(n.index) + static_cast<int>(n.order), 19))
                 : Expr{};
    });
  const Outcome structured = analyse(s.system, parameters, hints_at(s.state), s.structure);
  if (structured.ok()) smooth_enough(s), drop_absent(s.system, s.structure);
  const std::string large_angles = note_of_large_angles(s.system, s.state, s.given_nodes, choice.overrides);
  if (!large_angles.empty()) s.notes.push_back(large_angles);
  for (std::string& text : notes_of_redundancy(s)) s.notes.push_back(std::move(text));
  if (!initial.ok()) return initial;
  if (!structured.ok()) return structured;
  // Masses and forces that depend on accelerations, and coordinates without inertia, may also need more.
  const bool beyond =
      std::any_of(s.structure.d.begin(), s.structure.d.begin() + static_cast<std::ptrdiff_t>(s.system.coordinates),
                  [](int d) { return d > 2; }) ||
      conditions_on_leading(*model, s.system, s.structure.d) || forces_are_nonlinear(form, s);
  if (beyond && numbers && !s.routh) initial = complete(problem, s);
  if (initial.ok()) note_unused_values(form, s);
  s.notes.insert(s.notes.end(), s.state.notes.begin(), s.state.notes.end());
  if (!large_angles.empty()) s.state.notes.push_back(large_angles);
  return initial;
}

Outcome make_scenario(std::shared_ptr<const Model> model, const Formulation& form, const StateChoice& choice,
                      Scenario& s) {
  const std::shared_ptr<Model> own = clone(*model);
  if (choice.open_parameters) put_whole_exponents(*own, *choice.open_parameters);
  Outcome o = prepare(own, form, choice, s);
  s.model->graph->freeze();
  return o;
}

std::optional<Outcome> begin_anew(Workspace& s, const StateChoice& choice) {
  if (s.routh || !s.elimination.pivots().empty()) return std::nullopt;
  const std::vector<double> parameters = parameter_values<double>(*s.model);
  const InitialProblem<double> problem{s.mechanics.get(), parameters, choice.overrides,
                                       choice.t,          nullptr,    s.start.get()};
  if (Outcome o = consistent_state(problem, s.state); !o.ok()) return o;
  if (Outcome o = admissible(*s.model, parameters, s.state); !o.ok()) return o;
  const IndependentConstraints rows = independent_constraints(*s.mechanics, parameters, s.state);
  const auto vanish = std::count_if(s.classes.begin(), s.classes.end(), [](const auto& c) { return c.vanishes; });
  if (rows.independent != s.independent || static_cast<long>(rows.vanishing.size()) != vanish) return std::nullopt;
  return Outcome{};
}

Workspace::Workspace(const Scenario& from) : own_model_(clone(*from.model)) {
  const auto& [model_of, nodes, mechanics_of, classes_of, start_of, state_of, independent_of, redundant_of,
               undetermined_of, elimination_of, system_of, structure_of, routh_of, routh_structure_of, notes_of] = from;
  static_cast<void>(model_of);
  const auto own = [&](auto& part) {
    for_each_expression(part, [&](Expr& e) {
      if (e.graph) e = own_model_->graph->own(e);
    });
  };
  const auto own_system = [&](const System& s) {
    auto copy = std::make_shared<System>(s);
    copy->model = own_model_;
    own(*copy);
    return copy;
  };
  model = own_model_;
  given_nodes = nodes;
  mechanics = std::make_unique<Mechanics>(*mechanics_of);
  mechanics->model = own_model_.get();
  own(*mechanics);
  classes = classes_of;
  if (start_of) {
    auto plan = std::make_shared<StartPlan>(start_of->copy());
    own(*plan);
    start = std::move(plan);
  }
  state = state_of;
  independent = independent_of;
  redundant = redundant_of;
  undetermined = undetermined_of;
  elimination = elimination_of.of(*mechanics);
  own(elimination);
  system = *own_system(system_of);
  structure = structure_of;
  if (routh_of) routh = own_system(*routh_of);
  routh_structure = routh_structure_of;
  notes = notes_of;
}

void Workspace::set_parameter(std::size_t parameter, const Rational& value) {
  own_model_->parameters[parameter].value = graph().number(value);
}

void for_each_expression(Scenario& s, const ExprVisitor& f) {
  auto& [model, given_nodes, mechanics, classes, start, state, independent, redundant, undetermined, elimination,
         system, structure, routh, routh_structure, notes] = s;
  for_each_expression(const_cast<Model&>(*model), f);
  for_each_expression(*mechanics, f);
  if (start) for_each_expression(const_cast<StartPlan&>(*start), f);
  for_each_expression(elimination, f);
  for_each_expression(system, f);
  if (routh) for_each_expression(const_cast<System&>(*routh), f);
  // The other members hold numbers and words.
  static_cast<void>(given_nodes), static_cast<void>(classes), static_cast<void>(state);
  static_cast<void>(independent), static_cast<void>(redundant), static_cast<void>(undetermined);
  static_cast<void>(structure), static_cast<void>(routh_structure), static_cast<void>(notes);
}

std::shared_ptr<Model> given_model(const Scenario& s) { return clone(*s.model, s.given_nodes); }

template <Number N>
Outcome initial_state(Workspace& s, const StateChoice& choice, Start<N>& start) {
  const InitialProblem<N> problem{s.mechanics.get(), parameter_values<N>(*s.model), choice.overrides, choice.t, nullptr,
                                  s.start.get()};
  InitialState<N> named;
  if (Outcome o = consistent_state(problem, named); !o.ok()) return o;
  if (s.routh)
    if (Outcome o = complete_state(problem, *s.routh, s.routh_structure, named); !o.ok()) return o;
  start = start_of(s, named);
  return {};
}

template <Number N>
Outcome initial_state(const Scenario& s, const StateChoice& choice, Start<N>& start) {
  Workspace own(s);
  return initial_state(own, choice, start);
}

template Outcome initial_state<double>(Workspace&, const StateChoice&, Start<double>&);
template Outcome initial_state<double>(const Scenario&, const StateChoice&, Start<double>&);
template Outcome initial_state<long double>(Workspace&, const StateChoice&, Start<long double>&);
template Outcome initial_state<long double>(const Scenario&, const StateChoice&, Start<long double>&);
template Outcome initial_state<Quad>(Workspace&, const StateChoice&, Start<Quad>&);
template Outcome initial_state<Quad>(const Scenario&, const StateChoice&, Start<Quad>&);
template Outcome initial_state<Multi>(Workspace&, const StateChoice&, Start<Multi>&);
template Outcome initial_state<Multi>(const Scenario&, const StateChoice&, Start<Multi>&);

int orders_needed(const Scenario& s, std::span<const Expr> es) {
  int beyond = 0;
  for (NodeId id : symbols(es))
    if (const auto j = s.system.variable(id))
      beyond = std::max(beyond, static_cast<int>(s.model->graph->node(id).order) - s.structure.d[*j]);
  return beyond;
}

}  // namespace anholon

#include "ensemble/cases/case_parameters.h"

#include <algorithm>
#include <cmath>

#include "model/exponents.h"
#include "setup/eliminate.h"
#include "setup/start/orientations.h"

namespace anholon {

namespace {

// All parameters as functions of the varied ones.
Tape parameter_tape(const Model& model, const std::vector<Varied>& varied) {
  Graph& g = *model.graph;
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  for (const Varied& v : varied)
    if (v.kind == Varied::Kind::parameter) values[v.index] = g.parameter(static_cast<std::uint32_t>(v.index));
  Column es = values;
  for (std::size_t depth = 0; depth <= values.size(); ++depth)
    es = substitute(es, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::parameter ? values[n.index] : Expr{};
    });
  return compile(es);
}

bool of_parameters(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (e.graph->node(id).kind != Kind::parameter) return false;
  return true;
}

// True if an equation contains a derivative beyond those that are solved for, so that it may occur for some parameters.
bool may_go_beyond(const System& system, const Structure& t) {
  for (std::size_t i = 0; i < system.equations.size(); ++i)
    for (const NodeId id : symbols({&system.equations[i], 1})) {
      const std::optional<std::size_t> j = system.variable(id);
      if (j && static_cast<int>(system.equations[i].graph->node(id).order) + t.c[i] > t.d[*j]) return true;
    }
  return false;
}

// True if the equations can be assigned to the unknowns whose leading derivatives they contain: then sum sigma of an
// assignment is sum d - sum c, and it is less for any other assignment (Pryce 2001). REQUIRES: sigma_ij <= d_j - c_i.
bool each_is_determined(const std::vector<std::vector<int>>& sigma, const Structure& t) {
  const std::vector<int> unknown_of = highest_transversal(sigma);
  if (unknown_of.empty()) return false;
  int sum = 0;
  for (std::size_t i = 0; i < sigma.size(); ++i)
    sum += sigma[i][static_cast<std::size_t>(unknown_of[i])] + t.c[i] - t.d[i];
  return sum == 0;
}

}  // namespace

CaseParameters::CaseParameters(Workspace& s, const EnsembleOptions& o)
    : s_(s), varied_(o.varied), identities_(o.identities) {
  const std::shared_ptr<const Model> given = o.each_anew ? clone(*o.each_anew) : s.model;
  const Model& model = *given;
  const std::vector<Varied>& varied = varied_;
  may_be_no_rotation_ = anholon::may_be_no_rotation(*s.model);
  any_ = std::any_of(varied.begin(), varied.end(), [](const Varied& v) { return v.kind == Varied::Kind::parameter; });
  if (model.parameters.empty()) return;
  tape_ = parameter_tape(model, varied);
  if (!any_) return;
  Column es;
  for (const Body& b : model.bodies) {
    if (of_parameters(b.mass)) {
      checks_.push_back({"the mass of '" + b.name + "'", es.size(), {}});
      es.push_back(b.mass);
    }
    if (b.shape)
      for (Expr size : b.shape->sizes) {
        checks_.push_back({"a size of the shape of '" + b.name + "'", es.size(), {}});
        es.push_back(size);
      }
    const auto known = [](const Axis& a) {
      return a.own.size() == 3 && of_parameters(a.weight) && std::all_of(a.own.begin(), a.own.end(), is_number);
    };
    if (b.axes.empty() || !std::all_of(b.axes.begin(), b.axes.end(), known)) continue;
    checks_.push_back({"the inertia of '" + b.name + "'", es.size(), {}});
    for (const Axis& a : b.axes) checks_.back().axes.push_back(a.own), es.push_back(a.weight);
  }
  if (!es.empty()) bodies_ = compile(es);
  if (o.each_anew) return;
  const std::shared_ptr<Model> own = clone(model);
  std::vector<std::size_t> indices;
  for (const Varied& v : varied)
    if (v.kind == Varied::Kind::parameter) indices.push_back(v.index);
  Column exponents = exponents_of(*own, indices);
  Column formulas;
  for (const Column* reduced : {&o.reductions.formulas, &o.reductions.ends})
    for (const Expr e : *reduced) formulas.push_back(own->graph->own(e));
  for (const Expr e : exponents_of(*own, formulas, indices)) exponents.push_back(e);
  if (!exponents.empty()) exponents_ = compile(exponents);
  whole_ = implicit_system(s.model, *s.mechanics, *s.system.form, s.independent, s.elimination);
  goes_beyond_ = may_go_beyond(whole_, s.structure);
  equations_ = compile(whole_.equations);
  of_scenario_ = parameter_values<double>(model);
  vanishes_ = std::any_of(s.classes.begin(), s.classes.end(), [](const ConstraintClass& c) { return c.vanishes; });
  if (!o.switches) return;
  Column active;
  for (const Expr e : o.switches->active) active.push_back(s.graph().own(e));
  switches_ = compile(active);
  hold_ = that_hold(of_scenario_);
}

// Tells for each formula that switches a constraint whether it is positive.
std::vector<bool> CaseParameters::that_hold(const std::vector<double>& parameters) const {
  Machine<double> machine(*switches_, 0, parameters);
  machine.evaluate();
  std::vector<bool> hold;
  for (std::size_t i = 0; i < switches_->roots.size(); ++i) hold.push_back(machine.value(i) > 0);
  return hold;
}

template <Number N>
std::vector<N> CaseParameters::values(const std::vector<Rational>& numbers) const {
  const std::size_t n = s_.model->parameters.size();
  std::vector<N> list(n, N(0));
  if (n == 0) return list;
  for (std::size_t i = 0; i < varied_.size(); ++i)
    if (varied_[i].kind == Varied::Kind::parameter)
      list[varied_[i].index] = from_rational<N>(varied_[i].unit.in_si(numbers[i]));
  Machine<N> machine(tape_, 0, list);
  machine.evaluate();
  for (std::size_t i = 0; i < n; ++i) list[i] = machine.value(i);
  return list;
}
template std::vector<double> CaseParameters::values(const std::vector<Rational>&) const;
template std::vector<long double> CaseParameters::values(const std::vector<Rational>&) const;

Outcome CaseParameters::possible(const std::vector<double>& parameters) const {
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (!is_finite(parameters[i]))
      return {OutcomeKind::not_a_number, "the parameter '" + s_.model->parameters[i].name + "' has no value",
              "look for roots of negative numbers and divisions by zero among the parameters"};
  if (const auto d = first_violated(identities_, parameters))
    return {OutcomeKind::inconsistent, d->message, d->hint, d->span};
  if (!bodies_) return {};
  Machine<double> machine(*bodies_, 0, parameters);
  machine.evaluate();
  for (const Check& c : checks_) {
    if (c.axes.empty()) {
      if (const double v = machine.value(c.root); !(v >= 0))
        return {OutcomeKind::negative_mass, c.what + " is " + number_text(v, 6),
                "it is not negative: leave out such values"};
      continue;
    }
    // E = sum w u u' has no negative eigenvalue: no principal minor of E + slack is negative.
    double e[3][3] = {}, slack = 0;
    for (std::size_t k = 0; k < c.axes.size(); ++k) {
      const double w = machine.value(c.root + k);
      slack += 1e-9 * std::abs(w);
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
          e[i][j] += w * number_value(c.axes[k][i]).get_d() * number_value(c.axes[k][j]).get_d();
    }
    bool wrong = false;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t k = (i + 1) % 3;
      wrong = wrong || !(e[i][i] >= -slack) ||
              !((e[i][i] + slack) * (e[k][k] + slack) - e[i][k] * e[k][i] >= -slack * slack);
    }
    const double det = e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1]) -
                       e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0]) +
                       e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0]);
    const double size = std::abs(e[0][0]) + std::abs(e[1][1]) + std::abs(e[2][2]);
    if (wrong || !(det >= -slack * size * size))
      return {OutcomeKind::negative_mass, c.what + " is that of no body",
              "each principal moment is at most the sum of the two others: leave out such values"};
  }
  return {};
}

template <Number N>
Outcome CaseParameters::oriented(const std::vector<double>& parameters, const InitialState<N>& start) const {
  InitialState<double> narrow;
  narrow.t = to_double(start.t);
  for (const N& x : start.q) narrow.q.push_back(to_double(x));
  for (const N& x : start.qd) narrow.qd.push_back(to_double(x));
  for (const N& x : start.states) narrow.states.push_back(to_double(x));
  PointValues at = values_near(*s_.model, parameters, narrow);
  return anholon::oriented(*s_.model, at);
}
template Outcome CaseParameters::oriented(const std::vector<double>&, const InitialState<double>&) const;
template Outcome CaseParameters::oriented(const std::vector<double>&, const InitialState<long double>&) const;

bool CaseParameters::same_structure(const std::vector<double>& parameters) const {
  if (switches_ && that_hold(parameters) != hold_) return false;
  if (exponents_) {
    Machine<double> machine(*exponents_, 0, parameters);
    machine.evaluate();
    for (std::size_t i = 0; i < exponents_->roots.size(); ++i)
      if (machine.value(i) == std::round(machine.value(i))) return false;
  }
  // A constraint that vanishes in the scenario may hold in this case.
  if (vanishes_ && parameters != of_scenario_) return false;
  // Equations may lose what determines an unknown where a factor vanishes that does not in the scenario.
  constexpr double kVanishes = 1e-100;
  bool vanishes = false;
  for (std::size_t i = 0; i < std::min(parameters.size(), of_scenario_.size()); ++i) {
    if (!(std::abs(parameters[i]) < kVanishes) || std::abs(of_scenario_[i]) < kVanishes) continue;
    if (parameters[i] != 0) return false;  // the scale of an equation decides
    vanishes = true;
  }
  if (!equations_ || !(goes_beyond_ || vanishes)) return true;
  const auto sigma = signature(whole_, *equations_, parameters, hints_at(s_.state));
  if (!sigma) return false;
  const Structure& t = s_.structure;
  for (std::size_t i = 0; i < sigma->size(); ++i)
    for (std::size_t j = 0; j < sigma->size(); ++j)
      if ((*sigma)[i][j] + t.c[i] > t.d[j] && (*sigma)[i][j] != kAbsent) return false;
  return each_is_determined(*sigma, t);
}

}  // namespace anholon

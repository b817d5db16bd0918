#include "observe/floors/traction.h"

#include <algorithm>
#include <cmath>

#include "expr/diff.h"
#include "expr/normal.h"
#include "numeric/number.h"
#include "setup/notes_on_multipliers.h"
#include "tape/bind.h"

namespace anholon {

namespace {

bool held_by_motion(const Translations& t, std::size_t coordinate) {
  return std::any_of(t.all.begin(), t.all.end(), [&](const Translation& x) { return x.coordinate == coordinate; });
}

// True if an expression changes with a translation, in positions (order 0) or velocities (order 1).
bool feels(const Scenario& s, const Translations& t, Expr e, std::uint32_t order) {
  Column jets;
  for (std::uint32_t a = 0; a < s.model->coordinates.size(); ++a)
    if (held_by_motion(t, a)) jets.push_back(s.model->graph->jet(a, order));
  for (const Expr d : gradient(e, jets))
    if (!proved_zero(d)) return true;
  return false;
}

// True if all outside forces, besides the floor's, are gravity or given by a vector.
bool outside_is_known(const Workspace& s, const Translations& t) {
  const Model& m = *s.model;
  for (const Force& f : m.forces) {
    if (f.kind == Force::Kind::tension && !f.from) return false;
    for (const auto& [coordinate, component] : f.generalized)
      if (held_by_motion(t, coordinate)) return false;
  }
  for (const Potential& v : m.potentials)
    if (feels(s, t, put_masses(m, v.value), 0)) return false;
  for (const Dissipation& d : m.dissipation)
    if (feels(s, t, put_masses(m, d.value), 1)) return false;
  for (const Body& b : m.bodies)
    if (b.expelled_velocity) return false;
  return m.observer.inertial && m.masses.empty();
}

// The names of the constraints of velocities that hold the system sideways. Returns nullopt if the floor is not a
// plane, or a constraint is of another kind, such as one of the speed.
std::optional<std::vector<std::string>> rolling_constraints(const Workspace& s, const Translations& t) {
  std::vector<std::string> names;
  for (std::size_t r = 0; r < s.model->constraints.size(); ++r) {
    const Constraint& c = s.model->constraints[r];
    if (c.by || c.order > 1) return std::nullopt;
    if (c.order == 0) continue;
    const Expr phi = put_masses(*s.model, s.mechanics->phi[r]);
    if (!feels(s, t, phi, 1)) continue;
    if (s.classes[r].kind == "nonlinear" || (t.across && feels(s, t, phi, 0))) return std::nullopt;
    names.push_back(c.name);
  }
  return names;
}

// The force of the floor.
Column force_of_floor(const Model& m) {
  Graph& g = *m.graph;
  Column sum(3, g.zero());
  const auto add = [&](Expr factor, const Vector& v) {
    sum[0] = sum[0] + factor * v.x, sum[1] = sum[1] + factor * v.y, sum[2] = sum[2] + factor * v.z;
  };
  const Expr minus = g.number(-1);
  for (const Body& b : m.bodies) {
    add(b.mass, {total_derivative(b.center.x, 2), total_derivative(b.center.y, 2), total_derivative(b.center.z, 2)});
    add(minus * b.mass, b.gravity);
  }
  for (const Force& f : m.forces)
    if (f.kind == Force::Kind::vector && !f.from) add(minus, f.vector);
  return put_masses(m, sum);
}

}  // namespace

TractionWatch::TractionWatch(const Scenario& s, const std::optional<Translations>& found, bool has_floor)
    : s_(s), has_floor_(has_floor), start_(to_double(s.state.t)) {
  if (!found || !found->normal || found->all.empty() || events_set_numbers(*s.model) ||
      largest_order(s, s.structure.d) < 2)
    return;
  normal_ = *found->normal;
  level_ = found->level();
  if (std::all_of(found->all.begin(), found->all.end(),
                  [&](const Translation& t) { return norm(cross(t.along, normal_)) <= kSameRate * norm(t.along); }))
    return;  // the floor is not free sideways
  Workspace own(s);
  const auto names = rolling_constraints(own, *found);
  if (!names || names->empty() || !outside_is_known(own, *found)) return;
  names_ = *names;
  find_what_holds_the_normal(own, *found);
  const Column outputs = force_of_floor(*own.model);
  Tape tape = compile(outputs);
  for (const Input& in : tape.inputs) {
    const Node& n = own.model->graph->node(in.symbol);
    const bool known = n.kind == Kind::time || n.kind == Kind::parameter || (n.kind == Kind::jet && n.order <= 2);
    if (!known) return;
  }
  tape_ = std::move(tape);
  machine_.emplace(*tape_, 0, parameter_values<double>(*own.model));
  numbers_.resize(3 * s.model->coordinates.size());
}

void TractionWatch::look(double t) {
  const std::size_t n = s_.model->coordinates.size();
  bind(*machine_, *s_.model->graph,
       [&](const Node& node, NodeId) { return node.kind == Kind::jet ? numbers_[node.order * n + node.index] : t; });
  machine_->evaluate();
  const Triple force{machine_->value(0), machine_->value(1), machine_->value(2)};
  const double load = dot(force, normal_), sideways = std::sqrt(std::max(dot(force, force) - load * load, 0.0));
  largest_ = std::max(largest_, std::abs(load));
  // The round-off of a load that vanishes is neither pull nor load.
  constexpr double kNothing = 1e-9;
  if (load < -kNothing * largest_) {
    if (!pulls_) pulls_ = t;
    if (load < least_) least_ = load, least_t_ = t;
  } else if (load > kNothing * largest_ && sideways > load) {
    if (!above_) above_ = t;
    if (sideways > need_ * load) need_ = sideways / load, need_t_ = t;
  }
}

Expr load_of_floor(const Model& m, const Triple& normal) {
  const Column force = force_of_floor(m);
  const auto number = [&](double x) { return m.graph->number(Rational(x)); };
  return force[0] * number(normal.x) + force[1] * number(normal.y) + force[2] * number(normal.z);
}

Expr friction_above_load(const Model& m, const Triple& normal) {
  const Column f = force_of_floor(m);
  const Expr load = load_of_floor(m, normal);
  return f[0] * f[0] + f[1] * f[1] + f[2] * f[2] - 2 * load * load;
}

std::string TractionWatch::rolling() const {
  std::string list;
  for (const std::string& name : names_) list += (list.empty() ? "'" : ", '") + name + "'";
  return (names_.size() > 1 ? "constraints " : "constraint ") + list;
}

void TractionWatch::find_what_holds_the_normal(const Workspace& s, const Translations& found) {
  Column across;
  for (const Translation& t : found.all)
    if (std::abs(dot(t.along, normal_)) > kSameRate * norm(t.along))
      across.push_back(s.model->graph->jet(static_cast<std::uint32_t>(t.coordinate), 1));
  for (std::size_t r = 0; r < s.model->constraints.size() && !across.empty(); ++r) {
    if (s.model->constraints[r].order != 1) continue;
    const Column slopes = gradient(put_masses(*s.model, s.mechanics->phi[r]), across);
    if (!std::all_of(slopes.begin(), slopes.end(), [](Expr e) { return proved_zero(e); })) hold_normal_.push_back(r);
  }
}

// What a [[contact]] needs to open: the height as a coordinate that no other constraint holds.
std::string TractionWatch::how_to_lift() const {
  if (hold_normal_.empty()) return "with the height as a coordinate";
  std::vector<std::string> names;
  for (const std::size_t r : hold_normal_) names.push_back("'" + s_.model->constraints[r].name + "'");
  return "together with " + without_constraints(*s_.model, hold_normal_, level_) + ", because " + joined_names(names) +
         (names.size() > 1 ? " hold" : " holds") + " the direction in which it opens";
}

std::vector<std::string> TractionWatch::notes() const {
  std::vector<std::string> list;
  if (pulls_ && !has_floor_)
    list.push_back("the floor under " + rolling() + (level_ ? " pulls down" : " pulls") +
                   " from t = " + number_text(*pulls_, 6) + " on, at most with " + number_text(-least_, 3) +
                   " at t = " + number_text(least_t_, 6) +
                   ": a wheel would lift off; write what touches as a [[contact]], " + how_to_lift());
  if (above_)
    list.push_back(rolling() + (names_.size() > 1 ? " need" : " needs") +
                   " a friction above 1 from t = " + number_text(*above_, 6) + " on, at least " +
                   number_text(need_, 3) + " times the load at t = " + number_text(need_t_, 6) +
                   ": a wheel would slip; a [[contact]] with its slip and friction = 0.8 in place of the constraint "
                   "tells how");
  return list;
}

}  // namespace anholon

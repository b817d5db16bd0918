#include "observe/translations.h"

#include <algorithm>
#include <cmath>

#include "tape/bind.h"

namespace anholon {

namespace {

// What is a constant by its meaning comes out of Taylor arithmetic exactly, or within a few roundings.
constexpr double kSame = 1e-12;

// How the places of all bodies and the residuals of constraints change with one coordinate, by Taylor arithmetic: no
// expression is made.
class Rates {
 public:
  Rates(Workspace& s, const std::vector<std::size_t>& constraints)
      : s_(s), constraints_(constraints), tape_(compile(outputs())),
        machine_(tape_, 1, parameter_values<double>(*s.model)) {}

  // At the start, moved by this along every coordinate.
  void go(std::size_t coordinate, double away) {
    bind_series(machine_, *s_.model->graph, [&](const Node& n, NodeId, double* series, int) {
      series[1] = 0;
      if (n.kind == Kind::jet && n.order == 0)
        series[0] = s_.state.q[n.index] + away * (1 + 0.37 * n.index), series[1] = n.index == coordinate ? 1 : 0;
      else if (n.kind == Kind::time)
        series[0] = s_.state.t;
      else
        series[0] = n.kind == Kind::state && n.index < s_.state.states.size() ? s_.state.states[n.index] : 0;
    });
    for (int stage : {0, 1}) machine_.sweep(stage, 0, static_cast<std::uint32_t>(tape_.code.size()));
  }
  // Of the mass centre of a body, and whether the body turns.
  Triple center(std::size_t body) const { return direction(3 * body); }
  bool turns() const {
    for (std::size_t k = 3 * s_.model->bodies.size(); k < first_; ++k)
      if (rate(k) != 0) return true;
    return false;
  }
  double residual(std::size_t k) const { return rate(first_ + k); }
  Triple gravity() const {
    return {machine_.value(first_ + constraints_.size()), machine_.value(first_ + constraints_.size() + 1),
            machine_.value(first_ + constraints_.size() + 2)};
  }

 private:
  Column outputs() {
    Column es;
    const auto add = [&](const Vector& v) { es.insert(es.end(), {v.x, v.y, v.z}); };
    for (const Body& b : s_.model->bodies) add(b.center);
    for (const Body& b : s_.model->bodies)
      if (b.orientation)
        for (const Vector& column : b.orientation->columns) add(column);
    first_ = es.size();
    for (std::size_t r : constraints_) es.push_back(s_.mechanics->phi[r]);
    add(s_.model->bodies[0].gravity);
    return put_masses(*s_.model, es);
  }
  double rate(std::size_t root) const { return machine_.series(tape_.roots[root])[1]; }
  Triple direction(std::size_t root) const { return {rate(root), rate(root + 1), rate(root + 2)}; }

  const Scenario& s_;
  const std::vector<std::size_t>& constraints_;
  std::size_t first_ = 0;  // root of the constraints
  Tape tape_;
  Machine<double> machine_;
};

std::optional<Translation> translation(Rates& rates, const Scenario& s, std::size_t coordinate,
                                       std::size_t constraints) {
  std::optional<Translation> found;
  for (const double away : {0.0, 0.31, -0.73}) {
    rates.go(coordinate, away);
    if (rates.turns()) return std::nullopt;
    const Triple along = rates.center(0);
    const auto same = [&](const Triple& d, const Triple& e) {
      return norm({d.x - e.x, d.y - e.y, d.z - e.z}) <= kSame * norm(e);
    };
    if (!(norm(along) > 0)) return std::nullopt;
    for (std::size_t b = 1; b < s.model->bodies.size(); ++b)
      if (!same(rates.center(b), along)) return std::nullopt;
    std::vector<double> residuals;
    for (std::size_t k = 0; k < constraints; ++k) residuals.push_back(rates.residual(k));
    if (!found) {
      found = Translation{coordinate, along, residuals};
      continue;
    }
    if (!same(along, found->along)) return std::nullopt;
    // A rate that is not the same everywhere is marked as none of interest.
    for (std::size_t k = 0; k < constraints; ++k)
      if (!(std::abs(residuals[k] - found->residuals[k]) <= kSame * std::abs(residuals[k])))
        found->residuals[k] = std::nan("");
  }
  return found;
}

}  // namespace

std::optional<Translations> translations(const Scenario& s) {
  const Model& model = *s.model;
  if (model.bodies.empty() || !model.unknown_functions.empty()) return std::nullopt;
  Translations all;
  for (std::size_t r = 0; r < model.constraints.size(); ++r)
    if (model.constraints[r].order == 0) all.geometric.push_back(r);
  Workspace own(s);
  Rates rates(own, all.geometric);
  rates.go(0, 0);
  all.gravity = rates.gravity();
  if (!(norm(all.gravity) > 0)) return std::nullopt;
  for (std::size_t a = 0; a < model.coordinates.size(); ++a) {
    const auto t = translation(rates, s, a, all.geometric.size());
    if (!t) continue;
    const double along = dot(t->along, all.gravity) / (norm(t->along) * norm(all.gravity));
    if (std::abs(along) <= kSame)
      all.sideways.push_back(*t);
    else if (std::abs(std::abs(along) - 1) <= kSame && !all.up)
      all.up = t;
    else
      return std::nullopt;  // neither upwards nor sideways
  }
  // What holds the system sideways makes a hinge of it.
  for (const Translation& t : all.sideways)
    for (const double residual : t.residuals)
      if (residual != 0) return std::nullopt;
  return all;
}

}  // namespace anholon

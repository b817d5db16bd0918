#include "observe/floors/place_rates.h"

#include <algorithm>

namespace anholon {

namespace {

// True if a force depends on parameters alone.
bool constant(const Model& m, const Vector& v) {
  const Tape tape = compile(put_masses(m, Column{v.x, v.y, v.z}));
  return std::all_of(tape.inputs.begin(), tape.inputs.end(),
                     [&](const Input& in) { return m.graph->node(in.symbol).kind == Kind::parameter; });
}

// The direction of the weight of a body: that of gravity, or, without gravity, that of the constant forces.
Vector weight_of(const Model& m, std::size_t body) {
  const Body& b = m.bodies[body];
  if (!is_zero(b.gravity)) return b.gravity;
  Vector sum = b.gravity;
  for (const Force& f : m.forces)
    if (f.kind == Force::Kind::vector && !f.from && f.on.body == body && constant(m, f.vector))
      sum = {sum.x + f.vector.x, sum.y + f.vector.y, sum.z + f.vector.z};
  return sum;
}

}  // namespace

PlaceRates::PlaceRates(Workspace& s, const std::vector<std::size_t>& constraints)
    : s_(s), tape_(compile(outputs(constraints))), machine_(tape_, 1, parameter_values<double>(*s.model)) {
  for (const Input& in : tape_.inputs) {
    const Node& n = s.model->graph->node(in.symbol);
    known_ = known_ && (n.kind == Kind::time || (n.kind == Kind::jet && n.order <= 1));
    symbols_.push_back(n);
  }
}

Column PlaceRates::outputs(const std::vector<std::size_t>& constraints) {
  const Model& m = *s_.model;
  Column es;
  const auto add = [&](const Vector& v) { es.insert(es.end(), {v.x, v.y, v.z}); };
  for (const Body& b : m.bodies) add(b.center);
  for (const Body& b : m.bodies) {
    axes_.push_back(es.size());
    if (b.orientation)
      for (const Vector& column : b.orientation->columns) add(column);
  }
  axes_.push_back(es.size());
  first_residual_ = es.size();
  for (const std::size_t r : constraints) es.push_back(s_.mechanics->phi[r]);
  first_weight_ = es.size();
  for (std::size_t b = 0; b < m.bodies.size(); ++b) add(weight_of(m, b));
  return put_masses(m, es);
}

void PlaceRates::go(double away) {
  t_ = s_.state.t;
  q_ = s_.state.q, qd_ = s_.state.qd;
  for (std::size_t a = 0; a < q_.size(); ++a) q_[a] += away * (1 + 0.37 * static_cast<double>(a));
}

void PlaceRates::go(double t, const std::vector<double>& q) {
  t_ = t;
  q_ = q;
}

void PlaceRates::look(std::size_t coordinate, unsigned order) {
  for (std::size_t i = 0; i < symbols_.size(); ++i) {
    double* series = machine_.series(tape_.inputs[i].slot);
    const Node& n = symbols_[i];
    series[0] = series[1] = 0;
    if (n.kind == Kind::time) series[0] = t_;
    if (n.kind == Kind::state && n.order == 0 && n.index < s_.state.states.size()) series[0] = s_.state.states[n.index];
    if (n.kind != Kind::jet) continue;
    if (n.order == 0) series[0] = q_[n.index];
    if (n.order == 1 && n.index < qd_.size()) series[0] = qd_[n.index];
    series[1] = n.order == order && n.index == coordinate ? 1 : 0;
  }
  for (const int stage : {0, 1}) machine_.sweep(stage, 0, static_cast<std::uint32_t>(tape_.code.size()));
}

std::vector<double> PlaceRates::axes(std::size_t body) const {
  std::vector<double> list;
  for (std::size_t k = axes_[body]; k < axes_[body + 1]; ++k) list.push_back(rate(k));
  return list;
}

bool PlaceRates::turns(std::size_t body) const {
  for (std::size_t k = axes_[body]; k < axes_[body + 1]; ++k)
    if (rate(k) != 0) return true;
  return false;
}

Triple PlaceRates::weight(std::size_t body) const {
  const std::size_t k = first_weight_ + 3 * body;
  return {machine_.value(k), machine_.value(k + 1), machine_.value(k + 2)};
}

}  // namespace anholon

#include "observe/angles.h"

#include <algorithm>
#include <cmath>

#include "expr/normal.h"
#include "setup/outputs/output_tape.h"

namespace anholon {

namespace {

// The velocities by which a body with second moments turns.
std::vector<bool> turned_by(const Body& body, const Column& qd) {
  std::vector<bool> by(qd.size(), false);
  if (body.axes.empty() || !body.orientation) return by;
  const Vector& rate = body.orientation->own_rate;
  for (const Expr& e : {rate.x, rate.y, rate.z})
    for (NodeId id : symbols({&e, 1}))
      for (std::size_t a = 0; a < qd.size(); ++a)
        if (qd[a].id == id) by[a] = true;
  return by;
}

// True if another body turns by only one or two of the three angles (a gimbal with an inertia, a link of an arm). Such
// a body has kinetic energy where the three vectors fall into a plane, so nothing becomes singular there.
bool held_by_another(const Model& model, const std::vector<std::size_t>& angles, const Column& qd) {
  return std::any_of(model.bodies.begin(), model.bodies.end(), [&](const Body& other) {
    const std::vector<bool> by = turned_by(other, qd);
    const auto count = std::count_if(angles.begin(), angles.end(), [&](std::size_t a) { return by[a]; });
    return count > 0 && count < 3;
  });
}

}  // namespace

std::vector<AngleTriple> angle_triples(const Model& model) {
  std::vector<AngleTriple> list;
  const Column qd = jets(model, 1);
  for (const Body& body : model.bodies) {
    if (!body.orientation) continue;
    const Vector& rate = body.orientation->own_rate;
    const Column by[] = {gradient(rate.x, qd), gradient(rate.y, qd), gradient(rate.z, qd)};
    AngleTriple triple{body.name, {}, {}};
    std::vector<std::size_t> angles;
    for (std::size_t a = 0; a < qd.size(); ++a) {
      const Vector column{by[0][a], by[1][a], by[2][a]};
      if (is_zero(column)) continue;
      if (angles.size() < 3) triple.rates[angles.size()] = column;
      angles.push_back(a);
      triple.angles += (triple.angles.empty() ? "" : ", ") + model.coordinates[a].name;
    }
    const bool known =
        std::any_of(list.begin(), list.end(), [&](const AngleTriple& t) { return t.angles == triple.angles; });
    if (angles.size() != 3 || known || held_by_another(model, angles, qd)) continue;
    // Two joints about the same axis lie in a plane with any third one at all times, which is no singularity.
    if (!proved_zero(dot(triple.rates[0], cross(triple.rates[1], triple.rates[2])))) list.push_back(triple);
  }
  return list;
}

Column AngleWatch::expressions(const Model& model, const std::vector<AngleTriple>& triples) {
  Column es;
  for (const AngleTriple& t : triples) {
    es.push_back(dot(t.rates[0], cross(t.rates[1], t.rates[2])));
    for (const Vector& v : t.rates) es.push_back(dot(v, v));
  }
  // Turning the body's own axes changes none of these expressions, so they do not depend on the angles of such turns.
  const auto without = [](const Expr& e, const Expr& q) {
    return substitute({&e, 1}, [&](NodeId id) { return id == q.id ? q.graph->zero() : Expr{}; })[0];
  };
  for (Expr& e : es)
    for (const Expr& q : jets(model, 0))
      if (proved_zero(partial(e, q))) e = without(e, q);
  return es;
}

AngleWatch::AngleWatch(Workspace& s, const std::vector<double>& parameters)
    : triples(angle_triples(*s.model)), least(triples.size()) {
  if (triples.empty()) return;
  const Column es = expressions(*s.model, triples);
  outputs_.emplace(s, es, parameters);
  const Graph& g = *s.model->graph;
  for (const NodeId id : symbols(es)) {
    const Node& n = g.node(id);
    if (n.kind == Kind::jet && n.order == 0)
      coordinates_.push_back(n.index);
    else
      by_coordinates_ = by_coordinates_ && (n.kind == Kind::parameter || n.kind == Kind::mass);
  }
}

void AngleWatch::save(std::vector<double>& to) const {
  for (const Least& l : least) to.insert(to.end(), {l.value, l.t});
  to.push_back(margin_);
  to.insert(to.end(), looked_.begin(), looked_.end());
  to.resize(to.size() + coordinates_.size() - looked_.size(), 0);  // before the first look the margin is 0
}

void AngleWatch::resume(const std::vector<double>& from) {
  for (std::size_t i = 0; i < least.size(); ++i) least[i] = {from[2 * i], from[2 * i + 1]};
  margin_ = from[2 * least.size()];
  looked_.assign(from.begin() + static_cast<std::ptrdiff_t>(2 * least.size() + 1), from.end());
}

void AngleWatch::note(double t) {
  const OutputTape<double>& out = *outputs_;
  double smallest = 1;
  for (std::size_t i = 0; i < triples.size(); ++i) {
    const std::size_t at = 4 * i;
    const double lengths = std::sqrt(out[at + 1] * out[at + 2] * out[at + 3]);
    const double value = lengths > 0 ? std::abs(out[at]) / lengths : 0;
    if (value < least[i].value) least[i] = {value, t};
    smallest = std::min(smallest, value);
  }
  margin_ = by_coordinates_ ? smallest / 8 : 0;
}

}  // namespace anholon

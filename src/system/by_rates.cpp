#include "system/by_rates.h"

#include "expr/copy.h"

namespace anholon {

namespace {

bool depends_on_place(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (const Node& n = e.graph->node(id); n.kind == Kind::jet && n.order == 0) return true;
  return false;
}

bool is_symbol(Expr e) {
  const Kind k = e.graph->node(e.id).kind;
  return k == Kind::jet || k == Kind::number || k == Kind::parameter;
}

// What the equations are made of, copied to the graph where they are made.
struct Copied {
  struct Point {
    Expr weight, speed2;
    Vector place;
    bool of_mass;
  };
  std::vector<Point> points;
  Column forces, constraints, state_rates, others;
  std::shared_ptr<Model> model;  // names, masses and inputs
};

Copied copied(const Mechanics& m, const System& derived, std::span<const Expr> others) {
  const Model& from = *m.model;
  Copied c;
  c.model = std::make_shared<Model>();
  c.model->graph = std::make_shared<Graph>();
  c.model->names = from.names;
  c.model->names.defined.clear();
  c.model->coordinates = from.coordinates;
  c.model->masses = from.masses;
  c.model->controls = from.controls;
  Column all;
  const auto visit = [&](const auto& each) {
    for (std::size_t i = 0; i < m.points.size(); ++i) {
      const WeightedPoint& p = m.points[i];
      if (c.points.size() <= i) c.points.push_back({p.weight, p.speed2, p.place, p.uniform_field});
      for (Expr* e : {&c.points[i].weight, &c.points[i].speed2, &c.points[i].place.x, &c.points[i].place.y, &c.points[i].place.z}) each(*e);
    }
    for (Expr& e : c.forces) each(e);
    for (Expr& e : c.constraints) each(e);
    for (Expr& e : c.state_rates) each(e);
    for (Expr& e : c.others) each(e);
    for (VaryingMass& v : c.model->masses) each(v.value);
    for (Control& u : c.model->controls)
      if (u.value) each(*u.value);
  };
  c.forces = forces(m);
  for (std::size_t r : derived.constraints) c.constraints.push_back(m.phi[r]);
  for (const StateVariable& z : from.states) c.state_rates.push_back(z.rate);
  c.others.assign(others.begin(), others.end());
  visit([&](Expr& e) { all.push_back(e); });
  const Column images = anholon::copied(all, *c.model->graph);
  std::size_t i = 0;
  visit([&](Expr& e) { e = images[i++]; });
  return c;
}

class Writer {
 public:
  Writer(const System& derived, const Mechanics& m, std::span<const Expr> others) : derived_(derived), m_(m), c_(copied(m, derived, others)), g_(*c_.model->graph) {}

  ByRates run() {
    const std::size_t n = derived_.coordinates;
    q_ = jets(*c_.model, 0), qd_ = jets(*c_.model, 1);
    Expr held = kinetic_energy();
    // The same of T with V held. Momenta that depend on the place are differentiated by their series.
    Column rows = -gradient(held, q_);
    const Column momenta = gradient(held, qd_);
    for (std::size_t a = 0; a < n; ++a) rows[a] += c_.model->masses.empty() && depends_on_place(momenta[a]) ? rate(put_masses(*c_.model, momenta[a]), 1) : total_derivative(momenta[a]);
    rows = rows - with_rates(put_masses(*c_.model, c_.forces)) - reactions();
    rows = rows + pullback(places_, forces_at_places_, q_);
    ByRates r;
    r.system = derived_;
    r.system.model = c_.model;
    r.system.equations = put_masses(*c_.model, rows);
    r.system.equations.insert(r.system.equations.end(), constraints_.begin(), constraints_.end());
    for (std::size_t i = 0; i < c_.state_rates.size(); ++i)
      r.system.equations.push_back(g_.state(static_cast<std::uint32_t>(i), 1) - with_rates(put_masses(*c_.model, {&c_.state_rates[i], 1}))[0]);
    r.system.rates = rates_;
    r.others = c_.others;
    return r;
  }

 private:
  Expr rate(Expr of, unsigned order) {
    const auto [it, fresh] = rate_.try_emplace(of.id, rates_.size());
    if (fresh) rates_.push_back(of);
    return g_.jet(static_cast<std::uint32_t>(derived_.coordinates + it->second), order);
  }

  // T with the velocities of mass centres by their places, as far as that is worth a series; what remains is held.
  Expr kinetic_energy() {
    std::vector<std::pair<Rational, Expr>> held;
    for (const Copied::Point& p : c_.points) {
      if (!p.of_mass || !depends_on_place(p.speed2)) {
        held.push_back({Rational(1, 2), p.weight * p.speed2});
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        const Expr v = total_derivative(p.place[i]);
        if (is_zero(v)) continue;
        if (is_symbol(p.place[i])) {
          held.push_back({Rational(1, 2), p.weight * pow(v, 2)});
          continue;
        }
        places_.push_back(p.place[i]);
        forces_at_places_.push_back(p.weight * rate(p.place[i], 2));
        by_rate_.insert({v.id, rate(p.place[i], 1)});
        by_rate_.insert({total_derivative(v).id, rate(p.place[i], 2)});
      }
    }
    return g_.sum(held);
  }

  Column with_rates(const Column& es) const { return replace_nodes(es, by_rate_); }

  // sum lambda dphi/dq^(m). Of constraints on velocities V is held first, and what falls to it acts at the places.
  Column reactions() {
    Column sum(q_.size(), g_.zero()), velocity_constraints, multipliers;
    for (std::size_t i = 0; i < derived_.constraints.size(); ++i) {
      const std::size_t r = derived_.constraints[i];
      const Expr phi = put_masses(*c_.model, c_.constraints[i]), lambda = g_.multiplier(static_cast<std::uint32_t>(r), 0);
      const bool acts = !m_.model->constraints[r].by;
      if (m_.order[r] == 1) {
        constraints_.push_back(with_rates({phi})[0]);
        if (acts) velocity_constraints.push_back(constraints_.back()), multipliers.push_back(lambda);
      } else {
        constraints_.push_back(phi);
        if (acts) sum = sum + pullback({&phi, 1}, {&lambda, 1}, jets(*c_.model, static_cast<unsigned>(m_.order[r])));
      }
    }
    if (velocity_constraints.empty()) return sum;
    Column wanted = qd_;
    for (Expr place : places_) wanted.push_back(rate(place, 1));
    const Column found = pullback(velocity_constraints, multipliers, wanted);
    for (std::size_t a = 0; a < q_.size(); ++a) sum[a] += found[a];
    for (std::size_t c = 0; c < places_.size(); ++c) forces_at_places_[c] = forces_at_places_[c] - found[q_.size() + c];
    return sum;
  }

  const System& derived_;
  const Mechanics& m_;
  Copied c_;
  Graph& g_;
  Column q_, qd_;
  Column rates_;
  std::unordered_map<NodeId, std::size_t> rate_;
  std::unordered_map<NodeId, Expr> by_rate_;  // velocities and accelerations written out
  Column places_, forces_at_places_, constraints_;
};

}  // namespace

std::optional<ByRates> by_rates(const System& derived, const Mechanics& m, std::span<const Expr> others) {
  if (derived.form != find_formulation("routh")) return std::nullopt;
  ByRates r = Writer(derived, m, others).run();
  if (r.system.rates.empty()) return std::nullopt;
  return r;
}

}  // namespace anholon

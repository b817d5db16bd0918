#include "lowering/by_rates.h"

#include <algorithm>

#include "lowering/copied_mechanics.h"

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

class Writer {
 public:
  Writer(const System& derived, const Mechanics& m, std::span<const Expr> others)
      : derived_(derived), m_(m), c_(copied_mechanics(m, derived, others)), g_(*c_.model->graph) {}

  ByRates run() {
    const std::size_t n = derived_.coordinates;
    q_ = jets(*c_.model, 0), qd_ = jets(*c_.model, 1);
    const Expr held = kinetic_energy();
    // Lagrange's operator of T with V held. Momenta that depend on the place are differentiated by their series.
    Column rows = -gradient(held, q_);
    const Column momenta = gradient(held, qd_);
    for (std::size_t a = 0; a < n; ++a)
      rows[a] += c_.model->masses.empty() && depends_on_place(momenta[a]) ? rate(put_masses(*c_.model, momenta[a]), 1)
                                                                          : total_derivative(momenta[a]);
    rows = rows - by_rates(put_masses(*c_.model, c_.forces)) - reactions();
    rows = rows + pullback(places_, forces_at_places_, q_);
    ByRates r;
    r.system = derived_;
    r.system.model = c_.model;
    r.system.equations = put_masses(*c_.model, rows);
    r.system.equations.insert(r.system.equations.end(), constraints_.begin(), constraints_.end());
    for (std::size_t i = 0; i < c_.state_rates.size(); ++i)
      r.system.equations.push_back(g_.state(static_cast<std::uint32_t>(i), 1) -
                                   by_rates(put_masses(*c_.model, {&c_.state_rates[i], 1}))[0]);
    r.system.rates = rates_;
    r.others = c_.others;
    return r;
  }

 private:
  // Returns the derivative of this order, by the series, with constant factors in front. Sums are not split: one series
  // serves all bodies of a chain that share a sum.
  Expr rate(Expr of, unsigned order) {
    if (is_symbol(of)) return total_derivative(of, order);
    std::vector<std::pair<Expr, Rational>> constant, varying;
    if (g_.node(of.id).kind == Kind::product)
      for (const Term& t : g_.terms(of.id))
        (is_constant({&g_, t.node}) ? constant : varying).push_back({Expr{&g_, t.node}, g_.rational(t.weight)});
    if (!constant.empty()) return g_.product(constant) * rate(g_.product(varying), order);
    const auto [base, fresh] = base_.try_emplace(of.id, rates_.size());
    if (fresh) rates_.push_back(of);
    return g_.jet(static_cast<std::uint32_t>(derived_.coordinates + base->second), order);
  }

  bool is_constant(Expr e) const {
    for (NodeId id : symbols({&e, 1}))
      if (const Kind k = g_.node(id).kind; k != Kind::number && k != Kind::pi && k != Kind::parameter) return false;
    return true;
  }

  // Returns T with the velocities of mass centres by their places, if a series is worth it; the rest is held.
  Expr kinetic_energy() {
    std::vector<std::pair<Rational, Expr>> held;
    for (const CopiedMechanics::Point& p : c_.points) {
      if (!p.of_mass || !depends_on_place(p.speed2)) {
        held.push_back({Rational(1, 2), p.weight * p.speed2});
        continue;
      }
      for (int i = 0; i < 3; ++i) {
        const Expr v = total_derivative(p.place[i]);
        if (is_zero(v)) continue;
        places_.push_back(p.place[i]);
        forces_at_places_.push_back(p.weight * rate(p.place[i], 2));
        by_rate_.insert({v.id, rate(p.place[i], 1)});
        by_rate_.insert({total_derivative(v).id, rate(p.place[i], 2)});
      }
    }
    return g_.sum(held);
  }

  // Finds products of u' with the sine or cosine of u: they are derivatives of the other function, if its series is
  // needed anyway.
  void find_rates(const Column& es) {
    for (NodeId id : reachable(es)) {
      if (g_.node(id).kind != Kind::product || by_rate_.count(id)) continue;
      const std::vector<Term> factors(g_.terms(id).begin(), g_.terms(id).end());
      for (const Term& f : factors) {
        const Node node = g_.node(f.node);
        if (node.kind != Kind::function || g_.rational(f.weight) != 1) continue;
        const auto kind = static_cast<Function>(node.index);
        if (kind != Function::sin && kind != Function::cos) continue;
        const Expr u{&g_, g_.terms(f.node)[0].node}, du = total_derivative(u);
        const auto speed = std::find_if(factors.begin(), factors.end(),
                                        [&](const Term& t) { return t.node == du.id && g_.rational(t.weight) == 1; });
        if (speed == factors.end()) continue;
        std::vector<std::pair<Expr, Rational>> rest;
        for (const Term& t : factors)
          if (t.node != f.node && t.node != du.id) rest.push_back({Expr{&g_, t.node}, g_.rational(t.weight)});
        const Expr other = kind == Function::sin ? cos(u) : sin(u);
        if (!base_.count(other.id)) continue;
        by_rate_.insert({id, Rational(kind == Function::sin ? -1 : 1) * (g_.product(rest) * rate(other, 1))});
        break;
      }
    }
  }

  Column by_rates(const Column& es) {
    find_rates(es);
    return replace_nodes(es, by_rate_);
  }

  // Returns sum lambda dphi/dq^(m). For constraints on velocities, the rates are held first, and the forces on a rate
  // act on the expression whose rate it is.
  Column reactions() {
    Column sum(q_.size(), g_.zero()), velocity_constraints, multipliers;
    for (std::size_t i = 0; i < derived_.constraints.size(); ++i) {
      const std::size_t r = derived_.constraints[i];
      const Expr phi = put_masses(*c_.model, c_.constraints[i]),
                 lambda = g_.multiplier(static_cast<std::uint32_t>(r), 0);
      const bool acts = !m_.model->constraints[r].by;
      if (m_.order[r] == 1) {
        constraints_.push_back(by_rates({phi})[0]);
        if (acts) velocity_constraints.push_back(constraints_.back()), multipliers.push_back(lambda);
      } else {
        constraints_.push_back(phi);
        if (acts) sum = sum + pullback({&phi, 1}, {&lambda, 1}, jets(*c_.model, static_cast<unsigned>(m_.order[r])));
      }
    }
    if (velocity_constraints.empty()) return sum;
    Column wanted = qd_;
    const Column bases = rates_;
    for (Expr base : bases) wanted.push_back(rate(base, 1));
    const Column found = pullback(velocity_constraints, multipliers, wanted);
    for (std::size_t a = 0; a < q_.size(); ++a) sum[a] += found[a];
    for (std::size_t c = 0; c < bases.size(); ++c)
      if (const Expr& f = found[q_.size() + c]; !is_zero(f))
        places_.push_back(bases[c]), forces_at_places_.push_back(-f);
    return sum;
  }

  const System& derived_;
  const Mechanics& m_;
  CopiedMechanics c_;
  Graph& g_;
  Column q_, qd_;
  Column rates_;
  std::unordered_map<NodeId, std::size_t> base_;
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

#include "mechanics/mechanics.h"

namespace anholon {

namespace {

Expr norm2(const Vector& a) { return dot(a, a); }

std::vector<WeightedPoint> weighted_points(const Model& model) {
  std::vector<WeightedPoint> points;
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    const Body& body = model.bodies[b];
    if (!is_zero(body.mass)) {
      const Vector v = total_derivative(body.center), a = total_derivative(v);
      points.push_back({body.mass, body.center, true, b, norm2(v), norm2(a)});
    }
    for (const Axis& axis : body.axes) {
      WeightedPoint p{axis.weight, axis.vector, false, b, {}, {}};
      if (axis.own.empty()) {
        const Vector v = total_derivative(axis.vector), a = total_derivative(v);
        p.speed2 = norm2(v);
        p.acceleration2 = norm2(a);
      } else {
        // u fixed in the body: u' = Omega x u and u'' = Omega' x u + Omega x (Omega x u). Their squares are the same in
        // body axes, in which they are short.
        const Vector u{axis.own[0], axis.own[1], axis.own[2]}, omega = body.orientation->own_rate;
        const Vector v = cross(omega, u);
        p.speed2 = norm2(v);
        const Vector centripetal = cross(omega, v), tangential = cross(total_derivative(omega), u);
        p.acceleration2 = norm2(tangential + centripetal);
      }
      points.push_back(p);
    }
  }
  return points;
}

Expr weighted_sum(Graph& g, const std::vector<WeightedPoint>& points, Expr WeightedPoint::* square) {
  std::vector<std::pair<Rational, Expr>> parts;
  for (const WeightedPoint& p : points) parts.push_back({Rational(1, 2), p.weight * (p.*square)});
  return g.sum(parts);
}

// Accumulates sum_i f_i . drho_i/dq_a with the f_i held.
class Pull {
 public:
  void add(const Vector& output, const Vector& seed) {
    for (int i = 0; i < 3; ++i) {
      if (is_zero(seed[i])) continue;
      outputs_.push_back(output[i]);
      seeds_.push_back(seed[i]);
    }
  }
  Column back(const Column& symbols) const {
    if (outputs_.empty()) return Column(symbols.size(), symbols[0].graph->zero());
    return pullback(outputs_, seeds_, symbols);
  }

 private:
  Column outputs_, seeds_;
};

// Forces at mass centres act through rho_C,q, torques through dOmega/dq' (theory: weighted-points).
Column generalized_forces(const Mechanics& m, const std::vector<Load>& loads) {
  Pull positions, rates;
  for (std::size_t b = 0; b < loads.size(); ++b) {
    const Body& body = m.model->bodies[b];
    positions.add(body.center, loads[b].force);
    if (body.orientation) rates.add(body.orientation->rate, loads[b].torque);
  }
  return positions.back(m.q) + rates.back(m.qd);
}

}  // namespace

Mechanics mechanics(const Model& model) {
  Graph& g = *model.graph;
  Mechanics m;
  m.model = &model;
  m.q = jets(model, 0);
  m.qd = jets(model, 1);
  m.qdd = jets(model, 2);
  m.points = weighted_points(model);
  m.T = weighted_sum(g, m.points, &WeightedPoint::speed2);
  m.S = weighted_sum(g, m.points, &WeightedPoint::acceleration2);

  m.Q = generalized_forces(m, given_loads(model));
  for (const Potential& p : model.potentials) m.Q = m.Q - gradient(p.value, m.q);
  for (const Force& f : model.forces)
    for (const auto& [a, component] : f.generalized) m.Q[a] += component;
  m.QR = generalized_forces(m, reactive_loads(model));
  m.QD = Column(m.q.size(), g.zero());
  for (const Dissipation& d : model.dissipation) m.QD = m.QD - gradient(d.value, m.qd);

  // The moving observer.
  const Vector &omega = model.observer.spin, &a0 = model.observer.origin_acceleration;
  const Vector omega_dot = total_derivative(omega);
  m.V_O = m.V_omega = g.zero();
  Pull euler, coriolis;
  for (const WeightedPoint& p : m.points) {
    if (p.uniform_field) m.V_O += p.weight * dot(a0, p.place);
    if (is_zero(omega)) continue;
    m.V_omega += Rational(-1, 2) * (p.weight * norm2(cross(omega, p.place)));
    const Vector v = total_derivative(p.place);
    euler.add(p.place, (-p.weight) * cross(omega_dot, p.place));
    coriolis.add(p.place, (-2 * p.weight) * cross(omega, v));
  }
  m.Qomega = euler.back(m.q);
  m.minus_dVO = -gradient(m.V_O, m.q);
  m.minus_dVomega = -gradient(m.V_omega, m.q);
  m.Gamma = coriolis.back(m.q);

  // Constraints: N = sum lambda dphi/dq^(m), each with its own m  [L 2.6].
  m.N = Column(m.q.size(), g.zero());
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    m.phi.push_back(c.phi);
    m.order.push_back(c.order);
    m.lambda.push_back(g.multiplier(static_cast<std::uint32_t>(r), 0));
    m.Phi.push_back(gradient(c.phi, jets(model, static_cast<unsigned>(c.order))));
    if (c.by) continue;  // maintained by a force of its own, not by an ideal reaction
    for (std::size_t a = 0; a < m.q.size(); ++a)
      if (!is_zero(m.Phi[r][a])) m.N[a] += m.lambda[r] * m.Phi[r][a];
  }
  return m;
}

Column forces(const Mechanics& m) { return m.Q + m.QR + m.QD + m.Qomega + m.minus_dVO + m.minus_dVomega + m.Gamma; }

Expr by_time(Expr e) {
  Graph& g = *e.graph;
  Expr rate = partial(e, g.time());
  for (NodeId id : symbols({&e, 1})) {
    const Node n = g.node(id);
    if (n.kind == Kind::given || n.kind == Kind::state || n.kind == Kind::control)
      rate += total_derivative(Expr{&g, id}) * partial(e, Expr{&g, id});
  }
  return rate;
}

Power power(const Mechanics& m) {
  const Model& model = *m.model;
  Graph& g = m.graph();
  Expr h = -m.T;
  const Column momentum = gradient(m.T, m.qd);
  for (std::size_t a = 0; a < m.q.size(); ++a) h += m.qd[a] * momentum[a];

  // dh/dt = sum mdot dh/dm - DT/Dt(explicit) + sum q'(Q + QR + QD + Qomega - d(V_O + V_omega) + Gamma) + P_c
  Column masses;
  for (std::size_t i = 0; i < model.masses.size(); ++i) masses.push_back(g.mass(static_cast<std::uint32_t>(i)));
  const Column dh_dm = gradient(h, masses);
  Expr rate = -by_time(m.T), constraint = g.zero();
  for (std::size_t i = 0; i < masses.size(); ++i) rate += total_derivative(model.masses[i].value) * dh_dm[i];
  for (std::size_t a = 0; a < m.q.size(); ++a) {
    rate += m.qd[a] * (m.Q[a] + m.QR[a] + m.QD[a] + m.Qomega[a] + m.minus_dVO[a] + m.minus_dVomega[a] + m.Gamma[a]);
    constraint += m.qd[a] * m.N[a];
  }
  const Expr parts[] = {h, rate, constraint};
  const Column put = put_masses(model, parts);
  return {put[0], put[1], put[2], total_derivative(put[0])};
}

std::vector<Column> mass_matrix(const Mechanics& m) {
  std::vector<Column> rows;
  for (Expr p : gradient(m.T, m.qd)) rows.push_back(put_masses(*m.model, gradient(p, m.qd)));
  return rows;
}

Column newton_left_side(const Mechanics& m) {
  Pull pull;
  for (const WeightedPoint& p : m.points) pull.add(p.place, p.weight * total_derivative(total_derivative(p.place)));
  Column left = put_masses(*m.model, pull.back(m.q));
  for (Expr& e : left) e = put_state_rates(*m.model, e, 2);
  return left;
}

static void for_each_expression(WeightedPoint& p, const ExprVisitor& f) {
  auto& [weight, place, uniform_field, body, speed2, acceleration2] = p;
  for_each_expression_of(f, weight, place, uniform_field, body, speed2, acceleration2);
}

void for_each_expression(Mechanics& m, const ExprVisitor& f) {
  auto& [model, points, q, qd, qdd, T, S, V_O, V_omega, Q, QR, QD, Qomega, minus_dVO, minus_dVomega, Gamma, phi, order,
         Phi, lambda, N] = m;
  static_cast<void>(model);
  for_each_expression_of(f, points, q, qd, qdd, T, S, V_O, V_omega, Q, QR, QD, Qomega, minus_dVO, minus_dVomega, Gamma,
                         phi, order, Phi, lambda, N);
}

}  // namespace anholon

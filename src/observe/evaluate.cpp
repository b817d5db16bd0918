#include "observe/evaluate.h"

#include <algorithm>

#include "numeric/relative.h"
#include "setup/redundant.h"

namespace anholon {

template <Number N>
NewtonResidual<N> certify(const std::vector<N>& inertia, const std::vector<N>& force, const std::vector<N>& reaction,
                          const Matrix<N>& phi) {
  NewtonResidual<N> c;
  const std::size_t n = inertia.size();
  std::vector<N> a(n, N(0));
  for (std::size_t i = 0; i < n; ++i) {
    for (const N* v : {&inertia[i], &force[i], &reaction[i]})
      if (abs(*v) > c.largest) c.largest = abs(*v);
    a[i] = inertia[i] - force[i];
    if (N miss = abs(N(a[i] - reaction[i])); miss > c.newton) c.newton = miss;
  }
  // a - Phi^T lambda* with lambda* by least squares over independent rows.
  const std::vector<std::size_t> rows = choose_rows(phi, N(1e-9)).independent;
  Matrix<N> normal(rows.size(), rows.size());
  std::vector<N> rhs(rows.size(), N(0)), lambda;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < rows.size(); ++j)
      for (std::size_t k = 0; k < n; ++k) addmul(normal(i, j), phi(rows[i], k), phi(rows[j], k));
    for (std::size_t k = 0; k < n; ++k) addmul(rhs[i], phi(rows[i], k), a[k]);
  }
  Lu<N> lu;
  if (!rows.empty()) {
    if (!lu.factor(normal)) return c;
    lu.solve(rhs, lambda);
  }
  for (std::size_t k = 0; k < n; ++k) {
    N left = a[k];
    for (std::size_t i = 0; i < rows.size(); ++i) addmul(left, N(-lambda[i]), phi(rows[i], k));
    if (abs(left) > c.projected) c.projected = abs(left);
  }
  return c;
}

namespace {

template <Number N>
std::string text(const N& x, int digits) {
  if constexpr (std::same_as<N, Multi>)
    return number_text(x, digits + 2);
  else if constexpr (std::same_as<N, Quad>)
    return quad_text(x, digits);
  else
    return number_text(static_cast<double>(x));
}

template <Number N>
Outcome evaluate_in(Workspace& s, const StateChoice& choice, int digits, StateReport& r) {
  const Model& model = *s.model;
  const Mechanics& m = *s.mechanics;
  const std::size_t n = m.q.size();
  const std::vector<N> parameters = parameter_values<N>(model);
  const Program prog = program(s.system, s.structure);
  const int largest_d = largest_order(s, prog.d), beyond = orders_beyond(s, prog.d);
  Expansion<N> point(prog, parameters, std::max(1, beyond));
  Start<N> start;
  if (Outcome o = initial_state(s, choice, start); !o.ok()) return o;
  point.load(start.t, start.state, start.leading);
  if (Outcome o = point.prepare(); !o.ok()) return o;
  if (Outcome o = point.project(); !o.ok()) return o;
  if (Outcome o = point.solve(); !o.ok()) return o;
  if (beyond > 0)
    if (Outcome o = point.extend(); !o.ok()) return o;

  const auto put = [&](const Column& c) { return put_masses(model, c); };
  std::vector<std::pair<const char*, Column>> forces = {{"Q", put(m.Q)},
                                                        {"QR", put(m.QR)},
                                                        {"Qomega", put(m.Qomega)},
                                                        {"minus_dVO", put(m.minus_dVO)},
                                                        {"minus_dVomega", put(m.minus_dVomega)},
                                                        {"Gamma", put(m.Gamma)}};
  if (!model.dissipation.empty()) forces.push_back({"QD", put(m.QD)});
  const std::size_t given = forces.size();  // before Newton's left side and the reactions
  forces.push_back({"inertia_term", newton_left_side(m)});
  forces.push_back({"N", put(m.N)});
  const Power p = power(m);
  const std::vector<std::pair<const char*, Expr>> numbers = {{"T_r", put_masses(model, m.T)},
                                                             {"S_r", put_masses(model, m.S)},
                                                             {"V_O", put_masses(model, m.V_O)},
                                                             {"V_omega", put_masses(model, m.V_omega)},
                                                             {"h", p.h},
                                                             {"power_noncons", p.noncons},
                                                             {"power_constraint", p.constraint},
                                                             {"dh_dt", p.dh_dt}};
  const std::vector<Column> mass = mass_matrix(m);
  const std::vector<Load> loads = reactions(*m.model);
  Column es;
  for (const auto& [name, column] : forces) es.insert(es.end(), column.begin(), column.end());
  for (const auto& [name, e] : numbers) es.push_back(e);
  for (const Column& row : mass) es.insert(es.end(), row.begin(), row.end());
  for (const Load& l : loads)
    for (int i = 0; i < 3; ++i) es.push_back(l.force[i]);
  for (const Load& l : loads)
    for (int i = 0; i < 3; ++i) es.push_back(l.torque[i]);
  const std::size_t phi_first = es.size();
  for (std::size_t k : s.system.constraints)
    for (Expr e : m.Phi[k]) es.push_back(put_masses(model, e));
  OutputTape<N> out(s, es, parameters);
  out.evaluate(point);

  r.t = text(start.t, digits);
  for (std::size_t a = 0; a < n; ++a) {
    r.q.push_back({model.coordinates[a].name, text(point.derivative(a, 0), digits)});
    r.qdot.push_back({model.coordinates[a].name, text(point.derivative(a, 1), digits)});
  }
  std::size_t at = 0;
  std::vector<std::vector<N>> columns(forces.size());
  for (std::size_t f = 0; f < forces.size(); ++f) {
    std::vector<std::string> column;
    for (std::size_t a = 0; a < n; ++a, ++at) {
      columns[f].push_back(out[at]);
      column.push_back(text(out[at], digits));
    }
    r.forces.push_back({forces[f].first, column});
  }
  for (int k = 2; k <= largest_d; ++k)
    for (std::size_t a = 0; a < n; ++a)
      r.derivatives.push_back({derivative_name(model.coordinates[a].name, static_cast<unsigned>(k), Format::text),
                               text(point.derivative(a, k), digits)});
  Redundant<N> redundant(s, parameters);
  double missed = 0;
  if (Outcome o = redundant.hold(point, true, missed); !o.ok()) return o;
  const std::vector<N> multipliers = redundant.multipliers(point);
  for (std::size_t k = 0; k < model.constraints.size(); ++k) {
    const auto j = s.system.variable(m.lambda[k].id);
    for (int order = 0; order <= multiplier_orders(s); ++order)
      r.lambda.push_back({derivative_name(multiplier_name(model, k), static_cast<unsigned>(order), Format::text),
                          text(order == 0 ? multipliers[k]
                               : j        ? point.derivative(*j, order)
                                          : N(0),
                               digits)});
  }
  N dh(0), rate(0);
  const std::size_t first_number = at;
  for (const auto& [name, e] : numbers) {
    r.numbers.push_back({name, text(out[at], digits)});
    if (std::string(name) == "power_noncons" || std::string(name) == "power_constraint") rate += out[at];
    if (std::string(name) == "dh_dt") dh = out[at];
    ++at;
  }
  for (std::size_t a = 0; a < n; ++a) {
    std::vector<std::string> row;
    for (std::size_t b = 0; b < n; ++b, ++at) row.push_back(text(out[at], digits));
    r.mass_matrix.push_back(row);
  }
  const std::size_t bodies = model.bodies.size();
  for (std::size_t b = 0; b < bodies; ++b) {
    StateReport::Reaction reaction{model.bodies[b].name, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
      reaction.force.push_back(text(out[at + 3 * b + i], digits));
      reaction.torque.push_back(text(out[at + 3 * (bodies + b) + i], digits));
    }
    r.reactions.push_back(reaction);
  }
  std::vector<N> force(n, N(0));
  for (std::size_t f = 0; f < given; ++f)
    for (std::size_t a = 0; a < n; ++a) force[a] += columns[f][a];
  Matrix<N> phi(s.system.constraints.size(), n);
  for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = out[phi_first + i];
  const NewtonResidual<N> c = certify(columns[given], force, columns[given + 1], phi);
  const auto greatest_made_of = [&](std::size_t first, std::size_t count) {
    N most(0);
    for (std::size_t i = first; i < first + count; ++i)
      if (const N& v = out.made_of(i); v > most) most = v;
    return most;
  };
  const auto of_law = [&](const N& miss) {
    return relative_miss(miss, c.largest, [&] { return greatest_made_of(0, (given + 2) * n); });
  };
  const N power_miss = relative_miss(N(dh - rate), std::max(N(abs(dh)), N(abs(rate))),
                                     [&] { return greatest_made_of(first_number, numbers.size()); });
  const auto small = [](const N& x) { return number_text(to_double(x), 3); };
  r.residuals = {{"newton", small(of_law(c.newton))},
                 {"projected", small(of_law(c.projected))},
                 {"constraints", small(point.constraint_residual())},
                 {"power", small(power_miss)}};
  return {};
}

}  // namespace

Outcome evaluate(const Scenario& s, const StateChoice& choice, int digits, StateReport& report) {
  return evaluate(s, choice, digits <= 16 ? Precision::long_real : Precision::multi, digits, report);
}

Outcome evaluate(const Scenario& scenario, const StateChoice& choice, Precision precision, int digits,
                 StateReport& report) {
  Workspace s(scenario);
  switch (precision) {
  case Precision::real:
  case Precision::long_real:
    return evaluate_in<long double>(s, choice, digits, report);
  case Precision::quad:
    return evaluate_in<Quad>(s, choice, digits, report);
  case Precision::multi:
    break;
  }
  const PrecisionScope scope(digits + 12);
  return evaluate_in<Multi>(s, choice, digits, report);
}

template NewtonResidual<double> certify(const std::vector<double>&, const std::vector<double>&,
                                        const std::vector<double>&, const Matrix<double>&);
template NewtonResidual<long double> certify(const std::vector<long double>&, const std::vector<long double>&,
                                             const std::vector<long double>&, const Matrix<long double>&);
template NewtonResidual<Quad> certify(const std::vector<Quad>&, const std::vector<Quad>&, const std::vector<Quad>&,
                                      const Matrix<Quad>&);
template NewtonResidual<Multi> certify(const std::vector<Multi>&, const std::vector<Multi>&, const std::vector<Multi>&,
                                       const Matrix<Multi>&);

}  // namespace anholon

#include "observe/evaluate.h"

#include <algorithm>

#include "numeric/relative.h"
#include "setup/outputs/redundant.h"

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
  // a - Phi^T lambda*, where lambda* is found by least squares over independent rows.
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

// Outputs [first, first + count) of a tape.
struct Block {
  std::size_t first = 0, count = 0;
};

// The expressions of a report, in blocks of one list.
struct ReportedExpressions {
  explicit ReportedExpressions(const Scenario& s);

  struct Named {
    const char* name;
    Block at;
  };
  Column all;
  std::vector<Named> forces;  // by coordinate
  Named inertia, reaction;    // Newton's left side, N
  std::vector<Named> numbers;
  Block noncons, constraint, dh_dt;  // those of the power identity
  Block mass, body_forces, body_torques, phi;

 private:
  Block add(const Column& es) {
    all.insert(all.end(), es.begin(), es.end());
    return {all.size() - es.size(), es.size()};
  }
  Block add_number(const char* title, Expr e) {
    numbers.push_back({title, add({e})});
    return numbers.back().at;
  }
};

ReportedExpressions::ReportedExpressions(const Scenario& s) {
  const Model& model = *s.model;
  const Mechanics& m = *s.mechanics;
  const auto put = [&](const Column& c) { return put_masses(model, c); };
  forces = {{"Q", add(put(m.Q))}};
  if (!model.dissipation.empty()) forces.push_back({"QD", add(put(m.QD))});
  for (const auto& [name, column] : {std::pair{"QR", &m.QR},
                                     {"Qomega", &m.Qomega},
                                     {"minus_dVO", &m.minus_dVO},
                                     {"minus_dVomega", &m.minus_dVomega},
                                     {"Gamma", &m.Gamma}})
    forces.push_back({name, add(put(*column))});
  inertia = {"inertia_term", add(newton_left_side(m))};
  reaction = {"N", add(put(m.N))};
  const Power p = power(m);
  add_number("T_r", put_masses(model, m.T));
  add_number("S_r", put_masses(model, m.S));
  add_number("V_O", put_masses(model, m.V_O));
  add_number("V_omega", put_masses(model, m.V_omega));
  add_number("h", p.h);
  noncons = add_number("power_noncons", p.noncons);
  constraint = add_number("power_constraint", p.constraint);
  dh_dt = add_number("dh_dt", p.dh_dt);
  Column entries, on_bodies, about_bodies, partials;
  for (const Column& row : mass_matrix(m)) entries.insert(entries.end(), row.begin(), row.end());
  for (const Load& l : reactions(*m.model))
    for (int i = 0; i < 3; ++i) on_bodies.push_back(l.force[i]), about_bodies.push_back(l.torque[i]);
  for (std::size_t k : s.system.constraints)
    for (Expr e : m.Phi[k]) partials.push_back(put_masses(model, e));
  mass = add(entries);
  body_forces = add(on_bodies);
  body_torques = add(about_bodies);
  phi = add(partials);
}

// Writes a report of one point, part by part.
template <Number N>
class StateWriter {
 public:
  StateWriter(Workspace& s, const ReportedExpressions& e, const std::vector<N>& parameters, const Expansion<N>& point,
              int digits, StateReport& report)
      : s_(s), e_(e), n_(s.mechanics->q.size()), point_(point), digits_(digits), out_(s, e.all, parameters),
        r_(report) {
    if (out_.evaluate_moved(point, N(0)))
      moved_law_ = greatest_made_of(law()), moved_power_ = greatest_made_of(power());
    out_.evaluate(point);
  }

  void coordinates(int highest_derivative) {
    const std::vector<Coordinate>& q = s_.model->coordinates;
    r_.t = text(point_.time(), digits_);
    for (std::size_t a = 0; a < n_; ++a) {
      r_.q.push_back({q[a].name, text(point_.derivative(a, 0), digits_)});
      r_.qdot.push_back({q[a].name, text(point_.derivative(a, 1), digits_)});
    }
    for (int k = 2; k <= highest_derivative; ++k)
      for (std::size_t a = 0; a < n_; ++a)
        r_.derivatives.push_back({derivative_name(q[a].name, static_cast<unsigned>(k), Format::text),
                                  text(point_.derivative(a, k), digits_)});
  }

  void forces() {
    for (const auto& [name, at] : e_.forces) r_.forces.push_back({name, texts(at)});
    for (const auto& [name, at] : {e_.inertia, e_.reaction}) r_.forces.push_back({name, texts(at)});
  }

  // `values`: the multipliers of all constraints.
  void multipliers(const std::vector<N>& values) {
    for (std::size_t k = 0; k < s_.model->constraints.size(); ++k) {
      const auto j = s_.system.variable(s_.mechanics->lambda[k].id);
      for (int order = 0; order <= multiplier_orders(s_); ++order)
        r_.lambda.push_back({derivative_name(multiplier_name(*s_.model, k), static_cast<unsigned>(order), Format::text),
                             text(order == 0 ? values[k]
                                  : j        ? point_.derivative(*j, order)
                                             : N(0),
                                  digits_)});
    }
  }

  void numbers() {
    for (const auto& [name, at] : e_.numbers) r_.numbers.push_back({name, text(out_[at.first], digits_)});
    for (std::size_t a = 0; a < n_; ++a) r_.mass_matrix.push_back(texts({e_.mass.first + a * n_, n_}));
  }

  void reactions() {
    for (std::size_t b = 0; b < s_.model->bodies.size(); ++b)
      r_.reactions.push_back({s_.model->bodies[b].name, texts({e_.body_forces.first + 3 * b, 3}),
                              texts({e_.body_torques.first + 3 * b, 3})});
  }

  void residuals() {
    std::vector<N> force(n_, N(0));
    for (const auto& [name, at] : e_.forces)
      for (std::size_t a = 0; a < n_; ++a) force[a] += out_[at.first + a];
    Matrix<N> phi(s_.system.constraints.size(), n_);
    phi.data = values(e_.phi);
    const NewtonResidual<N> c = certify(values(e_.inertia.at), force, values(e_.reaction.at), phi);
    const auto of_law = [&](const N& miss) {
      return relative_miss(miss, c.largest, [&] { return size_behind(miss, greatest_made_of(law()), moved_law_); });
    };
    const N dh = out_[e_.dh_dt.first], rate = out_[e_.noncons.first] + out_[e_.constraint.first];
    const N power_miss = relative_miss(N(dh - rate), std::max(N(abs(dh)), N(abs(rate))), [&] {
      return size_behind(N(dh - rate), greatest_made_of(power()), moved_power_);
    });
    const auto small = [](const N& x) { return number_text(to_double(x), 3); };
    r_.residuals = {{"newton", small(of_law(c.newton))},
                    {"projected", small(of_law(c.projected))},
                    {"constraints", small(point_.constraint_residual())},
                    {"power", small(power_miss)}};
  }

 private:
  std::vector<N> values(const Block& of) const {
    std::vector<N> list;
    for (std::size_t i = 0; i < of.count; ++i) list.push_back(out_[of.first + i]);
    return list;
  }
  std::vector<std::string> texts(const Block& of) const {
    std::vector<std::string> list;
    for (const N& x : values(of)) list.push_back(text(x, digits_));
    return list;
  }
  Block law() const { return {0, e_.reaction.at.first + n_}; }
  Block power() const { return {e_.numbers.front().at.first, e_.numbers.size()}; }
  N greatest_made_of(const Block& of) const {
    N most(0);
    for (std::size_t i = of.first; i < of.first + of.count; ++i)
      if (const N& v = out_.made_of(i); v > most) most = v;
    return most;
  }

  Workspace& s_;
  const ReportedExpressions& e_;
  std::size_t n_;
  const Expansion<N>& point_;
  int digits_;
  OutputTape<N> out_;
  StateReport& r_;
  N moved_law_{0}, moved_power_{0};  // by OutputTape::evaluate_moved
};

// Computes the point of the consistent state, with the orders beyond its leading derivatives if they are needed.
template <Number N>
Outcome solve_at_start(Workspace& s, const StateChoice& choice, bool beyond, Expansion<N>& point) {
  Start<N> start;
  if (Outcome o = initial_state(s, choice, start); !o.ok()) return o;
  point.load(start.t, start.state, start.leading);
  if (Outcome o = point.prepare(); !o.ok()) return o;
  if (Outcome o = point.project(); !o.ok()) return o;
  if (Outcome o = point.solve(); !o.ok()) return o;
  return beyond ? point.extend() : Outcome{};
}

template <Number N>
Outcome evaluate_in(Workspace& s, const StateChoice& choice, int digits, StateReport& r) {
  const std::vector<N> parameters = parameter_values<N>(*s.model);
  const Program prog = program(s.system, s.structure);
  const int beyond = orders_beyond(s, prog.d);
  Expansion<N> point(prog, parameters, std::max(1, beyond));
  if (Outcome o = solve_at_start(s, choice, beyond > 0, point); !o.ok()) return o;
  const ReportedExpressions expressions(s);
  StateWriter<N> writer(s, expressions, parameters, point, digits, r);
  writer.coordinates(largest_order(s, prog.d));
  writer.forces();
  Redundant<N> redundant(s, parameters);
  std::vector<typename Redundant<N>::Miss> misses;
  if (Outcome o = redundant.hold(point, true, misses); !o.ok()) return o;
  if (Outcome o = follow_beside_start(s); !o.ok()) return o;
  writer.multipliers(redundant.multipliers(point));
  writer.numbers();
  writer.reactions();
  writer.residuals();
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

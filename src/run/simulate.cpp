#include "run/simulate.h"

#include <algorithm>
#include <chrono>

#include "run/evaluate.h"

namespace anholon {

namespace {

// The power of all forces for the energy balance. Constraints that do no work on the motion (first
// order and homogeneous, holonomic without t) are left out: their power is zero, and its terms, which
// are large and cancel, would only add round-off to the balance.
Expr balance_power(const Scenario& s, const Power& p) {
  const Mechanics& m = *s.mechanics;
  Graph& g = m.graph();
  Expr total = p.noncons;
  for (std::size_t r : s.system.constraints) {
    if (m.order[r] == 1 && s.classes[r].homogeneous) continue;
    Expr rate = g.zero();
    if (m.order[r] == 0) rate = -partial(m.phi[r], g.time());
    else
      for (std::size_t a = 0; a < m.q.size(); ++a) rate += m.Phi[r][a] * m.qd[a];
    total += m.lambda[r] * put_masses(*s.model, rate);
  }
  return total;
}

// N: the numbers of the Taylor coefficients; W: those of the state and of everything written.
template <Number N>
class Run {
 public:
  using W = Wider<N>;
  Run(const Scenario& s, const SimulationOptions& o, RowSink& sink)
      : s_(s), o_(o), sink_(sink), parameters_(parameter_values<W>(*s.model)), power_(anholon::power(*s.mechanics)),
        program_(program(s.system, s.structure, std::vector<Expr>{balance_power(s, power_)})),
        stepper_(program_, parameter_values<N>(*s.model), parameters_, settings(o)), point_(program_, parameters_, extra_orders()),
        outputs_(s, output_expressions(), parameters_) {}

  SimulationReport go() {
    report_.order = stepper_.order();
    sink_.columns(column_names());
    W t(0);
    std::vector<W> state;
    InitialState<W> named;
    report_.outcome = initial_state(s_, o_.state, t, state, named);
    if (report_.outcome.ok()) report_.outcome = stepper_.start(t, state);
    if (report_.outcome.ok()) {
      schedule(t);
      run(t);
    }
    report_.t = number_text(to_double(stepper_.time()));
    report_.steps = stepper_.steps();
    report_.constraints = to_double(stepper_.worst_constraint());
    report_.smallest_sigma = to_double(stepper_.smallest_sigma());
    return report_;
  }

 private:
  static StepSettings settings(const SimulationOptions& o) { return {o.tolerance, o.order, o.most_steps, o.cancelled}; }

  // Derivatives beyond its own leading one, up to the highest solved for any coordinate.
  int extra_orders() const {
    const auto end = program_.d.begin() + static_cast<std::ptrdiff_t>(s_.system.coordinates);
    return std::max(1, *std::max_element(program_.d.begin(), end) - *std::min_element(program_.d.begin(), end));
  }
  int highest() const {
    const auto end = program_.d.begin() + static_cast<std::ptrdiff_t>(s_.system.coordinates);
    return *std::max_element(program_.d.begin(), end);
  }
  bool mixed() const {
    const auto end = program_.d.begin() + static_cast<std::ptrdiff_t>(s_.system.coordinates);
    return *std::min_element(program_.d.begin(), end) < highest();
  }

  std::vector<std::string> column_names() const {
    std::vector<std::string> names = {"t"};
    const Model& model = *s_.model;
    for (int k = 0; k <= highest(); ++k)
      for (const Coordinate& c : model.coordinates) names.push_back(derivative_name(c.name, static_cast<unsigned>(k), Format::text));
    for (const Constraint& c : model.constraints) names.push_back("lambda." + c.name);
    for (const Coordinate& c : model.coordinates) names.push_back("N." + c.name);
    return names;
  }

  // N, then what the residual report needs: h, E, G, Phi.
  Column output_expressions() const {
    const Model& model = *s_.model;
    const Mechanics& m = *s_.mechanics;
    Column es = put_masses(model, m.N);
    es.push_back(power_.h);
    const Column inertia = newton_left_side(m);
    const Column force = put_masses(model, m.Q + m.QR + m.Qomega + m.minus_dVO + m.minus_dVomega + m.Gamma);
    es.insert(es.end(), inertia.begin(), inertia.end());
    es.insert(es.end(), force.begin(), force.end());
    for (std::size_t k : s_.system.constraints)
      for (Expr e : m.Phi[k]) es.push_back(put_masses(model, e));
    return es;
  }

  void schedule(const W& t) {
    if (!o_.at.empty()) {
      for (const Rational& r : o_.at) times_.push_back(from_rational<W>(r));
      end_ = *std::max_element(times_.begin(), times_.end());
      if (o_.to && from_rational<W>(*o_.to) > end_) end_ = from_rational<W>(*o_.to);
      return;
    }
    end_ = from_rational<W>(*o_.to);
    if (o_.every) {
      const bool forward = end_ >= t;
      const Rational t0 = start_time(t);
      for (long k = 0;; ++k) {
        const Rational r = forward ? Rational(t0 + k * *o_.every) : Rational(t0 - k * *o_.every);
        if (forward ? r > *o_.to : r < *o_.to) break;
        times_.push_back(from_rational<W>(r));
      }
      if (times_.empty() || times_.back() != end_) times_.push_back(end_);
    }
  }

  Rational start_time(const W& t) const {
    if (o_.state.t) return *o_.state.t;
    const Expr e = s_.model->initial.t;
    if (is_number(e)) return number_value(e);
    Rational r;
    r = to_double(t);
    return r;
  }

  void run(const W& t0) {
    const bool every_step = times_.empty();
    std::size_t next = 0;
    if (every_step) row(t0, "");
    // Rows at or before the start come from the initial state itself.
    while (next < times_.size() && times_[next] == t0) row(t0, label(next)), ++next;
    energy_at(t0, h0_);
    if (next < times_.size() && ((times_[next] < t0) == (end_ > t0)) && !(times_[next] == t0)) {
      report_.outcome = {OutcomeKind::inconsistent, "the time " + label_or(next) + " lies before the start",
                         "rows are wanted at times after [initial] t, in order"};
      return;
    }
    while (report_.outcome.ok() && !(stepper_.time() == end_)) {
      report_.outcome = stepper_.step(end_);
      if (!report_.outcome.ok()) break;
      if (o_.progress) o_.progress(to_double(stepper_.time()), stepper_.steps());
      const bool forward = end_ > t0;
      while (report_.outcome.ok() && next < times_.size() &&
             (forward ? times_[next] <= stepper_.time() : times_[next] >= stepper_.time())) {
        row(times_[next], label(next));
        ++next;
      }
      if (every_step && report_.outcome.ok()) row(stepper_.time(), "");
    }
    if (report_.outcome.ok() && stepper_.steps() > 0) balance();
    if (!report_.outcome.ok() && report_.outcome.message.find(" at t = ") == std::string::npos) {
      report_.outcome.message += " at t = " + number_text(to_double(stepper_.time()), 12);
      // The last good state is worth a row of its own.
      if (stepper_.steps() > 0 && !every_step) {
        const Outcome why = report_.outcome;
        row(stepper_.before(), "");
        report_.outcome = why;
      }
    }
  }

  std::string label(std::size_t k) const { return k < o_.at_text.size() ? o_.at_text[k] : std::string(); }
  std::string label_or(std::size_t k) const {
    return label(k).empty() ? number_text(to_double(times_[k]), 12) : label(k);
  }

  std::string text(const W& x) const {
    if constexpr (std::same_as<N, Multi>) return number_text(x, o_.digits + 2);
    else return number_text(convert<N>(x));
  }

  void row(const W& t, const std::string& label) {
    if (Outcome o = stepper_.at(t, point_); !o.ok()) {
      report_.outcome = o;
      report_.outcome.message += " at t = " + number_text(to_double(t), 12);
      return;
    }
    if (mixed())
      if (Outcome o = point_.extend(); !o.ok()) {
        report_.outcome = o;
        return;
      }
    outputs_.evaluate(point_);
    const std::size_t n = s_.system.coordinates;
    std::vector<std::string> values = {label.empty() ? text(t) : label};
    for (int k = 0; k <= highest(); ++k)
      for (std::size_t a = 0; a < n; ++a) values.push_back(text(point_.derivative(a, k)));
    for (std::size_t r = 0; r < s_.model->constraints.size(); ++r) {
      const auto j = s_.system.variable(s_.mechanics->lambda[r].id);
      values.push_back(text(j ? point_.derivative(*j, 0) : W(0)));
    }
    for (std::size_t a = 0; a < n; ++a) values.push_back(text(outputs_[a]));
    sink_.row(values);
    ++report_.rows;
    watch();
  }

  void watch() {
    const std::size_t n = s_.system.coordinates;
    std::vector<W> inertia(n), force(n), reaction(n);
    Matrix<W> phi(s_.system.constraints.size(), n);
    for (std::size_t a = 0; a < n; ++a) {
      reaction[a] = outputs_[a];
      inertia[a] = outputs_[n + 1 + a];
      force[a] = outputs_[2 * n + 1 + a];
    }
    for (std::size_t i = 0; i < phi.data.size(); ++i) phi.data[i] = outputs_[3 * n + 1 + i];
    const Certificate<W> c = certify(inertia, force, reaction, phi);
    report_.newton = std::max(report_.newton, to_double(c.newton));
    report_.projected = std::max(report_.projected, to_double(c.projected));
    report_.constraints_kept = std::max(report_.constraints_kept, to_double(point_.constraint_residual()));
  }

  void energy_at(const W& t, W& h) {
    if (!stepper_.at(t, point_).ok()) return;
    outputs_.evaluate(point_);
    h = outputs_[s_.system.coordinates];
  }

  void balance() {
    W h(0);
    energy_at(stepper_.time(), h);
    const W work = stepper_.integrals()[0];
    W scale(1);
    for (const W& v : {h, h0_, work})
      if (abs(v) > scale) scale = abs(v);
    report_.power = to_double(W(abs(W(h - h0_ - work)) / scale));
  }

  const Scenario& s_;
  const SimulationOptions& o_;
  RowSink& sink_;
  std::vector<W> parameters_;
  Power power_;
  Program program_;
  Stepper<N> stepper_;
  Expansion<W> point_;
  OutputTape<W> outputs_;
  std::vector<W> times_;
  W end_{0}, h0_{0};
  SimulationReport report_;
};

}  // namespace

SimulationReport simulate(const Scenario& s, const SimulationOptions& o, RowSink& sink) {
  const auto start = std::chrono::steady_clock::now();
  SimulationReport r;
  switch (o.precision) {
    case Precision::real: r = Run<double>(s, o, sink).go(); break;
    case Precision::long_real: r = Run<long double>(s, o, sink).go(); break;
    case Precision::multi: {
      const PrecisionScope precision(o.digits + 12);
      r = Run<Multi>(s, o, sink).go();
      break;
    }
  }
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return r;
}

}  // namespace anholon

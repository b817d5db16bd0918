#include "run/simulate.h"

#include <algorithm>
#include <chrono>

#include "run/evaluate.h"
#include "structure/branch.h"

namespace anholon {

namespace {

// A redundant constraint missed by more than this of the size of the state no longer follows from
// the others.
constexpr double kRedundantMiss = 1e-7;

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
        leg_(std::make_unique<Leg>(*this, s.system, s.structure)), outputs_(s, output_expressions(), parameters_) {
    watch_pivots(s.elimination);
  }

  SimulationReport go() {
    report_.order = leg_->stepper.order();
    Start<W> start;
    report_.outcome = initial_state(s_, o_.state, start);
    if (report_.outcome.ok()) report_.outcome = leg_->stepper.start(start.t, start.state, start.leading);
    if (report_.outcome.ok()) {
      sink_.columns(column_names());
      schedule(start.t);
      if constexpr (std::same_as<N, double>)
        if (o_.integrator != Integrator::taylor)
          second_ = std::make_unique<SecondMotion>(s_, o_.state, balance_power(s_, power_),
                                                   SundialsSettings{o_.integrator, o_.tolerance.get_d(), o_.most_steps, o_.cancelled}, end_);
      run(start.t);
    }
    report_.t = number_text(to_double(reached_ ? *reached_ : leg_->stepper.time()));
    report_.steps = leg_->stepper.steps();
    report_.constraints = to_double(leg_->stepper.worst_constraint());
    report_.smallest_sigma = to_double(leg_->stepper.smallest_sigma());
    if (second_) {
      report_.second = second_->report();
      report_.constraints = report_.second->drift;
    }
    return report_;
  }

 private:
  // A stretch of the motion with one elimination: its system and what steps through it.
  struct Leg {
    Leg(const Run& run, System of, Structure structured)
        : system(std::move(of)), structure(std::move(structured)), program(anholon::program(system, structure, quadratures(run.s_, run.power_))),
          stepper(program, parameter_values<N>(*run.s_.model), run.parameters_, settings(run.o_)), point(program, run.parameters_, std::max(1, orders_beyond(run.s_, structure.d))) {}
    System system;
    Structure structure;
    Program program;
    Stepper<N> stepper;
    Expansion<W> point;
  };

  static StepSettings settings(const SimulationOptions& o) {
    return {natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled};
  }

  // The energy balance first, then the masses that vary.
  static std::vector<Expr> quadratures(const Scenario& s, const Power& p) {
    std::vector<Expr> es = {balance_power(s, p)};
    for (const VaryingMass& m : s.model->masses) es.push_back(m.value);
    return es;
  }

  int highest() const { return largest_order(s_, leg_->program.d); }

  std::vector<std::string> column_names() const {
    std::vector<std::string> names = {"t"};
    const Model& model = *s_.model;
    for (int k = 0; k <= highest(); ++k)
      for (const Coordinate& c : model.coordinates) names.push_back(derivative_name(c.name, static_cast<unsigned>(k), Format::text));
    for (int k = 0; k <= multiplier_orders(s_); ++k)
      for (const Constraint& c : model.constraints) names.push_back(derivative_name("lambda." + c.name, static_cast<unsigned>(k), Format::text));
    for (const Coordinate& c : model.coordinates) names.push_back("N." + c.name);
    return names;
  }

  // N, then what the residual report needs: h, E, G, Phi, the redundant constraints.
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
    for (std::size_t k : s_.redundant) es.push_back(put_masses(model, m.phi[k]));
    return es;
  }

  // The times of the rows, in the direction of the motion, and its end.
  void schedule(const W& t) {
    for (const Rational& r : o_.at) times_.push_back(from_rational<W>(r));
    labels_ = o_.at_text;
    labels_.resize(times_.size());
    end_ = o_.to && (times_.empty() || *o_.to > o_.at.back()) ? from_rational<W>(*o_.to) : times_.back();
    if (!times_.empty() && times_.front() < t && !(times_.back() > t)) {
      std::reverse(times_.begin(), times_.end());
      std::reverse(labels_.begin(), labels_.end());
      end_ = times_.back();
    }
    if (!o_.every) return;
    const Rational step = end_ < t ? Rational(-*o_.every) : *o_.every;
    for (long k = 0;; ++k) {
      const W next = t + from_rational<W>(Rational(k * step));
      if (end_ < t ? next < end_ : next > end_) break;
      times_.push_back(next);
    }
    if (times_.empty() || times_.back() != end_) times_.push_back(end_);
    labels_.resize(times_.size());
  }

  void run(const W& t0) {
    const bool every_step = times_.empty();
    std::size_t next = 0;
    if (every_step) row(t0, "");
    // Rows at or before the start come from the initial state itself.
    while (next < times_.size() && times_[next] == t0) row(t0, label(next)), ++next;
    energy_at(t0, h0_);
    while (report_.outcome.ok() && !(leg_->stepper.time() == end_)) {
      report_.outcome = leg_->stepper.step(end_);
      // Near a zero of a pivot the form of the equations fails, not the motion: another elimination goes on.
      if (!report_.outcome.ok() && pivots_ && can_go_on(report_.outcome.kind) && eliminate_again()) report_.outcome = leg_->stepper.step(end_);
      if (!report_.outcome.ok()) break;
      const W stop = masses_positive_until();
      if (o_.progress) o_.progress(to_double(leg_->stepper.time()), leg_->stepper.steps());
      const bool forward = end_ > t0;
      while (report_.outcome.ok() && next < times_.size() &&
             (forward ? times_[next] <= stop : times_[next] >= stop)) {
        row(times_[next], label(next));
        ++next;
      }
      if (every_step && report_.outcome.ok()) row(stop, "");
      if (report_.outcome.ok() && !(stop == leg_->stepper.time())) negative_mass(stop);
      if (report_.outcome.ok() && !(leg_->stepper.time() == end_) && pivot_is_small()) eliminate_again();
    }
    if (report_.outcome.ok() && leg_->stepper.steps() > 0) balance();
    if (!report_.outcome.ok() && report_.outcome.message.find(" t = ") == std::string::npos) {
      report_.outcome.message += " at t = " + number_text(to_double(leg_->stepper.time()), 12);
      if (report_.outcome.kind == OutcomeKind::step_collapse || report_.outcome.kind == OutcomeKind::singular ||
          report_.outcome.kind == OutcomeKind::no_convergence)
        suspect();
      // The last good state is worth a row of its own.
      if (leg_->stepper.steps() > 0 && !every_step) {
        const Outcome why = report_.outcome;
        row(leg_->stepper.before(), "");
        report_.outcome = why;
      }
    }
  }

  static bool can_go_on(OutcomeKind kind) {
    return kind == OutcomeKind::singular || kind == OutcomeKind::step_collapse || kind == OutcomeKind::not_a_number;
  }

  // Keeps an eye on what the elimination divides by.
  void watch_pivots(const Elimination& e) {
    elimination_ = e;
    pivots_.reset();
    chosen_.clear();
    if (!e.pivots().empty()) pivots_ = std::make_unique<OutputTape<W>>(s_, put_masses(*s_.model, e.in_coordinates(e.on(e.pivots()))), parameters_);
  }

  bool pivot_is_small() {
    constexpr double kSmall = 0.4;
    if (!pivots_) return false;
    pivots_->evaluate(leg_->stepper.point());
    bool small = false;
    const bool first = chosen_.empty();
    for (std::size_t i = 0; i < elimination_.pivots().size(); ++i) {
      const double v = std::abs(to_double((*pivots_)[i]));
      if (first) chosen_.push_back(v);
      small = small || v < kSmall * chosen_[i];
    }
    return small;
  }

  // Another choice of dependent coordinates at the point where the last step began; false if it is the same and its pivots too.
  bool eliminate_again() {
    InitialState<double> here;
    const Expansion<W>& point = leg_->stepper.point();
    here.t = to_double(point.time());
    const auto level = [&](int k) {
      std::vector<double> values;
      for (std::size_t a = 0; a < s_.system.coordinates; ++a) values.push_back(k <= leg_->program.d[a] ? to_double(point.derivative(a, k)) : 0.0);
      return values;
    };
    here.q = level(0);
    here.qd = level(1);
    for (int k = 2; s_.routh && k <= highest(); ++k) here.higher.push_back({level(k), {}});
    const Model& model = *s_.model;
    try {
      const auto at = std::make_shared<PointValues>(values_near(model, parameter_values<double>(model), here));
      const Elimination e(*s_.mechanics, choose_elimination(*s_.mechanics, s_.independent, s_.system.form->unknowns, {}, *at), at);
      System system = implicit_system(s_.model, *s_.mechanics, *s_.system.form, s_.independent, e);
      Structure structure;
      ProbeHints hints;
      hints.t = here.t;
      hints.derivatives = {here.q, here.qd};
      for (const Level<double>& k : here.higher) hints.derivatives.push_back(k.value);
      if (!analyse(system, parameter_values<double>(model), hints, structure).ok() || structure.d != leg_->structure.d) return false;
      drop_absent(system, structure);
      const bool same = e.dependent == elimination_.dependent && e.pivots() == elimination_.pivots();
      watch_pivots(e);
      if (same) return false;
      auto next = std::make_unique<Leg>(*this, std::move(system), std::move(structure));
      if (!next->stepper.take_over(leg_->stepper).ok()) return false;
      leg_ = std::move(next);
      ++report_.eliminations;
      return true;
    } catch (const Failure&) {
      return false;  // the present elimination goes on as far as it can
    }
  }

  // The end of the last step, or the earlier time at which a mass passes zero.
  W masses_positive_until() {
    const W whole = leg_->stepper.time() - leg_->stepper.before();
    W good = whole;
    for (std::size_t i = 0; i < s_.model->masses.size(); ++i) {
      if (s_.model->masses[i].weight || !(leg_->stepper.quadrature(1 + i, good) < W(0))) continue;
      W low(0), high = good;
      for (int k = 0; k < 200 && !(low == high); ++k) {
        const W middle = low + (high - low) * W(0.5);
        if (middle == low || middle == high) break;
        (leg_->stepper.quadrature(1 + i, middle) < W(0) ? high : low) = middle;
      }
      good = low;
      negative_ = i;
    }
    return good == whole ? leg_->stepper.time() : leg_->stepper.before() + good;
  }

  // What the motion runs into: a mass that vanishes, a multiplier that grows without bound.
  void suspect() {
    constexpr double kVanished = 1e-9, kUnbounded = 1e9, kMeet = 1e-6, kFaint = 1e-3;
    std::string& message = report_.outcome.message;
    for (std::size_t a = 0; a < s_.system.coordinates; ++a)
      for (int k = 0; k < 2; ++k)
        if (std::abs(to_double(leg_->stepper.point().derivative(a, k))) > kUnbounded * kUnbounded) {
          report_.outcome.kind = OutcomeKind::blow_up;
          message += "; " + derivative_name(s_.system.variable_names[a], static_cast<unsigned>(k), Format::text) + " grows without bound";
          report_.outcome.hint = "look at the last good state: end the motion before";
          return;
        }
    for (std::size_t k = 0; k < s_.system.constraints.size(); ++k) {
      const std::size_t r = s_.system.constraints[k];
      if (!may_branch(*s_.mechanics, s_.system, r)) continue;
      const double now = to_double(leg_->stepper.point().derivative(s_.system.coordinates + k, 0)), start = s_.state.multipliers[0].value[r];
      const bool vanishes = s_.mechanics->order[r] > 2 && std::abs(now) < kFaint * std::abs(start);
      if (vanishes || to_double(leg_->stepper.smallest_sigma()) < kMeet) {
        report_.outcome.kind = OutcomeKind::singular;
        message = "singular configuration: " + (vanishes ? "the multiplier of the constraint '" + s_.model->constraints[r].name + "' goes to 0"
                                                         : "two solutions for the constraint '" + s_.model->constraints[r].name + "' meet") +
                  " at t = " + number_text(to_double(leg_->stepper.time()), 12) + ", and the equations no longer determine the motion there";
        report_.outcome.hint = "end the motion before; the other branch, [initial] branch = {…}, may go on";
        return;
      }
    }
    if (const std::string root = vanishing_root(); !root.empty()) message += "; " + root + " is at the edge of where it has a value";
    for (std::size_t i = 0; i < s_.model->masses.size(); ++i)
      if (std::abs(to_double(leg_->stepper.quadrature(1 + i, W(0)))) < kVanished)
        message += "; the mass of '" + s_.model->masses[i].name + "' vanishes there";
    for (std::size_t k = 0; k < s_.system.constraints.size(); ++k)
      if (std::abs(to_double(leg_->stepper.point().derivative(s_.system.coordinates + k, 0))) > kUnbounded)
        message += "; the multiplier of '" + s_.system.equation_names[s_.system.coordinates + k] +
                   "' grows without bound: the constraint loses its hold there";
  }

  // A root or logarithm in the equations whose argument has come to zero.
  std::string vanishing_root() const {
    const Tape& tape = leg_->program.tape;
    for (std::uint32_t k = 0; k < tape.main_end; ++k) {
      const Instruction& in = tape.code[k];
      const bool root = in.op == Op::power && tape.rationals[in.index].get_den() != 1;
      const bool logarithm = in.op == Op::function && in.index == static_cast<std::uint32_t>(Function::log);
      if ((root || logarithm) && std::abs(to_double(leg_->stepper.point().machine().series(in.a)[0])) < 1e-9)
        return root ? "the root of a quantity that reaches zero" : "the logarithm of a quantity that reaches zero";
    }
    return {};
  }

  void negative_mass(const W& t) {
    report_.outcome = {OutcomeKind::negative_mass,
                       "the mass of '" + s_.model->masses[negative_].name + "' is negative from t = " + number_text(to_double(t), 12) + " on",
                       "end the motion before, or let the mass end at zero flow"};
    reached_ = t;
  }

  const std::string& label(std::size_t k) const { return labels_[k]; }

  std::string text(const W& x) const {
    if constexpr (std::same_as<N, Multi>) return number_text(x, o_.digits + 2);
    else return number_text(convert<N>(x));
  }

  // The motion that was asked for, at t.
  Outcome point_at(const W& t) {
    Outcome o = leg_->stepper.at(t, leg_->point);
    if constexpr (std::same_as<N, double>)
      if (o.ok() && second_) o = second_->at(t, leg_->point);
    return o;
  }

  void row(const W& t, const std::string& label) {
    if (Outcome o = point_at(t); !o.ok()) {
      report_.outcome = o;
      if (o.message.find(" t = ") == std::string::npos) report_.outcome.message += " at t = " + number_text(to_double(t), 12);
      return;
    }
    if (orders_beyond(s_, leg_->program.d) > 0)
      if (Outcome o = leg_->point.extend(); !o.ok()) {
        report_.outcome = o;
        return;
      }
    outputs_.evaluate(leg_->point);
    const std::size_t n = s_.system.coordinates;
    std::vector<std::string> values = {label.empty() ? text(t) : label};
    for (int k = 0; k <= highest(); ++k)
      for (std::size_t a = 0; a < n; ++a) values.push_back(text(leg_->point.derivative(a, k)));
    for (int k = 0; k <= multiplier_orders(s_); ++k)
      for (std::size_t r = 0; r < s_.model->constraints.size(); ++r) {
        const auto j = s_.system.variable(s_.mechanics->lambda[r].id);
        values.push_back(text(j ? leg_->point.derivative(*j, k) : W(0)));
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
    const NewtonResidual<W> c = certify(inertia, force, reaction, phi);
    report_.newton = std::max(report_.newton, to_double(c.newton));
    report_.projected = std::max(report_.projected, to_double(c.projected));
    // A second opinion is not projected.
    const W& missed = second_ ? leg_->point.drift() : leg_->point.constraint_residual();
    report_.constraints_kept = std::max(report_.constraints_kept, to_double(missed));
    // A constraint that was left out because it followed from the others must go on to do so.
    W size(1);
    for (std::size_t a = 0; a < n; ++a)
      for (int k = 0; k < 2; ++k)
        if (W v = abs(leg_->point.derivative(a, k)); v > size) size = v;
    for (std::size_t i = 0; i < s_.redundant.size(); ++i) {
      const double miss = to_double(W(abs(outputs_[3 * n + 1 + phi.data.size() + i]) / size));
      report_.constraints_kept = std::max(report_.constraints_kept, miss);
      if (miss > kRedundantMiss)
        report_.outcome = {OutcomeKind::singular,
                           "the constraint '" + s_.model->constraints[s_.redundant[i]].name + "' no longer follows from the others",
                           "it was redundant at the start only: start elsewhere, or leave out one of the constraints"};
    }
  }

  void energy_at(const W& t, W& h) {
    if (!point_at(t).ok()) return;
    outputs_.evaluate(leg_->point);
    h = outputs_[s_.system.coordinates];
  }

  void balance() {
    W h(0);
    energy_at(leg_->stepper.time(), h);
    W work = leg_->stepper.integrals()[0];
    if constexpr (std::same_as<N, double>)
      if (second_) work = second_->work();
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
  std::unique_ptr<Leg> leg_;
  OutputTape<W> outputs_;
  std::unique_ptr<SecondMotion> second_;    // what another integrator makes of it
  Elimination elimination_;                 // the present one
  std::unique_ptr<OutputTape<W>> pivots_;   // its pivots, and what they were when it was chosen
  std::vector<double> chosen_;
  std::vector<W> times_;
  std::vector<std::string> labels_;
  W end_{0}, h0_{0};
  std::optional<W> reached_;
  std::size_t negative_ = 0;
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

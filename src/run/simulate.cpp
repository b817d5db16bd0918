#include "run/simulate.h"

#include <algorithm>
#include <chrono>

#include "run/motion.h"
#include "run/watch.h"

namespace anholon {

namespace {

StepSettings step_settings(const SimulationOptions& o) {
  return {natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled};
}

template <Number N>
class Run {
 public:
  using W = Wider<N>;
  Run(const Scenario& s, const SimulationOptions& o, RowSink& sink)
      : s_(s), o_(o), sink_(sink), power_(anholon::power(*s.mechanics)),
        motion_(s, step_settings(o), watched_quadratures(s, power_), orders_beyond(s, s.structure.d)), watch_(s, power_, motion_.parameters()) {}

  SimulationReport go() {
    report_.order = motion_.stepper().order();
    report_.outcome = motion_.start(o_.state);
    if (report_.outcome.ok()) {
      sink_.columns(column_names());
      const W t0 = motion_.stepper().time();
      schedule(t0);
      run(t0);
    }
    const Stepper<N>& stepper = motion_.stepper();
    report_.t = number_text(to_double(reached_ ? *reached_ : stepper.time()));
    report_.steps = stepper.steps();
    report_.constraints = to_double(stepper.worst_constraint());
    report_.smallest_sigma = to_double(stepper.smallest_sigma());
    report_.eliminations = motion_.eliminations();
    if (defect_) report_.rigorous = defect_->report();
    return report_;
  }

 private:
  int highest() const { return largest_order(s_, motion_.program().d); }

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
    if (motion_.at(t0).ok()) watch_.start_balance(motion_.point());
    if (o_.rigorous) defect_.emplace(s_, *o_.rigorous, Ball(t0), Ball(end_), significand_bits<W>());
    const Stepper<N>* stepper = &motion_.stepper();
    while (report_.outcome.ok() && !(stepper->time() == end_)) {
      report_.outcome = motion_.step(end_);
      stepper = &motion_.stepper();
      if (!report_.outcome.ok()) break;
      const W stop = masses_positive_until();
      if (defect_) defect_->step(dense_step(*stepper, stop));
      if (o_.progress) o_.progress(to_double(stepper->time()), stepper->steps());
      const bool forward = end_ > t0;
      while (report_.outcome.ok() && next < times_.size() &&
             (forward ? times_[next] <= stop : times_[next] >= stop)) {
        row(times_[next], label(next));
        ++next;
      }
      if (every_step && report_.outcome.ok()) row(stop, "");
      if (report_.outcome.ok() && !(stop == stepper->time())) negative_mass(stop);
    }
    if (report_.outcome.ok() && stepper->steps() > 0 && motion_.at(stepper->time()).ok())
      report_.power = watch_.balance(motion_.point(), stepper->integrals()[0]);
    if (!report_.outcome.ok() && report_.outcome.message.find(" t = ") == std::string::npos) {
      report_.outcome.message += " at t = " + number_text(to_double(stepper->time()), 12);
      if (report_.outcome.kind == OutcomeKind::step_collapse || report_.outcome.kind == OutcomeKind::singular ||
          report_.outcome.kind == OutcomeKind::no_convergence)
        explain(s_, motion_, report_.outcome);
      // The last good state is worth a row of its own.
      if (stepper->steps() > 0 && !every_step) {
        const Outcome why = report_.outcome;
        row(stepper->before(), "");
        report_.outcome = why;
      }
    }
  }

  // The end of the last step, or the earlier time at which a mass passes zero.
  W masses_positive_until() {
    const Stepper<N>& stepper = motion_.stepper();
    const W whole = stepper.time() - stepper.before();
    W good = whole;
    for (std::size_t i = 0; i < s_.model->masses.size(); ++i) {
      if (s_.model->masses[i].weight || !(stepper.quadrature(1 + i, good) < W(0))) continue;
      W low(0), high = good;
      for (int k = 0; k < 200 && !(low == high); ++k) {
        const W middle = low + (high - low) * W(0.5);
        if (middle == low || middle == high) break;
        (stepper.quadrature(1 + i, middle) < W(0) ? high : low) = middle;
      }
      good = low;
      negative_ = i;
    }
    return good == whole ? stepper.time() : stepper.before() + good;
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
    else if constexpr (std::same_as<N, Quad>) return quad_text(x, o_.digits);
    else return number_text(convert<N>(x));
  }

  void row(const W& t, const std::string& label) {
    report_.outcome = motion_.at(t);
    if (!report_.outcome.ok()) return;
    const Expansion<W>& point = motion_.point();
    report_.outcome = watch_.see(point, report_);
    const std::size_t n = s_.system.coordinates;
    std::vector<std::string> values = {label.empty() ? text(t) : label};
    for (int k = 0; k <= highest(); ++k)
      for (std::size_t a = 0; a < n; ++a) values.push_back(text(point.derivative(a, k)));
    for (int k = 0; k <= multiplier_orders(s_); ++k)
      for (std::size_t r = 0; r < s_.model->constraints.size(); ++r) {
        const auto j = s_.system.variable(s_.mechanics->lambda[r].id);
        values.push_back(text(j ? point.derivative(*j, k) : W(0)));
      }
    for (std::size_t a = 0; a < n; ++a) values.push_back(text(watch_.reaction(a)));
    sink_.row(values);
    ++report_.rows;
  }

  const Scenario& s_;
  const SimulationOptions& o_;
  RowSink& sink_;
  Power power_;
  Motion<N> motion_;
  Watch<W> watch_;
  std::optional<Defect> defect_;
  std::vector<W> times_;
  std::vector<std::string> labels_;
  W end_{0};
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
    case Precision::quad: r = Run<Quad>(s, o, sink).go(); break;
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

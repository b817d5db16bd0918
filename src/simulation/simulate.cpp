#include "simulation/simulate.h"

#include <algorithm>
#include <chrono>

#include "observe/angles.h"
#include "observe/judge.h"
#include "observe/supports.h"
#include "observe/watch.h"

namespace anholon {

namespace {

StepSettings step_settings(const SimulationOptions& o) {
  StepSettings s{natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled, o.kernel};
  if (o.settings.most_steps) s.most_steps = static_cast<std::size_t>(*o.settings.most_steps);
  s.integrals = 1;  // the power
  s.multipliers = o.rigorous.has_value();
  return s;
}

// What is to go on with the same bits, to be enclosed or to be compared with is Taylor's.
Method method(const SimulationOptions& o) {
  return o.method == Method::automatic && (o.save || o.resume || o.rigorous || o.integrator != Method::taylor)
             ? Method::taylor
             : o.method;
}

Column monitored(const Model& model) {
  Column es;
  for (const Monitor& m : model.monitors) es.push_back(m.value);
  return es;
}

template <Number N>
class Run {
 public:
  using W = Wider<N>;
  Run(Workspace& s, const SimulationOptions& o, RowSink& sink)
      : s_(s), o_(o), sink_(sink), power_(anholon::power(*s.mechanics)),
        course_(s, step_settings(o), method(o), watched_quadratures(s, power_),
                std::max(orders_beyond(s, s.structure.d), orders_needed(s, monitored(*s.model)))),
        watch_(s, power_, o.conserved, motion().parameters()), angles_(s, motion().parameters()), judge_(s, o),
        supports_(s) {
    report_.model = s.model->title;
    report_.form = s.system.form->name;
    report_.constraints_each = constraint_reports(s);
    report_.looks_for_events = !s.model->events.empty();
  }

  SimulationReport go() {
    if (o_.resume)
      report_.outcome = resume(*o_.resume);
    else
      begin();
    if (report_.outcome.ok()) {
      ask_second();
      sink_.columns(run_columns(s_, highest()));
      run();
    }
    report_.order = course_.order();
    report_.method = course_.report();
    report_.t = to_double(reached_ ? *reached_ : course_.time());
    report_.steps = course_.steps();
    report_.constraints = to_double(course_.worst_constraint());
    report_.smallest_sigma = to_double(course_.smallest_sigma());
    report_.smallest_sigma_t = to_double(course_.smallest_sigma_time());
    if (s_.system.form->eliminates()) report_.eliminations = motion().eliminations();
    if (second_) {
      report_.second = second_->report();
      report_.constraints = report_.second->drift;
    }
    if (defect_) report_.rigorous = defect_->report();
    const std::size_t monitors = s_.model->monitors.size();
    for (std::size_t i = 0; i < monitors; ++i) {
      const Monitor& m = s_.model->monitors[i];
      (declared_conserved(*s_.model, m) ? report_.conserved : report_.monitors)
          .push_back(watched(m.name, watch_.tracks()[i]));
    }
    for (std::size_t i = 0; i < o_.conserved.size(); ++i)
      report_.conserved.push_back(watched(o_.conserved[i].name, watch_.tracks()[monitors + i]));
    for (const std::string& text : supports_.notes()) note(text);
    warn();
    judge_.estimate(course_, report_);
    return report_;
  }

 private:
  // Taylor's part of it.
  Motion<N>& motion() { return course_.taylor(); }
  const Motion<N>& motion() const { return course_.taylor(); }

  int highest() const { return largest_order(s_, motion().program().d); }

  void begin() {
    report_.outcome = course_.start(o_.state);
    if (!report_.outcome.ok()) return;
    t0_ = course_.time();
    schedule();
    if (course_.at(t0_).ok()) watch_.start(course_.point());
    report_.outcome = motion().within_bounds();
    if (report_.outcome.ok()) limits();
  }

  void note(const std::string& text) {
    report_.notes.push_back(text);
    if (o_.note) o_.note(text);
  }

  // Events that look out for a limit which is passed at the start do not happen.
  void limits() {
    if (!forward_) return;
    // A limit at which the motion starts is not passed by round-off.
    constexpr double kPassed = 1e-12;
    for (std::size_t i = 0; i < s_.model->events.size(); ++i) {
      const Event& e = s_.model->events[i];
      const double value = e.direction * motion().at_start(i);
      if (!e.ends_step() || !(value > kPassed)) continue;
      note("event '" + e.name + "' is past its limit at the start: its formula is " +
           number_text(e.direction * value, 6) + ", and it happens where that passes zero " +
           (e.direction > 0 ? "upwards" : "downwards") + "; until it has come back, nothing happens");
    }
  }

  // Another integrator, whose motion is then the one that is written.
  void ask_second() {
    if constexpr (std::same_as<N, double>)
      if (o_.integrator != Method::taylor)
        second_ = std::make_unique<SecondMotion>(
            s_, o_.state, watched_quadratures(s_, power_)[0],
            SundialsSettings{o_.integrator, o_.tolerance.get_d(), o_.most_steps, o_.cancelled}, end_);
    if (second_) judge_.look_beside(course_);
  }

  // The motion that was asked for, at t.
  Outcome at(const W& t) {
    Outcome o = course_.at(t);
    if constexpr (std::same_as<N, double>)
      if (o.ok() && second_) o = second_->at(t, course_.point());
    return o;
  }

  const Expansion<W>& point() const {
    if constexpr (std::same_as<N, double>)
      if (second_) return second_->point();
    return course_.point();
  }

  const W& work() const {
    if constexpr (std::same_as<N, double>)
      if (second_) return second_->work();
    return course_.integrals()[0];
  }

  Outcome resume(const SavedRun& from) {
    if (Outcome o = motion().resume(o_.state, from); !o.ok()) return o;
    t0_ = from.number<W>("start");
    done_ = from.number<W>("rows");
    if (from.has("given")) {
      const std::vector<double> given = from.numbers<double>("given", 2);
      given_rows_ = static_cast<std::size_t>(given[0]), given_steps_ = static_cast<std::size_t>(given[1]);
    }
    judge_.goes_on_from(*done_);
    watch_.resume(from);
    const std::vector<double*> residuals = carried();
    const std::vector<double> worst = from.numbers<double>("residuals", residuals.size());
    for (std::size_t i = 0; i < worst.size(); ++i) *residuals[i] = worst[i];
    const std::vector<double> angles = from.numbers<double>("angles", 2 * angles_.least.size());
    for (std::size_t i = 0; i < angles_.least.size(); ++i) angles_.least[i] = {angles[2 * i], W(angles[2 * i + 1])};
    schedule();
    return {};
  }

  // The residuals so far.
  std::vector<double*> carried() {
    std::vector<double*> list = {&report_.newton, &report_.projected, &report_.constraints_kept};
    for (ConstraintReport& c : report_.constraints_each)
      for (double& x : c.residuals) list.push_back(&x);
    return list;
  }

  // From here a run goes on with the same bits.
  void save() {
    SavedRun to;
    motion().save(to);
    watch_.save(to);
    to.set_numbers<W>("start", {t0_});
    to.set_numbers<W>("rows", {*done_});
    // The last step will be made again.
    to.set_numbers<double>(
        "given", {static_cast<double>(given_rows_), static_cast<double>(given_steps_ > 0 ? given_steps_ - 1 : 0)});
    std::vector<double> worst, angles;
    for (const double* x : carried()) worst.push_back(*x);
    for (const auto& least : angles_.least) angles.insert(angles.end(), {least.value, to_double(least.t)});
    to.set_numbers("residuals", worst);
    to.set_numbers("angles", angles);
    o_.save(to);
  }

  // The times of the rows, in the direction of the motion, and its end.
  void schedule() {
    for (const Rational& r : o_.at) times_.push_back(from_rational<W>(r));
    labels_ = o_.at_text;
    labels_.resize(times_.size());
    end_ = o_.to && (times_.empty() || *o_.to > o_.at.back()) ? from_rational<W>(*o_.to) : times_.back();
    if (!times_.empty() && times_.front() < t0_ && !(times_.back() > t0_)) {
      std::reverse(times_.begin(), times_.end());
      std::reverse(labels_.begin(), labels_.end());
      end_ = times_.back();
    }
    forward_ = end_ > t0_;
    if (o_.every) {
      const Rational step = end_ < t0_ ? Rational(-*o_.every) : *o_.every;
      for (long k = 0;; ++k) {
        const W next = t0_ + from_rational<W>(Rational(k * step));
        if (end_ < t0_ ? next < end_ : next > end_) break;
        times_.push_back(next);
      }
      if (times_.empty() || times_.back() != end_) times_.push_back(end_);
      labels_.resize(times_.size());
    }
    every_step_ = times_.empty();
    while (done_ && next_ < times_.size() && reaches(*done_, times_[next_])) ++next_;
  }

  // Whether a motion that has come to `stop` has passed t.
  bool reaches(const W& stop, const W& t) const { return forward_ ? t <= stop : t >= stop; }

  void run() {
    // Rows at or before the start come from the initial state itself.
    if (!done_) {
      if (every_step_) row(t0_, "");
      while (next_ < times_.size() && times_[next_] == t0_) row(times_[next_], labels_[next_]), ++next_;
      done_ = t0_;
    } else if (reaches(*done_, end_)) {
      return;  // nothing is left
    }
    if (o_.rigorous) defect_.emplace(s_, *o_.rigorous, Ball(*done_), Ball(end_), significand_bits<W>());
    // Soon at first, so that a run that is killed early can go on, too; then at longer and longer intervals.
    constexpr double kFirst = 0.5, kLonger = 1.5;
    auto saved = std::chrono::steady_clock::now();
    double pause = std::min(kFirst, o_.save_seconds);
    while (report_.outcome.ok() && !(course_.time() == end_)) {
      watch_.turn_over(course_.integrals()[0]);
      report_.outcome = course_.step(end_);
      if (!report_.outcome.ok()) break;
      angles_.see(course_.begun());
      if (report_.outcome = watch_.still_redundant(course_.begun(), report_); !report_.outcome.ok()) break;
      const W stop = masses_positive_until();
      if (defect_) defect_->step(dense_step(motion().stepper(), stop));
      if (o_.progress) o_.progress(to_double(course_.time()), course_.steps());
      rows_until(stop);
      sink_.step(to_double(stop));
      ++given_steps_;
      if (report_.outcome.ok() && !(stop == course_.time())) negative_mass(stop);
      if (report_.outcome.ok() && course_.by_taylor() && motion().fired() && !events()) break;
      if (!o_.save || std::chrono::duration<double>(std::chrono::steady_clock::now() - saved).count() < pause) continue;
      save();
      saved = std::chrono::steady_clock::now();
      pause = std::min(kLonger * pause, o_.save_seconds);
    }
    if (report_.outcome.ok() && course_.steps() > 0 && at(course_.time()).ok()) watch_.end(point(), work(), report_);
    if (o_.save) save();
    if (!report_.outcome.ok()) stopped();
  }

  // What fired in the last step; false if it ends the motion.
  bool events() {
    if (Outcome o = motion().at(motion().stepper().time()); o.ok()) watch_.leave(motion().point());
    std::vector<Occurrence<W>> occurrences;
    bool goes_on = true;
    report_.outcome = motion().settle(occurrences, goes_on);
    for (const Occurrence<W>& o : occurrences) {
      const Event& e = s_.model->events[o.event];
      EventReport r{e.name, written(o.t), {}, to_double(o.correction), e.stop};
      for (const auto& c : o.changes) r.changes.push_back({c.name, written(c.before), written(c.after)});
      report_.events.push_back(std::move(r));
      accumulate(o);
    }
    judge_.events(occurrences);
    if (!report_.outcome.ok()) {
      reached_ = motion().stepper().time();
      return false;
    }
    angles_.set_parameters(motion().parameters());
    if (motion().at(motion().stepper().time()).ok()) watch_.enter(motion().point(), motion().parameters());
    if (!goes_on) ended();
    return goes_on && report_.outcome.ok();
  }

  // By an event: the state there is worth a row of its own.
  void ended() {
    const W t = course_.time();
    reached_ = t;
    if (!every_step_ && !(next_ > 0 && times_[next_ - 1] == t)) row(t, "");
  }

  // An event that comes sooner and sooner has infinitely many before some moment: nothing is computed beyond it.
  void accumulate(const Occurrence<W>& o) {
    constexpr int kShrinking = 3;
    constexpr double kNoTime = 1e-8;
    const Event& e = s_.model->events[o.event];
    if (e.set.empty()) return;
    paces_.resize(s_.model->events.size());
    Pace& p = paces_[o.event];
    const W interval = abs(W(o.t - p.last));
    p.shrinking = p.times > 1 && interval < p.interval ? p.shrinking + 1 : 0;
    p.interval = interval;
    p.last = o.t;
    ++p.times;
    if (!report_.outcome.ok() || p.shrinking < kShrinking || interval > W(kNoTime) * abs(W(end_ - t0_))) return;
    report_.outcome = {
        OutcomeKind::step_collapse,
        "events accumulate: '" + e.name + "' fired " + std::to_string(p.times) +
            " times, sooner and sooner, the last time after " + number_text(to_double(interval), 2),
        "let an event end the motion (stop = true), or change a mode, when what it resets has become small"};
  }

  // What lies in the last step.
  void rows_until(const W& stop) {
    for (; report_.outcome.ok() && next_ < times_.size() && reaches(stop, times_[next_]); ++next_)
      row(times_[next_], labels_[next_]);
    if (every_step_ && report_.outcome.ok() && !reaches(*done_, stop)) row(stop, "");
    if (!reaches(*done_, stop)) done_ = stop;
  }

  void stopped() {
    if (report_.outcome.message.find(" t = ") == std::string::npos) {
      report_.outcome.message += " at t = " + number_text(to_double(course_.time()), 12);
      // Nobody asked for an end here.
      const bool stopped_by_itself =
          report_.outcome.kind == OutcomeKind::interrupted && !(o_.cancelled && o_.cancelled());
      if (report_.outcome.kind == OutcomeKind::step_collapse || report_.outcome.kind == OutcomeKind::singular ||
          report_.outcome.kind == OutcomeKind::no_convergence || report_.outcome.kind == OutcomeKind::not_a_number ||
          stopped_by_itself)
        explain_stop(s_, motion(), report_.outcome);
    } else if (report_.outcome.kind != OutcomeKind::singular) {
      return;  // it has its row
    }
    // The last good state is worth a row of its own.
    if (course_.steps() > 0 && !every_step_) {
      const Outcome why = report_.outcome;
      report_.outcome = {};
      row(course_.before(), "");
      // So near to where J is singular that it cannot be solved to all digits any more: the series reach as far back as
      // forward.
      if (!report_.outcome.ok() && course_.by_taylor())
        report_.outcome = {}, row(course_.before() - (course_.time() - course_.before()), "");
      report_.outcome = why;
    }
  }

  void warn() {
    constexpr double kNearSingular = 1e-3;
    if (course_.smallest_sigma() < course_.first_sigma() * N(kNearSingular)) {
      const std::size_t j = course_.weakest_unknown(), n = s_.system.coordinates;
      const std::string what = j < n ? derivative_name(s_.system.variable_names[j],
                                                       static_cast<unsigned>(motion().program().d[j]), Format::text) +
                                           " is hardly determined"
                                     : "the constraint '" + s_.system.equation_names[j] + "' hardly holds";
      report_.warnings.push_back(
          {"the motion passes near a singular configuration at t = " + number_text(report_.smallest_sigma_t, 6) + ": " +
               what,
           "trust what follows less; write the constraint or the coordinates so that they are regular there"});
    }
    // Far above what integration and round-off leave.
    constexpr double kConserved = 1e-6;
    for (std::size_t i = 0; i < s_.model->monitors.size(); ++i)
      if (const double change = watch_.tracks()[i].relative_change();
          declared_conserved(*s_.model, s_.model->monitors[i]) && !(change <= kConserved))
        report_.warnings.push_back(
            {"the output '" + s_.model->monitors[i].name + "' is not conserved: it changes by " +
                 number_text(change, 3) + " of its size",
             "look for a force, an event or an observer that changes it, or leave out conserved = true"});
    for (std::size_t i = 0; i < angles_.triples.size(); ++i)
      if (angles_.least[i].value < kNearSingular)
        report_.warnings.push_back(
            {"the angles " + angles_.triples[i].angles +
                 " come near their singularity at t = " + number_text(to_double(angles_.least[i].t), 6),
             "describe the orientation of '" + angles_.triples[i].body + "' by a quaternion: quat(e0, e1, e2, e3)"});
  }

  // The end of the last step, or the earlier time at which a mass passes zero.
  W masses_positive_until() {
    if (!course_.by_taylor()) return course_.time();  // Taylor's steps go to where one vanishes
    const Stepper<N>& stepper = motion().stepper();
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
                       "the mass of '" + s_.model->masses[negative_].name +
                           "' is negative from t = " + number_text(to_double(t), 12) + " on",
                       "end the motion before, or let the mass end at zero flow"};
    reached_ = t;
  }

  std::string text(const W& x) const {
    if constexpr (std::same_as<N, Multi>)
      return number_text(x, o_.digits + 2);
    else if constexpr (std::same_as<N, Quad>)
      return quad_text(x, o_.digits);
    else
      return number_text(convert<N>(x));
  }

  WrittenNumber written(const W& x) const { return {to_double(x), kWide ? text(x) : std::string()}; }

  WatchedReport watched(const std::string& name, const Track<W>& track) const {
    return {name,
            written(track.first),
            written(track.last),
            written(track.least),
            written(track.greatest),
            track.relative_change()};
  }

  void row(const W& t, const std::string& label) {
    report_.outcome = at(t);
    if (!report_.outcome.ok()) return;
    const Expansion<W>& here = point();
    report_.outcome = watch_.see(here, report_);
    const std::vector<W> numbers = row_values(s_, highest(), here, watch_);
    judge_.row(t, label, numbers, course_);
    values_.assign(1, to_double(t));
    for (const W& x : numbers) values_.push_back(to_double(x));
    texts_.clear();
    if (kWide) {
      texts_.push_back(text(t));
      for (const W& x : numbers) texts_.push_back(text(x));
    }
    if (!label.empty()) texts_.resize(std::max<std::size_t>(1, texts_.size())), texts_[0] = label;
    supports_.see(to_double(t), [&](std::size_t r) { return to_double(watch_.multiplier(r)); });
    sink_.row({values_, texts_});
    ++report_.rows;
    ++given_rows_;
  }

  // The numbers written say more than doubles do.
  static constexpr bool kWide = !std::same_as<N, double>;

  Workspace& s_;
  const SimulationOptions& o_;
  RowSink& sink_;
  std::vector<double> values_;  // of the row that is written, and its digits
  std::vector<std::string> texts_;
  Power power_;
  Course<N> course_;
  std::unique_ptr<SecondMotion> second_;  // what another integrator makes of it
  Watch<W> watch_;
  AngleWatch<W> angles_;
  Judge<N> judge_;
  SupportWatch supports_;
  std::optional<Defect> defect_;
  std::vector<W> times_;
  std::vector<std::string> labels_;
  W t0_{0}, end_{0};
  bool forward_ = true, every_step_ = false;
  struct Pace {
    std::size_t times = 0;
    int shrinking = 0;  // how often in a row the time since the one before has become shorter
    W last{0}, interval{0};
  };
  std::vector<Pace> paces_;                       // of the events
  std::size_t next_ = 0;                          // row
  std::size_t given_rows_ = 0, given_steps_ = 0;  // since the start of the motion
  std::optional<W> done_;                         // all rows up to here have been given
  std::optional<W> reached_;
  std::size_t negative_ = 0;
  SimulationReport report_;
};

}  // namespace

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink) {
  Workspace own(scenario);
  return simulate_in(own, options, sink);
}

SimulationReport simulate_in(Workspace& s, const SimulationOptions& options, RowSink& sink) {
  const auto start = std::chrono::steady_clock::now();
  SimulationOptions o = options;
  for (Conserved& c : o.conserved) for_each_expression(c, [&](Expr& e) { e = s.graph().own(e); });
  SimulationReport r;
  switch (o.precision) {
  case Precision::real:
    r = Run<double>(s, o, sink).go();
    break;
  case Precision::long_real:
    r = Run<long double>(s, o, sink).go();
    break;
  case Precision::quad:
    r = Run<Quad>(s, o, sink).go();
    break;
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

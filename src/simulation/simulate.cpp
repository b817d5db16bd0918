#include "simulation/simulate.h"

#include <algorithm>
#include <atomic>
#include <chrono>

#include "setup/outputs/output_tape.h"
#include "simulation/event_paces.h"
#include "simulation/followed_value.h"
#include "simulation/lost_value.h"
#include "simulation/report_json.h"
#include "simulation/run_end.h"
#include "simulation/run_report.h"
#include "simulation/run_rows.h"
#include "simulation/told_polynomials.h"

namespace anholon {

namespace {

// Returns the formulas that are integrated for the report, then those that are followed.
std::vector<Expr> quadratures(Workspace& s, const Power& power, const SimulationOptions& o) {
  std::vector<Expr> es = watched_quadratures(s, power);
  Column own;
  for (const Expr e : o.followed) own.push_back(s.graph().own(e));
  own = OutputTape<long double>::put(s, own);
  es.insert(es.end(), own.begin(), own.end());
  return es;
}

StepSettings step_settings(const Model& model, const SimulationOptions& o) {
  StepSettings s{natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled, o.kernel};
  s.integrals = 1;   // the power
  s.known_from = 1;  // the masses, whose sign is watched
  s.known_to = s.known_from + model.masses.size();
  s.followed_to = s.known_to + o.followed.size() - o.followed_at_ends;
  s.multipliers = o.rigorous.has_value();
  s.from_zero = o.from_zero;
  return s;
}

// A motion that is saved, continued, enclosed or compared with another integrator is computed by Taylor's method.
Method method(const SimulationOptions& o) {
  return o.method == Method::automatic &&
                 (o.save || o.resume || o.rigorous || o.integrator != Method::taylor || !o.followed.empty())
             ? Method::taylor
             : o.method;
}

Column monitored(const Model& model) {
  Column es;
  for (const Monitor& m : model.monitors) es.push_back(m.value);
  return es;
}

// One run: prepares the motion, follows it step by step, writes and watches the rows, and reports.
template <Number N>
class Run {
 public:
  using W = Wider<N>;
  Run(Workspace& s, const SimulationOptions& o, RowSink& sink)
      : s_(s), o_(o), power_(anholon::power(*s.mechanics)),
        stages_(std::max(orders_beyond(s, s.structure.d), orders_needed(s, monitored(*s.model)))),
        course_(s, step_settings(*s.model, o), method(o), quadratures(s, power_, o), stages_), shown_(course_),
        watch_(s, power_, o.conserved, motion().parameters()), angles_(s, doubles(motion().parameters())), judge_(s, o),
        polynomials_(s, stages_, first_followed()), paces_(s.model->events), lost_(*s.model),
        rows_({s, o, stages_, course_, shown_, watch_, judge_, floors_, report_}, sink),
        end_({s, o, stages_, first_followed(), course_, rows_, report_}) {
    if (o.watches_floors) floors_.emplace(s, o.watches_carriers && !o.resume);
    report_.model = s.model->title;
    report_.form = s.system.form->name;
    report_.constraints_each = constraint_reports(s);
    report_.looks_for_events = !s.model->events.empty();
  }

  void use(const SimulationPlans& plans) {
    if (plans.motion.plan) motion().use(plans.motion);
    plans_ = plans;
  }
  SimulationPlans plans() const { return {motion().plans(), plans_.rows}; }

  SimulationReport go() {
    report_.outcome = o_.resume ? resume(*o_.resume) : begin();
    if (report_.outcome.ok()) {
      show_second();
      rows_.columns();
      follow();
    }
    if (defect_) report_.rigorous = defect_->report();
    const std::vector<Expr> watched = watched_quadratures(s_, power_);
    RunReport<N>({s_, o_, watched, course_, shown_, watch_, angles_, judge_, floors_, rows_, end_, report_}).fill();
    return report_;
  }

 private:
  const RowSchedule<W>& schedule() const { return rows_.schedule(); }
  const RowWriter<N>& written() const { return rows_.writer(); }
  Motion<N>& motion() { return course_.taylor(); }
  const Motion<N>& motion() const { return course_.taylor(); }

  static std::vector<double> doubles(const std::vector<W>& numbers) {
    std::vector<double> list;
    for (const W& x : numbers) list.push_back(to_double(x));
    return list;
  }

  // ---- start -------------------------------------------------------------------------------------

  Outcome begin() {
    if (Outcome o = course_.start(o_.state); !o.ok()) return o;
    rows_.begin(RowSchedule<W>(o_, course_.time()));
    if (o_.estimate != ErrorEstimate::never) motion().expect_second_run();
    rows_.begin_beside(plans_.rows);
    if (course_.at(schedule().start()).ok()) watch_.start(course_.point());
    if (!schedule().every_step() && !schedule().due_at(schedule().start())) watch_.count_start();
    if (Outcome o = motion().within_bounds(schedule().forward()); !o.ok()) return o;
    if (Outcome o = follow_beside_start(s_); !o.ok()) return o;
    for (const std::string& text : notes_of_redundancy(s_)) add_note(report_, o_, text);
    if (schedule().forward())
      for (const std::string& text : passed_limits(*s_.model, motion())) add_note(report_, o_, text);
    return {};
  }

  // Starts another integrator, whose motion is then written.
  void show_second() {
    if (o_.integrator == Method::taylor) return;
    rows_.by_reference();
    if constexpr (std::same_as<N, double>)
      shown_.show(std::make_unique<SecondMotion>(
          s_, o_.state, watched_quadratures(s_, power_)[0],
          SundialsSettings{o_.integrator, o_.tolerance.get_d(), o_.most_steps, o_.cancelled}, schedule().end()));
    if (shown_.second()) judge_.look_beside(course_);
  }

  // ---- saved runs --------------------------------------------------------------------------------

  // The residuals so far.
  std::vector<double*> carried() {
    std::vector<double*> list = {&report_.newton, &report_.projected, &report_.constraints_kept};
    for (ConstraintReport& c : report_.constraints_each)
      for (double& x : c.residuals) list.push_back(&x);
    return list;
  }

  // Stores the state from which a run continues with the same bits.
  void save() {
    rows_.settle();
    turn_over();
    SavedRun to;
    motion().save(to);
    watch_.save(to);
    to.set_numbers<W>("start", {schedule().start()});
    to.set_numbers<W>("rows", {*schedule().given()});
    // The continued run makes the last step again.
    const std::size_t steps = written().steps() > 0 ? written().steps() - 1 : 0;
    to.set_numbers<double>("given", {static_cast<double>(written().rows()), static_cast<double>(steps)});
    std::vector<double> worst, angles;
    for (const double* x : carried()) worst.push_back(*x);
    angles_.save(angles);
    to.set_numbers("residuals", worst);
    to.set("events", {events_json(events_before_step())});
    to.set_numbers("angles", angles);
    o_.save(to);
  }

  // The events before the last step, which the continued run makes again.
  std::vector<EventReport> events_before_step() {
    std::vector<EventReport> list = report_.events;
    const W now = motion().stepper().time(), begun = motion().stepper().begun().motion.t;
    if (!list.empty() && abs(W(now - last_events_.t)) < abs(W(now - begun)))
      list.resize(list.size() - last_events_.count);
    return list;
  }

  Outcome resume(const SavedRun& from) {
    if (Outcome o = motion().resume(o_.state, from); !o.ok()) return o;
    const W start = from.number<W>("start"), given_until = from.number<W>("rows");
    if (from.has("given")) {
      const std::vector<double> given = from.numbers<double>("given", 2);
      rows_.writer().go_on(static_cast<std::size_t>(given[0]), static_cast<std::size_t>(given[1]));
    }
    judge_.goes_on_from(given_until);
    watch_.resume(from, motion().parameters());
    const std::vector<double*> residuals = carried();
    const std::vector<double> worst = from.numbers<double>("residuals", residuals.size());
    for (std::size_t i = 0; i < worst.size(); ++i) *residuals[i] = worst[i];
    if (from.has("events")) report_.events = read_events(from.one("events"));
    angles_.set_parameters(doubles(motion().parameters()));
    angles_.resume(from.numbers<double>("angles", angles_.saved()));
    rows_.begin(RowSchedule<W>(o_, start, given_until));
    rows_.begin_beside(plans_.rows);
    return {};
  }

  // ---- the motion --------------------------------------------------------------------------------

  void follow() {
    // Rows at or before the start come from the initial state itself.
    if (RowSchedule<W>& due = rows_.schedule(); !due.given()) {
      const W start = due.start();
      if (due.every_step()) rows_.at(start, "");
      while (due.due_at(start)) rows_.at(due.take());
      due.set_given(start);
    } else if (due.reaches(*due.given(), due.end())) {
      return;  // nothing is left
    }
    if (o_.rigorous)
      defect_.emplace(s_, *o_.rigorous, Ball(*schedule().given()), Ball(schedule().end()), significand_bits<W>());
    // The first state is saved soon, so that a run that is killed early can be continued; then the intervals grow.
    constexpr double kFirst = 0.5, kLonger = 1.5;
    auto saved = std::chrono::steady_clock::now();
    double pause = std::min(kFirst, o_.save_seconds);
    while (report_.outcome.ok() && !(course_.time() == schedule().end())) {
      if (!step()) break;
      if (!o_.save || std::chrono::duration<double>(std::chrono::steady_clock::now() - saved).count() < pause) continue;
      save();
      saved = std::chrono::steady_clock::now();
      pause = std::min(kLonger * pause, o_.save_seconds);
    }
    rows_.settle();
    turn_over();
    if (report_.outcome.ok() && course_.steps() > 0 && shown_.at(course_.time()).ok())
      watch_.end(shown_.point(), shown_.work(), report_);
    if (o_.save) save();
    if (!report_.outcome.ok())
      end_.stop();
    else if (course_.steps() == 0)
      end_.end_at_start();
  }

  // Limits the stretch to the steps after which nothing is due.
  void limit_stretch() {
    const bool each = schedule().every_step() || o_.dense || defect_ || watch_.any_redundant() ||
                      masses_vary<N>(*s_.model, motion().stepper()) || looks_between() || lost_.any();
    stretch_.begin(each, schedule().next());
    if (rows_.watches_ranges()) stretch_.limit(steps_to_next_look(course_.steps()));
    angles_.keep_in(stretch_);
  }

  // Makes a stretch of steps, and what is due after it: rows and events. Returns false if it ends the motion before its
  // end.
  bool step() {
    work_ = std::max(work_, W(abs(course_.integrals()[0])));
    limit_stretch();
    Outcome o = course_.steps(schedule().end(), stretch_);
    if (const std::string advice = course_.take_advice(); !advice.empty()) add_note(report_, o_, advice);
    work_ = std::max(work_, W(stretch_.greatest_integral));
    // Nothing is due before the last step of the stretch.
    for (std::size_t i = 0; i + (o.ok() ? 1 : 0) < stretch_.times.size(); ++i) rows_.tell_step(stretch_.times[i]);
    if (!o.ok()) {
      report_.outcome = std::move(o);
      return false;
    }
    angles_.see(to_double(course_.before()), [&](std::size_t a) { return to_double(course_.begun_coordinate(a)); });
    if (watch_.any_redundant())
      if (report_.outcome = watch_.still_redundant(course_.begun(), report_); !report_.outcome.ok()) return false;
    const MassLimit<W> masses = masses_positive_until<N>(*s_.model, course_);
    const auto lost = lost_.in_last_step(course_, first_followed() + o_.followed.size(), masses.t);
    const W& end = lost.t;
    if (o_.dense && course_.by_taylor()) o_.dense(polynomials_.of_last_step(motion(), end));
    if (defect_) defect_->step(dense_step(motion().stepper(), end));
    if (o_.progress) o_.progress(to_double(course_.time()), course_.steps());
    const bool whole = end == course_.time() && course_.by_taylor();
    rows_.until(end, whole ? told_until(*s_.model, motion().stepper()) : end);
    rows_.end_step(end, stretch_.pace.read());
    look_between();
    if (report_.outcome.ok() && !(end == course_.time())) {
      report_.outcome = lost.event ? LostValues<N>::outcome(*s_.model, lost)
                                   : negative_mass(*s_.model, masses.mass, to_double(masses.t));
      end_.reach(end);
    }
    return !(report_.outcome.ok() && course_.by_taylor() && motion().fired()) || events();
  }

  // Outputs that are declared conserved are watched between rows, too, because a motion may be a single step with rows
  // at its ends alone. For this, the first steps are made one by one, so that the result does not depend on their
  // speed.
  bool looks_between() const {
    constexpr std::size_t kMostLooks = 32;
    return watch_.any_declared() && looks_ < kMostLooks;
  }
  void look_between() {
    constexpr int kParts = 4;
    if (!looks_between()) return;
    rows_.settle();  // because the thread of the rows uses the watch, too
    ++looks_;
    const W begin = course_.before(), length = course_.time() - begin;
    for (int k = 1; k < kParts; ++k)
      if (course_.at(begin + length * W(k) / W(kParts)).ok()) watch_.look(course_.point());
  }

  // The first of the followed formulas among the quadratures.
  std::size_t first_followed() const { return 1 + s_.model->masses.size(); }

  // Applies the events that fired in the last step; returns false if they end the motion.
  bool events() {
    rows_.settle();
    if (!report_.outcome.ok()) return false;
    const W t = motion().stepper().time();
    if (motion().at(t).ok()) watch_.leave(motion().point());
    Start<W> before{t, {}, {}};
    motion().stepper().foretell(t, before.state, before.leading);
    const std::vector<Fired<N>> fired = motion().stepper().fired();
    const Outcome pace = paces_.see(fired, course_.before(), W(schedule().end() - schedule().start()));
    bool has_row = this->has_row(t);
    // A row at the time of an event shows the motion before it.
    if (!has_row && (!pace.ok() || any_stops(s_.model->events, fired))) has_row = true, rows_.at(t, "");
    if (!report_.outcome.ok()) return false;
    std::vector<Occurrence<W>> occurrences;
    bool goes_on = true;
    report_.outcome = motion().settle(occurrences, goes_on);
    for (const Occurrence<W>& o : occurrences) {
      const Event& e = s_.model->events[o.event];
      EventReport r{e.name, written().written(o.t), {}, to_double(o.correction), e.stop};
      for (const auto& c : o.changes)
        r.changes.push_back({c.name, written().written(c.before), written().written(c.after)});
      report_.events.push_back(std::move(r));
    }
    last_events_ = {t, occurrences.size()};
    if (report_.outcome.ok()) report_.outcome = pace;
    judge_.events(occurrences);
    if (!goes_on || !report_.outcome.ok()) end_.reach(t);
    if (!report_.outcome.ok()) {
      end_.keep_before_event(std::move(before), has_row);
      return false;
    }
    angles_.set_parameters(doubles(motion().parameters()));
    rows_.set_parameters();
    if (motion().at(t).ok()) watch_.enter(motion().point(), motion().parameters());
    show_after(occurrences);
    return goes_on && report_.outcome.ok();
  }

  // Makes a row with the state after events that have set something, for a picture.
  void show_after(const std::vector<Occurrence<W>>& occurrences) {
    const bool set =
        std::any_of(occurrences.begin(), occurrences.end(), [](const auto& o) { return !o.changes.empty(); });
    if (set && o_.picture && schedule().every_step() && report_.outcome.ok()) rows_.after_event(course_.time());
  }

  // True if a row within the last step is that of its end t; rows in doubles tell times apart as doubles.
  bool has_row(const W& t) const {
    if (schedule().every_step() || schedule().took(t)) return true;
    return o_.precision == Precision::real && rows_.has_passed(course_.before()) && *rows_.last() != course_.before() &&
           to_double(*rows_.last()) == to_double(t);
  }

  // The rows may be using the watch beside the motion, so the watch gets the work only here.
  void turn_over() { watch_.turn_over(work_); }

  Workspace& s_;
  const SimulationOptions& o_;
  Power power_;
  int stages_;  // orders beyond the leading derivatives in rows
  Course<N> course_;
  ShownMotion<N> shown_;
  Watch<W> watch_;
  AngleWatch angles_;
  Judge<N> judge_;
  std::optional<FloorWatch> floors_;
  ToldPolynomials<N> polynomials_;
  std::size_t looks_ = 0;  // looks between rows
  EventPaces<W> paces_;
  LostValues<N> lost_;
  PacedStretch<W> stretch_;
  std::optional<Defect> defect_;
  W work_{0};  // the greatest work so far at the start of a step
  SimulationReport report_;
  struct {
    W t{0};
    std::size_t count = 0;
  } last_events_;          // the events at the end of a step that were found last
  SimulationPlans plans_;  // the plans of the motion are in the motion
  RunRows<N> rows_;        // after the members that it uses
  RunEnd<N> end_;          // the last member, because it uses the others
};

SimulationReport in_doubles(Workspace& s, const SimulationOptions& o, RowSink& sink, SimulationPlans* plans) {
  Run<double> run(s, o, sink);
  if (plans) run.use(*plans);
  SimulationReport r = run.go();
  if (plans) *plans = run.plans();
  return r;
}

}  // namespace

SimulationReport simulate(const Scenario& scenario, const SimulationOptions& options, RowSink& sink) {
  Workspace own(scenario);
  return simulate_in(own, options, sink);
}

SimulationReport simulate_in(Workspace& s, const SimulationOptions& options, RowSink& sink, SimulationPlans* plans) {
  const auto start = std::chrono::steady_clock::now();
  SimulationOptions o = options;
  for (Conserved& c : o.conserved) for_each_expression(c, [&](Expr& e) { e = s.graph().own(e); });
  // Rows that cannot be written end the motion, whichever thread notices.
  std::atomic<bool> lost = false;
  if (options.rows_lost) {
    o.rows_lost = [&] { return lost = lost || options.rows_lost(); };
    o.cancelled = [&] { return lost || (options.cancelled && options.cancelled()); };
  }
  SimulationReport r;
  switch (o.precision) {
  case Precision::real:
    r = in_doubles(s, o, sink, plans);
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

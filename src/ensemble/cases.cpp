#include "ensemble/cases.h"

#include <algorithm>
#include <cstdlib>

#include "base/thread_time.h"
#include "motion/course.h"
#include "motion/representation.h"
#include "observe/watch.h"
#include "setup/output_tape.h"
#include "simulation/followed_value.h"
#include "simulation/trust.h"

namespace anholon {

constexpr double kNoValue = std::numeric_limits<double>::quiet_NaN();

EnsemblePlan::EnsemblePlan(const Scenario& s, const EnsembleOptions& o)
    : of_all(s), options(o), scenario(s), parameters(scenario, o.varied), lanes(o.cases, o.threads) {
  make();
  scenario.graph().freeze();
}

void EnsemblePlan::make() {
  Workspace& s = scenario;
  const EnsembleOptions& o = options;
  const Model& model = *s.model;
  const Graph& g = *model.graph;
  settings = {natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled, o.kernel};
  plain = (o.method == Method::automatic || o.method == Method::taylor) && !s.routh && s.redundant.empty() &&
          s.elimination.pivots().empty() && !o.own_motion && model.bounds.empty();
  if (!plain) return;
  start.emplace(*s.mechanics, overrides_of(o, nullptr));
  for (std::size_t j = 0; j < s.system.size(); ++j)
    for (int k = 0; k < s.structure.d[j]; ++k) entries.push_back(s.system.symbol_node(j, static_cast<unsigned>(k)));
  Column quadratures;
  for (const VaryingMass& m : model.masses) quadratures.push_back(m.value);
  first_reduced = quadratures.size();
  for (const Expr e : o.reductions.formulas) quadratures.push_back(s.graph().own(e));
  settings.known_from = 0, settings.known_to = first_reduced, settings.followed_to = quadratures.size();
  watched = watched_series(s, quadratures.size());
  for (const Expr e : watched_formulas(model)) quadratures.push_back(e);
  for (const Event& e : model.events)
    sets.push_back(e.set.empty() ? std::nullopt : std::make_optional<SetByEvent>(s, e));
  const bool any_sets = std::any_of(sets.begin(), sets.end(), [](const auto& set) { return set.has_value(); });
  if (any_sets && !s.system.constraints.empty()) nearest.emplace(s, parameter_values<long double>(model));
  program = anholon::program(s.system, s.structure, quadratures);
  settings.measure = false;
  if (Start<long double> at; o.kernel && initial_state(s, o.state, at).ok()) {
    const std::vector<long double> numbers = parameter_values<long double>(model);
    const std::vector<double> state(at.state.begin(), at.state.end());
    const double t = static_cast<double>(at.t);
    const int order = o.order > 0 ? o.order : taylor_order(settings.log_tolerance);
    if (const auto derived = KernelPlan::make(std::make_shared<const Program>(*program), order - 1, numbers, t, state,
                                              Company::in_lanes)) {
      const std::vector<Representation> list = representations(
          {derived, s.structure, quadratures, numbers, t, state, s.mechanics.get()}, WritingEffort::long_motion);
      kernel = (watches_multipliers(model) ? cheapest_unmapped(list) : cheapest(list)).plan;
      if (o.method == Method::automatic && o.order == 0 && only_taylor(model, *program).empty())
        rates.emplace(std::make_shared<const Program>(*program), numbers, t, state);
    }
  }
  Column monitors;
  for (const Monitor& m : model.monitors) monitors.push_back(m.value);
  for (const Expr e : o.reductions.ends) monitors.push_back(s.graph().own(e));
  highest = largest_order(s, s.structure.d);
  stages = std::max(orders_beyond(s, s.structure.d), orders_needed(s, monitors));
  leading = stages > 0 || std::any_of(s.structure.d.begin(),
                                      s.structure.d.begin() + static_cast<std::ptrdiff_t>(s.system.coordinates),
                                      [](int d) { return d < 2; });
  if (monitors.empty()) return;
  outputs.emplace(Outputs{compile(OutputTape<Wider<double>>::put(s, monitors)), {}});
  for (const Input& in : outputs->tape.inputs) {
    const Node& n = g.node(in.symbol);
    const Outputs::Entry e{in.slot, s.system.variable(in.symbol), n.kind == Kind::time ? 0 : n.order};
    outputs->inputs.push_back(e);
    leading = leading || (e.variable && e.order >= s.structure.d[*e.variable]);
  }
}

CaseWay CaseWalk::begin(const EnsemblePlan& plan, CaseResult& r, const std::shared_ptr<Kernel>& kernel, int lane) {
  plan_ = &plan;
  result_ = nullptr;
  numbers_ = plan.options.numbers(r.number);
  for (const Rational& v : numbers_.values) r.values.push_back(from_rational<double>(v));
  if (!ready_ || plan.parameters.varies()) {
    std::vector<W> parameters = plan.parameters.values<W>(numbers_.values);
    ready_ = ready_ && parameters == parameters_;
    if (!ready_) {
      parameters_ = std::move(parameters);
      narrow_parameters_ = plan.parameters.values<double>(numbers_.values);
    }
  }
  r.t = plan.scenario.state.t;
  if (r.outcome = plan.parameters.possible(narrow_parameters_); !r.outcome.ok()) return CaseWay::plain;
  if (!ready_) same_structure_ = plan.parameters.same_structure(narrow_parameters_);
  if (!same_structure_) return CaseWay::derivation;
  if (plan.options.own_motion) return CaseWay::derivation;
  if (!plan.plain) return CaseWay::simulation;
  if (!ready_) {
    kernel_ = kernel, lane_ = lane;
    equip(parameters_, narrow_parameters_);
    starts_.emplace(*plan.scenario.mechanics, *plan.start, parameters_);
    if (!reducer_ && !plan.options.reductions.list.empty())
      reducer_.emplace(plan.options.reductions, plan.options.tolerance.get_d());
    ready_ = true;
  }
  if (reducer_) reducer_->restart();
  if (!plan.watched.empty()) paces_.emplace(plan.scenario.model->events);
  const EnsembleOptions& o = plan.options;
  InitialProblem<W> problem{plan.scenario.mechanics.get(), parameters_, overrides_of(o, &numbers_), o.state.t};
  problem.plan = &*plan.start;
  r.outcome = consistent_state(problem, *starts_, named_);
  r.t = to_double(named_.t);
  if (!r.outcome.ok()) return CaseWay::plain;
  std::vector<W> state;
  for (const Node& n : plan.entries) {
    const W* known = named_.value(n);
    state.push_back(known ? *known : W(0));
  }
  end_ = from_rational<W>(numbers_.to ? *numbers_.to : o.to);
  const bool forward = !(end_ < named_.t);
  times_.clear();
  for (const Rational& t : o.at)
    if (const W at = from_rational<W>(t); forward ? at <= end_ : at >= end_) times_.push_back(at);
  if (!forward) std::reverse(times_.begin(), times_.end());
  result_ = &r;
  if (end_ == named_.t)
    return stepper_->start(named_.t, state, {}, false).ok() ? after_step() : stop(CaseWay::derivation);
  stepper_->place(named_.t, state);
  if (watch_) watch_->begin(*stepper_);
  return CaseWay::plain;
}

// What computes, with these parameters.
void CaseWalk::equip(const std::vector<W>& parameters, const std::vector<double>& narrow) {
  if (kernel_) kernel_->set_parameters(lane_, parameters);
  if (stepper_) {
    stepper_->set_parameters(narrow, parameters);
    point_->set_parameters(parameters);
    if (outputs_) outputs_->set_parameters(parameters);
    return;
  }
  stepper_ = std::make_unique<Stepper<double>>(*plan_->program, narrow, parameters, plan_->settings);
  if (!plan_->watched.empty()) stepper_->watch(plan_->watched);
  if (kernel_) stepper_->accelerate(kernel_, lane_);
  if (plan_->rates) watch_.emplace(plan_->settings.log_tolerance);
  point_.emplace(*plan_->program, parameters, std::max(1, plan_->stages));
  if (plan_->outputs) outputs_.emplace(plan_->outputs->tape, 0, parameters);
}

CaseWay CaseWalk::stop(CaseWay way) {
  result_ = nullptr;
  return way;
}

CaseWay CaseWalk::stopped(const Outcome& why) {
  const EnsembleOptions& o = plan_->options;
  if (why.kind != OutcomeKind::interrupted || !o.cancelled || !o.cancelled())
    return stop(stepper_->steps() == 0 ? CaseWay::derivation : CaseWay::simulation);
  result_->outcome = why;
  return stop(CaseWay::plain);
}

CaseWay CaseWalk::begin_step() { return stepper_->begin_step() ? CaseWay::plain : stopped(stepper_->trouble()); }

CaseWay CaseWalk::aim() { return stepper_->aim(end_) ? CaseWay::plain : stopped(stepper_->trouble()); }

CaseWay CaseWalk::look_at_end() {
  const EndOfStep there = stepper_->look_at_end(end_);
  looks_elsewhere_ = there == EndOfStep::elsewhere;
  return there == EndOfStep::failed ? stopped(stepper_->trouble()) : CaseWay::plain;
}

CaseWay CaseWalk::finish_step() { return stepper_->finish_step() ? after_step() : stopped(stepper_->trouble()); }

OrdinarySteps::Motion CaseWalk::motion() const {
  if (!walking()) return {};
  const std::size_t row = result_->rows.size();
  return {stepper_.get(), end_, row < times_.size() ? times_[row] : end_,
          watch_ ? watch_->steps_to_look(stepper_->steps()) : std::numeric_limits<std::size_t>::max()};
}

CaseWay CaseWalk::step() {
  if (const Outcome o = stepper_->step(end_); !o.ok()) return stopped(o);
  return after_step();
}

// Takes the rows that lie in the last step, and the end if it does.
CaseWay CaseWalk::after_step() {
  for (std::size_t i = 0; i < plan_->first_reduced; ++i)
    if (!plan_->scenario.model->masses[i].weight &&
        (first_negative(*stepper_, i) || stepper_->quadrature(i, stepper_->time() - stepper_->before()) < W(0)))
      return stop(CaseWay::simulation);
  // `simulate` names an event whose formula has no value.
  for (const WatchedSeries& w : plan_->watched)
    if (!stepper_->one_sided() && !is_finite(stepper_->quadrature_coefficient(w.quadrature, 0)))
      return stop(CaseWay::simulation);
  if (!rows()) return stop(CaseWay::simulation);
  if (reducer_ && !reduce()) return stop(CaseWay::simulation);
  if (!stepper_->fired().empty()) return take_events();
  if (stepper_->time() == end_) return arrive();
  return another_method_pays() ? stop(CaseWay::simulation) : CaseWay::plain;
}

// False if the polynomials of a formula are not good, which `simulate` looks at more closely.
bool CaseWalk::reduce() {
  if (stepper_->one_sided() && !plan_->options.reductions.formulas.empty()) return false;
  const auto coefficient = [&](std::size_t i, int k) {
    return stepper_->quadrature_coefficient(plan_->first_reduced + i, k);
  };
  const auto value = [&](std::size_t i, double x) {
    if (!stepper_->arrived()) stepper_->leave_kernel();
    const auto [is, made_of] =
        value_of_quadrature(*stepper_, W(stepper_->before() + W(x)), plan_->first_reduced + i, *point_);
    return FormulaValue{is, made_of};
  };
  const auto hiding = [&](std::size_t i, double x) -> std::vector<HidingArgument> {
    const std::vector<HidingSlot>& slots = hiding_.of(*plan_->program, plan_->first_reduced + i);
    if (slots.empty()) return {};
    if (!stepper_->arrived()) stepper_->leave_kernel();
    return hiding_arguments(*stepper_, W(stepper_->before() + W(x)), slots, *point_);
  };
  const bool last = !stepper_->fired().empty() || stepper_->time() == end_;
  const bool good = reducer_->step({to_double(W(stepper_->time() - stepper_->before())), stepper_->order() - 1,
                                    coefficient, value, hiding, last, stepper_->kinks()});
  for (const Fired<double>& f : stepper_->fired())
    reducer_->event(plan_->scenario.model->events[f.series].name, to_double(W(stepper_->before() + W(f.where))));
  reducer_->values(result_->reduced);
  return good;
}

// `simulate`, which then makes the case, comes to the same conclusion.
bool CaseWalk::another_method_pays() {
  if (!watch_ || (stepper_->kinks() == 0 && watch_->steps_to_look(stepper_->steps() - 1) > 1)) return false;
  if (!plan_->rates->plan()) return false;
  return watch_->another_pays(
      *stepper_, {&*plan_->program, plan_->kernel, plan_->rates->plan(), &narrow_parameters_, &parameters_}, end_);
}

CaseWay CaseWalk::arrive() {
  result_->t = to_double(stepper_->time());
  result_->steps = stepper_->steps();
  const bool kept = keep(stepper_->time(), result_->last);
  if (kept && reducer_) tell_ends();
  return stop(kept ? CaseWay::plain : CaseWay::simulation);
}

// The last values of formulas, at the point that was kept.
void CaseWalk::tell_ends() {
  std::vector<double> values;
  const std::size_t monitors = plan_->scenario.model->monitors.size();
  for (std::size_t i = 0; i < plan_->options.reductions.ends.size(); ++i)
    values.push_back(to_double(outputs_->value(monitors + i)));
  reducer_->ends(std::move(values));
  reducer_->values(result_->reduced);
}

// Takes what fired in the last step. Where something is set at the very end of a motion, `simulate` decides.
CaseWay CaseWalk::take_events() {
  const std::vector<Event>& events = plan_->scenario.model->events;
  const std::vector<Fired<double>> fired = stepper_->fired();
  bool ends = stepper_->time() == end_, sets = false;
  for (const Fired<double>& f : fired) {
    const Event& e = events[f.series];
    if (e.stop) ends = true, result_->event = e.name;
    sets = sets || !e.set.empty();
  }
  if (ends) return sets ? stop(CaseWay::simulation) : arrive();
  if (!sets) return CaseWay::plain;
  stepper_->leave_kernel();
  if (!stepper_->at(stepper_->time(), *point_).ok()) return stop(CaseWay::simulation);
  std::vector<W> state, parameters = point_->parameters();
  point_->state(state);
  for (const Fired<double>& f : fired) {
    const std::optional<SetByEvent>& set = plan_->sets[f.series];
    if (!set) continue;
    std::vector<ChangeByEvent<W>> changes;
    if (!set->put(*point_, state, parameters, changes).ok() ||
        !paces_->see({f.series, stepper_->before() + W(f.where), {}, W(0)}, end_ - named_.t).ok())
      return stop(CaseWay::simulation);
  }
  if (parameters != point_->parameters()) {
    std::vector<double> narrow = narrow_parameters_;
    for (std::size_t i = 0; i < narrow.size(); ++i)
      if (plan_->scenario.model->parameters[i].mode) narrow[i] = to_double(parameters[i]);
    equip(parameters, narrow);
    ready_ = false;  // for the next case
  }
  if (plan_->nearest) {
    std::vector<W> leading;
    point_->leading(leading);
    if (!plan_->nearest->put(*plan_->program, stepper_->time(), parameters, leading, state).ok())
      return stop(CaseWay::simulation);
  }
  return stepper_->restart(state, false).ok() ? CaseWay::plain : stop(CaseWay::simulation);
}

// Keeps the rows that lie in the last step.
bool CaseWalk::rows() {
  const bool forward = !(end_ < stepper_->before());
  const W until = told_until(*plan_->scenario.model, *stepper_);
  while (result_->rows.size() < times_.size()) {
    const W& t = times_[result_->rows.size()];
    if (forward ? t > until : t < until) break;
    std::vector<double> row = {to_double(t)};
    if (!keep(t, row)) return false;
    result_->rows.push_back(std::move(row));
  }
  return true;
}

// Keeps the results at t, which lies in the last step.
bool CaseWalk::keep(const W& t, std::vector<double>& values) {
  const System& system = plan_->scenario.system;
  // As every reader of a motion does (motion.cpp), unless no step follows.
  if (!stepper_->arrived()) stepper_->leave_kernel();
  if (!stepper_->at(t, *point_, plan_->leading).ok() || (plan_->stages > 0 && !point_->extend().ok())) return false;
  // As `simulate`, which has no column of velocities if no coordinate is solved for by more than its value.
  for (const int k : {0, 1})
    for (std::size_t a = 0; a < system.coordinates; ++a)
      values.push_back(k <= plan_->highest ? to_double(point_->derivative(a, k)) : kNoValue);
  for (std::size_t j = system.mechanical(); j < system.size(); ++j)
    values.push_back(to_double(point_->derivative(j, 0)));
  if (!outputs_) return true;
  for (const EnsemblePlan::Outputs::Entry& e : plan_->outputs->inputs)
    outputs_->series(e.slot)[0] = e.variable ? point_->derivative(*e.variable, e.order) : point_->time();
  outputs_->evaluate();
  for (std::size_t i = 0; i < plan_->scenario.model->monitors.size(); ++i)
    values.push_back(to_double(outputs_->value(i)));
  return true;
}

// A case never stops the others.
template <class Work>
static bool contained(CaseResult& r, const Work& work) {
  try {
    work();
    return true;
  } catch (const Failure& e) {
    r.outcome = {OutcomeKind::too_large, e.diagnostic.message, e.diagnostic.hint};
  } catch (const std::bad_alloc&) {
    r.outcome = {OutcomeKind::too_large, "out of memory", "fewer threads need less"};
  }
  return false;
}

void CaseWorker::integrate(std::span<CaseResult> results) {
  if (results.empty()) return;
  const SweepLanes::Turn turn = plan_.lanes.begin(plan_.kernel, results.front().number);
  const double begun = seconds_of_this_thread();
  integrate(together(turn.lanes), results);
  plan_.lanes.end(turn, results.size(), seconds_of_this_thread() - begun);
}

CaseWorker::Together& CaseWorker::together(int lanes) {
  const auto [at, made] = together_.try_emplace(lanes);
  Together& t = at->second;
  if (!made) return t;
  t.walks.resize(static_cast<std::size_t>(lanes));
  if (!plan_.kernel) return t;
  t.kernel = std::make_shared<Kernel>(plan_.kernel, lanes);
  if (lanes > 1) t.ordinary.emplace(t.kernel, plan_.settings);
  return t;
}

// A lane takes the next case when it has done one. Its bits do not depend on the other lanes.
void CaseWorker::integrate(Together& together, std::span<CaseResult> results) {
  auto& [kernel, ordinary, walks] = together;
  std::vector<OrdinarySteps::Motion> motions;
  std::size_t next = 0, walking = 0;
  const auto go = [&](CaseWalk& walk, CaseWay (CaseWalk::*part)()) {
    if (!walk.walking()) return;
    CaseResult& r = walk.result();
    CaseWay way = CaseWay::plain;
    const bool done = contained(r, [&] { way = (walk.*part)(); });
    if (!done) walk.abandon();
    if (walk.walking()) return;
    --walking;
    if (done) contained(r, [&] { end(way, walk.numbers(), r); });
  };
  for (;;) {
    for (std::size_t lane = 0; lane < walks.size(); ++lane)
      while (!walks[lane].walking() && next < results.size()) {
        CaseResult& r = results[next++];
        CaseWalk& walk = walks[lane];
        const bool done = contained(r, [&] {
          const CaseWay way = walk.begin(plan_, r, kernel, static_cast<int>(lane));
          if (!walk.walking()) end(way, walk.numbers(), r);
        });
        if (!done) walk.abandon();
        if (walk.walking()) ++walking;
      }
    if (walking == 0) return;
    if (walks.size() == 1) {
      go(walks[0], &CaseWalk::step);
      continue;
    }
    for (CaseWalk& w : walks) go(w, &CaseWalk::begin_step);
    if (kernel) kernel->begin();
    bool aimed = false;
    if (ordinary) {
      motions.clear();
      for (const CaseWalk& w : walks) motions.push_back(w.motion());
      aimed = ordinary->run(motions);
    }
    if (!aimed)
      for (CaseWalk& w : walks) go(w, &CaseWalk::aim);
    for (bool again = kernel != nullptr; again; aimed = false) {
      if (!aimed) {
        kernel->advance();
        kernel->start_next();
      }
      again = false;
      for (CaseWalk& w : walks) {
        go(w, &CaseWalk::look_at_end);
        again = again || (w.walking() && w.looks_elsewhere());
      }
    }
    for (CaseWalk& w : walks) go(w, &CaseWalk::finish_step);
  }
}

void CaseWorker::end(CaseWay way, const EnsembleCase& numbers, CaseResult& r) {
  if (way == CaseWay::simulation) {
    by_simulation(numbers, r);
    // A case that fails at its start may have another structure there, or other redundant constraints.
    if (!r.outcome.ok() && r.steps == 0 && r.outcome.kind != OutcomeKind::inconsistent &&
        r.outcome.kind != OutcomeKind::interrupted)
      way = CaseWay::derivation;
  }
  if (way == CaseWay::derivation) by_derivation(numbers, r);
}

namespace {

// Keeps of the rows of `simulate` the columns of an ensemble.
class EnsembleRowFilter final : public RowSink {
 public:
  EnsembleRowFilter(const Model& model, const std::vector<Rational>& times, CaseResult& result)
      : model_(model), result_(result) {
    for (const Rational& t : times) times_.push_back(from_rational<double>(t));
  }
  void columns(const std::vector<RunColumn>& columns) override { kept_ = ensemble_places(model_, columns); }
  void row(const Row& row) override {
    const double t = row.values[0];
    result_.t = t;
    result_.last.clear();
    for (const std::optional<std::size_t>& k : kept_) result_.last.push_back(k ? row.values[*k] : kNoValue);
    if (std::find(times_.begin(), times_.end(), t) == times_.end()) return;
    std::vector<double>& kept = result_.rows.emplace_back();
    kept.push_back(t);
    kept.insert(kept.end(), result_.last.begin(), result_.last.end());
  }

 private:
  const Model& model_;
  std::vector<double> times_;
  CaseResult& result_;
  std::vector<std::optional<std::size_t>> kept_;  // columns
};

}  // namespace

void CaseWorker::simulate_case(Workspace& own, const EnsembleCase& numbers, CaseResult& r) {
  const EnsembleOptions& o = plan_.options;
  r.rows.clear();
  r.last.clear();
  r.reduced.clear();
  r.event.clear();
  const Rational to = numbers.to ? *numbers.to : o.to;
  SimulationOptions options = options_of_case(o, numbers);
  for (const Rational& t : o.at)
    if (to < Rational(own.state.t) ? t > to : t < to) options.at.push_back(t);
  options.at.push_back(to);
  std::sort(options.at.begin(), options.at.end());
  options.order = o.order;
  options.method = o.method;
  options.kernel = o.kernel;
  Reducer reducer(o.reductions, o.tolerance.get_d());
  const std::size_t ends = o.reductions.ends.size(), formulas = o.reductions.formulas.size();
  if (formulas + ends > 0) {
    options.followed = o.reductions.formulas;
    options.followed.insert(options.followed.end(), o.reductions.ends.begin(), o.reductions.ends.end());
    options.followed_at_ends = ends;
    options.dense = [&, ends, formulas](const StepPolynomials& step) {
      (void)reducer.step({step.end - step.begin, step.one_sided ? 0 : step.order - 1, step.followed,
                          [&](std::size_t i, double x) {
                            const auto [value, made_of] = step.followed_value(i, x);
                            return FormulaValue{value, made_of};
                          },
                          step.followed_hiding});
      std::vector<double> values;
      for (std::size_t i = 0; i < ends; ++i)
        values.push_back(step.followed_value(formulas + i, step.end - step.begin).first);
      reducer.ends(std::move(values));
    };
  }
  EnsembleRowFilter rows(*own.model, o.at, r);
  const SimulationReport report = o.own_motion ? o.own_motion(own, options, rows) : simulate_in(own, options, rows);
  for (const EventReport& e : report.events) {
    if (e.stop) r.event = e.name;
    reducer.event(e.name, e.t.value);
  }
  // Other methods, which motions with contacts take where slips are slow, have no polynomials.
  if (!report.method.turns.empty()) reducer.lose_formulas();
  const bool moved = report.outcome.ok() || report.steps > 0 || !report.events.empty();
  if (moved && !o.reductions.list.empty()) reducer.values(r.reduced);
  r.outcome = report.outcome;
  r.steps = report.steps;
  r.t = report.t;
}

void CaseWorker::by_simulation(const EnsembleCase& numbers, CaseResult& r) {
  ++in_workspaces_;
  Workspace own(plan_.of_all);
  const EnsembleOptions& o = plan_.options;
  for (std::size_t i = 0; i < o.varied.size(); ++i)
    if (o.varied[i].kind == Varied::Kind::parameter) own.set_parameter(o.varied[i].index, numbers.values[i]);
  simulate_case(own, numbers, r);
}

void CaseWorker::by_derivation(const EnsembleCase& numbers, CaseResult& r) {
  ++in_workspaces_;
  Scenario anew;
  r.outcome = scenario_of_case(plan_.of_all, plan_.options, numbers, anew);
  r.t = anew.state.t;
  r.rows.clear();
  r.last.clear();
  r.reduced.clear();
  if (!r.outcome.ok()) return;
  Workspace own(anew);
  simulate_case(own, numbers, r);
}

}  // namespace anholon

#include "ensemble/cases/case_walk.h"

#include <algorithm>

#include "ensemble/case_scenario.h"
#include "ensemble/columns.h"
#include "motion/course.h"
#include "simulation/trust.h"

namespace anholon {

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
  if (plan.options.own_motion || plan.options.each_anew) return CaseWay::derivation;
  if (!ready_) same_structure_ = plan.parameters.same_structure(narrow_parameters_);
  if (!same_structure_) return CaseWay::derivation;
  if (!plan.plain) return CaseWay::simulation;
  if (!ready_) {
    lane_ = {kernel, lane};
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
  r.replaced = named_.replaced.note;
  if (r.outcome.ok() && plan.parameters.may_be_no_rotation())
    r.outcome = plan.parameters.oriented(narrow_parameters_, named_);
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

// Gives these parameters to the objects that compute the case.
void CaseWalk::equip(const std::vector<W>& parameters, const std::vector<double>& narrow) {
  if (lane_.kernel) lane_.kernel->set_parameters(lane_.number, parameters);
  if (stepper_) {
    stepper_->set_parameters(narrow, parameters);
    point_->set_parameters(parameters);
    if (outputs_) outputs_->set_parameters(parameters);
    return;
  }
  stepper_ = std::make_unique<Stepper<double>>(*plan_->program, narrow, parameters, plan_->settings);
  if (!plan_->watched.empty()) stepper_->watch(plan_->watched);
  if (lane_.kernel) stepper_->accelerate(lane_.kernel, lane_.number);
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

// Takes the rows within the last step, and the end if the step reaches it.
CaseWay CaseWalk::after_step() {
  for (std::size_t i = 0; i < plan_->reduced.first; ++i)
    if (!plan_->scenario.model->masses[i].weight &&
        (first_negative(*stepper_, i) || stepper_->quadrature(i, stepper_->time() - stepper_->before()) < W(0)))
      return stop(CaseWay::simulation);
  // A formula of an event without a value is left to `simulate`, which names the event.
  for (const WatchedSeries& w : plan_->watched)
    if (!stepper_->one_sided() && !is_finite(stepper_->quadrature_coefficient(w.quadrature, 0)))
      return stop(CaseWay::simulation);
  if (!rows()) return stop(CaseWay::simulation);
  if (reducer_ && !reduce()) return stop(CaseWay::simulation);
  if (!stepper_->fired().empty()) return take_events();
  if (stepper_->time() == end_) return arrive();
  return another_method_pays() ? stop(CaseWay::simulation) : CaseWay::plain;
}

// Returns false if the polynomials of a formula are not good; then `simulate` computes the case and uses values.
bool CaseWalk::reduce() {
  if (stepper_->one_sided() && !plan_->options.reductions.formulas.empty()) return false;
  const auto coefficient = [&](std::size_t i, int k) {
    return stepper_->quadrature_coefficient(plan_->reduced.first + i, k);
  };
  const auto value = [&](std::size_t i, double x) {
    if (!stepper_->arrived()) stepper_->leave_kernel();
    const auto [is, made_of] =
        value_of_quadrature(*stepper_, W(stepper_->before() + W(x)), plan_->reduced.first + i, *point_);
    return FormulaValue{is, made_of};
  };
  const auto hiding = [&](std::size_t i) {
    std::vector<HidingPolynomial> arguments;
    for (const EnsemblePlan::Reduced::Function& f : plan_->reduced.functions[i]) {
      HidingPolynomial& next = arguments.emplace_back(HidingPolynomial{f.hiding, {}});
      for (int k = 0; k < stepper_->order(); ++k)
        next.argument.push_back(stepper_->quadrature_coefficient(f.argument, k));
    }
    return arguments;
  };
  const bool last = !stepper_->fired().empty() || stepper_->time() == end_;
  const double h = to_double(W(stepper_->time() - stepper_->before()));
  const bool good = reducer_->step({h, stepper_->order() - 1, coefficient, value, {}, last, stepper_->kinks(), hiding});
  for (const Fired<double>& f : stepper_->fired())
    reducer_->event(plan_->scenario.model->events[f.series].name, to_double(W(stepper_->before() + W(f.where))));
  reducer_->values(result_->reduced);
  return good;
}

// If another method pays, `simulate` computes the case and comes to the same conclusion.
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

// Takes the last values of formulas, at the point that was kept.
void CaseWalk::tell_ends() {
  std::vector<double> values;
  const std::size_t monitors = plan_->scenario.model->monitors.size();
  for (std::size_t i = 0; i < plan_->options.reductions.ends.size(); ++i)
    values.push_back(to_double(outputs_->value(monitors + i)));
  reducer_->ends(std::move(values));
  reducer_->values(result_->reduced);
}

// Takes the events of the last step. If one sets something at the very end of a motion, `simulate` computes the case.
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
    ready_ = false;  // so the next case has to set its parameters
  }
  if (plan_->nearest) {
    std::vector<W> leading;
    point_->leading(leading);
    if (!plan_->nearest->put(*plan_->program, stepper_->time(), parameters, leading, state).ok())
      return stop(CaseWay::simulation);
  }
  return stepper_->restart(state, false).ok() ? CaseWay::plain : stop(CaseWay::simulation);
}

// Keeps the rows within the last step.
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

// Keeps the results at t, a time of the last step.
bool CaseWalk::keep(const W& t, std::vector<double>& values) {
  const System& system = plan_->scenario.system;
  // Every reader of a motion takes it out of the kernel (motion.cpp), unless no step follows.
  if (!stepper_->arrived()) stepper_->leave_kernel();
  if (!stepper_->at(t, *point_, plan_->leading).ok() || (plan_->stages > 0 && !point_->extend().ok())) return false;
  // Like in `simulate`, there is no column of velocities if no coordinate is solved for by more than its value.
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

}  // namespace anholon

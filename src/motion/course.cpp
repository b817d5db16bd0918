#include "motion/course.h"

#include <algorithm>

namespace anholon {

namespace {

// Taylor's method makes kHelp steps where another method fails, and all further steps once it has helped too often.
constexpr std::size_t kHelp = 8, kMostRescues = 50;

// Guards end a step of another method: masses and arguments of tables, which are quadratures of the program.
std::vector<Guard> guards_of(const Model& model, std::size_t quadratures) {
  std::vector<Guard> guards;
  for (std::size_t i = 0; i < model.masses.size(); ++i)
    if (!model.masses[i].weight)
      guards.push_back({1 + i,
                        {OutcomeKind::negative_mass, "the mass of '" + model.masses[i].name + "' is negative",
                         "end the motion before"}});
  for (std::size_t i = 0; i < model.bounds.size(); ++i)
    guards.push_back({quadratures + model.events.size() + i,
                      {OutcomeKind::not_a_number, model.bounds[i].fault, "end the motion before"}});
  return guards;
}

template <Number N>
void count_taylor(const Stepper<N>& taylor, MethodReport& report) {
  report.taylor_steps = taylor.steps();
  report.expansions = taylor.expansions();
}

void count_other(StateStepper& other, MethodReport& report) {
  report.refused += other.refused();
  report.evaluations += other.rate().evaluations();
}

bool is_free(Method asked, const StepSettings& settings) { return asked == Method::automatic && settings.order == 0; }

}  // namespace

std::string only_taylor(const Model& model, const Program& program) {
  if (!model.events.empty()) return "does not look for events";
  if (program.several_solutions)
    return "cannot tell solutions that meet apart: the leading derivatives enter the equations nonlinearly";
  return {};
}

template <Number N>
MethodReport TaylorCourse<N>::report() const {
  MethodReport r;
  r.asked = asked_;
  count_taylor(motion_.stepper(), r);
  return r;
}

MethodCourse::MethodCourse(Workspace& s, const StepSettings& settings, Method asked,
                           const std::vector<Expr>& quadratures, int stages)
    : motion_(s, settings, quadratures, stages), model_(*s.model), settings_(settings), stages_(stages),
      steppers_(motion_, *s.model, settings, guards_of(*s.model, quadratures.size()), is_free(asked, settings)) {
  report_.asked = asked;
  if (!only_taylor(model_, motion_.program()).empty()) return;
  if (asked != Method::automatic) report_.last = asked;
  if (is_free(asked, settings)) choice_.emplace(steppers_, motion_, settings.log_tolerance);
}

Outcome MethodCourse::steps(const W& end, Stretch<W>& stretch) {
  if (choice_ && report_.last == Method::taylor)
    if (std::optional<MethodChoice::Turn> to = choice_->leave_taylor(end)) turn(*std::move(to));
  if (report_.last != Method::taylor && taylor_for_ == 0)
    if (const std::optional<Outcome> o = step_by_other(end)) {
      if (o->ok()) stretch.times.push_back(time());
      return *o;
    }
  return steps_by_taylor(end, stretch);
}

Outcome MethodCourse::steps_by_taylor(const W& end, Stretch<W>& stretch) {
  by_other_ = false;
  if (taylor_for_ > 0)
    stretch.limit(1);
  else if (choice_)
    stretch.limit(choice_->stays_with_taylor(end, stretch.most));
  const std::size_t known = stretch.times.size();
  const Outcome o = motion_.steps(end, stretch);
  if (choice_)
    for (std::size_t i = known; i < stretch.times.size(); ++i) choice_->note_step(stretch.times[i]);
  // Steps so short that the end is out of reach may be those of a stiff motion.
  if (o.kind == OutcomeKind::interrupted && choice_ && report_.last == Method::taylor &&
      !(settings_.cancelled && settings_.cancelled()))
    if (std::optional<MethodChoice::Turn> to = choice_->leave_for_bdf(end)) {
      turn(*std::move(to));
      return steps(end, stretch);
    }
  if (o.ok() && taylor_for_ > 0) --taylor_for_;
  return o;
}

// Makes a step by the other method; returns nullopt if Taylor's method has to make it.
std::optional<Outcome> MethodCourse::step_by_other(const W& end) {
  if (!other_) {
    other_ = std::make_unique<StateMotion>(motion_, parameter_values<double>(model_), stages_,
                                           steppers_.make(report_.last), met_);
    if (choice_) choice_->begin_other();
    if (!other_->stepper().start(present_point(motion_), end).ok()) return help_from(other_->stepper().now(), kHelp);
  }
  StateStepper& stepper = other_->stepper();
  if (choice_ && choice_->slower_than_taylor(stepper))
    return return_to_taylor("it had come to cost more than Taylor's steps before");
  if (motion_.pivot_is_small(other_->begin_step())) return help_from(stepper.now(), 1);
  code_.step(steppers_.plan(), to_double(stepper.now().t), to_double(end));
  const std::size_t steps = stepper.steps();
  const Outcome o = other_->step(end);
  // Taylor's method stops at the singular point, or finds that J is regular.
  if (o.ok() && other_->passed_singular_point()) return help_from(stepper.before(), kHelp);
  if (o.ok()) {
    by_other_ = true;
    report_.steps += stepper.steps() - steps;
    other_->note_step();
    return o;
  }
  if (o.kind == OutcomeKind::interrupted) {
    go_on_from(stepper.now());
    return o;
  }
  if (++rescues_ > kMostRescues)
    return return_to_taylor("Taylor's steps had to help " + std::to_string(kMostRescues) + " times");
  return help_from(stepper.now(), kHelp);
}

// Lets Taylor's method make the next steps, before the other method goes on. Returns nullopt if it can begin at p.
std::optional<Outcome> MethodCourse::help_from(const MotionPoint& p, std::size_t steps) {
  if (Outcome o = go_on_from(p); !o.ok()) return o;
  taylor_for_ = steps;
  return std::nullopt;
}

// Lets Taylor's method make all steps from here on. Returns nullopt if it can.
std::optional<Outcome> MethodCourse::return_to_taylor(std::string why) {
  if (Outcome o = go_on_from(other_->stepper().now()); !o.ok()) return o;
  turn({Method::taylor, std::move(why)});
  return std::nullopt;
}

// Ends the stretch of the other method: Taylor's motion continues from p.
Outcome MethodCourse::go_on_from(const MotionPoint& p) {
  StateStepper& stepper = other_->stepper();
  if (stepper.steps() > 0) {
    StepperState<double> b = motion_.stepper().begun();
    MotionState<double>& m = b.motion;
    m.t = p.t;
    m.state = p.state;
    m.carry.assign(p.state.size(), 0);
    m.leading.assign(p.leading.begin(), p.leading.end());
    m.integrals = p.integrals;
    m.integral_carry.assign(p.integrals.size(), 0);
    m.record.branch_step = m.record.last_step = 0;
    m.record.steps = motion_.stepper().steps();
    m.record.careful = true;
    if (Outcome o = motion_.go_on(b); !o.ok()) return o;
  }
  count_other(stepper, report_);
  other_.reset();
  by_other_ = false;
  return {};
}

void MethodCourse::turn(MethodChoice::Turn to) {
  report_.last = to.to;
  report_.turns.push_back({to_double(time()), to.to, std::move(to.why)});
}

int MethodCourse::order() const {
  const int fixed = info(report_.last).order;
  return fixed > 0 ? fixed : motion_.stepper().order();
}

MethodCourse::W MethodCourse::worst_constraint() const {
  return std::max(met_.worst_constraint, motion_.stepper().worst_constraint());
}

const LeastRegular<double>& MethodCourse::least_regular() const {
  const LeastRegular<double>& by_taylor = motion_.stepper().least_regular();
  return met_.least_regular.sigma < by_taylor.sigma ? met_.least_regular : by_taylor;
}

MethodReport MethodCourse::report() const {
  MethodReport r = report_;
  count_taylor(motion_.stepper(), r);
  if (choice_) r.trials = choice_->trials().count, r.trial_evaluations = choice_->trials().evaluations;
  if (other_) count_other(other_->stepper(), r);
  return r;
}

template class TaylorCourse<long double>;
template class TaylorCourse<Quad>;
template class TaylorCourse<Multi>;

}  // namespace anholon

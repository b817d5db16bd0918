#include "motion/course.h"

#include <algorithm>
#include <cmath>

#include "integrate/sigma_schedule.h"
#include "integrate/states/dormand_prince.h"

namespace anholon {

namespace {

// Where another method cannot go, Taylor makes some steps; if that happens too often, all that follow.
constexpr std::size_t kHelp = 8, kMostRescues = 50;

template <Number W>
std::vector<W> widened(const std::vector<double>& from) {
  return {from.begin(), from.end()};
}

}  // namespace

std::string only_taylor(const Model& model, const Program& program) {
  if (!model.events.empty()) return "does not look for events";
  if (program.nonlinear)
    return "cannot tell solutions that meet apart: the leading derivatives enter the equations nonlinearly";
  return {};
}

template <Number N>
Course<N>::Course(Workspace& s, const StepSettings& settings, Method asked, std::vector<Expr> quadratures, int stages)
    : s_(s), settings_(settings), motion_(s, settings, quadratures, stages), stages_(stages) {
  report_.asked = asked;
  if (!std::same_as<N, double> || asked == Method::taylor || !only_taylor(*s.model, motion_.program()).empty()) return;
  free_ = asked == Method::automatic && settings.order == 0;
  if (asked != Method::automatic) wanted_ = report_.last = asked;
  const Model& model = *s.model;
  for (std::size_t i = 0; i < model.masses.size(); ++i)
    if (!model.masses[i].weight)
      guards_.push_back({1 + i,
                         {OutcomeKind::negative_mass, "the mass of '" + model.masses[i].name + "' is negative",
                          "end the motion before"}});
  for (std::size_t i = 0; i < model.bounds.size(); ++i)
    guards_.push_back({quadratures.size() + model.events.size() + i,
                       {OutcomeKind::not_a_number, model.bounds[i].fault, "end the motion before"}});
}

template <Number N>
Outcome Course<N>::step(const W& end) {
  if (free_ && wanted_ == Method::taylor) choose(end);
  if (wanted_ != Method::taylor && taylor_for_ == 0)
    if (const std::optional<Outcome> o = step_by_other(end)) return *o;
  by_other_ = false;
  const Outcome o = motion_.step(end);
  // Steps so short that the end is out of reach may be those of a stiff motion.
  if (o.kind == OutcomeKind::interrupted && free_ && wanted_ == Method::taylor &&
      !(settings_.cancelled && settings_.cancelled()) && try_bdf(end))
    return step(end);
  if (!o.ok()) return o;
  if (taylor_for_ > 0) --taylor_for_;
  if (free_) {
    if (times_.size() > 2 * kStretch)
      times_.erase(times_.begin(), times_.end() - static_cast<std::ptrdiff_t>(kStretch + 1));
    times_.push_back(motion_.stepper().time());
  }
  return o;
}

// Nothing where Taylor has to step.
template <Number N>
std::optional<Outcome> Course<N>::step_by_other(const W& end) {
  if constexpr (std::same_as<N, double>) {
    const auto by_taylor = [&](std::size_t steps) -> std::optional<Outcome> {
      if (Outcome o = hand_over(other_->now()); !o.ok()) return o;
      taylor_for_ = steps;
      return std::nullopt;
    };
    if (!other_) {
      other_ = make(wanted_);
      point_ = motion_.point();
      begun_ = motion_.stepper().point();
      look_.emplace(motion_.program(), parameter_values<N>(*s_.model), 1);
      least_health_ = 1;
      suspected_ = false;
      times_.clear();
      window_steps_ = 0;
      window_t_ = static_cast<double>(motion_.stepper().time());
      window_spent_ = 0;
      if (!other_->start(here(), end).ok()) return by_taylor(kHelp);
    }
    if (slower_than_taylor()) {
      if (Outcome o = hand_over(other_->now()); !o.ok()) return o;
      turn(Method::taylor, "it had come to cost more than Taylor's steps before");
      return std::nullopt;
    }
    begun_->load(other_->now().t, other_->now().state, widened<W>(other_->now().leading));
    if (motion_.pivot_is_small(*begun_)) return by_taylor(1);
    code_.step(plan_);
    const std::size_t steps = other_->steps();
    const std::optional<Pivots> pivots = other_->rate().pivots();
    Outcome o = other_->step(end);
    // Also in the step after one in which they shrank: J may be singular close by. Without a kernel nothing tells.
    const bool suspected = !pivots || may_have_vanished(*pivots, *other_->rate().pivots());
    if (o.ok() && (suspected || suspected_) && passed_singular_point()) {
      // Taylor stops there, or knows better.
      if (o = hand_over(MotionPoint(other_->before())); !o.ok()) return o;
      taylor_for_ = kHelp;
      return std::nullopt;
    }
    suspected_ = suspected;
    if (o.ok()) {
      by_other_ = true;
      report_.steps += other_->steps() - steps;
      worst_constraint_ = std::max(worst_constraint_, W(other_->worst_constraint()));
      look();
      return o;
    }
    if (o.kind == OutcomeKind::interrupted) {
      hand_over(other_->now());
      return o;
    }
    if (++rescues_ > kMostRescues) {
      if (Outcome handed = hand_over(other_->now()); !handed.ok()) return handed;
      turn(Method::taylor, "Taylor's steps had to help " + std::to_string(kMostRescues) + " times");
      return std::nullopt;
    }
    return by_taylor(kHelp);
  } else {
    (void)end;
    return std::nullopt;
  }
}

// Whether J was singular within the last step: asked of the reference, at both ends.
template <Number N>
bool Course<N>::passed_singular_point() {
  if constexpr (std::same_as<N, double>) {
    std::optional<Mode<N>> modes[2];
    for (const bool after : {false, true}) {
      const MotionPoint& p = after ? other_->now() : other_->before();
      look_->load(static_cast<double>(p.t), std::vector<double>(p.state.begin(), p.state.end()), p.leading);
      if (!look_->prepare().ok()) return true;
      const double sigma = look_->smallest_singular_value();
      modes[after] = weakest_mode(*look_, sigma);
    }
    return crossed(*modes[0], *modes[1], s_.system.coordinates);
  }
  return false;
}

// Taylor goes on from where the other method has come to.
template <Number N>
Outcome Course<N>::hand_over(const MotionPoint& p) {
  if constexpr (std::same_as<N, double>) {
    if (other_->steps() > 0) {
      StepperState<N> b = motion_.stepper().begun();
      MotionState<N>& m = b.motion;
      m.t = p.t;
      m.state = p.state;
      m.carry.assign(p.state.size(), 0);
      m.leading = widened<W>(p.leading);
      m.integrals = p.integrals;
      m.integral_carry.assign(p.integrals.size(), 0);
      m.record.branch_step = m.record.last_step = 0;
      m.record.steps = motion_.stepper().steps();
      m.record.careful = true;
      if (Outcome o = motion_.go_on(b); !o.ok()) return o;
    }
    report_.refused += other_->refused();
    report_.evaluations += other_->rate().evaluations();
    other_.reset();
    by_other_ = false;
  }
  return {};
}

template <Number N>
Outcome Course<N>::at(const W& t) {
  if constexpr (std::same_as<N, double>) {
    if (by_other_) {
      MotionPoint p;
      Outcome o = other_->at(t, p);
      if (o.ok()) {
        point_->load(t, p.state, widened<W>(p.leading));
        o = point_->prepare();
        if (o.ok()) o = point_->project();
        if (o.ok()) o = point_->solve();
      }
      if (!o.ok())
        o.message += " at t = " + number_text(to_double(t), 12);
      else if (stages_ > 0)
        o = point_->extend();
      return o;
    }
  }
  return motion_.at(t);
}

// At the start of the last step, as Taylor's stepper does.
template <Number N>
void Course<N>::look() {
  if constexpr (std::same_as<N, double>) {
    const double health = other_->rate().pivots() ? other_->rate().pivots()->health : 1;
    if (!sigma_is_due(other_->steps()) && !(health < least_health_ * kPivotDropToRecheck)) return;
    least_health_ = std::min(least_health_, health);
    const MotionPoint& p = other_->before();
    look_->load(static_cast<double>(p.t), std::vector<double>(p.state.begin(), p.state.end()), p.leading);
    if (!look_->prepare().ok()) return;
    const double sigma = look_->smallest_singular_value();
    if (!(sigma < smallest_sigma_)) return;
    smallest_sigma_ = sigma;
    smallest_sigma_t_ = p.t;
    const std::vector<double>& v = look_->weakest_direction();
    for (std::size_t j = weakest_ = 0; j < v.size(); ++j)
      if (std::abs(v[j]) > std::abs(v[weakest_])) weakest_ = j;
  }
}

template <Number N>
typename Course<N>::W Course<N>::time() const {
  if constexpr (std::same_as<N, double>)
    if (by_other_) return other_->now().t;
  return motion_.stepper().time();
}

template <Number N>
typename Course<N>::W Course<N>::before() const {
  if constexpr (std::same_as<N, double>)
    if (by_other_) return other_->before().t;
  return motion_.stepper().before();
}

template <Number N>
const std::vector<typename Course<N>::W>& Course<N>::integrals() const {
  if constexpr (std::same_as<N, double>)
    if (by_other_) return other_->now().integrals;
  return motion_.stepper().integrals();
}

template <Number N>
std::size_t Course<N>::steps() const {
  return motion_.stepper().steps() + report_.steps;
}

template <Number N>
int Course<N>::order() const {
  switch (report_.last) {
  case Method::runge_kutta:
    return dormand_prince::kOrder;
  case Method::bdf:
    return 5;
  default:
    return motion_.stepper().order();
  }
}

template <Number N>
typename Course<N>::W Course<N>::worst_constraint() const {
  return std::max(worst_constraint_, motion_.stepper().worst_constraint());
}

template <Number N>
const N& Course<N>::smallest_sigma() const {
  return smallest_sigma_ < motion_.stepper().smallest_sigma() ? smallest_sigma_ : motion_.stepper().smallest_sigma();
}

template <Number N>
const typename Course<N>::W& Course<N>::smallest_sigma_time() const {
  return smallest_sigma_ < motion_.stepper().smallest_sigma() ? smallest_sigma_t_
                                                              : motion_.stepper().smallest_sigma_time();
}

template <Number N>
std::size_t Course<N>::weakest_unknown() const {
  return smallest_sigma_ < motion_.stepper().smallest_sigma() ? weakest_ : motion_.stepper().weakest_unknown();
}

template <Number N>
MethodReport Course<N>::report() const {
  MethodReport r = report_;
  r.taylor_steps = motion_.stepper().steps();
  r.expansions = motion_.stepper().expansions();
  if (other_) {
    r.refused += other_->refused();
    r.evaluations += other_->rate().evaluations();
  }
  return r;
}

template class Course<double>;
template class Course<long double>;
template class Course<Quad>;
template class Course<Multi>;

}  // namespace anholon

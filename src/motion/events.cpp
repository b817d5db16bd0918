// Applies what events set where the last step has ended.
#include "motion/motion.h"
#include "numeric/told_time.h"

namespace anholon {

std::vector<Expr> watched_formulas(const Model& model) {
  std::vector<Expr> es;
  for (const Event& e : model.events) es.push_back(e.when);
  for (const Bound& b : model.bounds) es.push_back(put_masses(model, b.inside));
  return es;
}

bool watches_multipliers(const Model& model) {
  const std::vector<NodeId> ids = symbols(watched_formulas(model));
  return std::any_of(ids.begin(), ids.end(), [&](NodeId id) { return model.graph->node(id).kind == Kind::multiplier; });
}

std::vector<WatchedSeries> watched_series(const Scenario& s, std::size_t first) {
  std::vector<WatchedSeries> list;
  const auto of_state = [&](Expr e) { return orders_needed(s, {&e, 1}) <= 0; };
  for (const Event& e : s.model->events)
    list.push_back({first + list.size(), e.direction, e.ends_step(), of_state(e.when)});
  for (const Bound& b : s.model->bounds) list.push_back({first + list.size(), 0, true, of_state(b.inside)});
  return list;
}

template <Number N>
std::vector<Expr> Motion<N>::with_watched(Workspace& in) const {
  std::vector<Expr> es;
  for (Expr e : quadratures_) es.push_back(in.graph().own(e));
  for (const Expr e : watched_formulas(*in.model)) es.push_back(e);
  return es;
}

template <Number N>
void Motion<N>::set_modes(const std::vector<W>& parameters) {
  parameters_ = parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (s_.model->parameters[i].mode) narrow_parameters_[i] = convert<N>(parameters[i]);
}

// True if the motion is beyond a bound, or on it and goes beyond it by more than round-off. `met`: the motion is on it.
template <Number N>
bool Motion<N>::leaves(std::size_t bound, bool met, bool forward) const {
  constexpr int kRoundoffs = 64, kAboveNoise = 1024;
  const Stepper<N>& stepper = leg_->stepper;
  const std::size_t at = quadratures_.size() + s_.model->events.size() + bound;
  N size(1);
  for (const W& x : stepper.state()) size = std::max(size, convert<N>(abs(x)));
  const N noise = unit_roundoff<N>() * N(kRoundoffs) * size, value = convert<N>(stepper.quadrature(at, W(0)));
  if (!met && abs(value) > noise) return value < N(0);
  for (int k = 1; k < stepper.order(); ++k)
    if (const N c = stepper.quadrature_coefficient(at, k); abs(c) > noise * N(kAboveNoise))
      return (forward || k % 2 == 0) ? c < N(0) : c > N(0);
  return false;
}

// Fails if an event's formula has no value where the motion is; `when` tells the place in words. A motion that begins
// where formulas have no derivatives has no values of them yet. `first`: the first quadrature of the events.
template <Number N>
static Outcome all_have_values(const Model& model, const Stepper<N>& stepper, std::size_t first,
                               const std::string& when) {
  for (std::size_t i = 0; i < model.events.size() && !stepper.one_sided(); ++i)
    if (!is_finite(stepper.quadrature_coefficient(first + i, 0)))
      return {OutcomeKind::not_a_number, "the formula of the event '" + model.events[i].name + "' has no value " + when,
              kEventWithoutValue};
  return {};
}

template <Number N>
Outcome Motion<N>::within_bounds(bool forward) {
  if (Outcome o = all_have_values(*s_.model, leg_->stepper, quadratures_.size(), "at the start"); !o.ok()) return o;
  for (std::size_t i = 0; i < s_.model->bounds.size(); ++i)
    if (leaves(i, false, forward))
      return {OutcomeKind::not_a_number, s_.model->bounds[i].fault + " at the start",
              "give the table more knots, or outside = \"hold\" or \"linear\""};
  return {};
}

template <Number N>
const SetByEvent& Motion<N>::set_by(std::size_t event) {
  effects_.sets.resize(s_.model->events.size());
  std::optional<SetByEvent>& set = effects_.sets[event];
  if (!set) set.emplace(s_, s_.model->events[event]);
  return *set;
}

// Makes what an event has set consistent by the least change in the mass norm.
template <Number N>
Outcome Motion<N>::to_nearest(std::vector<W>& state) {
  if (s_.system.constraints.empty()) return {};
  if (!effects_.nearest) effects_.nearest.emplace(s_, parameters_);
  std::vector<W> leading;
  leg_->point.leading(leading);
  return effects_.nearest->put(leg_->program, leg_->stepper.time(), parameters_, leading, state);
}

// The outcome of a motion that meets a bound at the time `t`.
static Outcome beyond(const Bound& b, double t) {
  return told({OutcomeKind::not_a_number, b.fault + at_time(t),
               "end the motion before, give the table more knots, or outside = \"hold\" or \"linear\""},
              t);
}

template <Number N>
Outcome Motion<N>::settle(std::vector<Occurrence<W>>& occurrences, bool& goes_on) {
  const std::vector<Fired<N>> fired = leg_->stepper.fired();
  const W start = leg_->stepper.before(), now = leg_->stepper.time();
  const Event* set = nullptr;  // the last event that sets something
  goes_on = true;
  std::optional<N> changed;  // the place at which an event changes or ends the motion
  std::vector<bool> met(
      s_.model->bounds.size());  // the bounds that were met at that place; the motion may turn back there
  std::vector<W> state, parameters = parameters_;
  if (Outcome o = at(now); !o.ok()) return o;
  leg_->point.state(state);
  for (const Fired<N>& f : fired) {
    if (f.series >= s_.model->events.size()) {
      const std::size_t bound = f.series - s_.model->events.size();
      if (!changed || f.where != *changed)
        return beyond(s_.model->bounds[bound], to_double(W(start + convert<W>(f.where))));
      met[bound] = true;
      continue;
    }
    const Event& event = s_.model->events[f.series];
    Occurrence<W> occurrence{f.series, start + convert<W>(f.where), {}, W(0)};
    if (!event.set.empty()) {
      set = &event;
      if (Outcome o = set_by(f.series).put(leg_->point, state, parameters, occurrence.changes); !o.ok()) return o;
    }
    if (event.stop) goes_on = false;
    if (event.ends_step()) changed = f.where;
    occurrences.push_back(std::move(occurrence));
  }
  if (!set) return {};
  std::unique_ptr<Leg> left;
  const std::vector<W> modes = parameters_;
  if (parameters != parameters_) {
    set_modes(parameters);
    auto next = same_leg();
    take(plans(), *next);
    next->at_once = leg_->at_once;
    next->stepper.adopt(leg_->stepper);
    left = std::exchange(leg_, std::move(next));
    choices_.pivots.clear();
  }
  const auto fail = [&](Outcome why) {
    before_events_ = {std::move(left), modes};
    return why;
  };
  const std::vector<W> as_set = state;
  Outcome o = to_nearest(state);
  if (o.ok()) o = leg_->stepper.restart(state);
  begun_parameters_ = parameters_;
  if (!o.ok()) {
    o.message = "after the event '" + set->name + "': " + o.message;
    return fail(std::move(o));
  }
  const std::string after = "after the event '" + set->name + "'," + at_time(to_double(now));
  if (goes_on)
    if (o = all_have_values(*s_.model, leg_->stepper, quadratures_.size(), after); !o.ok())
      return fail(told(std::move(o), to_double(now)));
  for (std::size_t i = 0; i < met.size(); ++i)
    if (leaves(i, met[i], now > start)) return fail(beyond(s_.model->bounds[i], to_double(now)));
  W correction(0);
  const std::vector<W>& consistent = leg_->stepper.state();
  for (std::size_t i = 0; i < state.size(); ++i)
    correction = std::max(correction, W(abs(W(consistent[i] - as_set[i])) / (W(1) + abs(as_set[i]))));
  if (correction > convert<W>(unit_roundoff<N>()) * W(1000))
    for (Occurrence<W>& each : occurrences)
      if (!each.changes.empty()) each.correction = correction;
  return {};
}

#define INSTANTIATE(N)                                                                                                 \
  template std::vector<Expr> Motion<N>::with_watched(Workspace&) const;                                                \
  template void Motion<N>::set_modes(const std::vector<Wider<N>>&);                                                    \
  template bool Motion<N>::leaves(std::size_t, bool, bool) const;                                                      \
  template Outcome Motion<N>::within_bounds(bool);                                                                     \
  template Outcome Motion<N>::to_nearest(std::vector<Wider<N>>&);                                                      \
  template const SetByEvent& Motion<N>::set_by(std::size_t);                                                           \
  template Outcome Motion<N>::settle(std::vector<Occurrence<Wider<N>>>&, bool&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

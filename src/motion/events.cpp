// What an event sets, put in where the last step has ended.
#include "motion/motion.h"

namespace anholon {

template <Number N>
std::vector<Expr> Motion<N>::with_events(Workspace& in) const {
  std::vector<Expr> es;
  for (Expr e : quadratures_) es.push_back(in.graph().own(e));
  for (const Event& e : in.model->events) es.push_back(e.when);
  for (const Bound& b : in.model->bounds) es.push_back(put_masses(*in.model, b.inside));
  return es;
}

template <Number N>
std::vector<WatchedSeries> Motion<N>::watched() const {
  std::vector<WatchedSeries> list;
  const auto of_state = [&](Expr e) { return orders_needed(s_, {&e, 1}) <= 0; };
  for (const Event& e : s_.model->events)
    list.push_back({quadratures_.size() + list.size(), e.direction, e.ends_step(), of_state(e.when)});
  for (const Bound& b : s_.model->bounds)
    list.push_back({quadratures_.size() + list.size(), 0, true, of_state(b.inside)});
  return list;
}

template <Number N>
void Motion<N>::set_modes(const std::vector<W>& parameters) {
  parameters_ = parameters;
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (s_.model->parameters[i].mode) narrow_parameters_[i] = convert<N>(parameters[i]);
}

template <Number N>
Outcome Motion<N>::within_bounds() {
  for (std::size_t i = 0; i < s_.model->bounds.size(); ++i)
    if (leg_->stepper.quadrature(quadratures_.size() + s_.model->events.size() + i, W(0)) < W(0))
      return {OutcomeKind::not_a_number, s_.model->bounds[i].fault + " at the start",
              "give the table more knots, or outside = \"hold\" or \"linear\""};
  return {};
}

// The values of one event by the state and the modes as they are now; then they are changed.
template <Number N>
Outcome Motion<N>::fire(const Event& event, std::vector<W>& state, std::vector<W>& parameters,
                        Occurrence<W>& occurrence) {
  const Graph& g = *s_.model->graph;
  Column values;
  for (const Assignment& a : event.set) values.push_back(a.value);
  if (values.empty()) return {};
  const Expansion<W>& point = leg_->point;
  const auto entry = [&](const Node& n) -> W* {  // of the state
    if (n.kind == Kind::parameter) return &parameters[n.index];
    const std::size_t j = n.kind == Kind::state ? s_.system.mechanical() + n.index : n.index;
    return static_cast<int>(n.order) < leg_->program.d[j] ? &state[point.offset(j) + n.order] : nullptr;
  };
  const Tape tape = compile(OutputTape<W>::put(s_, values));
  Machine<W> machine(tape, 0, parameters);
  bind(machine, g, [&](const Node& n, NodeId symbol) {
    const W* own = n.kind == Kind::jet || n.kind == Kind::state ? entry(n) : nullptr;
    return own ? *own : ValueAt<W>{s_.system, point}(n, symbol);
  });
  machine.evaluate();
  for (std::size_t i = 0; i < event.set.size(); ++i) {
    const Expr symbol = event.set[i].symbol;
    const std::string name = print(symbol, s_.model->names, Format::text);
    W* place = entry(g.node(symbol.id));
    if (!place)
      return {OutcomeKind::inconsistent,
              "the event '" + event.name + "' sets " + name +
                  ", which is no part of the state: it follows from the constraints",
              "set what it follows from"};
    if (!is_finite(machine.value(i)))
      return {OutcomeKind::not_a_number, "the event '" + event.name + "' gives " + name + " no value",
              "look for roots of negative numbers and divisions by zero in 'set'"};
    occurrence.changes.push_back({name, *place, machine.value(i)});
  }
  for (std::size_t i = 0; i < event.set.size(); ++i) *entry(g.node(event.set[i].symbol.id)) = machine.value(i);
  return {};
}

template <Number N>
Outcome Motion<N>::settle(std::vector<Occurrence<W>>& occurrences, bool& goes_on) {
  const std::vector<Fired<N>> fired = leg_->stepper.fired();
  const W start = leg_->stepper.before(), now = leg_->stepper.time();
  bool set = false;
  goes_on = true;
  std::vector<W> state, parameters = parameters_;
  if (Outcome o = at(now); !o.ok()) return o;
  leg_->point.state(state);
  for (const Fired<N>& f : fired) {
    if (f.series >= s_.model->events.size()) {
      const Bound& b = s_.model->bounds[f.series - s_.model->events.size()];
      return {OutcomeKind::not_a_number,
              b.fault + " at t = " + number_text(to_double(W(start + convert<W>(f.where))), 12),
              "end the motion before, give the table more knots, or outside = \"hold\" or \"linear\""};
    }
    const Event& event = s_.model->events[f.series];
    Occurrence<W> occurrence{f.series, start + convert<W>(f.where), {}, W(0)};
    if (Outcome o = fire(event, state, parameters, occurrence); !o.ok()) return o;
    set = set || !event.set.empty();
    if (event.stop) goes_on = false;
    occurrences.push_back(std::move(occurrence));
  }
  if (!set) return {};
  if (parameters != parameters_) {
    set_modes(parameters);
    auto next = same_leg();
    take(plans(), *next);
    next->at_once = leg_->at_once;
    next->stepper.adopt(leg_->stepper);
    leg_ = std::move(next);
    chosen_.clear();
  }
  Outcome o = leg_->stepper.restart(state);
  begun_parameters_ = parameters_;
  if (!o.ok()) {
    o.message = "after the event '" + s_.model->events[fired.back().series].name + "': " + o.message;
    return o;
  }
  W correction(0);
  const std::vector<W>& consistent = leg_->stepper.state();
  for (std::size_t i = 0; i < state.size(); ++i)
    correction = std::max(correction, W(abs(W(consistent[i] - state[i])) / (W(1) + abs(state[i]))));
  if (correction > convert<W>(unit_roundoff<N>()) * W(1000))
    for (Occurrence<W>& each : occurrences)
      if (!each.changes.empty()) each.correction = correction;
  return {};
}

#define INSTANTIATE(N)                                                                                                 \
  template std::vector<Expr> Motion<N>::with_events(Workspace&) const;                                                 \
  template std::vector<WatchedSeries> Motion<N>::watched() const;                                                      \
  template void Motion<N>::set_modes(const std::vector<Wider<N>>&);                                                    \
  template Outcome Motion<N>::within_bounds();                                                                         \
  template Outcome Motion<N>::fire(const Event&, std::vector<Wider<N>>&, std::vector<Wider<N>>&,                       \
                                   Occurrence<Wider<N>>&);                                                             \
  template Outcome Motion<N>::settle(std::vector<Occurrence<Wider<N>>>&, bool&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

#include "motion/set_by_event.h"

#include <algorithm>

#include "print/print.h"
#include "setup/outputs/output_tape.h"

namespace anholon {

SetByEvent::SetByEvent(Workspace& s, const Event& event) : event_(event.name) {
  const Graph& g = *s.model->graph;
  Column values;
  for (const Assignment& a : event.set) values.push_back(a.value);
  tape_ = compile(OutputTape<double>::put(s, values));
  for (const Input& in : tape_.inputs) inputs_.push_back({in.slot, place(s.system, g, in.symbol)});
  for (const Assignment& a : event.set)
    targets_.push_back({print(a.symbol, s.model->names, Format::text), place(s.system, g, a.symbol.id)});
}

SetByEvent::Place SetByEvent::place(const System& system, const Graph& graph, NodeId symbol) {
  const Node& n = graph.node(symbol);
  if (n.kind == Kind::time) return {Place::Kind::time};
  if (n.kind == Kind::parameter) return {Place::Kind::parameter, n.index};
  if (const auto j = system.variable(symbol)) return {Place::Kind::unknown, *j, static_cast<int>(n.order)};
  return {};
}

// Returns nullptr if the place does not belong to the state.
template <Number W>
W* SetByEvent::entry(const Place& p, const Expansion<W>& point, std::vector<W>& state, std::vector<W>& parameters) {
  if (p.kind == Place::Kind::parameter) return &parameters[p.index];
  if (p.kind != Place::Kind::unknown || p.order >= point.program().d[p.index]) return nullptr;
  return &state[point.offset(p.index) + static_cast<std::size_t>(p.order)];
}

template <Number W>
Outcome SetByEvent::with_all_orders(const Expansion<W>& point, std::optional<Expansion<W>>& more) const {
  int beyond = 0;
  for (const auto& [slot, from] : inputs_)
    if (from.kind == Place::Kind::unknown) beyond = std::max(beyond, from.order - point.program().d[from.index]);
  if (beyond == 0) return {};
  std::vector<W> state, leading;
  point.state(state);
  point.leading(leading);
  more.emplace(point.program(), point.parameters(), beyond);
  more->load(point.time(), state, leading);
  Outcome o = more->prepare();
  if (o.ok()) o = more->solve();
  if (o.ok()) o = more->extend();
  if (!o.ok()) o.message = "the event '" + event_ + "' sets numbers by derivatives of the motion: " + o.message;
  return o;
}

template <Number W>
Outcome SetByEvent::put(const Expansion<W>& point, std::vector<W>& state, std::vector<W>& parameters,
                        std::vector<ChangeByEvent<W>>& changes) const {
  std::optional<Expansion<W>> more;
  if (Outcome o = with_all_orders(point, more); !o.ok()) return o;
  const Expansion<W>& solution = more ? *more : point;
  Machine<W> machine(tape_, 0, parameters);
  for (const auto& [slot, from] : inputs_) {
    const W* own = from.kind == Place::Kind::unknown ? entry(from, point, state, parameters) : nullptr;
    machine.series(slot)[0] = own                                 ? *own
                              : from.kind == Place::Kind::time    ? point.time()
                              : from.kind == Place::Kind::unknown ? solution.derivative(from.index, from.order)
                                                                  : W(0);
  }
  machine.evaluate();
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const auto& [name, to] = targets_[i];
    const W* entry_of = entry(to, point, state, parameters);
    if (!entry_of)
      return {OutcomeKind::inconsistent,
              "the event '" + event_ + "' sets " + name +
                  ", which is no part of the state: it follows from the constraints",
              "set what it follows from"};
    if (!is_finite(machine.value(i)))
      return {OutcomeKind::not_a_number, "the event '" + event_ + "' gives " + name + " no value",
              "look for roots of negative numbers and divisions by zero in 'set'"};
    changes.push_back({name, *entry_of, machine.value(i)});
  }
  for (std::size_t i = 0; i < targets_.size(); ++i)
    *entry(targets_[i].place, point, state, parameters) = machine.value(i);
  return {};
}

#define INSTANTIATE(W)                                                                                                 \
  template Outcome SetByEvent::put(const Expansion<W>&, std::vector<W>&, std::vector<W>&,                              \
                                   std::vector<ChangeByEvent<W>>&) const;
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

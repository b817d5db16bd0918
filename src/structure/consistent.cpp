#include "structure/consistent.h"

#include <algorithm>

#include "structure/state_solver.h"
#include "tape/bind.h"

namespace anholon {

template <Number N>
Outcome StateSolver<N>::positions_and_velocities() {
  const std::size_t n = m_.q.size();
  state_.clear();
  state_.q.assign(n, N(0));
  state_.qd.assign(n, N(0));
  state_.q_origin.assign(n, Origin::chosen);
  state_.qd_origin.assign(n, Origin::chosen);
  states();
  start_values([](const Node& s) { return !is_higher(s); });
  std::optional<StartPlan> own;
  const StartPlan& plan = p_.plan ? *p_.plan : own.emplace(m_, p_.mass);
  plan_ = &plan;
  if (Outcome o = solve(plan.positions); !o.ok()) return o;
  const std::optional<InitialState<N>> before = plan.both ? std::optional(state_) : std::nullopt;
  if (Outcome o = solve(plan.velocities); !o.ok()) {
    if (!before || !move_positions(plan, *before)) return o;
  }
  if (Machine<N>* rates = memory_ ? memory_->rates() : nullptr) {
    put_rates(*rates);
  } else if (plan.state_rates) {
    Machine<N> once(*plan.state_rates, 0, p_.parameters);
    put_rates(once);
  }
  say_least_change();
  say_replaced();
  return {};
}

// Solves for positions and velocities together. Returns false if none fit; the state is then unchanged. A far place
// does not count as solution, because there any equation holds up to round-off of its terms.
template <Number N>
bool StateSolver<N>::move_positions(const StartPlan& plan, const InitialState<N>& before) {
  const InitialState<N> failed = state_;
  state_ = before;
  by_flow_ = true;
  const Outcome o = solve(plan.both);
  by_flow_ = false;
  const N far(1e4);
  bool near = o.ok();
  for (std::size_t a = 0; a < before.q.size(); ++a)
    near = near && abs(N(state_.q[a] - before.q[a])) <= far * (N(1) + abs(before.q[a]));
  if (!near) state_ = failed;
  return near;
}

// Sets the model's states to the values of the file.
template <Number N>
void StateSolver<N>::states() {
  const std::size_t n = model_.states.size();
  state_.states.assign(n, N(0));
  state_.state_rates.assign(n, N(0));
  state_.states_origin.assign(n, Origin::given);
  state_.state_rates_origin.assign(n, Origin::derived);
}

// Sets the rates of the model's states at this state.
template <Number N>
void StateSolver<N>::put_rates(Machine<N>& machine) {
  bind(machine, m_.graph(), [&](const Node& n, NodeId) {
    const N* known = state_.value(n);
    return n.kind == Kind::time ? state_.t : known ? *known : N(0);
  });
  machine.evaluate();
  for (std::size_t i = 0; i < state_.state_rates.size(); ++i) state_.state_rates[i] = machine.value(i);
}

// Sets guesses, then values of the file, then the overrides; the model's states start with the values of the file.
template <Number N>
void StateSolver<N>::start_values(const std::function<bool(const Node&)>& wanted) {
  const InitialData& in = model_.initial;
  std::optional<Tape> tape;
  std::optional<Machine<N>> own;
  if (!memory_) {
    own.emplace(p_.plan ? p_.plan->values : tape.emplace(initial_values(model_)), 0, p_.parameters);
    own->evaluate();
  }
  const Machine<N>& machine = memory_ ? memory_->values() : *own;
  std::size_t at = 0;
  const N t = machine.value(at++);
  state_.t = p_.t ? from_rational<N>(*p_.t) : t;
  for (N& z : state_.states) z = machine.value(at++);
  const auto place = [&](const Node& n, const N& value, Origin origin) {
    if (!wanted(n) || !state_.value(n)) return;
    *state_.value(n) = value;
    *state_.origin(n) = origin;
  };
  for (const GivenValue& v : in.guess) place(node(v.symbol), machine.value(at++), Origin::guessed);
  for (const GivenValue& v : in.given) place(node(v.symbol), machine.value(at++), Origin::given);
  for (const StateOverride& o : p_.overrides) {
    Node n{o.multiplier ? Kind::multiplier : Kind::jet};
    n.order = static_cast<std::uint8_t>(o.order);
    n.index = static_cast<std::uint32_t>(o.coordinate);
    place(n, from_rational<N>(o.value), Origin::given);
  }
}

// Solves for the data as given. Values and conditions of the file that clash with values of options give way to these.
template <Number N>
Outcome StateSolver<N>::solve(const StartPlan::Stages& stages) {
  if (!stages) return {};
  Stage<N>* known = memory_ ? memory_->stage(stages) : nullptr;
  std::optional<Stage<N>> own;
  Stage<N>& stage = known ? *known : own.emplace(m_, stages, p_.parameters);
  if (p_.overrides.empty()) return attempt(stage, true);
  std::vector<bool> kept(stage.size(), true);
  for (;;) {
    notes_.at_first = state_;
    if (Outcome o = attempt(stage, false); o.ok()) return o;
    if (std::optional<Outcome> clash = make_room_for_options(stage, kept)) return *clash;
    stage.keep(kept);
  }
}

template <Number N>
Outcome StateSolver<N>::solve(const StageEquations& equations, const Column& unknowns, unsigned metric) {
  return solve(planned(m_, equations, unknowns, metric, p_.mass));
}

// After an attempt that has failed, releases the values of the file that clash with values of options, or leaves out
// such conditions. Returns the outcome if values of the file clash without an option, or if nothing can give way.
template <Number N>
std::optional<Outcome> StateSolver<N>::make_room_for_options(Stage<N>& stage, std::vector<bool>& kept) {
  std::vector<bool> given, fails;
  for (std::size_t i = 0; i < stage.size(); ++i) fails.push_back(kept[i] && !stage.is_rounded(i));
  std::swap(state_, notes_.at_first);
  const InitialState<N>& failed = notes_.at_first;
  for (std::size_t j = 0; j < stage.unknowns(); ++j) given.push_back(*state_.origin(stage.unknown(j)) == Origin::given);
  std::vector<PartialContradiction<N>> list = contradictions(stage, state_, given, fails);
  stage.keep(kept);
  if (list.empty()) {  // values that agree up to rounding, or a formula without a value: all may take part
    PartialContradiction<N>& all = list.emplace_back();
    all.minimal = false;
    for (std::size_t i = 0; i < stage.size(); ++i)
      if (kept[i]) all.of.equations.push_back(i);
    for (std::size_t j = 0; j < given.size(); ++j)
      if (given[j]) all.of.given.push_back(j);
  }
  const InitialState<N> before = state_;
  for (const auto& [c, minimal] : list) {
    if (!options_in(stage, c).empty() && release(stage, c, kept)) continue;
    state_ = before;
    if (!minimal) return attempt(stage, true);
    state_ = failed;
    clash_is_told_ = true;
    return clash_of(stage, c, before);
  }
  return std::nullopt;
}

// Returns the values of options that take part in a contradiction, and values that follow from these.
template <Number N>
std::vector<Node> StateSolver<N>::options_in(const Stage<N>& stage, const Contradiction<N>& c) const {
  std::vector<Node> list;
  for (std::size_t j : c.given)
    if (const Node& n = stage.unknown(j); overridden(n)) list.push_back(n);
  for (std::size_t i : c.equations)
    for (const NodeId id : stage.plan().known[i])
      if (const Node& n = m_.graph().node(id); follows_from_options(n)) list.push_back(n);
  return list;
}

// True if a value that was found before the present stage is that of an option or follows from one.
template <Number N>
bool StateSolver<N>::follows_from_options(const Node& n) const {
  if (overridden(n)) return true;
  if (plan_) return n.kind == Kind::jet && n.order == 0 && positions_of_options()[n.index];
  return state_.value(n) && *state_.origin(n) != Origin::given;
}

// Tells for each position whether an option gives it, or whether it is coupled with such positions by equations.
template <Number N>
std::vector<bool> StateSolver<N>::positions_of_options() const {
  std::vector<bool> of(m_.q.size());
  for (std::size_t a = 0; a < of.size(); ++a) of[a] = overridden(node(m_.q[a]));
  if (!plan_->positions) return of;
  for (bool more = true; more;) {
    more = false;
    for (const std::vector<bool>& held : plan_->positions->holds) {
      bool coupled = false;
      for (std::size_t a = 0; a < of.size(); ++a) coupled = coupled || (held[a] && of[a]);
      for (std::size_t a = 0; coupled && a < of.size(); ++a)
        if (held[a] && !of[a] && state_.q_origin[a] != Origin::given) of[a] = more = true;
    }
  }
  return of;
}

// Releases the values of the file in a contradiction. If it has none, leaves out its conditions on values of options
// alone, or its only condition, unless positions may move so that this one holds. Returns false if nothing gives way.
template <Number N>
bool StateSolver<N>::release(const Stage<N>& stage, const Contradiction<N>& c, std::vector<bool>& kept) {
  ReplacedByOptions<N>& replaced = state_.replaced;
  bool any = false;
  for (std::size_t j : c.given) {
    const Node& n = stage.unknown(j);
    if (overridden(n)) continue;
    any = true;  // another contradiction may have released it already
    if (Origin& origin = *state_.origin(n); origin == Origin::given) {
      origin = Origin::guessed;
      replaced.values.push_back({n, *state_.value(n)});
    }
  }
  const auto note_options = [&] {
    for (const Node& n : options_in(stage, c))
      if (std::none_of(replaced.options.begin(), replaced.options.end(),
                       [&](const Node& o) { return o.kind == n.kind && o.index == n.index && o.order == n.order; }))
        replaced.options.push_back(n);
  };
  if (any) {
    note_options();
    return true;
  }
  const auto of_options_alone = [&](std::size_t i) {
    for (std::size_t j = 0; j < stage.unknowns(); ++j)
      if (stage.holds(i, j) && !overridden(stage.unknown(j))) return false;
    return true;
  };
  for (std::size_t i : c.equations)
    if (stage.equation(i).condition && kept[i] && of_options_alone(i)) kept[i] = false, any = true;
  const bool positions_may_move = plan_ && plan_->both && !by_flow_ && stage.unknown(0).order == 1;
  if (any || !plan_ || positions_may_move) return any;
  std::vector<std::size_t> conditions;
  for (std::size_t i : c.equations)
    if (stage.equation(i).condition && kept[i]) conditions.push_back(i);
  if (conditions.size() != 1) return false;
  note_options();
  kept[conditions[0]] = false;
  replaced.conditions.push_back(stage.equation(conditions[0]).what);
  return true;
}

// Notes the values of the file that options replace, in place of an earlier note.
template <Number N>
void StateSolver<N>::say_replaced() {
  constexpr std::size_t kNamed = 8;
  ReplacedByOptions<N>& replaced = state_.replaced;
  std::vector<std::string> parts;
  for (const auto& [n, before] : replaced.values) {
    const double is = to_double(*state_.value(n)), was = to_double(before);
    if (std::abs(is - was) <= stage_rounding<double>() * std::max(std::abs(is), std::abs(was))) continue;
    const auto [old, now] = told_apart(was, is);
    parts.push_back(entry_name(n) + " = " + old + (parts.empty() ? " is replaced by " : " by ") + now);
  }
  for (const std::string& condition : replaced.conditions) parts.push_back(condition + " is left out");
  if (parts.empty()) return;
  std::string text, options;
  for (std::size_t k = 0; k < std::min(parts.size(), kNamed); ++k) text += (k ? ", " : "") + parts[k];
  for (const Node& n : replaced.options)
    options += (options.empty() ? "" : ", ") + entry_name(n) + " = " + number_text(to_double(*state_.value(n)), 6);
  replaced.note = "initial data of the file clash with " + options + " and give way: " + text +
                  (parts.size() > kNamed ? ", …" : "");
  if (!replaced.place) {
    replaced.place = state_.notes.size();
    state_.notes.emplace_back();
  }
  state_.notes[*replaced.place] = replaced.note;
}

// Treats the given values as rounded numbers: all values may change a little. The others start from their values found
// before or from their guess, whichever changes the given values less. Returns false if the equations are not satisfied
// then.
template <Number N>
bool StateSolver<N>::correct_rounded(Stage<N>& stage, const InitialState<N>& before,
                                     const std::vector<std::size_t>& free, const std::vector<std::size_t>& all) {
  const auto correction = [&]() -> std::optional<N> {
    if (!find_by_least_change(stage, state_, all) || stage.worst() > stage_rounding<N>()) return std::nullopt;
    N largest(0);
    for (std::size_t j : all)
      if (*state_.origin(stage.unknown(j)) == Origin::given)
        if (N change = abs(N(stage.x(state_, j) - stage.x_of(before, j))); change > largest) largest = change;
    return largest;
  };
  const InitialState<N> found = state_;
  std::optional<N> least = correction();
  const InitialState<N> by_found = state_;
  state_ = found;
  for (std::size_t j : free) stage.x(state_, j) = stage.x_of(before, j);
  if (const std::optional<N> by_guess = correction(); by_guess && (!least || !(*by_guess > *least)))
    least = by_guess;
  else
    state_ = by_found;
  if (!least) {
    stage.evaluate(state_);
    return false;
  }
  for (std::size_t j : all)
    if (Origin& origin = *state_.origin(stage.unknown(j)); origin == Origin::given)
      if (stage.x(state_, j) != stage.x_of(before, j)) origin = Origin::corrected;
  if (*least > state_.largest_correction) state_.largest_correction = *least;
  return true;
}

// `tell`: true if a failure needs a message.
template <Number N>
Outcome StateSolver<N>::attempt(Stage<N>& stage, bool tell) {
  std::vector<std::size_t>&free = notes_.free, &all = notes_.all;
  free.clear(), all.clear();
  notes_.before = state_;
  const InitialState<N>& before = notes_.before;
  for (std::size_t j = 0; j < stage.unknowns(); ++j) {
    all.push_back(j);
    if (*state_.origin(stage.unknown(j)) != Origin::given) free.push_back(j);
  }
  std::size_t worst = 0;
  const auto failed = [&] { return Outcome{OutcomeKind::inconsistent, {}, {}}; };
  if (!tell && stage.linear() && stage.evaluate(state_) && stage.contradicts(free)) return failed();
  if (!find_by_least_change(stage, state_, free, p_.near, by_flow_)) return no_value(stage);
  mark_derived(stage, before, free);
  mark_undetermined(stage, before, free);
  if (!(stage.worst(&worst) > stage_rounding<N>())) return {};
  if (stage.is_rounded()) {
    if (correct_rounded(stage, before, free, all)) return {};
    stage.worst(&worst);
    // Overlapping data agree only to the digits in which they are written.
    if (!(stage.worst(&worst) > N(stage_rounding<double>()))) return {};
  }
  return tell ? clash(stage, worst, before) : failed();
}

// Marks values as derived that occur in an equation, and values that these move through the mass matrix by more than
// round-off.
template <Number N>
void StateSolver<N>::mark_derived(const Stage<N>& stage, const InitialState<N>& before,
                                  const std::vector<std::size_t>& free) {
  const auto change = [&](std::size_t j) { return N(abs(N(stage.x(state_, j) - stage.x_of(before, j)))); };
  N largest(0);
  for (std::size_t j : free)
    if (N c = change(j); c > largest) largest = c;
  for (std::size_t j : free) {
    if (stage.moves(j) || change(j) > largest * unit_roundoff<N>() * N(64))
      *state_.origin(stage.unknown(j)) = Origin::derived;
    else
      stage.x(state_, j) = stage.x_of(before, j);
  }
}

template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state) {
  return StateSolver<N>(problem, state).positions_and_velocities();
}

template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, StartMemory<N>& memory, InitialState<N>& state) {
  return StateSolver<N>(problem, state, &memory).positions_and_velocities();
}

#define INSTANTIATE(N)                                                                                                 \
  template void StateSolver<N>::start_values(const std::function<bool(const Node&)>&);                                 \
  template void StateSolver<N>::put_rates(Machine<N>&);                                                                \
  template Outcome StateSolver<N>::solve(const StageEquations&, const Column&, unsigned);                              \
  template void StateSolver<N>::say_replaced();
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE
template Outcome consistent_state<double>(const InitialProblem<double>&, StartMemory<double>&, InitialState<double>&);
template Outcome consistent_state<long double>(const InitialProblem<long double>&, StartMemory<long double>&,
                                               InitialState<long double>&);
template Outcome consistent_state<double>(const InitialProblem<double>&, InitialState<double>&);
template Outcome consistent_state<long double>(const InitialProblem<long double>&, InitialState<long double>&);
template Outcome consistent_state<Quad>(const InitialProblem<Quad>&, InitialState<Quad>&);
template Outcome consistent_state<Multi>(const InitialProblem<Multi>&, InitialState<Multi>&);

}  // namespace anholon

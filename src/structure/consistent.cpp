#include "structure/consistent.h"

#include <algorithm>

#include "structure/state_solver.h"

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
  const StartPlan& plan = p_.plan ? *p_.plan : own.emplace(m_, std::vector<StateOverride>{}, p_.mass);
  if (Outcome o = solve(plan.positions, [&] { return plan.kept ? plan.kept_positions : kept_of(plan.positions); });
      !o.ok())
    return o;
  const std::optional<InitialState<N>> before = plan.both ? std::optional(state_) : std::nullopt;
  if (Outcome o = solve(plan.velocities, [&] { return plan.kept ? plan.kept_velocities : kept_of(plan.velocities); });
      !o.ok()) {
    if (!before || !move_positions(plan, *before)) return o;
  }
  say_least_change();
  return {};
}

// Solves for positions and velocities together. Returns false if none fit; the state is then unchanged. A far place
// does not count as solution, because there any equation holds up to round-off of its terms.
template <Number N>
bool StateSolver<N>::move_positions(const StartPlan& plan, const InitialState<N>& before) {
  const InitialState<N> failed = state_;
  state_ = before;
  by_flow_ = true;
  const Outcome o = solve(plan.both, [&] { return plan.kept ? plan.kept_both : kept_of(plan.both); });
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

// Solves for the data as given. If overrides contradict values or conditions of the file, the overrides hold, and the
// file's values are only the start of the least change.
template <Number N>
Outcome StateSolver<N>::solve(const StartPlan::Stages& stages, const std::function<StartPlan::Stages()>& without) {
  if (!stages) return {};
  if (p_.overrides.empty()) return attempt(stages, true);
  notes_.at_first = state_;
  if (Outcome o = attempt(stages, false); o.ok()) return o;
  std::swap(state_, notes_.at_first);
  InitialState<N>& failed = notes_.at_first;
  for (Expr u : stages->unknowns)
    if (Origin& origin = *state_.origin(node(u)); origin == Origin::given && !overridden(node(u)))
      origin = Origin::guessed;
  const Outcome against_laws = attempt(without(), true);
  if (against_laws.ok()) return {};
  state_ = failed;
  return against_laws;
}

template <Number N>
Outcome StateSolver<N>::solve(const StageEquations& equations, const Column& unknowns, unsigned metric) {
  const StartPlan::Stages stages = planned(m_, equations, unknowns, metric, p_.mass);
  return solve(stages, [&] { return kept_of(stages); });
}

template <Number N>
StartPlan::Stages StateSolver<N>::kept_of(const StartPlan::Stages& s) const {
  return planned(m_, left_of(s->equations, s->unknowns, p_.overrides, m_.graph()), s->unknowns, s->metric, p_.mass);
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
Outcome StateSolver<N>::attempt(const StartPlan::Stages& stages, bool tell) {
  if (!stages) return {};
  const Column& unknowns = stages->unknowns;
  Stage<N>* known = memory_ ? memory_->stage(stages) : nullptr;
  std::optional<Stage<N>> own;
  Stage<N>& stage = known ? *known : own.emplace(m_, stages, p_.parameters);
  std::vector<std::size_t>&free = notes_.free, &all = notes_.all;
  free.clear(), all.clear();
  notes_.before = state_;
  const InitialState<N>& before = notes_.before;
  for (std::size_t j = 0; j < unknowns.size(); ++j) {
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
  template Outcome StateSolver<N>::solve(const StageEquations&, const Column&, unsigned);
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

// Entries that no equation determines, or that only an unneeded reaction would determine: the choice of their values,
// and its note.
#include "structure/state_solver.h"

namespace anholon {

// If linear constraints of order 3 and more leave accelerations free, the motion starts without their reaction: the
// guess is the acceleration without them. (A nonlinear one must have a reaction; there 0 is as good as any value.)
template <Number N>
void StateSolver<N>::start_with_free_accelerations(const System& s) {
  StageEquations laws;
  Column unknowns = m_.qdd;
  bool higher = false;
  for (std::size_t i = 0; i < s.coordinates; ++i) {
    if (jet_order(s.equations[i]) > 2) return;
    laws.push_back({s.equations[i], "the equation of motion of '" + s.equation_names[i] + "'", {}});
  }
  for (std::size_t k = 0; k < s.constraints.size(); ++k) {
    const std::size_t r = s.constraints[k];
    higher = higher || m_.order[r] > 2;
    if (may_branch(m_, s, r)) return;
    if (m_.order[r] > 2) continue;
    laws.push_back({total_derivative(s.equations[s.coordinates + k], static_cast<unsigned>(2 - m_.order[r])),
                    "constraint '" + model_.constraints[r].name + "'",
                    {}});
    unknowns.push_back(m_.lambda[r]);
  }
  if (!higher) return;
  const InitialState<N> before = state_;
  Stage<N> stage(m_, laws, unknowns, 1U << 2, p_.parameters, p_.mass);
  std::vector<std::size_t> every;
  for (std::size_t j = 0; j < unknowns.size(); ++j) every.push_back(j);
  if (!find_by_least_change(stage, state_, every)) state_ = before;
  keep_said(before, unknowns);
}

// Keeps given and guessed values.
template <Number N>
void StateSolver<N>::keep_said(const InitialState<N>& before, const Column& unknowns) {
  for (Expr u : unknowns)
    if (const Node& n = node(u); *before.origin(n) == Origin::given || *before.origin(n) == Origin::guessed)
      *state_.value(n) = *before.value(n);
}

// Does the same for rates of multipliers and the other entries of their stage: the guess for those entries is their
// value without these multipliers.
template <Number N>
void StateSolver<N>::start_unconstrained(const StageEquations& laws, const Column& unknowns, unsigned metric) {
  if (std::none_of(unknowns.begin(), unknowns.end(), [&](Expr u) { return free_multiplier(node(u)); })) return;
  const InitialState<N> before = state_;
  Stage<N> stage(m_, laws, unknowns, metric, p_.parameters, p_.mass);
  std::vector<std::size_t> free;
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    if (!free_multiplier(stage.unknown(j))) free.push_back(j);
  if (!find_by_least_change(stage, state_, free)) {
    state_ = before;
    return;
  }
  keep_said(before, unknowns);
}

// Marks values that no equation determines as chosen.
template <Number N>
void StateSolver<N>::mark_choices(const StageEquations& equations, const Column& unknowns, unsigned metric) {
  std::vector<std::size_t> free;
  for (std::size_t j = 0; j < unknowns.size(); ++j)
    if (const Origin o = *state_.origin(node(unknowns[j])); o == Origin::derived || o == Origin::chosen)
      free.push_back(j);
  std::size_t rank = 0;
  if (!equations.empty() && !free.empty()) {
    Stage<N> stage(m_, equations, unknowns, metric, p_.parameters, p_.mass);
    if (!stage.evaluate(state_)) return;
    Matrix<N> a(stage.size(), free.size());
    for (std::size_t i = 0; i < stage.size(); ++i)
      for (std::size_t j = 0; j < free.size(); ++j) a(i, j) = stage.jacobian(i, free[j]);
    rank = choose_rows(a, N(kDependent)).independent.size();
  }
  if (rank >= free.size()) return;
  std::vector<std::size_t> choices;
  for (std::size_t j : free)
    if (free_multiplier(node(unknowns[j]))) choices.push_back(j);
  if (choices.empty())
    for (std::size_t j : free)
      if (*state_.origin(node(unknowns[j])) == Origin::chosen) choices.push_back(j);
  for (std::size_t j : choices) *state_.origin(node(unknowns[j])) = Origin::chosen;
}

template <Number N>
void StateSolver<N>::say_choices(const System& s, const Structure& t) {
  for (const bool multipliers : {true, false}) {
    std::string list;
    for (std::size_t j = 0; j < s.size(); ++j)
      for (int k = 0; k < t.d[j]; ++k) {
        const Node& n = node(s.symbol(j, static_cast<unsigned>(k)));
        if (!is_higher(n) || (n.kind == Kind::multiplier) != multipliers || *state_.origin(n) != Origin::chosen)
          continue;
        list += (list.empty() ? "" : ", ") + entry_name(n) + " = " + number_text(to_double(*state_.value(n)), 6);
      }
    if (list.empty()) continue;
    state_.notes.push_back("a choice: " + list + " at the start" +
                           (multipliers ? ", which no equation determines: the motion starts as it would without the "
                                          "constraint; other values in [initial] lambda = {…}, or accelerations"
                                        : ", which no equation determines: other values in [initial] qddot = {…}"));
  }
}

// Marks the positions and velocities as chosen that the equations move but do not determine: they have the values that
// change least.
template <Number N>
void StateSolver<N>::mark_undetermined(Stage<N>& stage, const InitialState<N>& before,
                                       const std::vector<std::size_t>& free) {
  const std::vector<bool>& determined = stage.determined(free);
  for (std::size_t j = 0; j < free.size(); ++j) {
    const Node n = stage.unknown(free[j]);
    std::erase_if(changed_least_, [&](const Node& o) { return o.index == n.index && o.order == n.order; });
    if (n.kind != Kind::jet || is_higher(n) || determined[j] || *state_.origin(n) != Origin::derived) continue;
    *state_.origin(n) = Origin::chosen;
    if (*before.origin(n) == Origin::chosen &&
        abs(N(*state_.value(n) - *before.value(n))) > stage_rounding<N>() * abs(*state_.value(n)))
      changed_least_.push_back(n);
  }
}

// Notes which positions and velocities were chosen by least change, in place of the earlier note: values in the earlier
// note that are still chosen are named again, with their present values.
template <Number N>
void StateSolver<N>::say_least_change() {
  LeastChangeNote& said = state_.least_change;
  for (const Node& n : said.entries) {
    const bool known = std::any_of(changed_least_.begin(), changed_least_.end(),
                                   [&](const Node& o) { return o.index == n.index && o.order == n.order; });
    if (!known && *state_.origin(n) == Origin::chosen) changed_least_.push_back(n);
  }
  if (said.place) {
    state_.notes.erase(state_.notes.begin() + static_cast<std::ptrdiff_t>(*said.place));
    if (std::optional<std::size_t>& other = state_.replaced.place; other && *other > *said.place) --*other;
  }
  said = {changed_least_, std::nullopt};
  if (changed_least_.empty()) return;
  constexpr std::size_t kNamed = 8;  // the table of `check` shows all
  std::string list;
  for (std::size_t k = 0; k < changed_least_.size() && k < kNamed; ++k) {
    const Node& n = changed_least_[k];
    list += (list.empty() ? "" : ", ") + entry_name(n) + " = " + number_text(to_double(*state_.value(n)), 6);
  }
  if (changed_least_.size() > kNamed) list += ", …";
  said.place = state_.notes.size();
  state_.notes.push_back("a choice: " + list +
                         " at the start, the least change that satisfies the constraints: other values in [initial]");
}

#define INSTANTIATE(N)                                                                                                 \
  template void StateSolver<N>::start_with_free_accelerations(const System&);                                          \
  template void StateSolver<N>::start_unconstrained(const StageEquations&, const Column&, unsigned);                   \
  template void StateSolver<N>::mark_choices(const StageEquations&, const Column&, unsigned);                          \
  template void StateSolver<N>::say_choices(const System&, const Structure&);                                          \
  template void StateSolver<N>::mark_undetermined(Stage<N>&, const InitialState<N>&, const std::vector<std::size_t>&); \
  template void StateSolver<N>::say_least_change();
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

// Consistent values beyond positions and velocities.
#include "structure/state_solver.h"

namespace anholon {

template <Number N>
Outcome StateSolver<N>::complete(const System& s, const Structure& t) {
  int beyond = 0;
  std::vector<StageEquation> late;  // these hold leading derivatives, or derivatives of these up to the order `beyond`
  for (const StageEquation& e : conditions())
    if (const int order = order_beyond(e.residual, s, t); order >= 0)
      late.push_back(e), beyond = std::max(beyond, order);
  state_.higher.clear(), state_.multipliers.clear();
  make_room(s, t, beyond);
  start_values(is_higher);
  start_with_free_accelerations(s);
  const int deepest = *std::max_element(t.d.begin(), t.d.end());
  for (int level = deepest; level >= 1; --level)
    if (Outcome o = stage(s, t, level); !o.ok()) return o;
  if (Outcome o = given_beyond_the_state(s, t, late); !o.ok()) return o;
  if (Outcome o = leading(s, t); !o.ok()) return o;
  put_rates_of_state(s, t);
  for (int k = 1; k <= beyond; ++k)
    if (Outcome o = derivatives_of_leading(s, t, k); !o.ok()) return o;
  if (!late.empty())
    if (Outcome o = together(s, t, late, beyond); !o.ok()) return o;
  make_room(s, t, 0);
  for (const Expr x : leading_unknowns(s, t)) *state_.origin(node(x)) = Origin::derived;
  say_choices(s, t);
  say_replaced();
  return {};
}

// Makes room for the state and its derivatives up to this order of the leading ones, and keeps the present values.
template <Number N>
void StateSolver<N>::make_room(const System& s, const Structure& t, int beyond) {
  int coordinates = 2, multipliers = 0;
  for (std::size_t j = 0; j < s.mechanical(); ++j)
    (j < s.coordinates ? coordinates : multipliers) = std::max(j < s.coordinates ? coordinates : multipliers, t.d[j]);
  const auto level = [](std::size_t n) {
    return Level<N>{std::vector<N>(n, N(0)), std::vector<Origin>(n, Origin::chosen)};
  };
  state_.higher.resize(static_cast<std::size_t>(coordinates + beyond) - 1, level(m_.q.size()));
  state_.multipliers.resize(static_cast<std::size_t>(multipliers + beyond) + 1, level(m_.phi.size()));
}

static int order_beyond(Expr e, const System& s, const std::vector<int>& d) {
  int most = -1;
  for (NodeId id : symbols({&e, 1}))
    if (const auto j = s.variable(id); j && *j < s.mechanical())
      most = std::max(most, static_cast<int>(e.graph->node(id).order) - d[*j]);
  return most;
}

// Returns the order of the highest derivative of a leading derivative that e holds; -1 if e holds entries of the state
// only.
template <Number N>
int StateSolver<N>::order_beyond(Expr e, const System& s, const Structure& t) const {
  return anholon::order_beyond(e, s, t.d);
}

// Returns the number of orders between the highest entry of e and the leading derivatives; 0: e contains leading ones.
template <Number N>
int StateSolver<N>::level_of(Expr e, const System& s, const Structure& t) const {
  int level = 1000;
  for (NodeId id : symbols({&e, 1})) {
    const Node& n = m_.graph().node(id);
    if (!is_higher(n)) continue;
    if (const auto j = s.variable(id)) level = std::min(level, t.d[*j] - static_cast<int>(n.order));
  }
  return level == 1000 ? 0 : level;
}

// Computes the entries x_j^(d_j - level) from the equations E_i^(c_i - level), by least change.
template <Number N>
Outcome StateSolver<N>::stage(const System& s, const Structure& t, int level) {
  Column unknowns;
  unsigned metric = 0;
  for (std::size_t j = 0; j < s.size(); ++j) {
    const int k = t.d[j] - level;
    if (k < 0) continue;
    const Expr x = s.symbol(j, static_cast<unsigned>(k));
    if (!is_higher(node(x))) continue;
    unknowns.push_back(x);
    if (node(x).kind == Kind::jet) metric |= 1U << k;
  }
  if (unknowns.empty()) return {};
  StageEquations laws;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const int k = t.c[i] - level;
    if (k < 0) continue;
    const Expr e = put_state_rates(model_, total_derivative(s.equations[i], static_cast<unsigned>(k)), 1);
    if (!holds_higher(e)) continue;  // concerns positions and velocities only
    if (i < s.coordinates)
      laws.push_back({e, "the equation of motion of '" + s.equation_names[i] + "'", {}});
    else if (i < s.mechanical())
      laws.push_back({e, (k ? "a derivative of constraint '" : "constraint '") + s.equation_names[i] + "'",
                      model_.constraints[s.constraints[i - s.coordinates]].span});
  }
  StageEquations equations = laws;
  for (const StageEquation& e : conditions())
    if (order_beyond(e.residual, s, t) < 0 && holds_higher(e.residual) && level_of(e.residual, s, t) == level)
      equations.push_back(e);
  if (!laws.empty()) start_unconstrained(laws, unknowns, metric);
  const InitialState<N> before = state_;
  if (Outcome o = solve(equations, unknowns, metric); !o.ok()) {
    state_ = before;
    if (!add_velocities(s, t, level, equations, unknowns, metric) || !solve(equations, unknowns, metric).ok()) return o;
  }
  mark_choices(equations, unknowns, metric);
  return {};
}

// Adds velocities: a servo constraint whose input does not act against it restricts velocities through the equations of
// motion. These velocities are changed together with the other entries of this level, subject to all equations on
// velocities. Returns false if there are none.
template <Number N>
bool StateSolver<N>::add_velocities(const System& s, const Structure& t, int level, StageEquations& equations,
                                    Column& unknowns, unsigned& metric) const {
  const std::size_t higher = unknowns.size();
  for (std::size_t j = 0; j < s.coordinates; ++j)
    if (t.d[j] - level == 1) unknowns.push_back(s.symbol(j, 1)), metric |= 2U;
  if (unknowns.size() == higher) return false;
  for (std::size_t i = s.coordinates; i < s.mechanical(); ++i) {
    const int k = t.c[i] - level;
    if (k < 0) continue;
    const Expr e = put_state_rates(model_, total_derivative(s.equations[i], static_cast<unsigned>(k)), 1);
    if (!holds_higher(e))
      equations.push_back({e, "a derivative of constraint '" + s.equation_names[i] + "'",
                           model_.constraints[s.constraints[i - s.coordinates]].span});
  }
  for (const StageEquation& e : conditions())
    if (!holds_higher(e.residual) && jet_order(e.residual) == 1) equations.push_back(e);
  return true;
}

// Turns values given for derivatives that the state does not hold into conditions on the state.
template <Number N>
Outcome StateSolver<N>::given_beyond_the_state(const System& s, const Structure& t, StageEquations& late) {
  Outcome refused;
  const auto beyond = [&](Expr x) {
    const auto j = s.variable(x.id);
    return is_higher(node(x)) && j && static_cast<int>(node(x).order) >= t.d[*j];
  };
  const auto add = [&](Expr x, Expr value, Span span) {
    const auto j = s.variable(x.id);
    if (static_cast<int>(node(x).order) > t.d[*j])
      refused = {OutcomeKind::inconsistent,
                 equation_text({x, "the value given for " + entry_name(node(x)), span}) + " follows from the state",
                 "leave it out" + std::string(span.file > 0 ? ", or begin with a copy of that file" : "")};
    late.push_back({x - value, "the value given for " + entry_name(node(x)), span, !overridden(node(x))});
  };
  for (const GivenValue& v : model_.initial.given)
    if (beyond(v.symbol) && !overridden(node(v.symbol))) add(v.symbol, v.value, v.span);
  for (const StateOverride& o : p_.overrides)
    if (beyond(symbol(o))) add(symbol(o), m_.graph().number(o.value), {});
  return refused;
}

template <Number N>
bool StateSolver<N>::branch_holds(const std::vector<N>& x, const System& s) const {
  for (const BranchChoice& b : model_.initial.branches) {
    const auto j = s.variable(m_.lambda[b.constraint].id);
    if (j && !(b.positive ? x[*j] > N(0) : x[*j] < N(0))) return false;
  }
  return true;
}

template <Number N>
bool StateSolver<N>::branch_was_named(const System& s, const Structure& t) const {
  const auto leading_guess = [&](const GivenValue& v) {
    const auto j = s.variable(v.symbol.id);
    return j && static_cast<int>(node(v.symbol).order) == t.d[*j];
  };
  return !model_.initial.branches.empty() ||
         std::any_of(model_.initial.guess.begin(), model_.initial.guess.end(), leading_guess);
}

// Computes the leading derivatives by one linear system, or as the solution nearest to the guess.
template <Number N>
Outcome StateSolver<N>::leading(const System& s, const Structure& t) {
  const Column unknowns = leading_unknowns(s, t);
  if (!may_branch(m_, s, t)) {
    Stage<N> all(m_, leading_equations(s, t), unknowns, 0, p_.parameters, p_.mass);
    std::vector<std::size_t> every;
    for (std::size_t j = 0; j < unknowns.size(); ++j) every.push_back(j);
    if (!find_by_least_change(all, state_, every)) return no_value(all);
    return {};
  }
  const LeadingSolutions<N> solutions = leading_solutions<N>(
      m_, s, t, p_.parameters, state_, [&](const std::vector<N>& x) { return branch_holds(x, s); });
  const std::vector<N>* taken = nullptr;
  std::string others;
  for (const std::vector<N>& x : solutions.found) {
    if (!taken && branch_holds(x, s))
      taken = &x;
    else
      others += (others.empty() ? "" : "; ") + solution_text(x, s, t);
  }
  if (!taken) return no_leading(s, solutions, others);
  for (std::size_t j = 0; j < unknowns.size(); ++j) *state_.value(node(unknowns[j])) = (*taken)[j];
  // A branch is that of a constraint.
  const bool branches =
      std::any_of(s.constraints.begin(), s.constraints.end(), [&](std::size_t r) { return may_branch(m_, s, r); });
  if (!others.empty() && !branch_was_named(s, t))
    state_.notes.push_back("the equations have several solutions at the start: " + solution_text(*taken, s, t) +
                           " is taken, there is also " + others + "; name one by [initial] " +
                           (branches ? "branch = {…} or guess = {…}" : "guess = {…}"));
  return {};
}

// Sets the rates that belong to the state of the motion and hold accelerations or multipliers.
template <Number N>
void StateSolver<N>::put_rates_of_state(const System& s, const Structure& t) {
  Column rates;
  bool any = false;
  for (std::size_t i = 0; i < model_.states.size(); ++i) {
    rates.push_back(put_state_rates(model_, put_masses(model_, model_.states[i].rate), 1));
    any = any || (leads_beyond_rate(s, t, s.mechanical() + i) && holds_higher(rates.back()));
  }
  if (!any) return;
  const Tape tape = compile(rates);
  Machine<N> machine(tape, 0, p_.parameters);
  put_rates(machine);
}

// Computes the derivatives of this order of the leading ones.
template <Number N>
Outcome StateSolver<N>::derivatives_of_leading(const System& s, const Structure& t, int order) {
  StageEquations equations;
  Column unknowns;
  std::vector<std::size_t> every;
  for (std::size_t i = 0; i < s.mechanical(); ++i) {
    equations.push_back(law(s, i, static_cast<unsigned>(t.c[i] + order)));
    unknowns.push_back(s.symbol(i, static_cast<unsigned>(t.d[i] + order)));
    every.push_back(i);
  }
  Stage<N> all(m_, equations, unknowns, 0, p_.parameters, p_.mass);
  return find_by_least_change(all, state_, every) ? Outcome{} : no_value(all);
}

// Solves conditions on leading derivatives and their derivatives up to the order `beyond` together with all laws:
// velocities are changed first, positions only if necessary.
template <Number N>
Outcome StateSolver<N>::together(const System& s, const Structure& t, const StageEquations& late, int beyond) {
  // A state of the model has no derivative beyond its rate.
  const auto more = [&](std::size_t i) { return i < s.mechanical() ? beyond : 0; };
  StageEquations equations;
  for (std::size_t i = 0; i < s.size(); ++i)
    for (int k = 0; k <= (leads_beyond_rate(s, t, i) ? 0 : t.c[i]) + more(i); ++k)
      equations.push_back(law(s, i, static_cast<unsigned>(k)));
  for (const StageEquation& e : conditions())
    if (order_beyond(e.residual, s, t) < 0) equations.push_back(e);
  equations.insert(equations.end(), late.begin(), late.end());
  const Column leading = leading_unknowns(s, t);
  {  // The conditions may hold already: a value that follows from the others may be given as well.
    Stage<N> said(m_, late, leading, 0, p_.parameters, p_.mass);
    if (!said.evaluate(state_)) return no_value(said);
    if (said.is_rounded() && all_given(s, t)) return {};
    if (!(said.worst() > stage_rounding<N>())) return {};
  }
  const InitialState<N> before = state_;
  Outcome refused;
  for (int lowest : {1, 0}) {
    state_ = before;
    Column unknowns;
    unsigned metric = 0;
    for (std::size_t j = 0; j < s.size(); ++j)
      for (int k = j < s.coordinates ? std::min(lowest, t.d[j]) : 0;
           k <= (leads_beyond_rate(s, t, j) ? 1 : t.d[j]) + more(j); ++k) {
        unknowns.push_back(s.symbol(j, static_cast<unsigned>(k)));
        if (j < s.coordinates && k < t.d[j]) metric |= 1U << k;
      }
    // If every value of the state is held, the leading derivatives are known already.
    const bool may_move = std::any_of(unknowns.begin(), unknowns.end(), [&](Expr u) {
      const auto j = s.variable(u.id);
      return static_cast<int>(node(u).order) < t.d[*j] && *state_.origin(node(u)) != Origin::given;
    });
    if (!may_move && p_.overrides.empty()) continue;
    for (Expr u : unknowns)  // derived values may be computed anew
      if (const auto j = s.variable(u.id); static_cast<int>(node(u).order) >= t.d[*j])
        *state_.origin(node(u)) = Origin::derived;
    clash_is_told_ = false;
    by_flow_ = lowest == 0;
    refused = solve(equations, unknowns, metric);
    by_flow_ = false;
    if (refused.ok()) {
      say_least_change();
      return {};
    }
  }
  state_ = before;
  if (clash_is_told_) return refused;
  Stage<N> said(m_, late, leading, 0, p_.parameters, p_.mass);
  std::size_t worst = 0;
  if (!said.evaluate(state_)) return no_value(said);
  said.worst(&worst);
  const StageEquation& e = said.equation(worst);
  return {OutcomeKind::inconsistent,
          equation_text(e) + " does not hold: with the other initial data it is missed by " +
              number_text(std::abs(to_double(said.residual[worst])), 3),
          "leave it out, or leave out velocities and positions that it could determine; a guess near the wanted motion "
          "helps: [initial] guess = {…}"};
}

template <Number N>
bool StateSolver<N>::all_given(const System& s, const Structure& t) const {
  for (std::size_t j = 0; j < s.size(); ++j)
    for (int k = 0; k < t.d[j]; ++k)
      if (const Origin o = *state_.origin(node(s.symbol(j, static_cast<unsigned>(k))));
          o == Origin::chosen || o == Origin::guessed)
        return false;
  return true;
}

bool conditions_on_leading(const Model& model, const System& s, const std::vector<int>& d) {
  const std::vector<Condition>& list = model.initial.conditions;
  return std::any_of(list.begin(), list.end(), [&](const Condition& c) { return order_beyond(c.residual, s, d) >= 0; });
}

bool needs_completion(const Mechanics& m, const System& s, const Structure& t) {
  for (std::size_t j = 0; j < s.mechanical(); ++j)
    if (t.d[j] > (j < s.coordinates ? 2 : 0)) return true;
  const auto high = [](const Condition& c) { return holds_higher(c.residual); };
  return may_branch(m, s, t) || conditions_on_leading(*m.model, s, t.d) ||
         std::any_of(m.model->initial.conditions.begin(), m.model->initial.conditions.end(), high);
}

template <Number N>
Outcome complete_state(const InitialProblem<N>& problem, const System& s, const Structure& t, InitialState<N>& state) {
  return StateSolver<N>(problem, state).complete(s, t);
}

template Outcome complete_state<double>(const InitialProblem<double>&, const System&, const Structure&,
                                        InitialState<double>&);
template Outcome complete_state<long double>(const InitialProblem<long double>&, const System&, const Structure&,
                                             InitialState<long double>&);
template Outcome complete_state<Quad>(const InitialProblem<Quad>&, const System&, const Structure&,
                                      InitialState<Quad>&);
template Outcome complete_state<Multi>(const InitialProblem<Multi>&, const System&, const Structure&,
                                       InitialState<Multi>&);

}  // namespace anholon

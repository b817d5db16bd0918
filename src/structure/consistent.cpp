#include "structure/consistent.h"

#include <algorithm>
#include <functional>

#include "base/assert.h"
#include "expr/normal.h"
#include "structure/branch.h"

namespace anholon {

const char* name(Origin origin) {
  switch (origin) {
    case Origin::given: return "given";
    case Origin::derived: return "derived";
    case Origin::chosen: return "chosen";
    case Origin::guessed: return "guess";
    case Origin::corrected: return "corrected";
  }
  return "";
}

namespace {

// Given values may miss a constraint by this much of its scale: they are rounded numbers.
constexpr double kRounded = 1e-8;

using Equations = std::vector<StageEquation>;

// q_a^(k) with k >= 2, or a multiplier: what positions and velocities do not hold.
bool is_higher(const Node& n) { return n.kind == Kind::multiplier || (n.kind == Kind::jet && n.order > 1); }

bool holds_higher(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (is_higher(e.graph->node(id))) return true;
  return false;
}

bool same_entry(const StateOverride& v, const Node& n) {
  return v.multiplier == (n.kind == Kind::multiplier) && v.order == n.order && v.coordinate == n.index;
}

bool overridden(const std::vector<StateOverride>& overrides, const Node& n) {
  return std::any_of(overrides.begin(), overrides.end(), [&](const StateOverride& v) { return same_entry(v, n); });
}

// The numbers of the file: t, the states, then guesses and given values.
Tape values_of(const Model& model) {
  Column es = {model.initial.t};
  for (const StateVariable& z : model.states) es.push_back(z.initial);
  for (const std::vector<GivenValue>* list : {&model.initial.guess, &model.initial.given})
    for (const GivenValue& v : *list) es.push_back(v.value);
  return compile(es);
}

Equations conditions_of(const Model& model) {
  Equations list;
  for (const Condition& c : model.initial.conditions)
    list.push_back({put_masses(model, c.residual), "condition \"" + c.text + "\"", c.span, true});
  return list;
}

// Of equations, those that overrides leave: all laws, and the conditions that say something about what is still open.
Equations kept(const Equations& equations, const Column& unknowns, const std::vector<StateOverride>& overrides, Graph& g) {
  Equations list;
  for (const StageEquation& e : equations) {
    bool open = !e.condition;
    for (NodeId id : symbols({&e.residual, 1})) {
      const Expr symbol{&g, id};
      open = open || (std::find(unknowns.begin(), unknowns.end(), symbol) != unknowns.end() && !overridden(overrides, g.node(id)));
    }
    if (open) list.push_back(e);
  }
  return list;
}

StartPlan::Stages planned(const Mechanics& m, const Equations& equations, const Column& unknowns, unsigned metric,
                          const std::vector<Column>* mass) {
  return equations.empty() ? nullptr : std::make_shared<const StagePlan>(m, equations, unknowns, metric, mass);
}

template <Number N>
class Solver {
 public:
  Solver(const InitialProblem<N>& p, InitialState<N>& state) : p_(p), m_(*p.mechanics), model_(*m_.model), state_(state) {}

  Outcome positions_and_velocities() {
    const std::size_t n = m_.q.size();
    state_ = {};
    state_.q.assign(n, N(0));
    state_.qd.assign(n, N(0));
    state_.q_origin.assign(n, Origin::chosen);
    state_.qd_origin.assign(n, Origin::chosen);
    states();
    start_values([](const Node& s) { return !is_higher(s); });
    if (p_.plan) {
      if (Outcome o = solve(p_.plan->positions, [&] { return p_.plan->kept_positions; }); !o.ok()) return o;
      return solve(p_.plan->velocities, [&] { return p_.plan->kept_velocities; });
    }
    const StartPlan plan(m_, {}, p_.mass);
    if (Outcome o = solve(plan.positions, [&] { return kept_of(plan.positions); }); !o.ok()) return o;
    return solve(plan.velocities, [&] { return kept_of(plan.velocities); });
  }

  Outcome complete(const System& s, const Structure& t) {
    make_room(s, t);
    start_values(is_higher);
    std::vector<StageEquation> late;  // hold leading derivatives
    start_with_free_accelerations(s);
    const int deepest = *std::max_element(t.d.begin(), t.d.end());
    for (int level = deepest; level >= 1; --level)
      if (Outcome o = stage(s, t, level); !o.ok()) return o;
    for (const StageEquation& e : conditions())
      if (holds_higher(e.residual) && level_of(e.residual, s, t) <= 0) late.push_back(e);
    if (Outcome o = given_beyond_the_state(s, t, late); !o.ok()) return o;
    if (Outcome o = leading(s, t); !o.ok()) return o;
    if (!late.empty())
      if (Outcome o = together(s, t, late); !o.ok()) return o;
    for (std::size_t j = 0; j < s.size(); ++j)
      *state_.origin(node(s.symbol(j, static_cast<unsigned>(t.d[j])))) = Origin::derived;
    say_choices(s, t);
    return {};
  }

 private:
  // The model's states start where the file says.
  void states() {
    const std::size_t n = model_.states.size();
    state_.states.assign(n, N(0));
    state_.state_rates.assign(n, N(0));
    state_.states_origin.assign(n, Origin::given);
    state_.state_rates_origin.assign(n, Origin::derived);
  }

  const Node& node(Expr e) const { return m_.graph().node(e.id); }

  Expr symbol(const StateOverride& o) const {
    Graph& g = m_.graph();
    const auto index = static_cast<std::uint32_t>(o.coordinate);
    return o.multiplier ? g.multiplier(index, o.order) : g.jet(index, o.order);
  }

  // Guesses, then values of the file, then those that override them; the model's states start where the file says.
  void start_values(const std::function<bool(const Node&)>& wanted) {
    const InitialData& in = model_.initial;
    const Tape own = p_.plan ? Tape() : values_of(model_);
    Machine<N> machine(p_.plan ? p_.plan->values : own, 0, p_.parameters);
    machine.evaluate();
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

  Equations conditions() const { return conditions_of(model_); }
  bool overridden(const Node& n) const { return anholon::overridden(p_.overrides, n); }

  // As the data say; where overrides clash with values or conditions of the file, the overrides hold
  // and the file's values are only where the least change starts from.
  Outcome solve(const StartPlan::Stages& stages, const std::function<StartPlan::Stages()>& without) {
    const InitialState<N> before = state_;
    const Outcome o = attempt(stages);
    if (o.ok() || p_.overrides.empty()) return o;
    const InitialState<N> failed = std::exchange(state_, before);
    for (Expr u : stages->unknowns)
      if (Origin& origin = *state_.origin(node(u)); origin == Origin::given && !overridden(node(u))) origin = Origin::guessed;
    if (attempt(without()).ok()) return {};
    state_ = failed;
    return o;
  }

  Outcome solve(const Equations& equations, const Column& unknowns, unsigned metric) {
    const StartPlan::Stages stages = planned(m_, equations, unknowns, metric, p_.mass);
    return solve(stages, [&] { return kept_of(stages); });
  }

  StartPlan::Stages kept_of(const StartPlan::Stages& s) const {
    return planned(m_, kept(s->equations, s->unknowns, p_.overrides, m_.graph()), s->unknowns, s->metric, p_.mass);
  }

  Outcome attempt(const StartPlan::Stages& stages) {
    if (!stages) return {};
    const Column& unknowns = stages->unknowns;
    Stage<N> stage(m_, stages, p_.parameters);
    std::vector<std::size_t> free, all;
    std::vector<N> before;
    for (std::size_t j = 0; j < unknowns.size(); ++j) {
      all.push_back(j);
      before.push_back(stage.x(state_, j));
      if (*state_.origin(stage.unknown(j)) != Origin::given) free.push_back(j);
    }
    std::size_t worst = 0;
    if (!find_by_least_change(stage, state_, free)) return no_value(stage);
    for (std::size_t j : free)
      if (stage.moves(j)) *state_.origin(stage.unknown(j)) = Origin::derived;
    N miss = stage.worst(&worst);
    if (!(miss > stage_rounding<N>())) return {};
    if (to_double(miss) <= kRounded) {
      // Rounded numbers: all may move a little.
      if (find_by_least_change(stage, state_, all) && !(stage.worst(&worst) > stage_rounding<N>())) {
        for (std::size_t j : all)
          if (Origin& origin = *state_.origin(stage.unknown(j)); origin == Origin::given)
            if (N change = abs(N(stage.x(state_, j) - before[j])); change > N(0)) {
              origin = Origin::corrected;
              if (change > state_.largest_correction) state_.largest_correction = change;
            }
        return {};
      }
      miss = stage.worst(&worst);
    }
    return clash(stage, worst);
  }

  // ---- beyond velocities -------------------------------------------------------------------------

  void make_room(const System& s, const Structure& t) {
    int coordinates = 2, multipliers = 0;
    for (std::size_t j = 0; j < s.mechanical(); ++j) (j < s.coordinates ? coordinates : multipliers) = std::max(j < s.coordinates ? coordinates : multipliers, t.d[j]);
    const auto level = [](std::size_t n) { return Level<N>{std::vector<N>(n, N(0)), std::vector<Origin>(n, Origin::chosen)}; };
    state_.higher.assign(static_cast<std::size_t>(coordinates) - 1, level(m_.q.size()));
    state_.multipliers.assign(static_cast<std::size_t>(multipliers) + 1, level(m_.phi.size()));
  }

  // How far below the leading derivatives the highest entry of e lies; 0: e holds leading ones.
  int level_of(Expr e, const System& s, const Structure& t) const {
    int level = 1000;
    for (NodeId id : symbols({&e, 1})) {
      const Node& n = m_.graph().node(id);
      if (!is_higher(n)) continue;
      if (const auto j = s.variable(id)) level = std::min(level, t.d[*j] - static_cast<int>(n.order));
    }
    return level == 1000 ? 0 : level;
  }

  bool free_multiplier(const Node& n) const { return n.kind == Kind::multiplier && m_.order[n.index] >= 3; }

  // Entries x_j^(d_j - level) from the equations E_i^(c_i - level), by least change.
  Outcome stage(const System& s, const Structure& t, int level) {
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
    Equations laws;
    for (std::size_t i = 0; i < s.size(); ++i) {
      const int k = t.c[i] - level;
      if (k < 0) continue;
      const Expr e = total_derivative(s.equations[i], static_cast<unsigned>(k));
      if (!holds_higher(e)) continue;  // a matter of positions and velocities
      if (i < s.coordinates) laws.push_back({e, "the equation of motion of '" + s.equation_names[i] + "'", {}});
      else if (i < s.mechanical()) laws.push_back({put_state_rates(model_, e, 2), (k ? "a derivative of constraint '" : "constraint '") + s.equation_names[i] + "'", model_.constraints[s.constraints[i - s.coordinates]].span});
    }
    Equations equations = laws;
    for (const StageEquation& e : conditions())
      if (holds_higher(e.residual) && level_of(e.residual, s, t) == level) equations.push_back(e);
    if (!laws.empty()) start_unconstrained(laws, unknowns, metric);
    const InitialState<N> before = state_;
    if (Outcome o = solve(equations, unknowns, metric); !o.ok()) {
      state_ = before;
      if (!add_velocities(s, t, level, equations, unknowns, metric) || !solve(equations, unknowns, metric).ok()) return o;
    }
    mark_choices(equations, unknowns, metric);
    return {};
  }

  // A servo constraint that its actuator does not act against asks for velocities by the equations of motion. They move along with
  // what else is of this level, on all that holds them. False where there are none.
  bool add_velocities(const System& s, const Structure& t, int level, Equations& equations, Column& unknowns, unsigned& metric) const {
    const std::size_t higher = unknowns.size();
    for (std::size_t j = 0; j < s.coordinates; ++j)
      if (t.d[j] - level == 1) unknowns.push_back(s.symbol(j, 1)), metric |= 2U;
    if (unknowns.size() == higher) return false;
    for (std::size_t i = s.coordinates; i < s.mechanical(); ++i) {
      const int k = t.c[i] - level;
      if (k < 0) continue;
      const Expr e = put_state_rates(model_, total_derivative(s.equations[i], static_cast<unsigned>(k)), 2);
      if (!holds_higher(e)) equations.push_back({e, "a derivative of constraint '" + s.equation_names[i] + "'", model_.constraints[s.constraints[i - s.coordinates]].span});
    }
    for (const StageEquation& e : conditions())
      if (!holds_higher(e.residual) && jet_order(e.residual) == 1) equations.push_back(e);
    return true;
  }

  // Where linear constraints of order 3 and more leave accelerations free, the motion starts without their reaction: the guess
  // is the acceleration without them. (A nonlinear one must have a reaction; there 0 is as good as any.)
  void start_with_free_accelerations(const System& s) {
    Equations laws;
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
      laws.push_back({total_derivative(s.equations[s.coordinates + k], static_cast<unsigned>(2 - m_.order[r])), "constraint '" + model_.constraints[r].name + "'", {}});
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

  // Values given or guessed stay what they were.
  void keep_said(const InitialState<N>& before, const Column& unknowns) {
    for (Expr u : unknowns)
      if (const Node& n = node(u); *before.origin(n) == Origin::given || *before.origin(n) == Origin::guessed) *state_.value(n) = *before.value(n);
  }

  // The same for rates of multipliers and what goes with them: the guess for the other entries is what follows from none.
  void start_unconstrained(const Equations& laws, const Column& unknowns, unsigned metric) {
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

  std::string entry_name(const Node& n) const {
    return derivative_name(n.kind == Kind::multiplier ? "lambda." + model_.constraints[n.index].name : model_.coordinates[n.index].name, n.order, Format::text);
  }

  // What no equation determines is a choice.
  void mark_choices(const Equations& equations, const Column& unknowns, unsigned metric) {
    std::vector<std::size_t> free;
    for (std::size_t j = 0; j < unknowns.size(); ++j)
      if (const Origin o = *state_.origin(node(unknowns[j])); o == Origin::derived || o == Origin::chosen) free.push_back(j);
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

  void say_choices(const System& s, const Structure& t) {
    for (const bool multipliers : {true, false}) {
      std::string list;
      for (std::size_t j = 0; j < s.size(); ++j)
        for (int k = 0; k < t.d[j]; ++k) {
          const Node& n = node(s.symbol(j, static_cast<unsigned>(k)));
          if (!is_higher(n) || (n.kind == Kind::multiplier) != multipliers || *state_.origin(n) != Origin::chosen) continue;
          list += (list.empty() ? "" : ", ") + entry_name(n) + " = " + number_text(to_double(*state_.value(n)), 6);
        }
      if (list.empty()) continue;
      state_.notes.push_back("a choice: " + list + " at the start" +
                             (multipliers ? ", which no equation determines: the motion starts as it would without the constraint; other values in [initial] lambda = {…}, or accelerations"
                                          : ", which no equation determines: other values in [initial] qddot = {…}"));
    }
  }

  // Values given for derivatives that the state does not hold are conditions on it.
  Outcome given_beyond_the_state(const System& s, const Structure& t, Equations& late) {
    Outcome refused;
    const auto beyond = [&](Expr x) {
      const auto j = s.variable(x.id);
      return is_higher(node(x)) && j && static_cast<int>(node(x).order) >= t.d[*j];
    };
    const auto add = [&](Expr x, Expr value, Span span) {
      const auto j = s.variable(x.id);
      if (static_cast<int>(node(x).order) > t.d[*j])
        refused = {OutcomeKind::inconsistent, entry_name(node(x)) + " is given, but follows from the state", "leave it out"};
      late.push_back({x - value, "the value given for " + entry_name(node(x)), span, !overridden(node(x))});
    };
    for (const GivenValue& v : model_.initial.given)
      if (beyond(v.symbol) && !overridden(node(v.symbol))) add(v.symbol, v.value, v.span);
    for (const StateOverride& o : p_.overrides)
      if (beyond(symbol(o))) add(symbol(o), m_.graph().number(o.value), {});
    return refused;
  }

  bool branch_holds(const std::vector<N>& x, const System& s) const {
    for (const BranchChoice& b : model_.initial.branches) {
      const auto j = s.variable(m_.lambda[b.constraint].id);
      if (j && !(b.positive ? x[*j] > N(0) : x[*j] < N(0))) return false;
    }
    return true;
  }

  // The derivatives and multipliers of the nonlinear constraints.
  std::string solution_text(const std::vector<N>& x, const System& s, const Structure& t) const {
    std::string list;
    for (std::size_t j = 0; j < s.size(); ++j) {
      if (j >= s.mechanical()) continue;
      bool named = j >= s.coordinates && may_branch(m_, s, s.constraints[j - s.coordinates]);
      for (std::size_t r : s.constraints) named = named || (j < s.coordinates && may_branch(m_, s, r) && !is_zero(m_.Phi[r][j]));
      if (!named) continue;
      list += (list.empty() ? "" : ", ") + derivative_name(s.variable_names[j], static_cast<unsigned>(t.d[j]), Format::text) + " = " + number_text(to_double(x[j]), 6);
    }
    return list;
  }

  bool branch_was_named(const System& s, const Structure& t) const {
    const auto leading_guess = [&](const GivenValue& v) {
      const auto j = s.variable(v.symbol.id);
      return j && is_higher(node(v.symbol)) && static_cast<int>(node(v.symbol).order) == t.d[*j];
    };
    return !model_.initial.branches.empty() || std::any_of(model_.initial.guess.begin(), model_.initial.guess.end(), leading_guess);
  }

  // The leading derivatives: one linear system, or the solution nearest to the guess.
  Outcome leading(const System& s, const Structure& t) {
    const Column unknowns = leading_unknowns(s, t);
    if (!may_branch(m_, s)) {
      Stage<N> all(m_, leading_equations(s, t), unknowns, 0, p_.parameters, p_.mass);
      std::vector<std::size_t> every;
      for (std::size_t j = 0; j < unknowns.size(); ++j) every.push_back(j);
      if (!find_by_least_change(all, state_, every)) return no_value(all);
      return {};
    }
    const LeadingSolutions<N> solutions = leading_solutions(m_, s, t, p_.parameters, state_);
    const std::vector<N>* taken = nullptr;
    std::string others;
    for (const std::vector<N>& x : solutions.found) {
      if (!taken && branch_holds(x, s)) taken = &x;
      else others += (others.empty() ? "" : "; ") + solution_text(x, s, t);
    }
    if (!taken) return no_leading(s, solutions, others);
    for (std::size_t j = 0; j < unknowns.size(); ++j) *state_.value(node(unknowns[j])) = (*taken)[j];
    if (!others.empty() && !branch_was_named(s, t))
      state_.notes.push_back("the equations have several solutions at the start: " + solution_text(*taken, s, t) + " is taken, there is also " + others +
                             "; name one by [initial] branch = {…} or guess = {…}");
    return {};
  }

  Outcome no_leading(const System& s, const LeadingSolutions<N>& solutions, const std::string& others) const {
    std::string which;
    for (std::size_t r : s.constraints)
      if (may_branch(m_, s, r)) which += (which.empty() ? "'" : ", '") + model_.constraints[r].name + "'";
    if (!others.empty())
      return {OutcomeKind::inconsistent, "no solution lies on the branch asked for; there is " + others, "another [initial] branch, or other initial data"};
    if (solutions.singular)
      return {OutcomeKind::singular,
              "singular configuration: the multiplier of the constraint " + which + " is 0 at the start, and the equations do not determine the motion there",
              "give initial data at which the constraint has a reaction: other accelerations, [initial] qddot = {…}"};
    return {OutcomeKind::no_convergence, "no derivatives were found at the start that satisfy the constraint " + which + " and the equations of motion",
            "there may be no real solution; a guess helps where there is one: [initial] guess = {…}"};
  }

  // Conditions on leading derivatives, with all laws: velocities move first, positions only if they must.
  Outcome together(const System& s, const Structure& t, const Equations& late) {
    Equations equations;
    for (std::size_t i = 0; i < s.size(); ++i)
      for (int k = 0; k <= t.c[i]; ++k)
        equations.push_back(law(s, i, static_cast<unsigned>(k)));
    for (const StageEquation& e : conditions())
      if (!holds_higher(e.residual) || level_of(e.residual, s, t) > 0) equations.push_back(e);
    equations.insert(equations.end(), late.begin(), late.end());
    {  // They may hold already: a value that follows from the others was given too.
      Stage<N> said(m_, late, leading_unknowns(s, t), 0, p_.parameters, p_.mass);
      if (!said.evaluate(state_)) return no_value(said);
      if (to_double(said.worst()) <= kRounded && all_given(s, t)) return {};
      if (!(said.worst() > stage_rounding<N>())) return {};
    }
    const InitialState<N> before = state_;
    for (int lowest : {1, 0}) {
      state_ = before;
      Column unknowns;
      unsigned metric = 0;
      for (std::size_t j = 0; j < s.size(); ++j)
        for (int k = j < s.coordinates ? lowest : 0; k <= t.d[j]; ++k) {
          unknowns.push_back(s.symbol(j, static_cast<unsigned>(k)));
          if (j < s.coordinates && k < t.d[j]) metric |= 1U << k;
        }
      for (Expr u : unknowns)  // values that followed may follow anew
        if (const auto j = s.variable(u.id); static_cast<int>(node(u).order) == t.d[*j]) *state_.origin(node(u)) = Origin::derived;
      if (solve(equations, unknowns, metric).ok()) return {};
    }
    state_ = before;
    Stage<N> said(m_, late, leading_unknowns(s, t), 0, p_.parameters, p_.mass);
    std::size_t worst = 0;
    if (!said.evaluate(state_)) return no_value(said);
    said.worst(&worst);
    const StageEquation& e = said.equation(worst);
    return {OutcomeKind::inconsistent,
            e.what + (e.span.line ? " (line " + std::to_string(e.span.line) + ")" : "") + " does not hold: with the other initial data it is missed by " +
                number_text(std::abs(to_double(said.residual[worst])), 3),
            "leave it out, or leave out velocities and positions that it could determine; a guess near the wanted motion helps: [initial] guess = {…}"};
  }

  bool all_given(const System& s, const Structure& t) const {
    for (std::size_t j = 0; j < s.size(); ++j)
      for (int k = 0; k < t.d[j]; ++k)
        if (const Origin o = *state_.origin(node(s.symbol(j, static_cast<unsigned>(k)))); o == Origin::chosen || o == Origin::guessed) return false;
    return true;
  }

  // ---- what went wrong ---------------------------------------------------------------------------

  std::string kind(const Stage<N>& stage) const {
    const Node& n = stage.unknown(0);
    return n.kind != Kind::jet || n.order > 1 ? "higher derivatives" : n.order == 0 ? "positions" : "velocities";
  }

  Outcome no_value(const Stage<N>& stage) {
    return {OutcomeKind::inconsistent,
            "the " + kind(stage) + " cannot be found: " + stage.equation(0).what + " or its neighbours have no value at the initial data",
            "give a guess near the wanted configuration: [initial] guess = {…}"};
  }

  // What an equation asks of the unknowns that are free, the values of the others put in: "x'^2 + 1 = 0".
  std::string asked(const Stage<N>& stage, std::size_t row) const {
    constexpr std::size_t kMostUnknowns = 2, kLongest = 60;
    constexpr long kMostWork = 2000;
    if (p_.plan) return {};  // it would take an expression
    const Graph& g = m_.graph();
    const Expr residual = stage.equation(row).residual;
    std::size_t open = 0;
    bool valued = true;
    const auto number = [&](const N& value) {
      const std::optional<Rational> r = parse_rational(number_text(to_double(value), 6));
      valued = valued && r;
      return m_.graph().number(r ? *r : Rational(0));
    };
    const auto free = [&](NodeId id) {
      for (std::size_t j = 0; j < stage.unknowns(); ++j)
        if (&stage.unknown(j) == &g.node(id)) return *state_.origin(g.node(id)) != Origin::given;
      return false;
    };
    const Expr e = substitute({&residual, 1}, [&](NodeId id) {
      const Node& n = g.node(id);
      if (free(id)) return ++open, Expr{};
      if (n.kind == Kind::time) return number(state_.t);
      if (n.kind == Kind::parameter) return number(p_.parameters[n.index]);
      if (const N* value = state_.value(n)) return number(*value);
      return Expr{};
    })[0];
    if (open == 0 || open > kMostUnknowns || !valued || stage.equation(row).span.line == 0) return {};
    const std::optional<Expr> full = expanded(e, kMostWork);
    const std::string text = print(full ? *full : e, model_.names, Format::text);
    return text.size() > kLongest ? std::string() : "; it asks for " + text + " = 0 here";
  }

  Outcome clash(const Stage<N>& stage, std::size_t row) {
    const StageEquation& e = stage.equation(row);
    std::string fixed;
    for (std::size_t j = 0; j < stage.unknowns(); ++j) {
      const Node& n = stage.unknown(j);
      if (*state_.origin(n) == Origin::given && abs(stage.jacobian(row, j)) > N(0)) fixed += (fixed.empty() ? "" : ", ") + entry_name(n);
    }
    const std::string at = e.span.line ? " (line " + std::to_string(e.span.line) + ")" : "";
    return {OutcomeKind::inconsistent,
            e.what + at + " is missed by " + number_text(std::abs(to_double(stage.residual[row])), 3) + " with the initial data given" + asked(stage, row),
            fixed.empty() ? "it clashes with another constraint or condition, or has no real solution near the guess: [initial] guess = {…}"
                          : "leave out " + std::string(fixed.find(',') == std::string::npos ? "" : "one of ") + fixed +
                                " (what is missing is found from the constraints), if the equation can be satisfied at all"};
  }

  const InitialProblem<N>& p_;
  const Mechanics& m_;
  const Model& model_;
  InitialState<N>& state_;
};

}  // namespace

StartPlan::StartPlan(const Mechanics& m, const std::vector<StateOverride>& overrides, const std::vector<Column>* mass)
    : values(values_of(*m.model)) {
  const Model& model = *m.model;
  std::vector<StageEquation> of_positions, of_velocities;
  for (const Constraint& c : model.constraints) {
    if (c.order > 1) continue;
    const Expr phi = put_masses(model, c.phi);
    const std::string what = "constraint '" + c.name + "'";
    if (c.order == 0) {
      of_positions.push_back({phi, what, c.span});
      of_velocities.push_back({put_state_rates(model, total_derivative(phi), 1), "the derivative of " + what, c.span});
    } else {
      of_velocities.push_back({phi, what, c.span});
    }
  }
  for (const StageEquation& e : conditions_of(model))
    if (!holds_higher(e.residual)) (jet_order(e.residual) == 0 ? of_positions : of_velocities).push_back(e);
  constexpr unsigned kPositions = 1U, kVelocities = 2U;
  positions = planned(m, of_positions, m.q, kPositions, mass);
  velocities = planned(m, of_velocities, m.qd, kVelocities, mass);
  if (overrides.empty()) return;
  kept_positions = planned(m, kept(of_positions, m.q, overrides, m.graph()), m.q, kPositions, mass);
  kept_velocities = planned(m, kept(of_velocities, m.qd, overrides, m.graph()), m.qd, kVelocities, mass);
}

template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state) {
  return Solver<N>(problem, state).positions_and_velocities();
}

bool needs_completion(const Mechanics& m, const System& s, const Structure& t) {
  for (std::size_t j = 0; j < s.mechanical(); ++j)
    if (t.d[j] > (j < s.coordinates ? 2 : 0)) return true;
  const auto high = [](const Condition& c) { return holds_higher(c.residual); };
  return may_branch(m, s) || std::any_of(m.model->initial.conditions.begin(), m.model->initial.conditions.end(), high);
}

template <Number N>
Outcome complete_state(const InitialProblem<N>& problem, const System& s, const Structure& t, InitialState<N>& state) {
  return Solver<N>(problem, state).complete(s, t);
}

template Outcome consistent_state<double>(const InitialProblem<double>&, InitialState<double>&);
template Outcome consistent_state<long double>(const InitialProblem<long double>&, InitialState<long double>&);
template Outcome consistent_state<Quad>(const InitialProblem<Quad>&, InitialState<Quad>&);
template Outcome consistent_state<Multi>(const InitialProblem<Multi>&, InitialState<Multi>&);
template Outcome complete_state<double>(const InitialProblem<double>&, const System&, const Structure&, InitialState<double>&);
template Outcome complete_state<long double>(const InitialProblem<long double>&, const System&, const Structure&, InitialState<long double>&);
template Outcome complete_state<Quad>(const InitialProblem<Quad>&, const System&, const Structure&, InitialState<Quad>&);
template Outcome complete_state<Multi>(const InitialProblem<Multi>&, const System&, const Structure&, InitialState<Multi>&);

}  // namespace anholon

// The solver of consistent initial data behind consistent.h, whose parts are separate files.
#pragma once
#include <algorithm>
#include <functional>

#include "base/outcome.h"
#include "structure/branch.h"
#include "structure/contradiction.h"
#include "structure/start_memory.h"
#include "structure/structure.h"

namespace anholon {

// Prints two numbers with enough digits to distinguish them.
std::pair<std::string, std::string> told_apart(double a, double b);

template <Number N>
class StateSolver {
 public:
  StateSolver(const InitialProblem<N>& p, InitialState<N>& state, StartMemory<N>* memory = nullptr)
      : p_(p), m_(*p.mechanics), model_(*m_.model), state_(state), memory_(memory),
        notes_(memory ? memory->notes() : own_notes_) {}

  Outcome positions_and_velocities();
  Outcome complete(const System& s, const Structure& t);

 private:
  const Node& node(Expr e) const { return m_.graph().node(e.id); }
  Expr symbol(const StateOverride& o) const {
    Graph& g = m_.graph();
    const auto index = static_cast<std::uint32_t>(o.coordinate);
    return o.multiplier ? g.multiplier(index, o.order) : g.jet(index, o.order);
  }
  StageEquations conditions() const { return conditions_of(model_); }
  bool overridden(const Node& n) const { return anholon::overridden(p_.overrides, n); }
  bool free_multiplier(const Node& n) const { return n.kind == Kind::multiplier && m_.order[n.index] >= 3; }

  // Positions and velocities (consistent.cpp).
  void states();
  void put_rates(Machine<N>& machine);
  void start_values(const std::function<bool(const Node&)>& wanted);
  Outcome solve(const StartPlan::Stages& stages);
  Outcome solve(const StageEquations& equations, const Column& unknowns, unsigned metric);
  Outcome attempt(Stage<N>& stage, bool tell);
  bool correct_rounded(Stage<N>& stage, const InitialState<N>& before, const std::vector<std::size_t>& free,
                       const std::vector<std::size_t>& all);
  bool move_positions(const StartPlan& plan, const InitialState<N>& before);
  void mark_derived(const Stage<N>& stage, const InitialState<N>& before, const std::vector<std::size_t>& free);

  // Options in place of values of the file (consistent.cpp).
  std::optional<Outcome> make_room_for_options(Stage<N>& stage, std::vector<bool>& kept);
  bool release(const Stage<N>& stage, const Contradiction<N>& c, std::vector<bool>& kept);
  std::vector<Node> options_in(const Stage<N>& stage, const Contradiction<N>& c) const;
  bool follows_from_options(const Node& n) const;
  std::vector<bool> positions_of_options() const;
  void say_replaced();

  // Completes the state beyond velocities (completion.cpp).
  void make_room(const System& s, const Structure& t, int beyond);
  int order_beyond(Expr e, const System& s, const Structure& t) const;
  int level_of(Expr e, const System& s, const Structure& t) const;
  Outcome stage(const System& s, const Structure& t, int level);
  bool add_velocities(const System& s, const Structure& t, int level, StageEquations& equations, Column& unknowns,
                      unsigned& metric) const;
  Outcome given_beyond_the_state(const System& s, const Structure& t, StageEquations& late);
  bool branch_holds(const std::vector<N>& x, const System& s) const;
  bool branch_was_named(const System& s, const Structure& t) const;
  Outcome leading(const System& s, const Structure& t);
  void put_rates_of_state(const System& s, const Structure& t);
  Outcome derivatives_of_leading(const System& s, const Structure& t, int order);
  Outcome together(const System& s, const Structure& t, const StageEquations& late, int beyond);
  bool all_given(const System& s, const Structure& t) const;

  // Chooses values that no equation determines (choices.cpp).
  void start_with_free_accelerations(const System& s);
  void keep_said(const InitialState<N>& before, const Column& unknowns);
  void start_unconstrained(const StageEquations& laws, const Column& unknowns, unsigned metric);
  void mark_choices(const StageEquations& equations, const Column& unknowns, unsigned metric);
  void say_choices(const System& s, const Structure& t);
  void mark_undetermined(Stage<N>& stage, const InitialState<N>& before, const std::vector<std::size_t>& free);
  void say_least_change();

  // Messages about contradictions (clash.cpp).
  std::string entry_name(const Node& n) const;
  std::string solution_text(const std::vector<N>& x, const System& s, const Structure& t) const;
  Outcome no_leading(const System& s, const LeadingSolutions<N>& solutions, const std::string& others) const;
  Outcome no_accelerations(bool singular) const;
  std::string kind(const Stage<N>& stage) const;
  Outcome no_value(const Stage<N>& stage);
  std::string equation_text(const StageEquation& e) const;
  std::string asked(const Stage<N>& stage, std::size_t row, const std::vector<std::size_t>& released) const;
  Outcome clash(Stage<N>& stage, std::size_t worst, const InitialState<N>& before);
  Outcome clash_of(const Stage<N>& stage, const Contradiction<N>& c, const InitialState<N>& before) const;

  const InitialProblem<N>& p_;
  const Mechanics& m_;
  const Model& model_;
  InitialState<N>& state_;
  StartMemory<N>* memory_;
  StartNotes<N> own_notes_;  // without a memory
  StartNotes<N>& notes_;
  const StartPlan* plan_ = nullptr;  // while positions and velocities are solved for
  std::vector<Node> changed_least_;  // positions and velocities that the equations move but do not determine
  bool by_flow_ = false;        // positions are searched along Newton's flow: conditions on accelerations move them
  bool clash_is_told_ = false;  // the message names the values and equations of the last stage that failed
};

}  // namespace anholon

// One prepared model: mechanics, consistent state, independent constraints, implicit system in a form, structure. This
// file composes the stages up to the stepping program.
#pragma once
#include <algorithm>
#include <memory>
#include <span>

#include "modelfile/read.h"
#include "program/expansion.h"
#include "setup/eliminate.h"
#include "setup/undetermined_multipliers.h"
#include "structure/consistent.h"
#include "tape/bind.h"

namespace anholon {

struct ConstraintClass {
  std::string kind;          // holonomic, linear, affine, nonlinear (in its top derivative)
  bool homogeneous = false;  // homogeneous in the top derivative (order 1: it does no work)
  bool rheonomic = false;    // contains t explicitly
  bool redundant = false;    // follows from the others at the initial state
  bool vanishes = false;     // redundant because it vanishes identically with the values of the parameters
};

// The number type of a computation. multi: MPFR with the requested number of digits.
enum class Precision : std::uint8_t { real, long_real, quad, multi };

struct StateChoice {
  std::vector<StateOverride> overrides;
  std::optional<Rational> t;
  std::vector<std::size_t> eliminate;  // coordinates to eliminate; if empty, the program chooses
  // Exponents that are whole numbers are replaced by their values (model/exponents.h), unless they depend on one of
  // these parameters, which may get other values. If nullopt, no exponent is replaced.
  std::optional<std::vector<std::size_t>> open_parameters;
};

// A prepared system. Its graph is frozen and belongs to it, so reading a scenario never changes it and many threads may
// read it at once. Code that has to build expressions does so in a Workspace.
struct Scenario {
  std::shared_ptr<const Model> model;
  std::size_t given_nodes = 0;  // the number of nodes of the graph before the equations were derived
  std::unique_ptr<Mechanics> mechanics;
  std::vector<ConstraintClass> classes;
  std::shared_ptr<const StartPlan> start;  // null without numbers
  InitialState<double> state;              // consistent, in double
  std::vector<std::size_t> independent, redundant;
  UndeterminedMultipliers undetermined;  // of the redundant constraints
  Elimination elimination;               // the elimination of forms without multipliers
  System system;
  Structure structure;
  // Routh's system, if the initial state holds more than positions and velocities or the equations have several
  // solutions: the state is completed with this system, whatever the form.
  std::shared_ptr<const System> routh;
  Structure routh_structure;
  std::vector<std::string> notes;
};

// A copy of a prepared system in which its owner may build expressions. New nodes have the ids that they would have in
// the graph of the original, so numbers that are computed in a workspace have the same bits in every other workspace of
// the same scenario.
//
// Functions that return numbers or text take a `const Scenario&` and build in a workspace of their own. Functions that
// take or return expressions, and the parts of a computation, take the `Workspace&` whose graph holds these
// expressions.
struct Workspace : Scenario {
  explicit Workspace(const Scenario& from);
  explicit Workspace(const Workspace& from) : Workspace(static_cast<const Scenario&>(from)) {}
  Workspace& operator=(const Workspace&) = delete;

  Graph& graph() const { return *model->graph; }
  // Replaces the value of a parameter by a number.
  void set_parameter(std::size_t parameter, const Rational& value);

 private:
  std::shared_ptr<Model> own_model_;  // the same as `model`
};

// The handles of a scenario (expr/handles.h), including those of its model and of all other parts.
void for_each_expression(Scenario& s, const ExprVisitor& f);

// Returns the model as it was before equations were derived, for another form or other numbers; the owner may build in
// its graph.
std::shared_ptr<Model> given_model(const Scenario& scenario);

// Returns the classes of the constraints, by exact tests on their partial derivatives.
std::vector<ConstraintClass> classify(const Mechanics& mechanics);

// Prepares a clone of the model; the model itself is unchanged. A model that lacks something for numbers (unknown
// functions) is prepared without them. The outcome tells of faults of numbers: inconsistent data, a singular start.
Outcome make_scenario(std::shared_ptr<const Model> model, const Formulation& form, const StateChoice& choice,
                      Scenario& scenario);

// Finds the consistent state of a workspace whose parameters have other values (set_parameter), or whose state has
// other values (`choice`, for the same symbols as those with which it was made). Returns nullopt if the equations do
// not hold for the new state because other constraints are independent: make_scenario then makes them anew.
std::optional<Outcome> begin_anew(Workspace& s, const StateChoice& choice = {});

// Returns a note on the constraints that are left out, notes on the multipliers that the equations do not determine one
// by one, and on the formulas of the model that hold them; none if no constraint is redundant.
std::vector<std::string> notes_of_redundancy(const Scenario& scenario);

// Returns how many derivatives of the multipliers belong to the state or are solved for, in forms with multipliers.
int multiplier_orders(const Scenario& scenario);

// largest_order returns the order of the highest derivative of any coordinate that is solved for; `d` belongs to the
// system in the scenario's form. orders_beyond returns how many orders more than their own are to be computed of the
// other coordinates, and of the multipliers.
int largest_order(const Scenario& scenario, const std::vector<int>& d);
int orders_beyond(const Scenario& scenario, const std::vector<int>& d);

// Returns by how many orders the expressions exceed the derivatives that are solved for.
int orders_needed(const Scenario& scenario, std::span<const Expr> es);

// Returns the values near which the structure of a system is probed.
ProbeHints hints_at(const InitialState<double>& state);

// Returns nullopt if numbers can be computed for the model, else the reason why not.
std::optional<Diagnostic> not_integrated(const Model& model);

// The state in the order of an Expansion's state, its time, and the leading derivatives (empty: they follow without a
// guess).
template <Number N>
struct Start {
  N t{0};
  std::vector<N> state, leading;
};
// Returns the consistent state in double.
Start<double> start_of(const Scenario& scenario);
// Computes the consistent state in the number type N.
template <Number N>
Outcome initial_state(const Scenario& s, const StateChoice& choice, Start<N>& start);
// Computes the same in the given workspace.
template <Number N>
Outcome initial_state(Workspace& s, const StateChoice& choice, Start<N>& start);

template <Scalar N>
std::vector<N> parameter_values(const Model& model) {
  Column es;
  for (const Parameter& p : model.parameters) es.push_back(p.value);
  return evaluate_parameters<N>(*model.graph, es);
}

}  // namespace anholon

// One model made ready: mechanics, consistent state, independent constraints, implicit system in a
// form, structure. The composition of the whole main line up to the stepping program.
#pragma once
#include <algorithm>
#include <memory>
#include <span>

#include "modelfile/read.h"
#include "program/expansion.h"
#include "setup/eliminate.h"
#include "structure/consistent.h"
#include "tape/bind.h"

namespace anholon {

struct ConstraintClass {
  std::string kind;          // holonomic, linear, affine, nonlinear (in its top derivative)
  bool homogeneous = false;  // in the top derivative (order 1: it does no work)
  bool rheonomic = false;    // holds t explicitly
  bool redundant = false;    // follows from the others at the initial state
};

// The numbers of a computation. multi: MPFR with as many digits as asked for.
enum class Precision : std::uint8_t { real, long_real, quad, multi };

struct StateChoice {
  std::vector<StateOverride> overrides;
  std::optional<Rational> t;
  std::vector<std::size_t> eliminate;  // coordinates to eliminate; empty: chosen
  // Exponents that are whole numbers are put in (model/exponents.h), but for those that depend on one of these
  // parameters, which may get other values; nullopt: none is put in.
  std::optional<std::vector<std::size_t>> open_parameters;
};

// A prepared system. Its graph is frozen and is its own, so reading a scenario never changes it and many threads may do
// so at once; whoever has to build expressions does so in a Workspace.
struct Scenario {
  std::shared_ptr<const Model> model;
  std::size_t given_nodes = 0;  // those of the graph before the model was put into equations
  std::unique_ptr<Mechanics> mechanics;
  std::vector<ConstraintClass> classes;
  std::shared_ptr<const StartPlan> start;  // null without numbers
  InitialState<double> state;              // consistent, in double
  std::vector<std::size_t> independent, redundant;
  Elimination elimination;  // of forms without multipliers
  System system;
  Structure structure;
  // Routh's system, where the initial state holds more than positions and velocities, or the equations several
  // solutions: it is completed there, whatever the form.
  std::shared_ptr<const System> routh;
  Structure routh_structure;
  std::vector<std::string> notes;
};

// A copy of a prepared system in which its holder may build expressions. Nodes have the ids that they would have got in
// the graph of the original, so numbers that are computed in a workspace have the same bits in every other one made of
// the same scenario.
//
// Functions that give numbers or text take a `const Scenario&` and build in a workspace of their own. Those that take or
// give expressions, and the parts of a computation, take the `Workspace&` in which these are.
struct Workspace : Scenario {
  explicit Workspace(const Scenario& from);
  explicit Workspace(const Workspace& from) : Workspace(static_cast<const Scenario&>(from)) {}
  Workspace& operator=(const Workspace&) = delete;

  Graph& graph() const { return *model->graph; }
  // Puts another number in place of the value of a parameter.
  void set_parameter(std::size_t parameter, const Rational& value);

 private:
  std::shared_ptr<Model> own_model_;  // the same as `model`
};

// The handles of a scenario (expr/handles.h), those of its model and all other parts among them.
void for_each_expression(Scenario& s, const ExprVisitor& f);

// The model as it was before it was put into equations, for another form or other numbers; its holder may build in it.
std::shared_ptr<Model> given_model(const Scenario& scenario);

// Classes of the constraints, by exact tests on their partial derivatives.
std::vector<ConstraintClass> classify(const Mechanics& mechanics);

// Prepares a clone of the model; the model itself is left as it is.
// Diagnostics: what this model lacks for numbers (unknown functions).
// The outcome tells of numbers: inconsistent data, a singular start.
Outcome make_scenario(std::shared_ptr<const Model> model, const Formulation& form, const StateChoice& choice,
                      Scenario& scenario);

// Finds the consistent state of a workspace whose parameters have got other values (set_parameter), or whose state others
// (`choice`, for the same symbols as those with which it was made). Returns nullopt if its
// equations are not those of the new state, where other constraints are independent: make_scenario makes them anew.
std::optional<Outcome> begin_anew(Workspace& s, const StateChoice& choice = {});

// Derivatives of the multipliers that belong to the state or are solved for, in forms with multipliers.
int multiplier_orders(const Scenario& scenario);

// The highest derivative that is solved for of any coordinate, d being of the system in the scenario's form; how many
// more than their own are to be computed of the others, and of the multipliers.
int largest_order(const Scenario& scenario, const std::vector<int>& d);
int orders_beyond(const Scenario& scenario, const std::vector<int>& d);

// By how many orders the expressions exceed what is solved for.
int orders_needed(const Scenario& scenario, std::span<const Expr> es);

// Where the structure of its system is probed.
ProbeHints hints_at(const InitialState<double>& state);

// Nothing if numbers can be computed for the model, else why not.
std::optional<Diagnostic> not_integrated(const Model& model);

// The state in the order of an Expansion's, its time, and the leading derivatives (empty: they follow without a guess).
template <Number N>
struct Start {
  N t{0};
  std::vector<N> state, leading;
};
// The consistent state in double.
Start<double> start_of(const Scenario& scenario);
// The consistent state in the number type N.
template <Number N>
Outcome initial_state(const Scenario& s, const StateChoice& choice, Start<N>& start);
// The same, built in the workspace that is given.
template <Number N>
Outcome initial_state(Workspace& s, const StateChoice& choice, Start<N>& start);

template <Scalar N>
std::vector<N> parameter_values(const Model& model) {
  Column es;
  for (const Parameter& p : model.parameters) es.push_back(p.value);
  return evaluate_parameters<N>(*model.graph, es);
}

}  // namespace anholon

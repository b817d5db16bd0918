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

// The value of a symbol at a point of the motion, for tape/bind.h; 0 for the multiplier of a redundant constraint.
template <Number N>
struct ValueAt {
  const System& system;
  const Expansion<N>& point;
  N operator()(const Node& n, NodeId symbol) const {
    if (n.kind == Kind::time) return point.time();
    const auto j = system.variable(symbol);
    return j ? point.derivative(*j, n.order) : N(0);
  }
};

// Multipliers where constraints are redundant (setup/least_multipliers.h).
template <Number N>
class LeastMultipliers;
template <Number N>
std::shared_ptr<LeastMultipliers<N>> least_multipliers_of(Workspace& s, const std::vector<N>& parameters);
template <Number N>
std::vector<N> multipliers_at(LeastMultipliers<N>& least, const Expansion<N>& point);
template <Number N>
void set_parameters(LeastMultipliers<N>& least, const std::vector<N>& parameters);

// Expressions evaluated at a point of the motion. evaluate() reads no graph, so that one thread may evaluate while
// another builds expressions. Where constraints are redundant multipliers are the least ones with the same forces; if
// multipliers belong to the state, those of constraints that are left out are zero.
template <Number N>
class OutputTape {
 public:
  OutputTape(Workspace& s, const Column& es, const std::vector<N>& parameters)
      : system_(s.system), tape_(compile(s.redundant.empty() ? put(s, es) : es)), machine_(tape_, 0, parameters) {
    for (const Input& in : tape_.inputs) {
      const Node& n = s.model->graph->node(in.symbol);
      places_.push_back({n.kind == Kind::time, system_.variable(in.symbol), n.order, in.slot});
      if (!s.redundant.empty() && n.kind == Kind::multiplier) multipliers_.push_back({places_.size() - 1, n.index});
    }
    if (!multipliers_.empty() && multiplier_orders(s) == 0) least_ = least_multipliers_of(s, parameters);
  }
  // As evaluate_at(ValueAt) does.
  void evaluate(const Expansion<N>& point) {
    if (!multipliers_.empty()) find_multipliers(*point.program().system);
    for (const InputPlace& in : places_)
      machine_.series(in.slot)[0] = in.time       ? point.time()
                                    : in.variable ? point.derivative(*in.variable, in.order)
                                                  : N(0);
    if (least_) {
      const std::vector<N> all = multipliers_at(*least_, point);
      for (const MultiplierPlace& m : multipliers_)
        if (places_[m.input].order == 0) machine_.series(places_[m.input].slot)[0] = all[m.constraint];
    }
    machine_.evaluate();
    sizes_.clear();
  }
  // As above with the rule of tape/bind.h.
  template <class Rule>
  void evaluate_at(const Rule& rule) {
    bind(machine_, *system_.model->graph, rule);
    machine_.evaluate();
    sizes_.clear();
  }
  const N& operator[](std::size_t i) const { return machine_.value(i); }
  // The sum of the absolute values of its terms.
  N terms(std::size_t i) const { return machine_.magnitude(tape_.roots[i]); }
  // What it is made of (tape/tape.h), at the point evaluated last.
  const N& made_of(std::size_t i) const {
    if (sizes_.empty()) machine_.made_of(sizes_);
    return sizes_[tape_.roots[i]];
  }
  // Modes have changed.
  void set_parameters(const std::vector<N>& parameters) {
    machine_.set_parameters(parameters);
    if (least_) anholon::set_parameters(*least_, parameters);
    sizes_.clear();
  }
  static Column put(Workspace& s, const Column& es) { return taking_part(s.system, es); }

 private:
  struct InputPlace {
    bool time;
    std::optional<std::size_t> variable;  // the unknown; nullopt for the multiplier of a redundant constraint
    int order;                            // of its derivative
    std::uint32_t slot;
  };
  struct MultiplierPlace {
    std::size_t input;       // among the places
    std::size_t constraint;  // of the model
  };
  void find_multipliers(const System& of_point) {
    for (const MultiplierPlace& m : multipliers_) {
      const auto row = std::find(of_point.constraints.begin(), of_point.constraints.end(), m.constraint);
      places_[m.input].variable = std::nullopt;
      if (row != of_point.constraints.end())
        places_[m.input].variable = of_point.coordinates + static_cast<std::size_t>(row - of_point.constraints.begin());
    }
  }

  const System& system_;
  Tape tape_;
  Machine<N> machine_;
  std::vector<InputPlace> places_;              // of the inputs
  std::vector<MultiplierPlace> multipliers_;    // among them, where constraints are redundant
  std::shared_ptr<LeastMultipliers<N>> least_;  // that gives them; null where there is nothing to choose
  mutable std::vector<N> sizes_;
};

}  // namespace anholon

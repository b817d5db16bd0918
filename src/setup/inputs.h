// A system whose inputs can be set from outside: their symbols stand in the equations, their formulas beside them.
#pragma once
#include "emit/emit.h"
#include "setup/scenario.h"

namespace anholon {

struct OpenSystem {
  System system;  // of a model in which these inputs have no formulas
  std::vector<InputFormula> inputs;
};

// Not among them, and put in as formulas: inputs that hold accelerations or multipliers, that keep a constraint, that
// stand in an equation which is differentiated (their rates would be inputs, too), or whose formula stands in a
// potential, dissipation, mass or constraint (Control::put_into). Formulas of other inputs, monitors, rates and events
// of the system's model hold the symbols, too.
// The system is of the workspace.
OpenSystem open_inputs(Workspace& scenario);

// The names of the inputs whose rates stand in the equations or in an output: those in a position, or that turn a frame.
std::vector<std::string> inputs_with_rates(const Scenario& scenario);

// A model whose inputs are parameters, the last ones, so that whoever gives a parameter sets an input. It starts as the
// given one does: each holds the value of its formula there.
struct InputsAsParameters {
  std::shared_ptr<const Model> model;
  std::vector<std::string> names;
  std::vector<NodeId> formulas;       // of the inputs, in the graph of the model, in t, state and parameters
  std::vector<NodeId> open_formulas;  // the same, with those parameters that are inputs
  std::vector<std::string> left_out;  // monitors that hold the rate of an input, which nobody gives
};
// All inputs that can be set where `names` has none, also those that act in other inputs alone. Throws Failure for a name that is no input, or one that cannot be set.
InputsAsParameters inputs_as_parameters(const Scenario& scenario, const std::vector<std::string>& names = {});

}  // namespace anholon

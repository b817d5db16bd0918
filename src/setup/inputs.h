// A system whose inputs can be set from outside: the equations contain their symbols, and the formulas are kept beside
// them.
#pragma once
#include "emit/emit.h"
#include "setup/scenario.h"

namespace anholon {

struct OpenSystem {
  System system;  // the system of a model in which these inputs have no formulas
  std::vector<InputFormula> inputs;
};

// Opens the inputs of the workspace's system. Some inputs are not opened, and their formulas are substituted: inputs
// that hold accelerations or multipliers, that keep a constraint, that occur in an equation which is differentiated
// (their rates would be inputs as well), or whose formula occurs in a potential, dissipation, mass or constraint
// (Control::put_into). Formulas of other inputs, monitors, rates and events of the system's model hold the symbols as
// well.
OpenSystem open_inputs(Workspace& scenario);

// Returns the names of the inputs whose rates occur in the equations or in an output: inputs in a position, or that
// turn a frame.
std::vector<std::string> inputs_with_rates(const Scenario& scenario);

// A model whose inputs are its last parameters, so that setting a parameter sets an input. Its start is that of the
// given model: each parameter has the value of the input's formula there.
struct InputsAsParameters {
  std::shared_ptr<const Model> model;
  std::vector<std::string> names;
  std::vector<NodeId> formulas;       // formulas of the inputs, in the graph of the model, in t, state and parameters
  std::vector<NodeId> open_formulas;  // the same, in terms of the parameters that are inputs
  std::vector<std::string> left_out;  // monitors that hold the rate of an input, which has no value
};
// Makes the inputs in `names` parameters, in the order of `names`; if `names` is empty, all inputs that can be set, also
// those that act only in other inputs, in the order of the model. Throws Failure for a name that is no input, belongs to
// an input that cannot be set, or is given twice.
InputsAsParameters inputs_as_parameters(const Scenario& scenario, const std::vector<std::string>& names = {});

}  // namespace anholon

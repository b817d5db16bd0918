// The motion as expressions, which generated programs compute: equations with their derivatives, state, parameters.
#pragma once
#include <string>
#include <vector>

#include "emit/emit.h"

namespace anholon::emit {

// One entry of the state: the derivative of this order of a variable.
struct StateEntry {
  std::size_t variable;
  unsigned order;
};

struct Motion {
  std::vector<StateEntry> state;     // by order, then by variable
  Column residual;                   // E_i^(c_i)
  std::vector<Column> jacobian;      // with respect to the leading derivatives
  Column hidden;                     // E_i^(k), k < c_i
  std::vector<std::size_t> derived;  // parameters whose values depend on other parameters
  std::vector<std::size_t> inputs;   // controls of the model
  Column input_values;               // by their formulas
  Column parameters;                 // values in terms of the independent parameters
  bool linear = true;                // the equations are linear in the leading derivatives
  std::vector<int> orders;           // orders of the leading derivatives, by variable
  Column outputs;
  struct Event {
    std::size_t index;  // in the model
    Expr when;
    std::vector<std::string> targets;  // "state[3]", "p[0]": the places that the event sets
    Column values;
    bool moves = false;  // true if it sets coordinates or velocities
  };
  std::vector<Event> events;
  std::vector<std::string> output_names, left_out;  // left_out: outputs and events with derivatives beyond lead
  std::vector<std::string> state_names, leading_names, equation_names, hidden_names, input_names;

  // Returns the index of x_j^(k), k < d_j, in the state.
  std::size_t place(std::size_t variable, unsigned order) const;
};

// Returns the motion. Throws Failure for functions without a formula.
Motion motion(const System& system, const Structure& structure, const EmitOptions& options);
// Returns the motion without outputs and events.
Motion motion_between_events(const System& system, const Structure& structure, std::span<const InputFormula> inputs);

// Returns the initial state in the order of the state.
std::vector<double> start_state(const Motion& motion, const EmitOptions::Start& start);

}  // namespace anholon::emit

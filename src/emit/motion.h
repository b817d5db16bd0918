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
  std::vector<std::string> state_names, leading_names, equation_names, hidden_names, input_names;

  // The index of x_j^(k), k < d_j, in the state.
  std::size_t place(std::size_t variable, unsigned order) const;
};

// Throws Failure for a model whose motion a program cannot compute.
Motion motion(const System& system, const Structure& structure, const EmitOptions& options);
// The equations between events, of which all models have some. Throws Failure for functions without a formula.
Motion motion_between_events(const System& system, const Structure& structure, std::span<const InputFormula> inputs);

// The initial state in the order of the state; multipliers begin with zero.
std::vector<double> start_state(const System& system, const Motion& motion, const EmitOptions::Start& start);

}  // namespace anholon::emit

// The motion as source text: a C99 file, or a Python module, that computes the right side of x' = f(t, x) and needs
// only math.h or NumPy.
//
// Equation i is differentiated c_i times, here symbolically; the result is linear in the leading derivatives x_j^(d_j),
// or solved for them by Newton's method, with the system Jacobian
//   J_ij = dE_i^(c_i) / dx_j^(d_j) = dE_i / dx_j^(d_j - c_i)    (theory: dae-view).
// The state is x_j^(k), k < d_j, all of order 0 first; the hidden constraints E_i^(k), k < c_i, are a function of their
// own, so that an integrator that ignores them can be checked.
//
// Inputs are an array u of their own: without it, the formulas of the model give the inputs. Outputs y and the formulas
// of events are functions of state and lead. The assignments of events are a function that changes state and parameters
// (modes are parameters). Outputs and events with derivatives beyond lead are left out, and the head of the text says
// so.
//
// A derivative that does not truly occur (structure.h) is set to zero.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "structure/structure.h"

namespace anholon {

struct RateFormulas;

// An input, which is a symbol in the equations, and its formula in t, state and parameters.
struct InputFormula {
  std::size_t control;
  Expr value;
};

struct EmitOptions {
  std::string name = "motion";  // prefix of all names in C
  std::string made_by;          // the command line, for the head of the text
  struct Start {
    double t = 0;
    std::vector<std::vector<double>> values;  // by variable: its derivatives below the leading one
    std::vector<double> leading;              // start of Newton's method; empty: zero
  };
  std::optional<Start> start;  // an initial state
  std::vector<InputFormula> inputs;
  std::vector<std::pair<std::string, Expr>> outputs;  // names and values
  const RateFormulas* rates = nullptr;                // rates of independent velocities, for Python
  std::vector<std::string> of_order;                  // parameters that determine the order of the equations
  std::vector<std::string> switching;                 // parameters that decide which constraints hold
};

// Both return the text, and throw Failure for an expression that cannot be written: an unknown function of time, a
// number beyond double.
std::string emit_c(const System& system, const Structure& structure, const EmitOptions& options);
std::string emit_python(const System& system, const Structure& structure, const EmitOptions& options);

}  // namespace anholon

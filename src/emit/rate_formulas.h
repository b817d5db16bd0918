// The motion as formulas  x' = f(t, x, u, p),  y = h(t, x, u, p)  for other programs.
//
// Rates are explicit in independent velocities (theory: quasi-velocities). Otherwise they contain further unknowns
// `lead`: accelerations, multipliers and rates of states, which satisfy  equations(t, x, u, p, lead) = 0.
#pragma once
#include <memory>

#include "system/system.h"

namespace anholon {

struct RateFormulas {
  struct Symbols {
    std::vector<std::string> names;
    Column symbols;
    std::size_t size() const { return symbols.size(); }
    void add(std::string name, Expr symbol) {
      names.push_back(std::move(name));
      symbols.push_back(symbol);
    }
  };

  std::shared_ptr<const Model> model;  // its graph holds the expressions, and its names print them
  std::string title;
  Symbols x, u, p, lead;              // p: the parameters that do not follow from others
  Column exact_parameters;            // the values of p in the model
  std::vector<std::string> meanings;  // for x: the meaning of an independent velocity; empty for the others
  Column rates;                       // rates of x, one by one
  Column equations;                   // one for each of lead
  bool linear = true;                 // true if the equations are linear in lead
  // The inputs u by the formulas of the model, in t, x, p; empty if some contain solved unknowns.
  Column input_formulas;
  Column open_input_formulas;  // the same, with u where a formula contains other inputs
  std::vector<std::string> output_names;
  Column outputs;
  std::vector<std::string> left_out;  // outputs with multipliers, which independent velocities do not have

  // An order of pivots of the matrix, row and column, that suits the start: one for each of lead.
  std::vector<std::pair<std::size_t, std::size_t>> pivots;

  double t = 0;  // the initial state
  std::vector<double> start, parameters, inputs;

  bool explicit_rates() const { return lead.size() == 0; }
  // matrix() returns d equations / d lead, row by row, and right() -equations at lead = 0:  matrix lead = right. For
  // nonlinear equations right = -equations, so that  matrix correction = right  is a step of Newton's method.
  std::vector<Column> matrix() const;
  Column right() const;
  // Returns the rows, those of rates and then those of outputs, whose formulas may have no value where some of their
  // derivatives are numbers: z + log(x) for x < 0.
  std::vector<std::size_t> rows_that_may_lack_values() const;
};

// Returns expressions with the same values in which branches that are not taken have values as well: sqrt(x) in the
// branch of x >= 0 becomes sqrt(x where x >= 0, else 1). Libraries that compute both branches then have derivatives as
// well.
Column with_guarded_branches(const Column& es);

// Returns the rates as a Python module, whose functions take the library for arrays as an argument: NumPy, JAX, or a
// replacement for CasADi, SymPy and mpmath.
std::string emit_formulas(const RateFormulas& formulas);

// Returns the rates as a C file: name_rhs(t, x, u, p, dx), and name with its Jacobian jac_name in CasADi's external
// interface, (t, x, u, p) -> (dx, y). REQUIRES: the equations are linear.
std::string emit_casadi(const RateFormulas& formulas, const std::string& name, const std::string& made_by);

}  // namespace anholon

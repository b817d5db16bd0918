// Gaussian elimination of the equations for the leading derivatives, statement by statement, in an order of pivots that
// suits the initial state.
#pragma once
#include <optional>

#include "emit/motion.h"

namespace anholon::emit {

// Row and column of each pivot, in order.
using Pivots = std::vector<std::pair<std::size_t, std::size_t>>;

struct PivotOrder {
  Pivots pivots;
  // True if a solution loses digits at the start or near it, so that the residual of the equations corrects it, with
  // the same multipliers and pivots.
  bool refined = false;
};

// Returns an order with few statements whose multipliers stay small at the start and near it (Markowitz). Returns
// nullopt if the equations are not linear in the leading derivatives, or have no such order.
std::optional<PivotOrder> elimination_at_start(const System& system, const Motion& motion,
                                               const EmitOptions::Start& start);

// The names of the entries of matrix and right side, row by row; entries that vanish have empty names.
struct EliminationNames {
  std::vector<std::string> matrix, right;
  std::string prefix;             // prefix of further names
  std::string residual;           // for a correction: statements that compute, for a solution `lead`,
  std::vector<std::string> left;  // the residuals of the equations, under these names
};

// Returns statements of Python that overwrite the entries by the solution; `lead` is the list of the solution, `suits`
// tells whether no multiplier is large.
std::string python_elimination(const PivotOrder& elimination, const EliminationNames& names);

}  // namespace anholon::emit

// Pryce's Sigma-method: how often each equation is differentiated, which derivatives are solved for, and which may be
// prescribed.
//
//   sigma_ij  order of the highest derivative of variable j that truly occurs in equation i
//   Val       highest-value transversal;  offsets  d_j - c_i >= sigma_ij, equality on it
//   J_ij      = dE_i / dx_j^(d_j - c_i), the system Jacobian
// If J is regular at a consistent point, Val = sum d - sum c is the dimension of the state: equation i is
// differentiated c_i times, x_j^(d_j) is solved for, and E_i^(k) = 0 (k < c_i) are the hidden constraints (theory:
// dae-view).
//
// "Truly" is decided numerically, not symbolically: a derivative counts if the partial derivative by it is not zero at
// random points (theory: dae-view, the jet trap).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "base/outcome.h"
#include "system/system.h"
#include "tape/tape.h"

namespace anholon {

inline constexpr int kAbsent = -1;  // no derivative of variable j occurs in equation i

struct Structure {
  std::vector<std::vector<int>> sigma;
  std::vector<int> transversal;  // equation i -> variable
  std::vector<int> c, d;
  int state_dimension = 0;          // sum d - sum c
  int degrees_of_freedom = 0;       // n - s: independent velocities
  int configuration_dimension = 0;  // n - number of holonomic constraints

  int largest_c() const;
};

// Values from which the probing points are drawn (coordinate jets by order); may be empty.
struct ProbeHints {
  std::vector<std::vector<double>> derivatives;  // [order][coordinate]
  std::vector<double> states;
  double t = 0;
  // Returns the value of a symbol; nullopt if the hints have none.
  std::optional<double> at(const Node& n) const {
    if (n.kind == Kind::time) return t;
    if (n.kind == Kind::jet && n.order < derivatives.size()) return derivatives[n.order][n.index];
    if (n.kind == Kind::state && n.order == 0 && n.index < states.size()) return states[n.index];
    return std::nullopt;
  }
};

// Returns sigma by probing near the hints; nullopt if the equations have no value there. `equations`: the equations of
// the system, compiled. The function builds no expressions, so many threads may call it at the same time.
std::optional<std::vector<std::vector<int>>> signature(const System& system, const Tape& equations,
                                                       const std::vector<double>& parameters, const ProbeHints& hints);

// Returns the assignment of variables to equations with the greatest sum of sigma: equation i -> variable. Entries
// kAbsent are forbidden; the result is empty if there is no assignment.
std::vector<int> highest_transversal(const std::vector<std::vector<int>>& sigma);

// Computes the structure. Returns the outcome `singular` if the system has no transversal (an unknown that no equation
// determines).
Outcome analyse(const System& system, const std::vector<double>& parameters, const ProbeHints& hints,
                Structure& structure);

// Replaces derivatives by zero that appear in an equation but cannot truly occur in it, because they are higher than
// those solved for: they cancel, and a stepper could not know their values.
void drop_absent(System& system, const Structure& structure);

std::string print(const System& system, const Structure& structure);

}  // namespace anholon

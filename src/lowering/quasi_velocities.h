// The equations of motion in quasi-velocities p that make the kinetic energy a sum of squares: no multipliers, no mass
// matrix.
//
// If constraints are linear in the velocities, the admissible velocities are q' = S p + s_0, and S is such that the
// velocities of the weighted points are v_c = sum_i e_ci p_i + e_c0 with sum_c m_c e_ci . e_cj = I_i for i = j, else 0,
// I_i constant. Kane's equations of the p are then explicit,
//
//   I_i p_i' = sum_a S_ai Q_a - sum_j A_ij p_j - sum_c m_c e_ci . e_c0',    A_ij = sum_c m_c e_ci . e_cj' = -A_ji     (theory: quasi-velocities).
//
// This is a first-order system for motions: if reactions are requested, they are recovered from Routh's equations.
#pragma once
#include <functional>
#include <optional>

#include "system/system.h"

namespace anholon {

// The equations in quasi-velocities, in a model that has only names and a graph of its own.
struct QuasiVelocities {
  System
      system;  // unknowns: the coordinates, the model's states, then p, as states that follow those; all of first order
  std::size_t count = 0;      // number of the p
  Column inertia;             // I: T = 1/2 sum I_i p_i^2 + terms of lower degree in p
  Column of_state;            // p in t, q, q'
  Column velocities;          // q' in t, q, p
  Column others;              // the given expressions, on the manifold
  bool clears_poles = false;  // the formulas have values at poles of constraints
  Expr determinant;           // the determinant of the system Jacobian of Routh's equations, up to a constant factor
};

// Derives the equations. `symbol`: values near the motion, by which the velocities to solve for are chosen. Returns
// nullopt if the equations are not of the kind above, there are too many velocities, formulas become long, or `others`
// contain multipliers; `why` then tells the reason, as a clause in words of the model.
std::optional<QuasiVelocities> quasi_velocities(const System& derived, const Mechanics& mechanics,
                                                std::span<const Expr> others,
                                                const std::function<double(const Node&)>& symbol, std::string& why);

}  // namespace anholon

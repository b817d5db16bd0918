// The linear model of a motion at one of its points: z' = A z in independent coordinates and velocities.
//
// With the offsets c, d of the structure, the motion near a point is determined by
//   E_i^(k) = 0,  k = 0..c_i,   in the entries  x_j^(k),  k = 0..d_j        (theory: dae-view)
// alone: equations of motion, constraints and their derivatives. Differentiated with respect to the entries they give
// as many linear equations as there are entries beside a choice of independent ones z. So every variation follows from
// those of z, and z' consists of entries again. This holds for constraints of any order; dE/dq contains the
// contribution of the multipliers to the stiffness (lambda d^2 phi/dq dq) (theory: linear-models).
//
// A steady motion is one in which the coordinates that move have no influence on the others: x, y, heading and spin of
// a disc that rolls in a circle. So may states of the file, such as an odometer. They are found, and the eigenvalues are
// those of the others.
#pragma once
#include "numeric/eigen.h"
#include "setup/scenario.h"
#include "tape/one_sided.h"

namespace anholon {

// Inputs u and outputs y of a linear model. A symbol u is a constant of the equations; B and D are derivatives with
// respect to it while all formulas of the model stay valid.
struct Signals {
  std::vector<std::string> inputs, outputs;
  Column u, y;
  std::vector<std::string> notes;  // notes about the signals
};

// z' = A z + B u,  y = C z + D u.
struct LinearModel {
  enum class Motion : std::uint8_t {
    equilibrium,
    steady,     // coordinates and states of [state] without influence move, all else rests, and A is constant
    unsteady,   // A holds for an instant only; its eigenvalues do not decide stability
    unchecked,  // perhaps steady; the check found no other point of the motion
  };
  Motion motion = Motion::unchecked;
  std::string why;                     // the reason, if unsteady or unchecked
  std::vector<std::string> eliminate;  // if unsteady: coordinates without whose velocities the motion is steady, if any
  Multi t{0};
  std::vector<std::string> states;     // names of z: x, …, x', …
  std::vector<std::string> dependent;  // entries of the state that follow from z
  std::vector<Multi> values, rates;    // z and z' on the motion
  Matrix<Multi> A, B, C, D;
  std::vector<std::string> inputs, outputs;
  std::vector<std::string> notes;    // signals that do not occur in the model
  std::string replaced;              // the note on initial values of the file that give way; also among the notes
  std::vector<std::size_t> cyclic;   // indices of z: coordinates, states of [state] that influence nothing
  std::vector<std::size_t> core;     // the others
  std::vector<Eigenvalue> spectrum;  // eigenvalues of A over the core, with vectors over the core
};
const char* name(LinearModel::Motion motion);

}  // namespace anholon

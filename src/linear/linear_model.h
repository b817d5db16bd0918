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
// a disc that rolls in a circle. These coordinates are found, and the eigenvalues are those of the others.
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
  std::vector<std::string> notes;  // about them
};

// z' = A z + B u,  y = C z + D u.
struct LinearModel {
  enum class Motion : std::uint8_t {
    equilibrium,
    steady,     // coordinates without influence move, all others rest, and A is constant
    unsteady,   // A holds for an instant only; its eigenvalues do not decide stability
    unchecked,  // perhaps steady; the check found no other point of the motion
  };
  Motion motion = Motion::unchecked;
  std::string why;  // unsteady, unchecked: the reason
  Multi t{0};
  std::vector<std::string> states;     // names of z: x, …, x', …
  std::vector<std::string> dependent;  // entries of the state that follow from z
  std::vector<Multi> values, rates;    // z and z' on the motion
  Matrix<Multi> A, B, C, D;
  std::vector<std::string> inputs, outputs;
  std::vector<std::string> notes;    // signals that do not occur in the model
  std::vector<std::size_t> cyclic;   // indices of states: coordinates that influence neither the others nor themselves
  std::vector<std::size_t> core;     // the others
  std::vector<Eigenvalue> spectrum;  // of A over the core; vectors over the core
};
const char* name(LinearModel::Motion motion);

// Derivatives and their tape, made once for all parameter values. The precision of the thread must be that of its
// construction.
class LinearPoint;
class Linearizer {
 public:
  Linearizer(Workspace& scenario, const StateChoice& choice, Signals signals = {});
  // With other values of the parameters; the initial data are solved anew. Only if `check` it is found out whether the
  // motion is steady.
  Outcome at(const std::vector<Multi>& parameters, bool check, LinearModel& out) const;

 private:
  friend class LinearPoint;
  struct Entry {
    std::size_t variable;
    int order;
  };
  struct Partial {
    std::size_t row, column;  // rows: E_i^(k), then outputs; columns: entries, then inputs
  };
  std::size_t entry(std::size_t variable, int order) const {
    return first_[variable] + static_cast<std::size_t>(order);
  }
  bool leading(std::size_t e) const { return entries_[e].order == s_.structure.d[entries_[e].variable]; }
  std::string entry_name(std::size_t e) const;
  // Looks for rows that have no derivative at the point. Returns an outcome that names an equation among them, and marks
  // outputs in `rough` by the place where they have none.
  Outcome look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                         std::vector<std::string>& rough) const;

  const Scenario& s_;
  const StateChoice& choice_;
  Signals signals_;
  std::vector<std::string> notes_;
  std::vector<Column> mass_;                       // the mass matrix
  std::vector<Entry> entries_;                     // x_j^(k), k <= d_j
  std::vector<std::size_t> first_;                 // of each variable
  std::vector<std::pair<std::size_t, int>> rows_;  // E_i^(k), k <= c_i
  std::vector<Partial> partials_;
  Tape tape_;       // values of the rows, outputs, then the partial derivatives
  OneSided sides_;  // of the rows and outputs
};

}  // namespace anholon

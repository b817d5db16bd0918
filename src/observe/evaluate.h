// Computes everything about one state: each generalized force separately, accelerations, multipliers, reactions, power,
// and the residual report. Numbers are returned as text, in any precision.
#pragma once
#include "setup/scenario.h"

namespace anholon {

struct StateReport {
  using Named = std::vector<std::pair<std::string, std::string>>;  // name -> number
  std::string t;
  Named q, qdot;
  std::vector<std::pair<std::string, std::vector<std::string>>> forces;  // Q, QR, … by coordinate
  Named derivatives;                                                     // "x''" …
  Named lambda;
  Named numbers;  // T_r, S_r, V_O, …
  std::vector<std::vector<std::string>> mass_matrix;
  struct Reaction {
    std::string body;
    std::vector<std::string> force, torque;
  };
  std::vector<Reaction> reactions;
  Named residuals;  // newton (C1), projected (C2), constraints (C3), equations, power
};

// real and long_real are computed in long double and rounded to double. `digits`: of the numbers written in the other
// precisions, and of the computation in multi.
Outcome evaluate(const Scenario& scenario, const StateChoice& choice, Precision precision, int digits,
                 StateReport& report);
// Computes in long_real if digits <= 16, otherwise in multi.
Outcome evaluate(const Scenario& scenario, const StateChoice& choice, int digits, StateReport& report);

// Residuals C1 and C2 (theory: certificate) from E - G and Phi at a state.
template <Number N>
struct NewtonResidual {
  N newton{0};     // |E - G - N| by the points themselves
  N projected{0};  // of |E|, |G|, |N|
  N largest{0};    // of |E|, |G|, |N|
};
template <Number N>
NewtonResidual<N> certify(const std::vector<N>& inertia, const std::vector<N>& force, const std::vector<N>& reaction,
                          const Matrix<N>& phi);

}  // namespace anholon

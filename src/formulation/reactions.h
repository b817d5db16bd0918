// The reactions as formulas: multipliers, generalized reactions, and what acts on each body.
//
// Routh's equations say Phi^T lambda = a, a = E - G [L 3.1, 3.2]. The rows of the dependent coordinates give the
// multipliers,
//
//   lambda = Phi_D^-T a_D                                          [L 3.5]
//
// and N_a = sum_r lambda_r dphi_r/dq_a^(m) = E_a - G_a [L 2.6, 2.7]: [L 4.4, 4.11, 4.12] are the second of these. What
// acts on a body follows from Newton's law alone (theory: certificate). Accelerations stand in all of it; for a form
// without multipliers, those of the dependent coordinates as the constraints give them.
//
// Hypotheses: ideal reactions; Phi_D is regular. Constraints that follow from others have multipliers zero.
#pragma once
#include "formulation/formulation.h"

namespace anholon {

struct ReactionFormulas {
  Column multipliers;       // one for each constraint of the model; those kept by an input have none (an invalid Expr)
  Column by_multipliers;    // N = sum lambda Phi
  Column by_motion;         // N = E - G, and zero where N vanishes identically
  std::vector<Load> loads;  // on each body
};

// `E`: the form's own elimination where it has one, else any by coordinates: of the ideal constraints.
ReactionFormulas reaction_formulas(const Mechanics& M, const Formulation& form, const Elimination& E);

}  // namespace anholon

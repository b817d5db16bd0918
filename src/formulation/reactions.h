// The reactions as formulas: multipliers, generalized reactions, and the forces and torques on each body.
//
// Routh's equations are Phi^T lambda = a, a = E - G [L 3.1, 3.2]. The rows of the dependent coordinates give the
// multipliers,
//
//   lambda = Phi_D^-T a_D                                          [L 3.5]
//
// and N_a = sum_r lambda_r dphi_r/dq_a^(m) = E_a - G_a [L 2.6, 2.7]: [L 4.4, 4.11, 4.12] are the second of these. The
// load on a body follows from Newton's law alone (theory: certificate). All formulas contain accelerations; for a form
// without multipliers, those of the dependent coordinates are expressed by the constraints.
//
// Hypotheses: ideal reactions; Phi_D is regular. Constraints that follow from others have multipliers zero.
#pragma once
#include "formulation/formulation.h"

namespace anholon {

struct ReactionFormulas {
  // one for each constraint of the model; invalid Exprs for constraints maintained by an input
  Column multipliers;
  Column by_multipliers;    // N = sum lambda Phi
  Column by_motion;         // N = E - G, and zero if N vanishes identically
  std::vector<Load> loads;  // on each body
};

// `E`: the form's own elimination of the ideal constraints if it has one, else any elimination by coordinates.
ReactionFormulas reaction_formulas(const Mechanics& M, const Formulation& form, const Elimination& E);

}  // namespace anholon

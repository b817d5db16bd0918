// The power of the reactions of each constraint, P_c = sum_r lambda_r sum_a Phi_ra q_a' (theory: certificate), written
// for a motion that satisfies the constraint:
//
//   holonomic            -lambda df/dt                     0 if f does not depend on t
//   order 1, degree d    lambda (sum Phi q' - d phi)       0 if homogeneous; affine: -lambda b; v^2 = c^2: 2 lambda c^2
//   order 2 and more     lambda sum Phi q'                 in general not 0, linear or not
#pragma once
#include "mechanics/mechanics.h"

namespace anholon {

// Returns the factor of lambda_r in the power of constraint r; the node 0 if the constraint is proved to do no work.
Expr power_factor(const Mechanics& mechanics, std::size_t r);

}  // namespace anholon

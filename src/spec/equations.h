// Published equations in a file of their own, over the names of a model:
//
//   # comment
//   4.3.psi: r^2*psi'' + … = … + 2*r^2*psi'*lambda
//       - …                                            an indented line continues the one before
//
// Beyond the names of the model: lambda.NAME, the multiplier of the constraint NAME; lambda, where there is one constraint;
// m_NAME, the varying mass of a body.
#pragma once
#include <vector>

#include "model/published.h"
#include "spec/read.h"

namespace anholon {

// All errors are collected in `diagnostics`, which then speak of `equations`.
std::vector<PublishedEquation> read_equations(const SourceText& equations, const OpenModel& model, Diagnostics& diagnostics);

}  // namespace anholon

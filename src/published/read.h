// Published equations in a file of their own, over the names of a model and of quantities derived from it
// (published/vocabulary.h):
//
//   # comment
//   let w = phi'                                   a definition of the file's own, for the lines after it
//   4.3.psi: r^2*psi'' + … = … + 2*r^2*psi'*lambda
//       - …                                            an indented line continues the one before
//   2.1: m*acc(P, inertial) = F + reaction(B)      vectors: three equations, 2.1.x, 2.1.y and 2.1.z
#pragma once
#include <vector>

#include "published/equation.h"
#include "published/vocabulary.h"

namespace anholon {

// Reads the equations. All errors are collected in `diagnostics`, whose positions refer to `equations`. Definitions are
// added to the vocabulary.
std::vector<PublishedEquation> read_equations(const SourceText& equations, Vocabulary& words, Diagnostics& diagnostics);

}  // namespace anholon

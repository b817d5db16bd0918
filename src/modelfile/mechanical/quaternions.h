// quat(e0, e1, e2, e3) is a rotation only if e0^2 + e1^2 + e2^2 + e3^2 = 1: the equation becomes a constraint of the
// model (theory: weighted-points), once for each quaternion, unless it always holds or the file contains it already.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

struct UnitNorm {
  std::string name;  // "norm.e0", by the first component that is a coordinate
  Expr phi;          // norm^2 - 1
  std::string equation;
  Span span;                          // place of quat(…)
  std::optional<std::size_t> scalar;  // the coordinate e0, if the four components are four coordinates
  std::vector<std::size_t> coordinates;
};

// Returns the constraints to add for the quaternions read so far. Throws Failure for a quaternion that is no rotation; a
// quaternion of parameters becomes an identity of the scope.
std::vector<UnitNorm> unit_norms(Scope& scope, const Model& model);

// Starts a quaternion of four coordinates whose first is not given near the identity: the default guess 0 is not a
// rotation.
void start_at_identity(const std::vector<UnitNorm>& norms, Model& model);

}  // namespace anholon

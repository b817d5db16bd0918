// The directions along which a vector equation is taken: the observer's axes, or those that `along` names.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

struct Direction {
  std::string tag;             // "x", "y", "z" of axes, "1", "2", … of a list
  std::optional<Vector> axis;  // nullopt: the observer's own axis, whose component is in the vector itself
};

// along = "frame" (a frame, a body, or a formula of a rotation) or along = ["v1", "v2"]; without it ex, ey, ez. Throws
// Failure.
std::vector<Direction> directions(const Item* along, Scope& scope);

// The same, made of length 1 and at right angles; those that are so identically are taken as they are. Throws Failure, also if
// they do not span as many dimensions.
std::vector<Direction> orthonormal_directions(const Item& along, Scope& scope);

Expr component(const Vector& v, const Direction& d, int index);

}  // namespace anholon

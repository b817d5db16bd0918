// The directions along which a vector equation is taken: the observer's axes, or those that the key `along` names.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

struct Direction {
  std::string tag;             // "x", "y", "z" of axes, "1", "2", … of a list
  std::optional<Vector> axis;  // nullopt: the observer's own axis, whose component is in the vector itself
};

// Returns the directions of along = "frame" (a frame, a body, or a formula of a rotation) or along = ["v1", "v2"]; ex,
// ey, ez if `along` is null. Throws Failure.
std::vector<Direction> directions(const Item* along, Scope& scope);

// Returns the same directions, made of length 1 and orthogonal; directions that are identically orthonormal are
// unchanged. Throws Failure, also if the directions are linearly dependent.
std::vector<Direction> orthonormal_directions(const Item& along, Scope& scope);

// Returns the hint for an equation whose one side is the vector of this formula and whose other side is a number.
std::string hint_for_component(const Syntax& vector, const Scope& scope);

Expr component(const Vector& v, const Direction& d, int index);

}  // namespace anholon

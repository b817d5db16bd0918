// Rotations of the model language: of a quaternion, of angles about given axes, and of nine numbers.
#pragma once
#include "formula/formula.h"

namespace anholon {

// From the Euler parameters e0 (scalar part) and e1, e2, e3, whose squares sum to 1: columns are the body's axes in the
// axes that it is turned from.
Rotation quaternion(Expr e0, Expr e1, Expr e2, Expr e3);

// The call euler(LETTERS, a, b, …): one turn, in rad, about each axis that a letter names, each about the axes that the
// turns before it have made. `values` are the angles. Throws Failure at the letters or at the angle that is wrong.
Rotation euler(const Syntax& call, const std::vector<Value>& values, Graph& g);

// The call matrix([[…], […], […]]), given by rows. Throws Failure where the numbers are surely no rotation.
Rotation rotation_matrix(const Syntax& call, Names& names);

}  // namespace anholon

// Rotations of the model language: from a quaternion, from angles about given axes, and from nine numbers.
#pragma once
#include "formula/formula.h"

namespace anholon {

// Returns the rotation of the Euler parameters e0 (scalar part) and e1, e2, e3, whose squares sum to 1. The columns are
// the body's axes, in components along the axes from which it is turned.
Rotation quaternion(Expr e0, Expr e1, Expr e2, Expr e3);

// Evaluates the call euler(LETTERS, a, b, …): one turn, in rad, about each axis that a letter names, each about the
// axes resulting from the turns before. `values` are the angles. Throws Failure at the wrong letters or the wrong
// angle.
Rotation euler(const Syntax& call, const std::vector<Value>& values, Graph& g);

// Evaluates the call matrix([[…], […], […]]), given by rows. Throws Failure if the numbers are certainly not a
// rotation.
Rotation rotation_matrix(const Syntax& call, Names& names);

}  // namespace anholon

// shape = "disc(R)": homogeneous solids of mass m and their central moments of inertia about the body axes. Disc, ring
// and cylinder are turned about z, the axis of a rod is x. torus(R, r): a full tube of radius r around the circle of
// radius R.
#pragma once
#include "modelfile/names/names.h"

namespace anholon {

// Reads the shape with its sizes, which are numbers or formulas of parameters. Throws Failure.
Shape read_shape(const Item& item, Scope& scope, Model& model);

// Returns the moments of inertia about x, y, z for the mass m.
Column moments(const Shape& shape, Expr m);

}  // namespace anholon

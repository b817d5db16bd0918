// The linear model of a motion at its initial state: z' = A z + B u, y = C z + D u.  (theory: linear-models)
#pragma once
#include <complex>

#include "anholon/system.h"

namespace anholon::v1 {

// Row after row.
struct Matrix {
  std::size_t rows = 0, columns = 0;
  std::vector<double> values;
  double operator()(std::size_t row, std::size_t column) const { return values[row * columns + column]; }
};

enum class Steadiness : std::uint8_t {
  equilibrium,
  steady,     // coordinates without influence move, everything else rests
  unsteady,   // A holds for an instant, and its eigenvalues say nothing of stability
  unchecked,  // perhaps steady: the check found no other point of the motion
};

struct LinearModel {
  Steadiness motion = Steadiness::unchecked;
  std::string why;                  // unsteady, unchecked: what tells so
  std::vector<std::string> states;  // independent coordinates and velocities z
  std::vector<std::string> inputs, outputs;
  std::vector<double> values;  // of z at the point
  Matrix A, B, C, D;
  std::vector<std::complex<double>>
      eigenvalues;  // of A without the coordinates that influence nothing, with multiplicity
};

// Errors: a singular configuration, eigenvalues that could not be enclosed (an outcome).
ANHOLON_API Result<LinearModel> linearize(const System& system);

}  // namespace anholon::v1

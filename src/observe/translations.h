// The coordinates that move all bodies as one, upwards against gravity or sideways, found at several places by Taylor
// arithmetic.
#pragma once
#include <cmath>
#include <optional>
#include <vector>

#include "setup/scenario.h"

namespace anholon {

// A vector of space as numbers.
struct Triple {
  double x = 0, y = 0, z = 0;
};
inline double dot(const Triple& a, const Triple& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline double norm(const Triple& a) { return std::sqrt(dot(a, a)); }

// A coordinate that moves all bodies along one direction, and the rates of the geometric constraints with it; a rate
// that is not the same everywhere is NaN.
struct Translation {
  std::size_t coordinate = 0;
  Triple along;
  std::vector<double> residuals;
};

struct Translations {
  Triple gravity;
  std::vector<std::size_t> geometric;  // the constraints of order 0, to which `residuals` belong
  std::optional<Translation> up;
  std::vector<Translation> sideways;
};

// Returns nullopt if there is no gravity, if a coordinate moves all bodies along a slope, or if a geometric constraint
// holds the system sideways as well, as a hinge does.
std::optional<Translations> translations(const Scenario& s);

}  // namespace anholon

// Finds, by Taylor arithmetic at several places, the coordinates that move all bodies as one, and the geometric
// constraints that hold these motions: floors, and grounds that are not planes.
#pragma once
#include <optional>
#include <vector>

#include "observe/floors/place_rates.h"

namespace anholon {

// A coordinate that moves all bodies along one direction, and the rates of the geometric constraints with it; a rate
// that is not the same everywhere is NaN.
struct Translation {
  std::size_t coordinate = 0;
  Triple along;
  std::vector<double> residuals;
};

struct Translations {
  std::vector<std::size_t> geometric;  // the constraints of order 0, to which `residuals` belong
  std::vector<Translation> all;
  // The unit vector against the weight, and the unit normal of the plane on which the system stands; nullopt if the
  // ground is not a plane. The normal comes from a geometric constraint that is a floor; without such a constraint it
  // is orthogonal to the translations, against the weight; or it comes from a constraint of velocities that holds one of
  // them.
  Triple up;
  std::optional<Triple> normal;
  bool across = false;  // a translation leads away from the plane
  // The gradient of each geometric constraint with respect to the place of the whole system; nullopt if it is not the
  // same everywhere.
  std::vector<std::optional<Triple>> gradients;
  bool level() const { return normal && 1 - dot(*normal, up) <= kSameRate; }
};

// Returns nullopt if there is no weight, or if the geometric constraints hold the system as a hinge, a guide or a rod
// does: they are neither planes with one normal nor heights above a ground.
std::optional<Translations> translations(const Scenario& s);

// True if events may change parameters during the motion, and with them the surfaces.
bool events_set_numbers(const Model& model);

}  // namespace anholon

#include "setup/start/orientations.h"

#include <algorithm>
#include <cmath>

#include "numeric/number.h"

namespace anholon {

// Returns by how much the axes of an orientation deviate from length 1, right angles or a right-handed order.
static double missed_by(const Rotation& r, PointValues& at) {
  double axes[3][3];
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) axes[k][i] = at(r[k][i]);
  double most = 0;
  const auto miss = [&](double v) { most = std::isnan(v) || std::abs(v) > most ? std::abs(v) : most; };
  for (int j = 0; j < 3; ++j)
    for (int k = 0; k <= j; ++k)
      miss(axes[j][0] * axes[k][0] + axes[j][1] * axes[k][1] + axes[j][2] * axes[k][2] - (j == k ? 1 : 0));
  double volume = 0;
  for (int i = 0; i < 3; ++i)
    volume += axes[0][i] * (axes[1][(i + 1) % 3] * axes[2][(i + 2) % 3] - axes[1][(i + 2) % 3] * axes[2][(i + 1) % 3]);
  miss(volume - 1);
  return most;
}

bool may_be_no_rotation(const Model& model) {
  return std::any_of(model.bodies.begin(), model.bodies.end(),
                     [](const Body& b) { return b.orientation && !b.orientation->by_turns; });
}

Outcome oriented(const Model& model, PointValues& at) {
  constexpr double kOfRotation = 1e-9;
  for (const Body& b : model.bodies) {
    if (!b.orientation || b.orientation->by_turns) continue;
    if (const double miss = missed_by(*b.orientation, at); !(miss <= kOfRotation))
      return {OutcomeKind::inconsistent,
              "the orientation of '" + b.name +
                  "' is no rotation at the start: its axes miss length 1, right angles or " +
                  "a right-handed order by " + number_text(miss, 3),
              "the columns of matrix(…) are the new axes: give other initial values, or constraints that hold them at "
              "length 1 and right angles"};
  }
  return {};
}

}  // namespace anholon

// The observer's path in the inertial frame, from its angular velocity and the acceleration of its origin (theory:
// weighted-points).
//
//   A' = A [omega x],  A the rotation from the observer's axes to the inertial ones, A = 1 at t = 0
//   r' = A v, v the given velocity of the origin along the observer's axes; without one r'' = A a0, at rest in r = 0 at t = 0
//
// The path is only for pictures. It is computed by Runge-Kutta steps of order 4, much shorter than a turn.
#pragma once
#include <array>
#include <vector>

#include "model/model.h"

namespace anholon {

struct ObserverPose {
  std::array<double, 4> quaternion{1, 0, 0, 0};  // w, x, y, z: observer's axes -> inertial axes
  std::array<double, 3> origin{0, 0, 0};         // along inertial axes
};

// Returns the poses at these times, ascending or descending.
std::vector<ObserverPose> observer_path(const Model& model, const std::vector<double>& parameters,
                                        const std::vector<double>& times);

}  // namespace anholon

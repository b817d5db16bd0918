// The equations of a motion as a function x' = f(t, x), for integrators and optimizers of others.
#pragma once
#include <span>

#include "anholon/system.h"

namespace anholon::v1 {

struct DynamicsOptions {
  // In independent velocities, which satisfy the constraints whatever their values are (theory: quasi-velocities), if
  // the equations have them; else in all velocities.
  bool minimal = true;
};

struct StateName {
  std::string name;     // "x", "x'", an independent velocity "u1", a state of the model
  std::string meaning;  // of an independent velocity: its formula in coordinates and velocities; else empty
};

// Immutable, cheap to copy, and safe to use from many threads. All numbers are in SI units.
class ANHOLON_API Dynamics {
 public:
  // What x holds: coordinates, velocities, then the model's states.
  const std::vector<StateName>& states() const;
  bool minimal() const;
  double start_time() const;
  const std::vector<double>& start() const;  // x at the initial state

  // The rates of `count` states at time t. Number i of state k is at [i * count + k] of both arrays, of the size
  // states() * count. NaN where the equations have no solution. A state has the same bits alone and among others.
  // REQUIRES: the sizes fit.
  void rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates) const;

  // The exact derivatives of the rates of one state x by x and by the model's parameters, in the order of
  // Model::parameters: number (i, k) at [i * columns + k]. NaN where the equations have no solution.
  // REQUIRES: not minimal; the size fits.
  struct Jacobian {
    std::size_t states = 0, parameters = 0;
    std::vector<double> by_state, by_parameter;  // states x states, states x parameters
  };
  Jacobian jacobian(double t, const std::vector<double>& x) const;

  // One state from coordinates q, velocities qdot and the model's states z, and back. REQUIRES: the sizes fit.
  std::vector<double> from_motion(double t, const std::vector<double>& q, const std::vector<double>& qdot,
                                  const std::vector<double>& z = {}) const;
  struct Motion {
    std::vector<double> q, qdot, z;
  };
  Motion to_motion(double t, const std::vector<double>& x) const;

  struct Data;
  explicit Dynamics(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

 private:
  std::shared_ptr<const Data> data_;
};

// Errors: equations that are not solved for accelerations alone, as constraints of order 2 and more ask for, redundant
// constraints, formulas that kernels do not know (diagnostics that say which).
ANHOLON_API Result<Dynamics> dynamics(const System& system, const DynamicsOptions& options = {});

}  // namespace anholon::v1

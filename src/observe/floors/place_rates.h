// Computes by Taylor arithmetic how the places of all bodies, constraints and weights change with one coordinate; no
// expression is made.
#pragma once
#include <vector>

#include "observe/floors/triple.h"
#include "setup/scenario.h"

namespace anholon {

class PlaceRates {
 public:
  // `constraints`: those whose residuals are needed, of order 0 or 1.
  PlaceRates(Workspace& s, const std::vector<std::size_t>& constraints);
  // True if the places and residuals depend on t, parameters, coordinates and velocities alone.
  bool known() const { return known_; }

  // Goes to the start, moved by `away` along every coordinate; or to the place with these coordinates.
  void go(double away);
  void go(double t, const std::vector<double>& q);
  // Computes the rates with a coordinate (order 0), or with its velocity (order 1).
  void look(std::size_t coordinate, unsigned order = 0);

  Triple center(std::size_t body) const { return direction(3 * body); }
  // The rates of the axes of a body: nine numbers, none for a particle.
  std::vector<double> axes(std::size_t body) const;
  bool turns(std::size_t body) const;
  double residual(std::size_t k) const { return rate(first_residual_ + k); }
  // The force of gravity per mass at a body (the value, not a rate); without gravity, the sum of the constant forces on
  // it.
  Triple weight(std::size_t body) const;

 private:
  Column outputs(const std::vector<std::size_t>& constraints);
  double rate(std::size_t root) const { return machine_.series(tape_.roots[root])[1]; }
  Triple direction(std::size_t root) const { return {rate(root), rate(root + 1), rate(root + 2)}; }

  const Scenario& s_;
  std::vector<std::size_t> axes_;  // the begin of the axes of each body, and the end of the last ones
  std::size_t first_residual_ = 0, first_weight_ = 0;
  Tape tape_;
  Machine<double> machine_;
  std::vector<Node> symbols_;  // of the inputs
  bool known_ = true;
  double t_ = 0;
  std::vector<double> q_, qd_;
};

}  // namespace anholon

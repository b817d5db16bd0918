// Angles that are about to fail: a body whose orientation is made of three angles has an angular velocity
//   omega = sum_a omega_a q_a',  a = 1, 2, 3,
// and the three vectors omega_a fall into a plane at the singularity of the angles (theta = 0 of Euler's). Watched is
//   |omega_1 . (omega_2 x omega_3)| / (|omega_1| |omega_2| |omega_3|).  (theory: integrals)
// Angles of joints are none of these: neither those that lie in a plane always, nor those of which some turn another
// body with inertia.
#pragma once
#include "setup/scenario.h"

namespace anholon {

struct AngleTriple {
  std::string body, angles;  // "disc", "psi, theta, phi"
  Vector rates[3];           // omega_a, components along the body's own axes
};
// Of the bodies with three angles, each set of angles once.
std::vector<AngleTriple> angle_triples(const Model& model);

// In doubles, whatever the numbers of the motion are: a measure of nearness needs no more.
class AngleWatch {
 public:
  AngleWatch(Workspace& scenario, const std::vector<double>& parameters);
  // At a time of the motion; coordinate(a) is the value of coordinate a there.
  template <class F>
  void see(double t, F coordinate) {
    if (!outputs_) return;
    outputs_->evaluate_at([&](const Node& n, NodeId) { return n.kind == Kind::time ? t : coordinate(n.index); });
    note(t);
  }
  void set_parameters(const std::vector<double>& parameters) {
    if (outputs_) outputs_->set_parameters(parameters);
  }
  // The smallest value so far and when, for every triple.
  struct Least {
    double value = 1, t = 0;
  };
  std::vector<AngleTriple> triples;
  std::vector<Least> least;

 private:
  static Column expressions(const Model& model, const std::vector<AngleTriple>& triples);
  void note(double t);
  std::optional<OutputTape<double>> outputs_;  // if there are any
};

}  // namespace anholon

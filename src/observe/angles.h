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

template <Number W>
class AngleWatch {
 public:
  AngleWatch(Workspace& scenario, const std::vector<W>& parameters);
  void see(const Expansion<W>& point);
  void set_parameters(const std::vector<W>& parameters) {
    if (outputs_) outputs_->set_parameters(parameters);
  }
  // The smallest value so far and when, for every triple.
  struct Least {
    double value = 1;
    W t{0};
  };
  std::vector<AngleTriple> triples;
  std::vector<Least> least;

 private:
  static Column expressions(const std::vector<AngleTriple>& triples);
  std::optional<OutputTape<W>> outputs_;  // where there are any
};

extern template class AngleWatch<long double>;
extern template class AngleWatch<Quad>;
extern template class AngleWatch<Multi>;

}  // namespace anholon

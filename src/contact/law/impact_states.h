// The jumps, at an impact, of states whose rates contain forces of contacts.
//
//   z' = R(lambda), linear in the forces:   z+ - z- = sum_k P_k dR/dlambda_k, at the mean of the velocities before and after
//
// P are the impulses. With the power of the forces as the rate, z is their work, and the jumps of all contacts together
// equal that of the kinetic energy (Kelvin): T+ - T- is the sum of all P times the mean velocities of their gaps and
// slips.
#pragma once
#include "contact/law/impact.h"

namespace anholon {

class ImpactStates {
 public:
  ImpactStates(Workspace& s, const std::vector<Contact>& contacts);
  // Adds the jumps to the states. `after`: the velocities after the impact; `at` contains those before.
  void add(ContactState& at, const std::vector<long double>& after, const Impulses& impulses);

 private:
  struct Slope {
    std::size_t state;
    ContactForces::Force force;
  };
  const Graph& graph_;
  std::vector<Slope> slopes_;  // dR/dlambda, the outputs of the tape
  std::optional<Tape> tape_;
  std::optional<Machine<long double>> machine_;
};

}  // namespace anholon

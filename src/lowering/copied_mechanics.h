// The ingredients of equations, copied to a graph of their own, so that rewriting them leaves the graph of the model
// unchanged.
#pragma once
#include "system/system.h"

namespace anholon {

struct CopiedMechanics {
  struct Point {
    Expr weight, speed2;
    Vector place;
    bool of_mass;  // true for a mass point, false for an axis vector
  };
  std::vector<Point> points;
  Column forces, constraints, state_rates, others;  // constraints: those of the system
  std::shared_ptr<Model> model;                     // names, masses and inputs
};
CopiedMechanics copied_mechanics(const Mechanics& mechanics, const System& derived, std::span<const Expr> others);

}  // namespace anholon

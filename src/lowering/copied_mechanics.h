// What equations are made of, copied to a graph of its own: whoever writes them anew there leaves the graph of the
// model as it was.
#pragma once
#include "system/system.h"

namespace anholon {

struct CopiedMechanics {
  struct Point {
    Expr weight, speed2;
    Vector place;
    bool of_mass;  // no axis vector
  };
  std::vector<Point> points;
  Column forces, constraints, state_rates, others;  // constraints: those of the system
  std::shared_ptr<Model> model;                     // names, masses and inputs
};
CopiedMechanics copied_mechanics(const Mechanics& mechanics, const System& derived, std::span<const Expr> others);

}  // namespace anholon

// Contacts by shapes, body = "ball" in a [[contact]]: gap and slip velocity of a point, a ball, a disc, a torus or the
// corners of a box on a plane, on a ball or in a bowl.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "modelfile/names/names.h"

namespace anholon {

struct Touching {
  Expr gap;
  Vector slip;                     // the velocity of the material point of the body, relative to the touched surface
  std::vector<Vector> directions;  // two, tangential
  Vector normal;                   // of length 1, away from the touched surface
  // The angular velocity of a body with an orientation, relative to the touched surface.
  std::optional<Vector> rate;
  std::string shape;        // point, ball, disc, torus or box
  std::vector<Expr> sizes;  // sizes of the shape and of the touched ball or bowl, which are positive
};

// Returns the place of contact of a point, a ball, a disc or a torus; for a box the corners, without those whose gaps
// are equal. Throws Failure.
std::vector<Touching> read_touching(const Item& contact, Scope& scope, Model& model);

}  // namespace anholon

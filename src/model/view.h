// The picture of a model: what is drawn beside its bodies, and from where it is looked at. All vectors are components
// along the observer's axes; nothing here has a part in the motion.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "formula/formula.h"

namespace anholon {

// The homogeneous solid that a body has the inertia of, or is drawn as.
struct Shape {
  std::string kind;         // "disc", "ball", …
  std::vector<Expr> sizes;  // of numbers and parameters
};

struct View {
  enum class Kind : std::uint8_t { solid, line, trace, vector };
  struct Element {
    std::string name;
    Kind kind = Kind::solid;
    std::string color;           // "#a33" or "#aa3333"; empty: of the page
    std::optional<Shape> shape;  // of a solid
    std::vector<Vector>
        places;  // a line's corners; else where it is (a solid named as a body: none, that is where the body is)
    std::optional<Rotation> axes;  // of a solid
    std::optional<Vector> vector;
    Span span;
  };
  std::vector<Element> elements;
  std::vector<std::pair<std::string, Vector>> points;  // of [point], in the order of the file
  std::optional<Vector> camera, target;                // from where, and whereto
  std::optional<Vector> up;                            // a constant direction; without it z
  std::optional<Expr> floor;                           // height of a plane z = const
  bool no_floor = false;                               // floor = false
  std::string follow;                                  // the body or point that stays in the middle
  std::vector<std::string> hidden;                     // bodies and points that are not drawn
};

}  // namespace anholon

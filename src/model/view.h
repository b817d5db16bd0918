// The picture of a model: the elements that are drawn beside its bodies, and the camera. All vectors are components
// along the observer's axes; the motion does not depend on the picture.
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "formula/formula.h"

namespace anholon {

// The homogeneous solid whose inertia a body has, or as which a body is drawn.
struct Shape {
  std::string kind;         // "disc", "ball", …
  std::vector<Expr> sizes;  // formulas of numbers and parameters
};

struct View {
  enum class Kind : std::uint8_t { solid, line, trace, vector };
  struct Element {
    std::string name;
    Kind kind = Kind::solid;
    std::string color;           // "#a33" or "#aa3333"; if empty, the page chooses
    std::optional<Shape> shape;  // of a solid
    std::vector<Vector>
        places;  // corners of a line, or the place of another element; empty for a solid named like a body, which is
                 // drawn at the body
    std::optional<Rotation> axes;  // of a solid
    std::optional<Vector> vector;
    Span span;
  };
  std::vector<Element> elements;
  std::vector<std::pair<std::string, Vector>> points;  // points of [point], in the order of the file
  std::optional<Vector> camera, target;                // place of the camera, and the point it looks at
  std::optional<Vector> up;                            // a constant direction; z if absent
  std::optional<Expr> floor;                           // height of a plane z = const
  bool no_floor = false;                               // floor = false
  std::string follow;                                  // the body or point that stays in the centre of the picture
  std::vector<std::string> hidden;                     // bodies and points that are not drawn
};

}  // namespace anholon

#include "modelfile/mechanical/shapes.h"

#include <array>

#include "modelfile/names/constant.h"
#include "numeric/number.h"

namespace anholon {

namespace {

// The moments are m (c_0 s_0^2 + c_1 s_1^2 + …) with the sizes s.
struct Solid {
  const char* name;
  const char* call;
  std::vector<const char*> sizes;                 // their names
  const char* meaning;                            // meaning of the sizes
  std::array<std::array<Rational, 3>, 3> moment;  // about x, y, z; coefficients of the squares
};

const std::vector<Solid>& solids() {
  static const auto row = [](Rational a, Rational b = 0, Rational c = 0) { return std::array<Rational, 3>{a, b, c}; };
  static const Rational half(1, 2), third2(2, 3), fourth(1, 4), fifth2(2, 5), twelfth(1, 12);
  static const std::vector<Solid> list = {
      {"disc", "disc(R)", {"R"}, "R is the radius", {row(fourth), row(fourth), row(half)}},
      {"ring", "ring(R)", {"R"}, "R is the radius", {row(half), row(half), row(1)}},
      {"ball", "ball(R)", {"R"}, "R is the radius", {row(fifth2), row(fifth2), row(fifth2)}},
      {"shell", "shell(R)", {"R"}, "R is the radius", {row(third2), row(third2), row(third2)}},
      {"rod", "rod(l)", {"l"}, "l is the length", {row(0), row(twelfth), row(twelfth)}},
      {"box",
       "box(a, b, c)",
       {"a", "b", "c"},
       "a, b and c are the lengths of its edges",
       {row(0, twelfth, twelfth), row(twelfth, 0, twelfth), row(twelfth, twelfth, 0)}},
      {"ellipsoid",
       "ellipsoid(a, b, c)",
       {"a", "b", "c"},
       "a, b and c are the half axes",
       {row(0, Rational(1, 5), Rational(1, 5)), row(Rational(1, 5), 0, Rational(1, 5)),
        row(Rational(1, 5), Rational(1, 5), 0)}},
      {"torus",
       "torus(R, r)",
       {"R", "r"},
       "R is the radius of the circle in the middle of the tube, r that of the tube",
       {row(half, Rational(5, 8)), row(half, Rational(5, 8)), row(1, Rational(3, 4))}},
      {"cylinder",
       "cylinder(R, h)",
       {"R", "h"},
       "R is the radius, h the height",
       {row(fourth, twelfth), row(fourth, twelfth), row(half, 0)}},
  };
  return list;
}

std::string hint_of(const Solid& s) { return std::string(s.call) + ": " + s.meaning; }

const Solid* find(const std::string& name) {
  for (const Solid& s : solids())
    if (name == s.name) return &s;
  return nullptr;
}

}  // namespace

Shape read_shape(const Item& item, Scope& scope, Model& model) {
  if (item.kind != Item::Kind::string) throw Failure(item.span, "a shape is a text", "shape = \"disc(R)\"");
  const Syntax s = parse_formula(item.formula);
  const Solid* solid = s.op == Syntax::Op::call ? find(s.text) : nullptr;
  if (!solid) {
    std::vector<std::string> names;
    std::string calls;
    for (const Solid& k : solids()) {
      names.push_back(k.name);
      calls += (calls.empty() ? "" : ", ") + std::string(k.call);
    }
    if (s.op == Syntax::Op::name && find(s.text))
      throw Failure(s.span, "the shape '" + s.text + "' has no size", hint_of(*find(s.text)));
    const std::string near = did_you_mean(s.text, names);
    throw Failure(s.span,
                  "there is no shape '" + s.text.substr(0, 40) + "'" +
                      (near.empty() ? "" : "; did you mean '" + near + "'?"),
                  "the shapes are " + calls);
  }
  const std::size_t sizes = solid->sizes.size();
  if (s.args.size() != sizes)
    throw Failure(s.span,
                  s.text + " takes " + std::to_string(sizes) + (sizes == 1 ? " size, " : " sizes, ") +
                      std::to_string(s.args.size()) + (s.args.size() == 1 ? " is" : " are") + " given",
                  hint_of(*solid));
  Shape shape{s.text, {}};
  for (const Syntax& a : s.args) {
    const Expr size = evaluate_number(a, scope);
    for (NodeId id : symbols({&size, 1}))
      if (model.graph->node(id).kind != Kind::parameter)
        throw Failure(a.span, "a size of a shape is a number or a formula of parameters",
                      "give the inertia of what changes its shape: inertia = …");
    const auto value = constant_value(model, size);
    if (value && !(*value > 0))
      throw Failure(a.span,
                    "the size " + std::string(solid->sizes[shape.sizes.size()]) + " of the " + shape.kind + " is " +
                        number_text(*value, 6) + ": a size is positive",
                    hint_of(*solid));
    shape.sizes.push_back(size);
  }
  if (shape.kind == "torus")
    if (const auto hole = constant_value(model, shape.sizes[0] - shape.sizes[1]); hole && *hole < 0)
      throw Failure(s.span,
                    "the tube of the torus is thicker than its middle circle: r is " +
                        number_text(*constant_value(model, shape.sizes[1]), 6) + ", and it is at most R, which is " +
                        number_text(*constant_value(model, shape.sizes[0]), 6),
                    hint_of(*solid));
  return shape;
}

Column moments(const Shape& shape, Expr m) {
  const Solid& solid = *find(shape.kind);
  Column out;
  for (const auto& coefficients : solid.moment) {
    std::vector<std::pair<Rational, Expr>> parts;
    for (std::size_t k = 0; k < solid.sizes.size(); ++k)
      if (coefficients[k] != 0) parts.push_back({coefficients[k], m * pow(shape.sizes[k], 2)});
    out.push_back(m.graph->sum(parts));
  }
  return out;
}

}  // namespace anholon

#include "modelfile/names/along.h"

#include "expr/normal.h"

namespace anholon {

std::vector<Direction> directions(const Item* along, Scope& scope) {
  std::vector<Direction> list;
  if (!along) {
    for (const char* tag : {"x", "y", "z"}) list.push_back({tag, std::nullopt});
    return list;
  }
  if (along->kind == Item::Kind::array) {
    if (along->items.empty() || along->items.size() > 3)
      throw Failure(along->span, "'along' is a frame, or a list of one to three vectors",
                    "along = \"T\" or along = [\"T.x\", \"T.y\"]");
    for (const Item& i : along->items) {
      const Vector v = scope.vector(i);
      if (is_zero(v)) throw Failure(i.span, "a component along the zero vector", "along = [\"ex\", \"ey\"]");
      list.push_back({std::to_string(list.size() + 1), v});
    }
    return list;
  }
  if (along->kind != Item::Kind::string)
    throw Failure(along->span, "'along' is a frame, or a list of one to three vectors",
                  "along = \"T\" or along = [\"T.x\", \"T.y\"]");
  const Syntax s = parse_formula(along->formula);
  const Value v = evaluate(s, scope);
  const Rotation* axes = std::get_if<Rotation>(&v);
  if (const BodyName* b = std::get_if<BodyName>(&v)) axes = &scope.orientation(b->index, s.span);
  if (!axes)
    throw Failure(
        s.span, std::string("the axes of a frame are expected, this is ") + type_name(v),
        std::holds_alternative<Vector>(v) ? "one direction is a list of one: along = [\"" + along->text() + "\"]" : "");
  for (int k = 0; k < 3; ++k) list.push_back({std::string(1, "xyz"[k]), (*axes)[k]});
  return list;
}

std::vector<Direction> orthonormal_directions(const Item& along, Scope& scope) {
  std::vector<Direction> list = directions(&along, scope);
  for (std::size_t i = 0; i < list.size(); ++i) {
    Vector v = *list[i].axis;
    for (std::size_t k = 0; k < i; ++k)
      if (const Expr part = dot(v, *list[k].axis); !proved_zero(part)) v = v - part * *list[k].axis;
    const Expr square = dot(v, v);
    if (proved_zero(square))
      throw Failure(along.span, "two directions of a contact are parallel",
                    "leave one out, or two directions at an angle: along = [\"ex\", \"ey\"]");
    if (!proved_zero(square - 1)) v = pow(square, Rational(-1, 2)) * v;
    list[i].axis = v;
  }
  return list;
}

std::string hint_for_component(const Syntax& vector, const Scope& scope) {
  if (vector.op == Syntax::Op::member && vector.args[0].op == Syntax::Op::name)
    if (const std::size_t* body = scope.find_body(vector.args[0].text); body && scope.has_orientation(*body))
      return print(vector) + " is an axis of the body; the coordinate of its centre is " + vector.args[0].text +
             ".center." + vector.text;
  const bool short_enough = vector.op == Syntax::Op::name || vector.op == Syntax::Op::call ||
                            vector.op == Syntax::Op::member || vector.op == Syntax::Op::prime;
  const std::string v = short_enough ? print(vector) : "(" + print(vector) + ")";
  return "an equation of numbers takes a component of the vector: " + v + ".x, or dot(" + print(vector) + ", ex)";
}

Expr component(const Vector& v, const Direction& d, int index) { return d.axis ? dot(v, *d.axis) : v[index]; }

}  // namespace anholon

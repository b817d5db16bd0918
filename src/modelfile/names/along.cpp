#include "modelfile/names/along.h"

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
      if (is_zero(v)) throw Failure(i.span, "a component along the zero vector");
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

Expr component(const Vector& v, const Direction& d, int index) { return d.axis ? dot(v, *d.axis) : v[index]; }

}  // namespace anholon

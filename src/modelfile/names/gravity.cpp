// The field of gravity at a place.
#include "modelfile/names/names.h"

namespace anholon {

void Scope::set_gravity(const Item& field) { gravity_ = &field; }

Vector Scope::gravity_at(const Vector& place, Span use) {
  if (!gravity_) throw Failure(use, "there is no [gravity] field");
  if (here_) throw Failure(use, "the field of [gravity] is defined through itself");
  here_ = place;
  const auto arguments = std::exchange(arguments_, {});
  const auto restore = [&] { here_.reset(), arguments_ = arguments; };
  try {
    const Vector field = vector(*gravity_);
    restore();
    return field;
  } catch (...) {
    restore();
    throw;
  }
}

std::vector<Vector> Scope::gravity_gradient_at(const Vector& place, Span use) {
  Graph& g = *model_.graph;
  // Three symbols that no model has represent the place, so that the field can be differentiated by it.
  constexpr std::uint32_t kPlace = 200'000;
  const Column here = {g.quasi(kPlace, 0), g.quasi(kPlace + 1, 0), g.quasi(kPlace + 2, 0)};
  const Vector field = gravity_at({here[0], here[1], here[2]}, use);
  for (int i = 0; i < 3; ++i)
    for (NodeId id : symbols({&field[i], 1}))
      if (g.node(id).kind == Kind::quasi && g.node(id).order > 0)
        throw Failure(gravity_->span, "the field depends on the velocity of 'here'",
                      "a gradient is taken of a field of the place");
  const Column rows[3] = {gradient(field.x, here), gradient(field.y, here), gradient(field.z, here)};
  std::vector<Vector> by;
  bool uniform = true;
  for (std::size_t k = 0; k < 3; ++k) {
    const Expr parts[] = {rows[0][k], rows[1][k], rows[2][k]};
    const Column at = substitute(parts, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::quasi && n.index >= kPlace ? place[static_cast<int>(n.index - kPlace)] : Expr{};
    });
    by.push_back({at[0], at[1], at[2]});
    uniform = uniform && is_zero(by.back());
  }
  if (uniform) by.clear();
  return by;
}

}  // namespace anholon

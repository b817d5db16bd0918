#include "formula/roots.h"

namespace anholon {

namespace {

struct Sides {
  Expr condition, above, below;  // the value where the condition is >= 0, and elsewhere
};

// Returns the values of a term on both sides; nullopt if the term has no sides.
std::optional<Sides> sides_of(Graph& g, NodeId term) {
  const Node& n = g.node(term);
  const std::span<const Term> operands = g.terms(term);
  const auto operand = [&](std::size_t k) { return Expr{&g, operands[k].node}; };
  if (n.kind == Kind::select) return Sides{operand(0), operand(1), operand(2)};
  if (n.kind == Kind::function && static_cast<Function>(n.index) == Function::abs)
    return Sides{operand(0), operand(0), -operand(0)};
  return std::nullopt;
}

// Returns sides of which one is 0: for a sum, by its first term that leads to such sides; for anything else, its own
// sides.
std::optional<Sides> with_a_zero_side(Expr base) {
  Graph& g = *base.graph;
  const auto zero_side = [](const std::optional<Sides>& s) { return s && (is_zero(s->above) || is_zero(s->below)); };
  if (g.node(base.id).kind != Kind::sum) {
    const std::optional<Sides> own = sides_of(g, base.id);
    return zero_side(own) ? own : std::nullopt;
  }
  const std::vector<Term> terms(g.terms(base.id).begin(), g.terms(base.id).end());
  for (const Term& t : terms) {
    std::optional<Sides> s = sides_of(g, t.node);
    if (!s) continue;
    const Rational weight = g.rational(t.weight);
    const Expr rest = base - weight * Expr{&g, t.node};
    s->above = rest + weight * s->above;
    s->below = rest + weight * s->below;
    if (zero_side(s)) return s;
  }
  return std::nullopt;
}

}  // namespace

Expr power_by_sides(Expr base, Rational e) {
  if (e.is_integer() || e < 0) return pow(base, e);
  const std::optional<Sides> s = with_a_zero_side(base);
  if (!s) return pow(base, e);
  const auto side = [&](Expr value) { return is_zero(value) ? value : pow(value, e); };
  return select(s->condition, side(s->above), side(s->below));
}

}  // namespace anholon

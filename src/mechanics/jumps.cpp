#include "mechanics/jumps.h"

#include <algorithm>
#include <cmath>

#include "expr/diff.h"
#include "expr/normal.h"
#include "tape/point.h"

namespace anholon {

namespace {

// Choices inside of choices are taken one after the other, up to this depth.
constexpr int kDeepest = 16;
// Products of terms for a proof; a longer one is given up, and the expression is said to jump.
constexpr long kMostOfProof = 1'000'000;

bool varies(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (e.graph->node(id).kind != Kind::parameter) return true;
  return false;
}

Expr operand(const Graph& g, Expr e, std::size_t k) { return {e.graph, g.terms(e.id)[k].node}; }

bool is_function(const Node& n, Function f) {
  return n.kind == Kind::function && n.index == static_cast<std::uint32_t>(f);
}

// What decides between two formulas in a node; a handle with graph == nullptr if nothing does.
Expr decides(Expr e) {
  const Graph& g = *e.graph;
  const Node& n = g.node(e.id);
  return n.kind == Kind::select || is_function(n, Function::sign) ? operand(g, e, 0) : Expr{};
}

// 1 or -1 if a is a positive or negative multiple of b; else 0.
int same_sign(Expr a, Expr b) {
  if (a == b) return 1;
  if (a == -b) return -1;
  const std::optional<Expr> ratio = is_zero(b) ? std::nullopt : expanded(a / b, kMostOfProof);
  return ratio && is_number(*ratio) ? sgn(number_value(*ratio)) : 0;
}

// e where s has that sign.
Expr on_side(Expr e, Expr s, int side) {
  Graph& g = *e.graph;
  for (int depth = 0; depth < kDeepest; ++depth) {
    std::unordered_map<NodeId, Expr> by;
    for (NodeId id : reachable({&e, 1})) {
      const Expr part{&g, id};
      const bool magnitude = is_function(g.node(id), Function::abs);
      const Expr own = magnitude ? operand(g, part, 0) : decides(part);
      const int sign = own.graph ? side * same_sign(own, s) : 0;
      if (sign == 0) continue;
      if (magnitude)
        by.emplace(id, sign > 0 ? own : -own);
      else if (g.node(id).kind == Kind::select)
        by.emplace(id, operand(g, part, sign > 0 ? 1 : 2));
      else
        by.emplace(id, g.number(sign));
    }
    if (by.empty()) return e;
    e = replace_nodes({&e, 1}, by).front();
  }
  return e;
}

std::optional<Expr> denominator(Expr e) {
  const std::optional<NormalForm> f = normal_form(e, {}, kMostOfProof);
  return f ? std::optional(expression(f->denominator, f->generators)) : std::nullopt;
}

// e with the choices that parameters alone decide.
Expr chosen(Expr e, const std::vector<double>& parameters) {
  constexpr double kOnIt = 1e-9;
  Graph& g = *e.graph;
  for (int depth = 0; depth < kDeepest; ++depth) {
    PointValues at([&](const Node& n) { return n.kind == Kind::pi ? 3.14159265358979323846 : parameters[n.index]; });
    std::unordered_map<NodeId, Expr> by;
    for (NodeId id : reachable({&e, 1})) {
      const Expr part{&g, id}, s = decides(part);
      if (!s.graph || varies(s)) continue;
      const double value = at(s);
      if (!(std::abs(value) > kOnIt)) continue;
      by.emplace(id,
                 g.node(id).kind == Kind::select ? operand(g, part, value > 0 ? 1 : 2) : g.number(value > 0 ? 1 : -1));
    }
    if (by.empty()) return e;
    e = replace_nodes({&e, 1}, by).front();
  }
  return e;
}

// e where s = 0, by a symbol in which s is linear with a coefficient of parameters.
std::optional<Expr> where_zero(Expr e, Expr s) {
  const Graph& g = *e.graph;
  for (NodeId id : symbols({&s, 1})) {
    if (g.node(id).kind == Kind::parameter || g.node(id).kind == Kind::pi) continue;
    const Expr symbol{e.graph, id}, slope = partial(s, symbol);
    if (varies(slope) || is_zero(slope)) continue;
    const Expr root = expanded(symbol - s / slope, kMostOfProof).value_or(symbol - s / slope);
    const Expr there = substitute({&e, 1}, [&](NodeId other) { return other == id ? root : Expr{}; }).front();
    return there;
  }
  return std::nullopt;
}

bool vanishes_with(Expr difference, Expr s, const std::vector<double>& parameters) {
  difference = chosen(difference, parameters);
  if (is_zero(difference) || proved_zero(difference)) return true;
  if (const std::optional<Expr> there = where_zero(difference, s))
    if (proved_zero(chosen(*there, parameters))) return true;
  const std::optional<Expr> own = denominator(difference), divided = denominator(difference / s);
  if (!own || !divided) return false;
  const std::optional<Expr> more = expanded(*divided / *own, kMostOfProof);
  return more && !varies(*more);
}

}  // namespace

bool may_jump(Expr e, const std::vector<double>& parameters) {
  Graph& g = *e.graph;
  for (NodeId id : reachable({&e, 1})) {
    const Expr part{&g, id};
    const Node n = g.node(id);
    if (n.kind == Kind::lookup && g.step_function(n.index).smooth < 0 && varies(operand(g, part, 0))) return true;
    if (n.kind == Kind::atan2 && varies(part)) {
      const Expr turned = replace_nodes({&e, 1}, {{id, part + 2 * g.pi()}}).front();
      if (!proved_zero(turned - e)) return true;
    }
    const Expr s = decides(part);
    if (s.graph && varies(s) && !vanishes_with(on_side(e, s, 1) - on_side(e, s, -1), s, parameters)) return true;
  }
  return false;
}

}  // namespace anholon

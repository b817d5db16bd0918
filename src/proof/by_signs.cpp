#include "proof/by_signs.h"

#include <algorithm>
#include <set>
#include <unordered_map>

#include "base/diagnostic.h"
#include "expr/diff.h"
#include "expr/normal.h"

namespace anholon {

namespace {

constexpr std::size_t kMostDeciding = 3;

bool is(const Node& n, Function f) { return n.kind == Kind::function && static_cast<Function>(n.index) == f; }

// Returns the node that decides: the operand of sign and abs, the condition of a choice.
std::optional<NodeId> decides(const Graph& g, NodeId id) {
  const Node& n = g.node(id);
  if (!is(n, Function::sign) && !is(n, Function::abs) && n.kind != Kind::select) return std::nullopt;
  return g.terms(id)[0].node;
}

// An expression as a factor times a part that is the same for all its multiples.
struct Multiple {
  Rational factor;
  Expr of;
};

Multiple as_multiple(Graph& g, NodeId id) {
  Expr e{&g, id};
  if (const auto full = expanded(e)) e = *full;
  if (g.node(e.id).kind != Kind::sum) return {1, e};
  const Rational c = g.rational(g.terms(e.id)[0].weight);
  return {c, Rational(1 / c) * e};
}

// Returns the symbol in which u is linear with a number as its coefficient, and its value where u is zero.
std::optional<std::pair<Expr, Expr>> solved(Expr u) {
  Graph& g = *u.graph;
  for (const NodeId id : symbols({&u, 1})) {
    const Expr s{&g, id}, slope = partial(u, s);
    if (!is_number(slope) || is_zero(slope)) continue;
    return std::pair{s, Rational(-1 / number_value(slope)) * put(u, {s}, {g.zero()})};
  }
  return std::nullopt;
}

class Cases {
 public:
  Cases(Expr e, const std::function<bool(Expr)>& zero) : g_(*e.graph), zero_(zero) {}

  // True if `zero` holds of e in all cases; the signs of `depth` expressions in e are chosen already.
  bool hold(Expr e, std::size_t depth) {
    const std::optional<Expr> u = first_deciding(e);
    if (!u) return zero_(e);
    if (depth == kMostDeciding) return false;
    if (!hold(with_sign(e, *u, 1), depth + 1) || !hold(with_sign(e, *u, -1), depth + 1)) return false;
    const auto root = solved(*u);
    const Expr at_zero = with_sign(e, *u, 0);
    return hold(root ? put(at_zero, {root->first}, {root->second}) : at_zero, depth + 1);
  }

 private:
  // Returns an expression that decides and contains no other one.
  std::optional<Expr> first_deciding(Expr e) {
    for (const NodeId id : reachable({&e, 1}))
      if (const auto u = decides(g_, id)) return as_multiple(g_, *u).of;
    return std::nullopt;
  }

  // Replaces what the sign of u decides. The branches may contain further choices by u, which are decided as well.
  Expr with_sign(Expr e, Expr u, int sign) {
    for (;;) {
      const Expr next = decided(e, u, sign);
      if (next == e) return e;
      e = next;
    }
  }
  Expr decided(Expr e, Expr u, int sign) {
    std::unordered_map<NodeId, Expr> by;
    for (const NodeId id : reachable({&e, 1})) {
      const auto at = decides(g_, id);
      if (!at) continue;
      const Multiple m = as_multiple(g_, *at);
      if (!(m.of == u)) continue;
      const int own = sgn(m.factor) * sign;
      const std::span<const Term> t = g_.terms(id);
      if (is(g_.node(id), Function::sign))
        by.emplace(id, g_.number(own));
      else if (is(g_.node(id), Function::abs))
        by.emplace(id, Rational(own) * Expr{&g_, *at});
      else
        by.emplace(id, Expr{&g_, t[own >= 0 ? 1 : 2].node});
    }
    return replace_nodes({&e, 1}, by)[0];
  }

  Graph& g_;
  const std::function<bool(Expr)>& zero_;
};

}  // namespace

bool shown_zero_by_signs(Expr e, const std::function<bool(Expr)>& zero) {
  Graph& g = *e.graph;
  const std::vector<NodeId> ids = reachable({&e, 1});
  const bool chooses = std::any_of(ids.begin(), ids.end(), [&](NodeId id) { return g.node(id).kind == Kind::select; });
  if (!chooses) return false;
  try {
    return Cases(e, zero).hold(e, 0);
  } catch (const Failure&) {
    return false;  // a denominator vanishes in a case
  }
}

}  // namespace anholon

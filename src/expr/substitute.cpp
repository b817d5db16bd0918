#include <algorithm>
#include <unordered_map>

#include "base/assert.h"
#include "expr/diff.h"

namespace anholon {

static bool is_symbol(Kind k) {
  switch (k) {
  case Kind::time:
  case Kind::jet:
  case Kind::parameter:
  case Kind::mass:
  case Kind::multiplier:
  case Kind::given:
  case Kind::quasi:
  case Kind::state:
  case Kind::control:
    return true;
  case Kind::number:
  case Kind::pi:
  case Kind::sum:
  case Kind::product:
  case Kind::function:
  case Kind::atan2:
  case Kind::select:
  case Kind::lookup:
    return false;
  }
  return false;
}

// `replacement(id)` of any node returns the new expression; a handle with graph == nullptr keeps the node.
static Column rebuild(std::span<const Expr> es, const std::function<Expr(NodeId)>& replacement) {
  if (es.empty()) return {};
  Graph& g = *es[0].graph;
  std::unordered_map<NodeId, Expr> image;
  for (NodeId id : reachable(es)) {
    const Node n = g.node(id);
    const Expr r = replacement(id);
    if (r.graph || n.view_count == 0) {
      image[id] = r.graph ? r : Expr{&g, id};
      continue;
    }
    const std::vector<Term> terms(g.summands(id).begin(), g.summands(id).end());
    const bool same =
        std::all_of(terms.begin(), terms.end(), [&](const Term& t) { return image[t.node].id == t.node; });
    if (same) {
      image[id] = {&g, id};
      continue;
    }
    switch (n.kind) {
    case Kind::sum: {
      std::vector<std::pair<Rational, Expr>> parts;
      for (const Term& t : terms) parts.push_back({g.rational(t.weight), image[t.node]});
      image[id] = g.sum(parts);
      break;
    }
    case Kind::product: {
      std::vector<std::pair<Expr, Rational>> parts;
      for (const Term& t : terms) parts.push_back({image[t.node], g.rational(t.weight)});
      image[id] = g.product(parts);
      break;
    }
    case Kind::function:
      image[id] = g.apply(static_cast<Function>(n.index), image[terms[0].node]);
      break;
    case Kind::atan2:
      image[id] = g.arctangent2(image[terms[0].node], image[terms[1].node]);
      break;
    case Kind::select:
      image[id] = g.select(image[terms[0].node], image[terms[1].node], image[terms[2].node]);
      break;
    case Kind::lookup:
      image[id] = g.lookup(n.index, image[terms[0].node]);
      break;
    case Kind::number:
    case Kind::pi:
    case Kind::time:
    case Kind::jet:
    case Kind::parameter:
    case Kind::mass:
    case Kind::multiplier:
    case Kind::given:
    case Kind::quasi:
    case Kind::state:
    case Kind::control:
      break;
    }
  }
  Column result;
  for (Expr e : es) result.push_back(image[e.id]);
  return result;
}

Column substitute(std::span<const Expr> es, const std::function<Expr(NodeId)>& replacement) {
  if (es.empty()) return {};
  const Graph& g = *es[0].graph;
  return rebuild(es, [&](NodeId id) { return is_symbol(g.node(id).kind) ? replacement(id) : Expr{}; });
}

Column put(std::span<const Expr> es, const Column& from, const Column& to) {
  std::unordered_map<NodeId, Expr> image;
  for (std::size_t i = 0; i < from.size(); ++i)
    if (!(from[i] == to[i])) image.emplace(from[i].id, to[i]);
  if (image.empty()) return {es.begin(), es.end()};
  return substitute(es, [&](NodeId id) {
    const auto it = image.find(id);
    return it == image.end() ? Expr{} : it->second;
  });
}

Expr put(Expr e, const Column& from, const Column& to) { return put(std::span<const Expr>(&e, 1), from, to)[0]; }

Column replace_nodes(std::span<const Expr> es, const std::unordered_map<NodeId, Expr>& replacement) {
  return rebuild(es, [&](NodeId id) {
    const auto it = replacement.find(id);
    return it == replacement.end() ? Expr{} : it->second;
  });
}

std::vector<NodeId> symbols(std::span<const Expr> es) {
  std::vector<NodeId> found;
  for (NodeId id : reachable(es))
    if (is_symbol(es[0].graph->node(id).kind)) found.push_back(id);
  return found;
}

int jet_order(Expr e) {
  int order = -1;
  for (NodeId id : symbols({&e, 1})) {
    const Node& n = e.graph->node(id);
    if (n.kind == Kind::jet) order = std::max(order, static_cast<int>(n.order));
  }
  return order;
}

static Column combine(const Column& a, const Column& b, int sign) {
  if (b.empty()) return a;
  if (a.empty()) return sign > 0 ? b : -b;
  ANHOLON_ASSERT(a.size() == b.size());
  Column r;
  for (std::size_t i = 0; i < a.size(); ++i) r.push_back(sign > 0 ? a[i] + b[i] : a[i] - b[i]);
  return r;
}

Column operator+(const Column& a, const Column& b) { return combine(a, b, 1); }
Column operator-(const Column& a, const Column& b) { return combine(a, b, -1); }
Column operator-(const Column& a) { return Rational(-1) * a; }

Column operator*(const Rational& c, const Column& a) {
  Column r;
  for (Expr e : a) r.push_back(c * e);
  return r;
}

}  // namespace anholon

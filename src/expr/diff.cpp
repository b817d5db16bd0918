#include "expr/diff.h"

#include <algorithm>
#include <unordered_set>

#include "base/assert.h"

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

Expr derivative(Function f, [[maybe_unused]] Expr u, [[maybe_unused]] Expr v) {
  switch (f) {
#define ROW(name, formula, ...)                                                                                        \
  case Function::name:                                                                                                 \
    return formula;
#include "expr/elementary.def"
#undef ROW
  }
  return {};
}

// Computes the partial derivatives of a node with respect to its summands, in their order.
static void local_partials(Graph& g, NodeId id, Column& out) {
  out.clear();
  const Node n = g.node(id);
  const std::vector<Term> terms(g.summands(id).begin(), g.summands(id).end());
  switch (n.kind) {
  case Kind::sum:
    for (const Term& t : terms) out.push_back(g.number(g.rational(t.weight)));
    return;
  case Kind::product:
    for (std::size_t i = 0; i < terms.size(); ++i) {
      std::vector<std::pair<Expr, Rational>> factors;
      const Rational exponent = g.rational(terms[i].weight);
      for (std::size_t j = 0; j < terms.size(); ++j) {
        const Rational& r = g.rational(terms[j].weight);
        factors.push_back({Expr{&g, terms[j].node}, j == i ? Rational(r - 1) : r});
      }
      out.push_back(exponent * g.product(factors));
    }
    return;
  case Kind::function:
    out.push_back(derivative(static_cast<Function>(n.index), Expr{&g, terms[0].node}, Expr{&g, id}));
    return;
  case Kind::atan2: {
    // Each node is made by a statement of its own: the order of terms is the order of their creation, which must not
    // depend on the compiler.
    const Expr y{&g, terms[0].node}, x{&g, terms[1].node}, y2 = y * y, x2 = x * x, r2 = x2 + y2;
    out.push_back(x / r2);
    out.push_back(-(y / r2));
    return;
  }
  case Kind::lookup:  // constant between its knots
    out.push_back(g.zero());
    return;
  case Kind::select: {
    const Expr s{&g, terms[0].node};
    out.push_back(g.zero());
    out.push_back(select(s, g.one(), g.zero()));
    out.push_back(select(s, g.zero(), g.one()));
    return;
  }
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
    return;
  }
}

static Expr rate_of_symbol(Graph& g, const Node& n) {
  switch (n.kind) {
  case Kind::time:
    return g.one();
  case Kind::jet:
    return g.jet(n.index, n.order + 1U);
  case Kind::multiplier:
    return g.multiplier(n.index, n.order + 1U);
  case Kind::given:
    return g.given(n.index, n.order + 1U);
  case Kind::quasi:
    return g.quasi(n.index, n.order + 1U);
  case Kind::state:
    return g.state(n.index, n.order + 1U);
  case Kind::control:
    return g.control(n.index, n.order + 1U);
  case Kind::number:
  case Kind::pi:
  case Kind::parameter:
  case Kind::mass:
  case Kind::sum:
  case Kind::product:
  case Kind::function:
  case Kind::atan2:
  case Kind::select:
  case Kind::lookup:
    return g.zero();
  }
  return g.zero();
}

// Returns the nodes of `es` and below whose rate is not known yet, operands before users.
static std::vector<NodeId> without_rate(Graph& g, std::span<const Expr> es) {
  std::vector<NodeId> found;
  std::unordered_set<NodeId> seen;
  const auto add = [&](NodeId id) {
    if (!g.rate(id).graph && seen.insert(id).second) found.push_back(id);
  };
  for (Expr e : es) add(e.id);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Term& t : g.summands(found[i])) add(t.node);
  std::sort(found.begin(), found.end());
  return found;
}

Column total_derivative(std::span<const Expr> es) {
  if (es.empty()) return {};
  Graph& g = *es[0].graph;
  Column partials;
  for (NodeId id : without_rate(g, es)) {
    const Node n = g.node(id);
    if (n.view_count == 0) {
      g.set_rate(id, rate_of_symbol(g, n).id);
      continue;
    }
    const std::vector<Term> terms(g.summands(id).begin(), g.summands(id).end());
    std::vector<std::pair<Rational, Expr>> parts;
    const bool constant =
        std::all_of(terms.begin(), terms.end(), [&](const Term& t) { return is_zero(g.rate(t.node)); });
    if (constant) {
      g.set_rate(id, g.zero().id);
      continue;
    }
    if (n.kind == Kind::select) {
      // The rate is taken branch by branch: an expression must not be evaluated outside its own branch.
      g.set_rate(id, select(Expr{&g, terms[0].node}, g.rate(terms[1].node), g.rate(terms[2].node)).id);
      continue;
    }
    if (n.kind == Kind::sum) {
      for (const Term& t : terms) parts.push_back({g.rational(t.weight), g.rate(t.node)});
    } else {
      local_partials(g, id, partials);
      for (std::size_t i = 0; i < terms.size(); ++i)
        if (!is_zero(g.rate(terms[i].node))) parts.push_back({1, partials[i] * g.rate(terms[i].node)});
    }
    g.set_rate(id, g.sum(parts).id);
  }
  Column result;
  for (Expr e : es) result.push_back(g.rate(e.id));
  return result;
}

Expr total_derivative(Expr e) { return total_derivative(std::span<const Expr>(&e, 1))[0]; }

Expr total_derivative(Expr e, unsigned times) {
  for (; times > 0; --times) e = total_derivative(e);
  return e;
}

Column pullback(std::span<const Expr> outputs, std::span<const Expr> seeds, std::span<const Expr> wanted) {
  ANHOLON_ASSERT(outputs.size() == seeds.size());
  if (wanted.empty()) return {};
  Graph& g = *wanted[0].graph;
  const std::vector<NodeId> ids = reachable(outputs);
  std::unordered_map<NodeId, std::vector<std::pair<Rational, Expr>>> adjoint;
  std::unordered_map<NodeId, bool> depends;
  depends.reserve(ids.size());
  for (Expr s : wanted) depends[s.id] = true;
  for (NodeId id : ids)
    for (const Term& t : g.summands(id))
      if (depends[t.node]) depends[id] = true;
  for (std::size_t c = 0; c < outputs.size(); ++c) adjoint[outputs[c].id].push_back({1, seeds[c]});
  Column partials;
  std::unordered_map<NodeId, Expr> found;
  for (std::size_t k = ids.size(); k-- > 0;) {
    const NodeId id = ids[k];
    if (!depends[id]) continue;
    const auto it = adjoint.find(id);
    if (it == adjoint.end()) continue;
    const Expr bar = g.sum(it->second);
    adjoint.erase(it);
    if (is_zero(bar)) continue;
    const Node n = g.node(id);
    if (n.view_count == 0) {
      const auto [it_found, fresh] = found.try_emplace(id, bar);
      if (!fresh) it_found->second = it_found->second + bar;
      continue;
    }
    const std::vector<Term> terms(g.summands(id).begin(), g.summands(id).end());
    if (n.kind == Kind::select) {
      const Column a = gradient(Expr{&g, terms[1].node}, wanted), b = gradient(Expr{&g, terms[2].node}, wanted);
      for (std::size_t i = 0; i < wanted.size(); ++i) {
        const Expr part = bar * select(Expr{&g, terms[0].node}, a[i], b[i]);
        const auto [it_found, fresh] = found.try_emplace(wanted[i].id, part);
        if (!fresh) it_found->second = it_found->second + part;
      }
      continue;
    }
    if (n.kind == Kind::sum) {
      for (const Term& t : terms)
        if (depends[t.node]) adjoint[t.node].push_back({g.rational(t.weight), bar});
    } else {
      local_partials(g, id, partials);
      for (std::size_t i = 0; i < terms.size(); ++i)
        if (depends[terms[i].node]) adjoint[terms[i].node].push_back({1, bar * partials[i]});
    }
  }
  Column result;
  for (Expr s : wanted) {
    const auto it = found.find(s.id);
    result.push_back(it == found.end() ? g.zero() : it->second);
  }
  return result;
}

Column gradient(Expr e, std::span<const Expr> wanted) {
  const Expr one = e.graph->one();
  return pullback({&e, 1}, {&one, 1}, wanted);
}

Expr partial(Expr e, Expr symbol) { return gradient(e, {&symbol, 1})[0]; }

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

// Partial derivatives by one reverse sweep over the graph.
#include <map>
#include <optional>
#include <unordered_map>

#include "base/assert.h"
#include "expr/derivatives/local_partials.h"
#include "expr/derivatives/point_gradient.h"
#include "expr/derivatives/squares.h"
#include "expr/diff.h"

namespace anholon {

namespace {

using Parts = std::vector<std::pair<Rational, Expr>>;

class ReverseSweep {
 public:
  // `at_kinks`: roots of sums of squares are treated as in point_gradient; nullopt: by the rules alone.
  ReverseSweep(std::span<const Expr> wanted, std::optional<AtKinks> at_kinks)
      : g_(*wanted[0].graph), wanted_(wanted), at_kinks_(at_kinks) {}

  Column run(std::span<const Expr> outputs, std::span<const Expr> seeds) {
    const std::vector<NodeId> ids = reachable(outputs);
    depends_.reserve(ids.size());
    for (Expr s : wanted_) depends_[s.id] = true;
    for (NodeId id : ids)
      for (const Term& t : g_.summands(id))
        if (depends_[t.node]) depends_[id] = true;
    for (std::size_t c = 0; c < outputs.size(); ++c) adjoint_[outputs[c].id].push_back({1, seeds[c]});
    for (std::size_t k = ids.size(); k-- > 0;) {
      const NodeId id = ids[k];
      if (!depends_[id]) continue;
      if (at_kinks_) join_roots(id);
      const auto it = adjoint_.find(id);
      if (it == adjoint_.end()) continue;
      const Expr bar = g_.sum(it->second);
      adjoint_.erase(it);
      if (!is_zero(bar)) spread(id, bar);
    }
    Column result;
    for (Expr s : wanted_) {
      const auto it = found_.find(s.id);
      result.push_back(it == found_.end() ? g_.zero() : it->second);
    }
    return result;
  }

 private:
  // Gives the operands of a node their parts of its adjoint.
  void spread(NodeId id, Expr bar) {
    const Node n = g_.node(id);
    if (n.view_count == 0) {
      add(id, bar);
      return;
    }
    const std::vector<Term> terms(g_.summands(id).begin(), g_.summands(id).end());
    if (n.kind == Kind::select) {
      const Column a = gradient_of({&g_, terms[1].node}), b = gradient_of({&g_, terms[2].node});
      for (std::size_t i = 0; i < wanted_.size(); ++i)
        add(wanted_[i].id, bar * select(Expr{&g_, terms[0].node}, a[i], b[i]));
    } else if (n.kind == Kind::sum) {
      for (const Term& t : terms)
        if (depends_[t.node]) adjoint_[t.node].push_back({g_.rational(t.weight), bar});
    } else {
      local_partials(g_, id, partials_);
      const bool product = n.kind == Kind::product;
      for (std::size_t i = 0; i < terms.size(); ++i) {
        if (!depends_[terms[i].node]) continue;
        if (product && at_kinks_ && is_root_of_squares(terms[i]))
          roots_[terms[i].node][g_.rational(terms[i].weight)].push_back({1, bar * without(terms, i)});
        else
          adjoint_[terms[i].node].push_back({1, bar * partials_[i]});
      }
    }
  }

  void add(NodeId symbol, Expr part) {
    const auto [it, fresh] = found_.try_emplace(symbol, part);
    if (!fresh) it->second = it->second + part;
  }

  Column gradient_of(Expr e) {
    const Expr one = g_.one();
    return ReverseSweep(wanted_, at_kinks_).run({&e, 1}, {&one, 1});
  }

  bool is_root_of_squares(const Term& factor) {
    const Rational& r = g_.rational(factor.weight);
    if (!(r > 0 && r < 1)) return false;
    const auto [it, fresh] = squares_.try_emplace(factor.node, false);
    if (fresh) it->second = is_sum_of_squares(g_, factor.node);
    return it->second;
  }

  // Returns the product of the factors other than factor i.
  Expr without(const std::vector<Term>& terms, std::size_t i) {
    std::vector<std::pair<Expr, Rational>> factors;
    for (std::size_t j = 0; j < terms.size(); ++j)
      if (j != i) factors.push_back({Expr{&g_, terms[j].node}, g_.rational(terms[j].weight)});
    return g_.product(factors);
  }

  // Adds the parts of the roots of a node to its adjoint. All products with these roots have been visited.
  void join_roots(NodeId id) {
    const auto of = roots_.find(id);
    if (of == roots_.end()) return;
    const Expr u{&g_, id};
    for (const auto& [r, parts] : of->second) {
      const Expr by_root = g_.sum(parts);
      if (is_zero(by_root)) continue;
      const Expr part = r * by_root * pow(u, Rational(r - 1));
      const bool treated = r >= Rational(1, 2) || !holds_root_of(by_root, id);
      adjoint_[id].push_back({1, treated ? at_point(u, by_root, part) : part});
    }
    roots_.erase(of);
  }

  // Returns the part of the adjoint, or 0 where the root contributes nothing to derivatives.
  Expr at_point(Expr u, Expr by_root, Expr part) {
    switch (*at_kinks_) {
    case AtKinks::no_value:
      return is_number(by_root) ? part : select(-abs(by_root), by_root, part);
    case AtKinks::between:
      return select(-u, g_.zero(), part);
    }
    return part;
  }

  Graph& g_;
  std::span<const Expr> wanted_;
  std::optional<AtKinks> at_kinks_;
  std::unordered_map<NodeId, Parts> adjoint_;
  std::unordered_map<NodeId, std::map<Rational, Parts>> roots_;  // u, and the parts of df/dw by the exponent of w
  std::unordered_map<NodeId, bool> depends_, squares_;
  std::unordered_map<NodeId, Expr> found_;
  Column partials_;
};

}  // namespace

Column pullback(std::span<const Expr> outputs, std::span<const Expr> seeds, std::span<const Expr> wanted) {
  ANHOLON_ASSERT(outputs.size() == seeds.size());
  return wanted.empty() ? Column{} : ReverseSweep(wanted, std::nullopt).run(outputs, seeds);
}

Column gradient(Expr e, std::span<const Expr> wanted) {
  const Expr one = e.graph->one();
  return pullback({&e, 1}, {&one, 1}, wanted);
}

Expr partial(Expr e, Expr symbol) { return gradient(e, {&symbol, 1})[0]; }

Column point_gradient(Expr e, std::span<const Expr> wanted, AtKinks at_kinks) {
  if (wanted.empty()) return {};
  const Expr one = e.graph->one();
  return ReverseSweep(wanted, at_kinks).run({&e, 1}, {&one, 1});
}

}  // namespace anholon

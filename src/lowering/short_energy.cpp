#include "lowering/short_energy.h"

#include <algorithm>

namespace anholon {

namespace {

// A matrix with longer entries is not eliminated.
constexpr std::size_t kLongest = 100;

// The square root `varying` in e = constant varying^2; `whole`: it contains no root.
struct Root {
  Expr constant, varying;
  bool whole;
};

Root root_of(Expr e) {
  Graph& g = *e.graph;
  if (g.node(e.id).kind == Kind::sum && g.terms(e.id).size() == 1) {
    const Term t = g.terms(e.id)[0];
    const Root r = root_of(Expr{&g, t.node});
    return {g.rational(t.weight) * r.constant, r.varying, r.whole};
  }
  std::vector<std::pair<Expr, Rational>> factors{{e, Rational(1)}}, constant, out, rest;
  if (g.node(e.id).kind == Kind::product) {
    factors.clear();
    for (const Term& t : g.terms(e.id)) factors.push_back({Expr{&g, t.node}, g.rational(t.weight)});
  }
  for (const auto& [base, exponent] : factors)
    if (is_constant(base))
      constant.push_back({base, exponent});
    else if (const Rational half = exponent / 2; half.is_integer())
      out.push_back({base, half});
    else
      rest.push_back({base, exponent});
  return {g.product(constant), g.product(out) * sqrt(g.product(rest)), rest.empty()};
}

}  // namespace

bool ShortEnergy::diagonalize(Rows M, const Column& v, PointValues& at, Tidy& tidy,
                              const std::function<Expr(Expr)>& named) {
  const std::size_t l = v.size();
  const Expr zero = v[0].graph->zero();
  std::vector<std::size_t> left(l);
  for (std::size_t i = 0; i < l; ++i) left[i] = i;
  std::vector<Root> roots;
  while (!left.empty()) {
    // Constant pivots come first, then squares, then others.
    std::size_t best = left.size();
    std::pair<int, std::size_t> cost{3, SIZE_MAX};
    Root root{zero, zero, false};
    for (std::size_t x = 0; x < left.size(); ++x) {
      const Expr d = M[left[x]][left[x]];
      if (!(at(d) > 0)) return false;
      const Root r = root_of(d);
      const std::pair<int, std::size_t> c{is_constant(d) ? 0 : r.whole ? 1 : 2, node_count(d)};
      if (c < cost) best = x, cost = c, root = r;
    }
    const std::size_t k = left[best];
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
    Column L(l, zero);
    for (const std::size_t j : left)
      if (!is_zero(M[j][k])) {
        if (node_count(M[j][k]) + node_count(M[k][k]) > kLongest) return false;
        L[j] = tidy(M[j][k] / M[k][k]);
      }
    for (const std::size_t i : left)
      for (const std::size_t j : left)
        if (j >= i && !is_zero(L[i]) && !is_zero(L[j])) M[i][j] = M[j][i] = tidy(M[i][j] - L[i] * M[j][k]);
    order_.push_back(k);
    above_.push_back(std::move(L));
    roots.push_back(root);
    inertia.push_back(root.constant);
    pivots.push_back(M[k][k]);
  }
  v_by_p.assign(l, Column(l, zero));
  for (std::size_t i = l; i-- > 0;) {
    const std::size_t k = order_[i];
    p_by_v.insert(p_by_v.begin(), roots[i].varying * (v[k] + dot(above_[i], v)));
    v_by_p[k][i] = pow(roots[i].varying, -1);
    if (!roots[i].whole) v_by_p[k][i] = named(v_by_p[k][i]);
    for (std::size_t x = i + 1; x < l; ++x) {
      Column of_x;
      for (std::size_t j = 0; j < l; ++j) of_x.push_back(v_by_p[j][x]);
      v_by_p[k][x] = tidy(-dot(above_[i], of_x));
    }
  }
  return true;
}

Column ShortEnergy::v_in(const Column& p, const std::function<Expr(Expr)>& named) const {
  Column v(p.size(), p[0].graph->zero());
  for (std::size_t i = p.size(); i-- > 0;) v[order_[i]] = named(v_by_p[order_[i]][i] * p[i] - dot(above_[i], v));
  return v;
}

}  // namespace anholon

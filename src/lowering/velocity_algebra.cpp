#include "lowering/velocity_algebra.h"

#include <algorithm>

#include "print/arrange.h"

namespace anholon {

namespace {
// The least and largest number of nodes of formulas that are rewritten, and the limit of products of terms.
constexpr std::size_t kShort = 6, kLong = 64;
constexpr long kWork = 400;
}  // namespace

std::size_t node_count(Expr e) { return reachable({&e, 1}).size(); }

std::size_t varying_nodes(Expr e) {
  const std::vector<NodeId> all = reachable({&e, 1});
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [&](NodeId id) { return !is_constant({e.graph, id}); }));
}

bool is_constant(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (const Kind k = e.graph->node(id).kind; k != Kind::pi && k != Kind::parameter) return false;
  return true;
}

bool contains(Expr e, const Column& v) {
  for (NodeId id : symbols({&e, 1}))
    if (std::any_of(v.begin(), v.end(), [&](Expr x) { return x.id == id; })) return true;
  return false;
}

Expr written_out(Expr e, std::size_t first, const Column& rates) {
  const auto series = [&](NodeId id) {
    const Node& n = e.graph->node(id);
    return n.kind == Kind::jet && n.index >= first ? total_derivative(rates[n.index - first], n.order) : Expr{};
  };
  for (;;) {
    const Expr out = substitute({&e, 1}, series)[0];
    if (out == e) return e;
    e = out;
  }
}

Expr dot(const Column& a, const Column& b) {
  std::vector<Expr> terms{a[0].graph->zero()};
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!is_zero(a[i]) && !is_zero(b[i])) terms.push_back(a[i] * b[i]);
  return sum(terms);
}

Expr Tidy::operator()(Expr e) {
  const std::size_t size = node_count(e);
  if (size < kShort || size > kLong) return e;
  const auto [known, fresh] = known_.try_emplace(e.id, e);
  if (!fresh) return known->second;
  const std::optional<NormalForm> plain = normal_form(e, {}, kWork);
  if (!plain) return e;
  // There is nothing to arrange in a monomial.
  const bool monomial = plain->numerator.size() <= 1 && plain->denominator.size() <= 1;
  return known->second = monomial ? expression(*plain).value_or(e) : arranged(e, {}, plain);
}

Linear linear(Expr e, const Column& v, Tidy& tidy) {
  Column values(v.size(), e.graph->zero());
  Linear l{{}, put(e, v, values)};
  for (Expr& one : values) {
    one = e.graph->one();
    l.by.push_back(tidy(put(e, v, values) - l.rest));
    one = e.graph->zero();
  }
  return l;
}

}  // namespace anholon

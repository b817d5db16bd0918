#include "tape/point.h"

#include <algorithm>
#include <vector>

#include "base/stop.h"
#include "tape/function_value.h"

namespace anholon {

namespace {

// Most weights are small integers.
template <Number N>
N number_of(const Rational& r) {
  if (r.is_integer() && abs(r.get_num()) < 1'000'000) return N(static_cast<int>(r.to_long()));
  return from_rational<N>(r);
}

}  // namespace

template <Number N>
N ValuesAt<N>::evaluate(const Graph& g, NodeId id) const {
  const Node& n = g.node(id);
  switch (n.kind) {
  case Kind::number:
    return number_of<N>(g.value(id));
  case Kind::pi:
    return pi<N>();
  case Kind::sum: {
    N s(0);
    for (const Term& t : g.summands(id)) s += number_of<N>(g.rational(t.weight)) * known(t.node);
    return s;
  }
  case Kind::product: {
    N p(1);
    for (const Term& t : g.terms(id)) {
      const Rational& e = g.rational(t.weight);
      p *= e == 1 ? known(t.node) : pow(known(t.node), number_of<N>(e));
    }
    return p;
  }
  case Kind::function:
    return function_value(static_cast<Function>(n.index), known(g.terms(id)[0].node));
  case Kind::atan2:
    return atan2(known(g.terms(id)[0].node), known(g.terms(id)[1].node));
  case Kind::time:
  case Kind::jet:
  case Kind::parameter:
  case Kind::mass:
  case Kind::multiplier:
  case Kind::given:
  case Kind::quasi:
  case Kind::state:
  case Kind::control:
    return symbol_(n);
  case Kind::select:
    return known(g.terms(id)[!(known(g.terms(id)[0].node) < N(0)) ? 1 : 2].node);
  case Kind::lookup: {
    const StepFunction& f = g.step_function(n.index);
    const N& x = known(g.terms(id)[0].node);
    std::size_t k = 0;
    while (k < f.knots.size() && !(x < from_rational<N>(f.knots[k]))) ++k;
    return from_rational<N>(f.values[k]);
  }
  }
  return N(0);
}

template <Number N>
N ValuesAt<N>::operator()(Expr e) {
  look_for_stop();
  const Graph& g = *e.graph;
  if (place_.size() <= e.id) place_.resize(g.size(), 0);
  constexpr std::uint32_t kFound = ~std::uint32_t{0};
  std::vector<NodeId> found;
  const auto find = [&](NodeId id) {
    if (place_[id] == 0) place_[id] = kFound, found.push_back(id);
  };
  find(e.id);
  for (std::size_t i = 0; i < found.size(); ++i)
    for (const Term& t : g.summands(found[i])) find(t.node);
  std::sort(found.begin(), found.end());
  for (NodeId id : found) {
    N value = evaluate(g, id);
    values_.push_back(std::move(value));
    place_[id] = static_cast<std::uint32_t>(values_.size());
  }
  return known(e.id);
}

template class ValuesAt<double>;
template class ValuesAt<Multi>;

}  // namespace anholon

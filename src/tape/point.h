// Values of expressions at one point, stored node by node: for choices (pivots, coordinates), never for results.
#pragma once
#include <functional>
#include <vector>

#include "expr/expr.h"
#include "numeric/number.h"

namespace anholon {

template <Number N>
class ValuesAt {
 public:
  // `symbol` returns the value of every symbol (t, q_a^(k), parameters, …).
  explicit ValuesAt(std::function<N(const Node&)> symbol) : symbol_(std::move(symbol)) {}
  N operator()(Expr e);

 private:
  N evaluate(const Graph& g, NodeId id) const;
  const N& known(NodeId id) const { return values_[place_[id] - 1]; }

  std::function<N(const Node&)> symbol_;
  std::vector<std::uint32_t> place_;  // index of a node among the values, counted from 1; 0 if it has none
  std::vector<N> values_;
};

extern template class ValuesAt<double>;
extern template class ValuesAt<Multi>;
using PointValues = ValuesAt<double>;

}  // namespace anholon

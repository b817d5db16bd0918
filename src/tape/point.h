// Values of expressions at one point, node by node and remembered: for choices (which pivot, which coordinate), never for
// results.
#pragma once
#include <functional>
#include <unordered_map>

#include "expr/expr.h"

namespace anholon {

class PointValues {
 public:
  // `symbol` gives the value of every symbol (t, q_a^(k), parameters, …).
  explicit PointValues(std::function<double(const Node&)> symbol) : symbol_(std::move(symbol)) {}
  double operator()(Expr e);

 private:
  double evaluate(const Graph& g, NodeId id) const;

  std::function<double(const Node&)> symbol_;
  std::unordered_map<NodeId, double> known_;
};

}  // namespace anholon

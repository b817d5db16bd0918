// Powers with formulas as exponents. a^b is exp(b*log(a)) in a graph, so exp(b*log(a) + c*log(d) + e) is a^b d^c exp(e).
#pragma once
#include <optional>
#include <utility>
#include <vector>

#include "expr/expr.h"

namespace anholon {

// A factor times powers of nodes.
struct FactorOfExponent {
  Rational factor;
  std::vector<std::pair<NodeId, Rational>> of;
};

// base^(constant + the sum of terms)
struct GeneralPower {
  NodeId base;
  Rational constant;
  std::vector<FactorOfExponent> terms;
};

// The powers times exp(constant + rest), a sum of nodes with their coefficients.
struct GeneralPowers {
  std::vector<GeneralPower> powers;
  Rational constant = 0;
  std::vector<std::pair<NodeId, Rational>> rest;

  // The nodes of which these are made, each as often as it occurs.
  std::vector<NodeId> operands() const;
};

// The node exp(…) as powers; nullopt if none of them has a formula as its exponent.
std::optional<GeneralPowers> general_powers(const Graph& g, NodeId id);

// Powers of one node in place of their product: base^b base^k is base^(b + k).
void join_powers(std::vector<GeneralPower>& powers, GeneralPower more);

// The part c b log(a) of an exponent, with a factor c and powers b of nodes; nullopt if `node`, which has the
// coefficient c, is no such product.
struct PowerParts {
  NodeId base;
  Rational factor;
  std::vector<std::pair<NodeId, Rational>> exponent;
};
std::optional<PowerParts> power_parts(const Graph& g, NodeId node, const Rational& c);
// The parts of a node exp(c b log(a)).
std::optional<PowerParts> parts_of_power(const Graph& g, NodeId id);

}  // namespace anholon

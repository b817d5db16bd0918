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

// The power base^(constant + the sum of terms).
struct GeneralPower {
  NodeId base;
  Rational constant;
  std::vector<FactorOfExponent> terms;
};

// The powers, times exp(constant + rest), where rest is a sum of nodes with their coefficients.
struct GeneralPowers {
  std::vector<GeneralPower> powers;
  Rational constant = 0;
  std::vector<std::pair<NodeId, Rational>> rest;

  // Returns the nodes of these powers, each as often as it occurs.
  std::vector<NodeId> operands() const;
};

// Returns the node exp(…) as powers; nullopt if no power has a formula as its exponent.
std::optional<GeneralPowers> general_powers(const Graph& g, NodeId id);

// Replaces a product of powers of one node by one power: base^b base^k is base^(b + k).
void join_powers(std::vector<GeneralPower>& powers, GeneralPower more);

// The part c b log(a) of an exponent, with a factor c and powers b of nodes; nullopt if `node`, which has the
// coefficient c, is no such product.
struct PowerParts {
  NodeId base;
  Rational factor;
  std::vector<std::pair<NodeId, Rational>> exponent;
};
std::optional<PowerParts> power_parts(const Graph& g, NodeId node, const Rational& c);
// Returns the parts of a node exp(c b log(a)).
std::optional<PowerParts> parts_of_power(const Graph& g, NodeId id);

}  // namespace anholon

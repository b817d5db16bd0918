#include "proof/checker/real.h"

#include <algorithm>

#include "proof/checker/functions.h"

namespace anholon::verification {

using Index = Certificate::Index;
using Operation = Certificate::Operation;

namespace {

constexpr std::uint32_t kNone = ~std::uint32_t{0};

}  // namespace

RealProgram::RealProgram(const Certificate& c, const std::vector<const Certificate::Claim*>& claims,
                         const std::vector<Index>& others)
    : c_(c), local_(c.nodes.size(), kNone) {
  for (const Certificate::Claim* claim : claims) {
    add(claim->left);
    for (const Certificate::Pair& p : claim->right) add(p.coefficient), add(p.node);
  }
  for (const Index node : others) add(node);
  for (std::size_t i = 0; i < nodes_.size(); ++i)
    for (const Certificate::Term& t : c.nodes[nodes_[i]].terms) add(t.node);
  std::sort(nodes_.begin(), nodes_.end());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    local_[nodes_[i]] = static_cast<std::uint32_t>(i);
    const Certificate::Node& n = c.nodes[nodes_[i]];
    if (n.operation == Operation::symbol) symbols_.push_back(n.symbol);
  }
  std::sort(symbols_.begin(), symbols_.end());
  symbols_.erase(std::unique(symbols_.begin(), symbols_.end()), symbols_.end());
}

void RealProgram::add(Index node) {
  if (local_[node] != kNone) return;
  local_[node] = 0;
  nodes_.push_back(node);
}

void RealProgram::evaluate(const std::vector<Ball>& symbols) {
  value_.resize(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Certificate::Node& n = c_.nodes[nodes_[i]];
    const auto operand = [&](std::size_t k) -> const Ball& { return value_[local_[n.terms[k].node]]; };
    Ball v;
    switch (n.operation) {
    case Operation::number:
      v = Ball(n.value);
      break;
    case Operation::pi:
      v = Ball::pi();
      break;
    case Operation::symbol:
      v = symbols[n.symbol];
      break;
    case Operation::sum:
      for (std::size_t k = 0; k < n.terms.size(); ++k)
        v += n.terms[k].weight == 1 ? operand(k) : Ball(n.terms[k].weight) * operand(k);
      break;
    case Operation::product:
      v = Ball(1);
      for (std::size_t k = 0; k < n.terms.size(); ++k)
        if (n.terms[k].weight != 0) v *= n.terms[k].weight == 1 ? operand(k) : pow(operand(k), n.terms[k].weight);
      break;
    case Operation::function:
      v = function(n.function).value(operand(0));
      break;
    case Operation::atan2:
      v = anholon::atan2(operand(0), operand(1));
      break;
    }
    value_[i] = std::move(v);
  }
}

Ball RealProgram::difference(const Certificate::Claim& claim) const {
  Ball d = value(claim.left);
  for (const Certificate::Pair& p : claim.right) d -= value(p.coefficient) * value(p.node);
  return d;
}

std::vector<Ball> RealProgram::jacobian(const std::vector<Index>& nodes, const std::vector<Index>& symbols) const {
  const std::size_t m = symbols.size();
  std::vector<std::vector<Ball>> tangent(nodes_.size());
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    const Certificate::Node& n = c_.nodes[nodes_[i]];
    std::vector<Ball>& t = tangent[i];
    const auto add_to = [&](const Ball& factor, const std::vector<Ball>& of) {
      if (of.empty()) return;  // constant
      t.resize(m);
      for (std::size_t j = 0; j < m; ++j) t[j] += factor * of[j];
    };
    const auto operand = [&](std::size_t k) { return local_[n.terms[k].node]; };
    switch (n.operation) {
    case Operation::number:
    case Operation::pi:
      break;
    case Operation::symbol:
      if (const auto at = std::find(symbols.begin(), symbols.end(), n.symbol); at != symbols.end()) {
        t.resize(m);
        t[static_cast<std::size_t>(at - symbols.begin())] = Ball(1);
      }
      break;
    case Operation::sum:
      for (std::size_t k = 0; k < n.terms.size(); ++k) add_to(Ball(n.terms[k].weight), tangent[operand(k)]);
      break;
    case Operation::product:
      for (std::size_t k = 0; k < n.terms.size(); ++k) {
        if (n.terms[k].weight == 0 || tangent[operand(k)].empty()) continue;
        Ball factor = Ball(n.terms[k].weight) * pow(value_[operand(k)], n.terms[k].weight - 1);
        for (std::size_t l = 0; l < n.terms.size(); ++l)
          if (l != k && n.terms[l].weight != 0) factor *= pow(value_[operand(l)], n.terms[l].weight);
        add_to(factor, tangent[operand(k)]);
      }
      break;
    case Operation::function:
      add_to(function(n.function).derivative(value_[operand(0)], value_[i]), tangent[operand(0)]);
      break;
    case Operation::atan2: {
      const Ball &y = value_[operand(0)], &x = value_[operand(1)], scale = Ball(1) / (x * x + y * y);
      // Across the cut the function is not continuous.
      const bool cut = !x.is_positive() && y.contains_zero();
      add_to(cut ? Ball::unknown() : x * scale, tangent[operand(0)]);
      add_to(cut ? Ball::unknown() : -y * scale, tangent[operand(1)]);
      break;
    }
    }
  }
  std::vector<Ball> rows;
  rows.reserve(nodes.size() * m);
  for (const Index node : nodes) {
    const std::vector<Ball>& t = tangent[local_[node]];
    for (std::size_t j = 0; j < m; ++j) rows.push_back(t.empty() ? Ball(0) : t[j]);
  }
  return rows;
}

}  // namespace anholon::verification

#include "expr/derivatives/squares.h"

#include <algorithm>
#include <unordered_map>

namespace anholon {

namespace {

// What the structure shows of a node.
struct Shown {
  bool squares = false;    // it is a sum of products of squares: not negative, and of second order near its zeros
  bool positive = false;   // it does not vanish
  bool lipschitz = false;  // it changes at most in proportion to its symbols
};

// The derivatives of these functions are roots in the denominator.
bool has_steep_ends(Function f) { return f == Function::asin || f == Function::acos || f == Function::acosh; }

Shown of_sum(const Graph& g, NodeId id, const std::unordered_map<NodeId, Shown>& known) {
  Shown s{true, false, true};
  for (const Term& t : g.terms(id)) {
    const Shown& of = known.at(t.node);
    s.squares = s.squares && of.squares && g.rational(t.weight) > 0;
    s.positive = s.positive || of.positive;
    s.lipschitz = s.lipschitz && of.lipschitz;
  }
  s.positive = s.positive && s.squares;
  return s;
}

Shown of_product(const Graph& g, NodeId id, const std::unordered_map<NodeId, Shown>& known) {
  Shown s{true, true, true};
  for (const Term& t : g.terms(id)) {
    const Rational& e = g.rational(t.weight);
    const Shown& of = known.at(t.node);
    const bool whole = e.is_integer(), even = whole && Rational(e / 2).is_integer();
    const bool lipschitz = of.lipschitz && (whole || (of.squares && (of.positive || e >= Rational(1, 2))));
    s.lipschitz = s.lipschitz && lipschitz;
    s.squares = s.squares && lipschitz && (even || (of.squares && (of.positive || e >= 1)));
    s.positive = s.positive && of.positive;
  }
  return s;
}

Shown shown(const Graph& g, NodeId id, const std::unordered_map<NodeId, Shown>& known) {
  const Node& n = g.node(id);
  switch (n.kind) {
  case Kind::number:
    return {g.value(id) > 0, g.value(id) > 0, true};
  case Kind::pi:
    return {true, true, true};
  case Kind::sum:
    return of_sum(g, id, known);
  case Kind::product:
    return of_product(g, id, known);
  case Kind::function:
    return {false, false, known.at(g.terms(id)[0].node).lipschitz && !has_steep_ends(static_cast<Function>(n.index))};
  case Kind::atan2:
  case Kind::select: {
    const std::span<const Term> of = g.terms(id);
    return {false, false, std::all_of(of.begin(), of.end(), [&](const Term& t) { return known.at(t.node).lipschitz; })};
  }
  case Kind::time:
  case Kind::jet:
  case Kind::parameter:
  case Kind::mass:
  case Kind::multiplier:
  case Kind::given:
  case Kind::quasi:
  case Kind::state:
  case Kind::control:
  case Kind::lookup:
    return {false, false, true};
  }
  return {};
}

}  // namespace

bool is_sum_of_squares(const Graph& g, NodeId u) {
  std::unordered_map<NodeId, Shown> known;
  // The flat terms of a sum may lie outside its chain.
  std::vector<NodeId> open{u};
  while (!open.empty()) {
    const NodeId id = open.back();
    if (known.contains(id)) {
      open.pop_back();
      continue;
    }
    const std::size_t before = open.size();
    for (const Term& t : g.terms(id))
      if (!known.contains(t.node)) open.push_back(t.node);
    if (open.size() > before) continue;
    known.emplace(id, shown(g, id, known));
    open.pop_back();
  }
  return known.at(u).squares && !known.at(u).positive;
}

bool holds_root_of(Expr e, NodeId u) {
  const Graph& g = *e.graph;
  for (const NodeId id : reachable({&e, 1})) {
    if (g.node(id).kind != Kind::product) continue;
    for (const Term& t : g.terms(id))
      if (t.node == u && !g.rational(t.weight).is_integer()) return true;
  }
  return false;
}

}  // namespace anholon

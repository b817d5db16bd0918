#include "expr/degree.h"

#include <unordered_map>

namespace anholon {

std::optional<Rational> homogeneous_degree(Expr e, const std::function<bool(const Node&)>& in) {
  const Graph& g = *e.graph;
  std::unordered_map<NodeId, Rational> degrees;
  for (NodeId id : reachable({&e, 1})) {
    const Node& n = g.node(id);
    const std::span<const Term> parts = g.summands(id);
    Rational& degree = degrees[id];
    switch (n.kind) {
    case Kind::sum:
      degree = degrees.at(parts[0].node);
      for (const Term& t : parts)
        if (degrees.at(t.node) != degree) return std::nullopt;
      break;
    case Kind::product:
      for (const Term& t : parts) degree += g.rational(t.weight) * degrees.at(t.node);
      break;
    case Kind::function:
    case Kind::atan2:
    case Kind::select:
    case Kind::lookup:
      for (const Term& t : parts)
        if (degrees.at(t.node) != 0) return std::nullopt;
      break;
    case Kind::time:
    case Kind::jet:
    case Kind::parameter:
    case Kind::mass:
    case Kind::multiplier:
    case Kind::given:
    case Kind::quasi:
    case Kind::state:
    case Kind::control:
      if (in(n)) degree = 1;
      break;
    case Kind::number:
    case Kind::pi:
      break;
    }
  }
  return degrees.at(e.id);
}

}  // namespace anholon

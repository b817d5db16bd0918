// Names for subexpressions that occur more than once.
#include <algorithm>
#include <cctype>

#include "print/print.h"

namespace anholon {

std::vector<Expr> name_parts(std::span<const Expr> es, SymbolNames& names) {
  std::vector<Expr> parts;
  if (es.empty()) return parts;
  Graph& g = *es[0].graph;
  names.short_sums = true;
  const std::vector<NodeId> ids = reachable(es);
  std::unordered_map<NodeId, std::size_t> uses;
  for (Expr e : es) ++uses[e.id];
  for (NodeId id : ids)
    for (const Term& t : g.summands(id)) ++uses[t.node];
  std::string prefix = "w";
  const auto taken = [&](const std::string& p) {
    const auto begins = [&](const std::string& n) {
      return n.size() > p.size() && n.compare(0, p.size(), p) == 0 &&
             std::isdigit(static_cast<unsigned char>(n[p.size()]));
    };
    for (const auto* list : {&names.coordinates, &names.parameters, &names.masses, &names.given, &names.quasi,
                             &names.states, &names.controls})
      if (std::any_of(list->begin(), list->end(), begins)) return true;
    return false;
  };
  while (taken(prefix)) prefix += "w";
  for (NodeId id : ids) {
    const Node& n = g.node(id);
    if (uses[id] < 2 || n.view_count < 2 || (n.kind != Kind::sum && n.kind != Kind::product) || names.defined.count(id))
      continue;
    parts.push_back({&g, id});
    names.defined.emplace(id, prefix + std::to_string(parts.size()));
  }
  return parts;
}

}  // namespace anholon

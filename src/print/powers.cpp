#include "print/powers.h"

#include <algorithm>

namespace anholon {

static bool is_function(const Node& n, Function f) {
  return n.kind == Kind::function && n.index == static_cast<std::uint32_t>(f);
}

std::optional<PowerParts> power_parts(const Graph& g, NodeId node, const Rational& c) {
  if (is_function(g.node(node), Function::log)) return PowerParts{g.terms(node)[0].node, c, {}};
  if (g.node(node).kind != Kind::product) return std::nullopt;
  PowerParts p{0, c, {}};
  bool known = false;
  for (const Term& t : g.terms(node))
    if (!known && is_function(g.node(t.node), Function::log) && g.rational(t.weight) == 1)
      known = true, p.base = g.terms(t.node)[0].node;
    else
      p.exponent.push_back({t.node, g.rational(t.weight)});
  return known ? std::optional(std::move(p)) : std::nullopt;
}

std::optional<PowerParts> parts_of_power(const Graph& g, NodeId id) {
  if (!is_function(g.node(id), Function::exp)) return std::nullopt;
  const NodeId argument = g.terms(id)[0].node;
  if (g.node(argument).kind != Kind::sum) return power_parts(g, argument, 1);
  const std::span<const Term> terms = g.summands(argument);
  if (terms.size() != 1) return std::nullopt;
  return power_parts(g, terms[0].node, g.rational(terms[0].weight));
}

void join_powers(std::vector<GeneralPower>& powers, GeneralPower more) {
  const auto same =
      std::find_if(powers.begin(), powers.end(), [&](const GeneralPower& p) { return p.base == more.base; });
  if (same == powers.end()) return powers.push_back(std::move(more));
  same->constant += more.constant;
  for (FactorOfExponent& f : more.terms) {
    const auto alike = std::find_if(same->terms.begin(), same->terms.end(),
                                    [&](const FactorOfExponent& known) { return known.of == f.of; });
    if (alike == same->terms.end())
      same->terms.push_back(std::move(f));
    else if (alike->factor += f.factor; alike->factor == 0)
      same->terms.erase(alike);
  }
}

std::optional<GeneralPowers> general_powers(const Graph& g, NodeId id) {
  if (!is_function(g.node(id), Function::exp)) return std::nullopt;
  const NodeId argument = g.terms(id)[0].node;
  GeneralPowers all;
  const auto add = [&](NodeId node, const Rational& c) {
    const std::optional<PowerParts> p = power_parts(g, node, c);
    if (!p && g.is_number(node)) all.constant += c * g.value(node);
    if (!p && !g.is_number(node)) all.rest.push_back({node, c});
    if (!p) return;
    GeneralPower power{p->base, 0, {}};
    if (p->exponent.empty()) {
      power.constant = p->factor;
    } else if (abs(p->factor) == 1 && p->exponent.size() == 1 && p->exponent[0].second == 1 &&
               g.node(p->exponent[0].first).kind == Kind::sum) {
      for (const Term& t : g.terms(p->exponent[0].first)) {
        const Rational weight = p->factor * g.rational(t.weight);
        if (g.is_number(t.node))
          power.constant += weight * g.value(t.node);
        else
          power.terms.push_back({weight, {{t.node, 1}}});
      }
    } else {
      power.terms.push_back({p->factor, p->exponent});
    }
    join_powers(all.powers, std::move(power));
  };
  if (g.node(argument).kind == Kind::sum)
    for (const Term& t : g.terms(argument)) add(t.node, g.rational(t.weight));
  else
    add(argument, 1);
  const bool general =
      std::any_of(all.powers.begin(), all.powers.end(), [](const GeneralPower& p) { return !p.terms.empty(); });
  return general ? std::optional(std::move(all)) : std::nullopt;
}

std::vector<NodeId> GeneralPowers::operands() const {
  std::vector<NodeId> list;
  for (const GeneralPower& p : powers) {
    list.push_back(p.base);
    for (const FactorOfExponent& f : p.terms)
      for (const auto& [node, weight] : f.of) list.push_back(node);
  }
  for (const auto& [node, coefficient] : rest) list.push_back(node);
  return list;
}

}  // namespace anholon

#include "model/exponents.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace anholon {

namespace {

constexpr int kLargestExponent = 1000;  // the largest exponent that a formula may have

// Returns e with the values of parameters substituted repeatedly, and collects these parameters in `used`. Returns
// nullopt if e contains another symbol.
std::optional<Expr> with_values(const Model& model, Expr e, std::set<std::size_t>& used) {
  const Graph& g = *model.graph;
  for (std::size_t depth = 0; depth <= model.parameters.size(); ++depth) {
    const std::vector<NodeId> in = symbols({&e, 1});
    if (in.empty()) return e;
    for (NodeId id : in) {
      if (g.node(id).kind != Kind::parameter) return std::nullopt;
      used.insert(g.node(id).index);
    }
    e = substitute({&e, 1}, [&](NodeId id) { return model.parameters[g.node(id).index].value; }).front();
  }
  return std::nullopt;
}

// An exponent whose parameters no event changes.
struct FixedExponent {
  Expr value;
  std::set<std::size_t> in_it, follows_from;  // parameters in the exponent; these and those that they follow from
};

std::optional<FixedExponent> fixed(const Model& model, Expr exponent) {
  FixedExponent f;
  for (NodeId id : symbols({&exponent, 1}))
    if (const Node& n = model.graph->node(id); n.kind == Kind::parameter) f.in_it.insert(n.index);
  const std::optional<Expr> value = with_values(model, exponent, f.follows_from);
  const bool set_by_events = std::any_of(f.follows_from.begin(), f.follows_from.end(),
                                         [&](std::size_t i) { return model.parameters[i].mode; });
  if (set_by_events || !value) return std::nullopt;
  f.value = *value;
  return f;
}

bool whole(Expr e) {
  return is_number(e) && number_value(e).is_integer() && !(abs(number_value(e)) > kLargestExponent);
}

// The power base^exponent, whose exponent depends on parameters alone.
struct FixedPower {
  Expr base, exponent;
};

std::optional<FixedPower> fixed_power(Graph& g, NodeId id) {
  const std::optional<PowerParts> p = parts_of_power(g, id);
  if (!p || p->exponent.empty()) return std::nullopt;
  std::vector<std::pair<Expr, Rational>> factors;
  for (const auto& [node, weight] : p->exponent) {
    factors.push_back({{&g, node}, weight});
    for (NodeId symbol : symbols({&factors.back().first, 1}))
      if (g.node(symbol).kind != Kind::parameter) return std::nullopt;
  }
  return FixedPower{{&g, p->base}, p->factor * g.product(factors)};
}

Column all_expressions(Model& model) {
  Column all;
  for_each_expression(model, [&](Expr& e) {
    if (e.graph) all.push_back(e);
  });
  return all;
}

bool depends(const FixedExponent& e, const std::vector<std::size_t>& on) {
  return std::any_of(on.begin(), on.end(), [&](std::size_t i) { return e.follows_from.count(i) > 0; });
}

// The nodes that whole exponents replace in some formulas.
struct Replacements {
  std::unordered_map<NodeId, Expr> by;
  std::set<std::size_t> known;  // the parameters in these exponents
};

Replacements replacements(const Model& model, const Column& formulas, const std::vector<std::size_t>& open) {
  Graph& g = *model.graph;
  Replacements r;
  for (NodeId id : reachable(formulas)) {
    const std::optional<FixedPower> p = fixed_power(g, id);
    const std::optional<FixedExponent> e = p ? fixed(model, p->exponent) : std::nullopt;
    if (!e || !whole(e->value) || depends(*e, open)) continue;
    const Expr base = replace_nodes({&p->base, 1}, r.by).front();
    if (is_zero(base)) continue;
    r.by.emplace(id, pow(base, number_value(e->value)));
    r.known.insert(e->in_it.begin(), e->in_it.end());
  }
  for (const std::size_t i : r.known) {
    std::set<std::size_t> used;
    r.by.emplace(g.parameter(static_cast<std::uint32_t>(i)).id, *with_values(model, model.parameters[i].value, used));
  }
  return r;
}

}  // namespace

void put_whole_exponents(Model& model, const std::vector<std::size_t>& open) {
  const Column all = all_expressions(model);
  const Replacements r = replacements(model, all, open);
  if (r.by.empty()) return;
  for (const std::size_t i : r.known) {
    std::string& doc = model.parameters[i].doc;
    doc += doc.empty() ? "in a whole exponent: put in as a number" : " (in a whole exponent: put in as a number)";
  }
  const Column replaced = replace_nodes(all, r.by);
  std::size_t next = 0;
  for_each_expression(model, [&](Expr& e) {
    if (e.graph) e = replaced[next++];
  });
}

Column with_whole_exponents(const Model& model, const Column& formulas, const std::vector<std::size_t>& open) {
  const Replacements r = replacements(model, formulas, open);
  return r.by.empty() ? formulas : replace_nodes(formulas, r.by);
}

Column exponents_of(Model& model, const std::vector<std::size_t>& parameters) {
  return exponents_of(model, all_expressions(model), parameters);
}

Column exponents_of(const Model& model, const Column& formulas, const std::vector<std::size_t>& parameters) {
  Column list;
  for (NodeId id : reachable(formulas)) {
    const std::optional<FixedPower> p = fixed_power(*model.graph, id);
    if (const auto e = p ? fixed(model, p->exponent) : std::nullopt; e && depends(*e, parameters))
      list.push_back(p->exponent);
  }
  return list;
}

bool any_exponents(const Model& model) {
  std::vector<std::size_t> all(model.parameters.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return !exponents_of(*clone(model), all).empty();
}

}  // namespace anholon

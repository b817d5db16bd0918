#include "tape/one_sided.h"

#include <map>

#include "expr/derivatives/point_gradient.h"

namespace anholon {

namespace {

// Returns the name of the table of a step function "name.coefficient".
std::string table_of(const StepFunction& f) { return f.name.substr(0, f.name.rfind('.')); }

bool is_sign(const Node& n) { return n.kind == Kind::function && static_cast<Function>(n.index) == Function::sign; }

bool has_branches(const Node& n) {
  return n.kind == Kind::select || n.kind == Kind::lookup || is_sign(n) ||
         (n.kind == Kind::function && static_cast<Function>(n.index) == Function::abs);
}

void add_knots(Branch& b, const StepFunction& f) {
  b.knots.insert(b.knots.end(), f.knots.begin(), f.knots.end());
  std::sort(b.knots.begin(), b.knots.end());
  b.knots.erase(std::unique(b.knots.begin(), b.knots.end()), b.knots.end());
}

}  // namespace

OneSided::OneSided(const Column& es, const Column& by, std::size_t parameters) {
  if (es.empty()) return;
  Graph& g = *es[0].graph;
  std::map<std::pair<NodeId, bool>, std::size_t> known;  // by condition and whether it is that of tables
  std::unordered_map<NodeId, Expr> image;
  for (const NodeId id : reachable(es)) {
    const Node n = g.node(id);
    if (!has_branches(n)) continue;
    Column operands;
    for (const Term& t : g.terms(id)) operands.push_back({&g, t.node});
    const bool table = n.kind == Kind::lookup;
    const auto [at, fresh] = known.try_emplace({operands[0].id, table}, branches_.size());
    if (fresh) branches_.push_back({operands[0], "", {}, 1});
    Branch& b = branches_[at->second];
    if (table && b.table.empty()) b.table = table_of(g.step_function(n.index));
    if (table)
      add_knots(b, g.step_function(n.index));
    else
      b.knots = {Rational(0)};
    operands = replace_nodes(operands, image);
    const Expr shifted = operands[0] + g.parameter(static_cast<std::uint32_t>(parameters + at->second));
    if (n.kind == Kind::function)
      operands = is_sign(n) ? Column{shifted, g.one(), g.number(-1)} : Column{shifted, operands[0], -operands[0]};
    image[id] = table ? g.lookup(n.index, shifted) : g.select(shifted, operands[1], operands[2]);
  }
  if (branches_.empty()) return;
  Column conditions;
  for (Branch& b : branches_) {
    conditions.push_back(b.condition);
    for (std::size_t i = 1; i < b.knots.size(); ++i)
      b.shift = std::min(b.shift, Rational((b.knots[i] - b.knots[i - 1]) / 2));
  }
  conditions_ = compile(conditions);
  Column all = replace_nodes(es, image);
  for (std::size_t row = 0; row < es.size(); ++row) {
    const Column d = point_gradient(all[row], by, AtKinks::no_value);
    for (std::size_t c = 0; c < d.size(); ++c)
      if (!is_zero(d[c])) all.push_back(d[c]), partials_.push_back({row, c});
  }
  tape_ = compile(all);
}

}  // namespace anholon

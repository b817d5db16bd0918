#include "proof/enclose.h"

#include "base/stop.h"
#include "tape/function_value.h"

namespace anholon {

// Returns the value of a step function; nullptr if x does not determine it.
static const Rational* lookup(const StepFunction& f, const Ball& x) {
  std::size_t k = 0;
  for (; k < f.knots.size(); ++k) {
    const Ball above = x - Ball(f.knots[k]);
    if (above.contains_zero()) return nullptr;
    if (!above.is_positive()) break;
  }
  return &f.values[k];
}

// Returns the values of all nodes below the expressions.
static BallPoint values_below(std::span<const Expr> es, const BallPoint& at) {
  const Graph& g = *es[0].graph;
  BallPoint value;
  for (NodeId id : reachable(es)) {
    look_for_stop();
    const Node& n = g.node(id);
    Ball v;
    switch (n.kind) {
    case Kind::number:
      v = Ball(g.value(id));
      break;
    case Kind::pi:
      v = Ball::pi();
      break;
    case Kind::sum:
      for (const Term& t : g.summands(id)) v += Ball(g.rational(t.weight)) * value.at(t.node);
      break;
    case Kind::product:
      v = Ball(1);
      for (const Term& t : g.terms(id)) v *= pow(value.at(t.node), g.rational(t.weight));
      break;
    case Kind::function:
      v = function_value(static_cast<Function>(n.index), value.at(g.terms(id)[0].node));
      break;
    case Kind::atan2:
      v = atan2(value.at(g.terms(id)[0].node), value.at(g.terms(id)[1].node));
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
      v = at.at(id);
      break;
    case Kind::select: {
      const Ball& s = value.at(g.terms(id)[0].node);
      v = s.is_positive()      ? value.at(g.terms(id)[1].node)
          : !s.contains_zero() ? value.at(g.terms(id)[2].node)
                               : Ball::unknown();
      break;
    }
    case Kind::lookup: {
      const Rational* known = lookup(g.step_function(n.index), value.at(g.terms(id)[0].node));
      v = known ? Ball(*known) : Ball::unknown();
      break;
    }
    }
    value.emplace(id, std::move(v));
  }
  return value;
}

std::vector<Ball> enclose(std::span<const Expr> es, const BallPoint& at) {
  if (es.empty()) return {};
  const BallPoint value = values_below(es, at);
  std::vector<Ball> out;
  for (Expr e : es) out.push_back(value.at(e.id));
  return out;
}

Column on_branches(std::span<const Expr> es, const BallPoint& at) {
  Column out(es.begin(), es.end());
  if (es.empty()) return out;
  Graph& g = *es[0].graph;
  // A branch may contain further branching functions.
  for (;;) {
    std::unordered_map<NodeId, Expr> chosen;
    const BallPoint value = values_below(out, at);
    for (NodeId id : reachable(out)) {
      const Node& n = g.node(id);
      if (n.kind == Kind::select) {
        const Ball& s = value.at(g.terms(id)[0].node);
        if (s.is_positive() || !s.contains_zero())
          chosen.emplace(id, Expr{&g, g.terms(id)[s.is_positive() ? 1 : 2].node});
      } else if (n.kind == Kind::lookup) {
        const Rational* known = lookup(g.step_function(n.index), value.at(g.terms(id)[0].node));
        if (known) chosen.emplace(id, g.number(Rational(*known)));
      }
    }
    if (chosen.empty()) return out;
    out = replace_nodes(out, chosen);
  }
}

}  // namespace anholon

#include "model/jumps.h"

#include <algorithm>
#include <cmath>

#include "expr/diff.h"
#include "expr/generic_point.h"
#include "expr/normal.h"
#include "tape/point.h"
#include "tape/tape.h"

namespace anholon {

namespace {

// The depth to which nested choices are followed.
constexpr int kDeepest = 16;
// The limit of a proof, in products of terms; beyond it, the expression is said to jump.
constexpr long kMostOfProof = 1'000'000;

bool varies(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (e.graph->node(id).kind != Kind::parameter) return true;
  return false;
}

Expr operand(const Graph& g, Expr e, std::size_t k) { return {e.graph, g.terms(e.id)[k].node}; }

bool is_function(const Node& n, Function f) {
  return n.kind == Kind::function && n.index == static_cast<std::uint32_t>(f);
}

// Returns the condition of a choice or the argument of a sign; a handle with graph == nullptr if the node is neither.
Expr decides(Expr e) {
  const Graph& g = *e.graph;
  const Node& n = g.node(e.id);
  return n.kind == Kind::select || is_function(n, Function::sign) ? operand(g, e, 0) : Expr{};
}

// Returns 1 or -1 if a is a positive or negative multiple of b; else 0.
int same_sign(Expr a, Expr b) {
  if (a == b) return 1;
  if (a == -b) return -1;
  const std::optional<Expr> ratio = is_zero(b) ? std::nullopt : expanded(a / b, kMostOfProof);
  return ratio && is_number(*ratio) ? sgn(number_value(*ratio)) : 0;
}

// Returns the form that e has where s has the sign `side`.
Expr on_side(Expr e, Expr s, int side) {
  Graph& g = *e.graph;
  for (int depth = 0; depth < kDeepest; ++depth) {
    std::unordered_map<NodeId, Expr> by;
    for (NodeId id : reachable({&e, 1})) {
      const Expr part{&g, id};
      const bool magnitude = is_function(g.node(id), Function::abs);
      const Expr own = magnitude ? operand(g, part, 0) : decides(part);
      const int sign = own.graph ? side * same_sign(own, s) : 0;
      if (sign == 0) continue;
      if (magnitude)
        by.emplace(id, sign > 0 ? own : -own);
      else if (g.node(id).kind == Kind::select)
        by.emplace(id, operand(g, part, sign > 0 ? 1 : 2));
      else
        by.emplace(id, g.number(sign));
    }
    if (by.empty()) return e;
    e = replace_nodes({&e, 1}, by).front();
  }
  return e;
}

std::optional<Expr> denominator(Expr e) {
  const std::optional<NormalForm> f = normal_form(e, {}, kMostOfProof);
  return f ? std::optional(expression(f->denominator, f->generators)) : std::nullopt;
}

// Returns e with the choices made that the values of parameters decide.
Expr chosen(Expr e, const std::vector<double>& parameters) {
  constexpr double kOnIt = 1e-9;
  Graph& g = *e.graph;
  for (int depth = 0; depth < kDeepest; ++depth) {
    PointValues at([&](const Node& n) { return n.kind == Kind::pi ? 3.14159265358979323846 : parameters[n.index]; });
    std::unordered_map<NodeId, Expr> by;
    for (NodeId id : reachable({&e, 1})) {
      const Expr part{&g, id}, s = decides(part);
      if (!s.graph || varies(s)) continue;
      const double value = at(s);
      if (!(std::abs(value) > kOnIt)) continue;
      by.emplace(id,
                 g.node(id).kind == Kind::select ? operand(g, part, value > 0 ? 1 : 2) : g.number(value > 0 ? 1 : -1));
    }
    if (by.empty()) return e;
    e = replace_nodes({&e, 1}, by).front();
  }
  return e;
}

// Returns e at s = 0, by substituting a symbol in which s is linear with a coefficient of parameters.
std::optional<Expr> where_zero(Expr e, Expr s) {
  const Graph& g = *e.graph;
  for (NodeId id : symbols({&s, 1})) {
    if (g.node(id).kind == Kind::parameter || g.node(id).kind == Kind::pi) continue;
    const Expr symbol{e.graph, id}, slope = partial(s, symbol);
    if (varies(slope) || is_zero(slope)) continue;
    const Expr root = expanded(symbol - s / slope, kMostOfProof).value_or(symbol - s / slope);
    try {
      return substitute({&e, 1}, [&](NodeId other) { return other == id ? root : Expr{}; }).front();
    } catch (const Failure&) {
      return std::nullopt;  // e has no value there
    }
  }
  return std::nullopt;
}

bool vanishes_with(Expr difference, Expr s, const std::vector<double>& parameters) {
  difference = chosen(difference, parameters);
  if (is_zero(difference) || proved_zero(difference)) return true;
  if (const std::optional<Expr> there = where_zero(difference, s))
    if (proved_zero(chosen(*there, parameters))) return true;
  const std::optional<Expr> own = denominator(difference), divided = denominator(difference / s);
  if (!own || !divided) return false;
  const std::optional<Expr> more = expanded(*divided / *own, kMostOfProof);
  return more && !varies(*more);
}

// The values of e on both sides of a zero of s; nullopt if e has no value on one of them.
struct Sides {
  Expr above, below;
};
std::optional<Sides> sides_of(Expr e, Expr s) {
  try {
    return Sides{on_side(e, s, 1), on_side(e, s, -1)};
  } catch (const Failure&) {
    return std::nullopt;
  }
}

bool continuous_at(Expr e, Expr s, const std::vector<double>& parameters) {
  const std::optional<Sides> sides = sides_of(e, s);
  return sides && vanishes_with(sides->above - sides->below, s, parameters);
}

std::vector<double> parameters_of(const Model& model) {
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  return evaluate_parameters<double>(*model.graph, values);
}

double generic(const Node& n, std::uint64_t seed) { return 4 * generic_value(n, seed) - 2; }

// Returns a generic point, in which the symbol `moved`, if given, has the value x.
PointValues point(std::uint64_t seed, const std::vector<double>& parameters, const Node* moved = nullptr,
                  double x = 0) {
  const std::optional<Node> other = moved ? std::optional(*moved) : std::nullopt;
  return PointValues([&parameters, seed, other, x](const Node& n) {
    return n.kind == Kind::pi          ? 3.14159265358979323846
           : n.kind == Kind::parameter ? parameters[n.index]
           : other && other->kind == n.kind && other->index == n.index && other->order == n.order ? x
                                                                                                  : generic(n, seed);
  });
}

// Returns a point at which s vanishes, found by Newton's method along one of its symbols from a generic point; nullopt
// if none is found.
// is none.
std::optional<PointValues> zero_of(Expr s, Expr along, std::uint64_t seed, const std::vector<double>& parameters) {
  constexpr int kMostSteps = 40;
  constexpr double kOnIt = 1e-12;
  const Expr slope = partial(s, along);
  const Node moved = s.graph->node(along.id);
  double x = generic(moved, seed);
  for (int k = 0; k < kMostSteps; ++k) {
    PointValues at = point(seed, parameters, &moved, x);
    const double value = at(s), rate = at(slope);
    if (!std::isfinite(value) || !std::isfinite(rate)) return std::nullopt;
    if (std::abs(value) <= kOnIt * (1 + std::abs(rate * x))) return at;
    if (rate == 0) return std::nullopt;
    x -= value / rate;
  }
  return std::nullopt;
}

}  // namespace

bool may_jump(const Model& model, Expr e, const Decides& counts) {
  Graph& g = *e.graph;
  const std::vector<double> parameters = parameters_of(model);
  const auto is_met = [&](Expr s) { return varies(s) && (!counts || counts(s)); };
  for (NodeId id : reachable({&e, 1})) {
    const Expr part{&g, id};
    const Node n = g.node(id);
    if (n.kind == Kind::lookup && g.step_function(n.index).smooth < 0 && is_met(operand(g, part, 0))) return true;
    if (n.kind == Kind::atan2 && is_met(part)) {
      const Expr turned = replace_nodes({&e, 1}, {{id, part + 2 * g.pi()}}).front();
      if (!proved_zero(turned - e)) return true;
    }
    const Expr s = decides(part);
    if (s.graph && is_met(s) && !continuous_at(e, s, parameters)) return true;
  }
  return false;
}

bool jumps_at_a_point(const Model& model, Expr e, const Decides& counts) {
  constexpr std::uint64_t kPoints = 4;
  constexpr double kRounded = 1e-8;  // numbers of a formula are rounded to a few digits
  Graph& g = *e.graph;
  const std::vector<double> parameters = parameters_of(model);
  for (NodeId id : reachable({&e, 1})) {
    const Expr s = decides(Expr{&g, id});
    if (!s.graph || !varies(s) || (counts && !counts(s))) continue;
    const std::optional<Sides> sides = sides_of(e, s);
    if (!sides || sides->above == sides->below) continue;
    const auto& [above, below] = *sides;
    for (NodeId symbol : symbols({&s, 1})) {
      if (g.node(symbol).kind == Kind::parameter || g.node(symbol).kind == Kind::pi) continue;
      for (std::uint64_t k = 0; k < kPoints; ++k) {
        std::optional<PointValues> at = zero_of(s, Expr{&g, symbol}, k, parameters);
        if (!at) continue;
        PointValues elsewhere = point(k, parameters);
        double scale = 0;
        for (const double v : {elsewhere(above), elsewhere(below)})
          if (std::isfinite(v)) scale += std::abs(v);
        const double a = (*at)(above), b = (*at)(below);
        if (std::isfinite(a) && std::isfinite(b) && std::abs(a - b) > kRounded * (scale + std::abs(a) + std::abs(b)))
          return true;
      }
    }
  }
  return false;
}

bool may_switch(const Node& n) {
  return n.kind == Kind::select || n.kind == Kind::lookup || is_function(n, Function::sign) ||
         is_function(n, Function::abs);
}

static bool holds(Expr e, Kind kind) {
  for (NodeId id : symbols({&e, 1}))
    if (e.graph->node(id).kind == kind) return true;
  return false;
}

bool holds_coordinates(Expr e) { return holds(e, Kind::jet); }
bool holds_time(Expr e) { return holds(e, Kind::time); }

}  // namespace anholon

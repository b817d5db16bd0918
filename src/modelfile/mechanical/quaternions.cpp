#include "modelfile/mechanical/quaternions.h"

#include <algorithm>
#include <cmath>

#include "expr/normal.h"
#include "modelfile/names/constant.h"
#include "numeric/number.h"

namespace anholon {

// True if this constraint is a multiple of norm^2 = 1.
static bool same_constraint(Expr phi, Expr norm) {
  for (const Rational& k : {Rational(1), Rational(-1), Rational(1, 2), Rational(-1, 2)})
    if (proved_zero(phi - k * norm)) return true;
  return false;
}

std::vector<UnitNorm> unit_norms(Scope& scope, const Model& model) {
  constexpr double kRounded = 1e-9;
  constexpr const char* kHint = "divide it by its norm, or write rot(axis, angle)";
  Graph& g = *model.graph;
  std::vector<UnitNorm> list;
  for (const Scope::Quaternion& q : scope.quaternions()) {
    std::vector<Expr> squares;
    for (Expr e : q.components) squares.push_back(e * e);
    const Expr norm = sum(squares), phi = norm - 1;
    if (is_zero(phi) || proved_zero(phi)) continue;
    if (std::any_of(list.begin(), list.end(), [&](const UnitNorm& n) { return n.phi == phi; })) continue;
    if (jet_order(phi) < 0) {
      // Given numbers, or functions of time, cannot be constrained: their norm must be 1 already.
      for (const Rational& t : {Rational(0), Rational(3, 10), Rational(2)}) {
        const Expr at =
            substitute({&phi, 1}, [&](NodeId id) { return g.node(id).kind == Kind::time ? g.number(t) : Expr{}; })[0];
        const auto value = constant_value(model, at);
        if (value && !(std::abs(*value) <= kRounded))
          throw Failure(
              q.span, "this quaternion is no rotation: the sum of its squares is " + number_text(*value + 1, 6), kHint);
        add_identity(
            scope.identities, at, kRounded,
            [line = q.span.line](double v) {
              return "the quaternion in line " + std::to_string(line) + " is no rotation: the sum of its squares is " +
                     number_text(v + 1, 6);
            },
            kHint, q.span);
      }
      continue;
    }
    if (std::any_of(model.constraints.begin(), model.constraints.end(),
                    [&](const Constraint& c) { return c.order == 0 && same_constraint(c.phi, phi); }))
      continue;
    UnitNorm n;
    n.phi = phi;
    n.span = q.span;
    n.equation = print(norm, model.names, Format::text) + " = 1";
    for (Expr e : q.components) {
      const Node& node = g.node(e.id);
      if (node.kind == Kind::jet && node.order == 0) n.coordinates.push_back(node.index);
    }
    if (n.coordinates.size() == 4) n.scalar = n.coordinates[0];
    n.name =
        "norm." + (n.coordinates.empty() ? std::to_string(list.size() + 1) : model.names.coordinates[n.coordinates[0]]);
    list.push_back(n);
  }
  return list;
}

void start_at_identity(const std::vector<UnitNorm>& norms, Model& model) {
  constexpr double kFull = 1e-9;
  Graph& g = *model.graph;
  for (const UnitNorm& n : norms) {
    if (!n.scalar) continue;
    // Returns the index of the component whose value is given, if it is one of the four.
    const auto component = [&](const GivenValue& v) -> std::optional<std::size_t> {
      const Node& node = g.node(v.symbol.id);
      const auto it = std::find(n.coordinates.begin(), n.coordinates.end(), node.index);
      if (node.kind != Kind::jet || node.order != 0 || it == n.coordinates.end()) return std::nullopt;
      return static_cast<std::size_t>(it - n.coordinates.begin());
    };
    double given = 0;
    bool mentioned = false;
    for (const GivenValue& v : model.initial.given)
      if (const auto k = component(v)) {
        mentioned = mentioned || *k == 0;
        const double value = constant_value(model, v.value).value_or(0);
        given += value * value;
      }
    for (const GivenValue& v : model.initial.guess) mentioned = mentioned || component(v).has_value();
    // If the norm is already 1, the scalar part stays 0: half a turn.
    if (mentioned || given > 1 - kFull) continue;
    model.initial.guess.push_back({g.jet(static_cast<std::uint32_t>(*n.scalar), 0), g.one(), n.span});
  }
}

}  // namespace anholon

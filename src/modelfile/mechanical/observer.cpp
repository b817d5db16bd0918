#include "modelfile/mechanical/observer.h"

#include <cmath>

#include "expr/normal.h"
#include "modelfile/names/constant.h"
#include "modelfile/text/keys.h"

namespace anholon {

static bool constant_in_time(Expr e) { return is_zero(total_derivative(e)); }

// One term: constant * t^n or constant * f(a t + b).
static std::optional<Expr> antiderivative_of_term(Expr e) {
  Graph& g = *e.graph;
  const Expr t = g.time();
  if (constant_in_time(e)) return e * t;
  std::vector<std::pair<Expr, Rational>> constants;
  std::optional<std::pair<Expr, Rational>> varying;
  const Node n = g.node(e.id);
  if (n.kind == Kind::product) {
    for (const Term& f : g.terms(e.id)) {
      const std::pair<Expr, Rational> factor{Expr{&g, f.node}, g.rational(f.weight)};
      if (constant_in_time(factor.first))
        constants.push_back(factor);
      else if (varying)
        return std::nullopt;
      else
        varying = factor;
    }
  } else {
    varying = {e, 1};
  }
  const Expr c = g.product(constants);
  const auto& [f, exponent] = *varying;
  if (f == t && exponent != -1) return c * pow(t, Rational(exponent + 1)) / g.number(exponent + 1);
  const Node fn = g.node(f.id);
  if (fn.kind != Kind::function || exponent != 1) return std::nullopt;
  const Expr u{&g, g.terms(f.id)[0].node};
  const Expr rate = total_derivative(u);
  if (!constant_in_time(rate) || is_zero(rate)) return std::nullopt;
  switch (static_cast<Function>(fn.index)) {
  case Function::sin:
    return -(c * cos(u) / rate);
  case Function::cos:
    return c * sin(u) / rate;
  case Function::exp:
    return c * f / rate;
  case Function::sinh:
    return c * cosh(u) / rate;
  case Function::cosh:
    return c * sinh(u) / rate;
  default:
    return std::nullopt;
  }
}

std::optional<Expr> antiderivative(Expr e) {
  Graph& g = *e.graph;
  if (g.node(e.id).kind != Kind::sum) return antiderivative_of_term(e);
  Expr total = g.zero();
  const std::vector<Term> terms(g.terms(e.id).begin(), g.terms(e.id).end());
  for (const Term& t : terms) {
    const auto part = antiderivative_of_term(Expr{&g, t.node});
    if (!part) return std::nullopt;
    total += g.rational(t.weight) * *part;
  }
  return total;
}

// The rotation A(t) whose angular velocity is `spin`, equal to 1 at t = 0; nullopt unless the direction of the spin is
// one of the axes.
static std::optional<Rotation> rotation_of(const Vector& spin) {
  int axis = -1;
  for (int i = 0; i < 3; ++i) {
    if (is_zero(spin[i])) continue;
    if (axis >= 0) return std::nullopt;
    axis = i;
  }
  Graph& g = *spin.x.graph;
  if (axis < 0) return identity_rotation(g);
  const auto angle = antiderivative(spin[axis]);
  if (!angle) return std::nullopt;
  const NodeId t = g.time().id;
  const Expr start = substitute({&*angle, 1}, [&](NodeId id) { return id == t ? g.zero() : Expr{}; })[0];
  return turn(axis, *angle - start);
}

// Checks the axes at a few times: only the user's formulas keep an observer's axes orthonormal.
static void check_orthonormal(const Rotation& a, const Model& model, Span span) {
  constexpr double kRounded = 1e-9;
  Graph& g = *model.graph;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      const Expr miss = dot(a[i], a[j]) - (i == j ? 1 : 0);
      if (proved_zero(miss)) continue;
      for (const Rational& t : {Rational(0), Rational(3, 10), Rational(2)}) {
        const auto value = constant_value(model, substitute({&miss, 1}, [&](NodeId id) {
                                            return g.node(id).kind == Kind::time ? g.number(t) : Expr{};
                                          })[0]);
        if (value && !(std::abs(*value) <= kRounded))
          throw Failure(span, "the observer's axes are not of length 1 and at right angles",
                        "spin = […] gives axes that are");
      }
    }
}

void read_observer(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics) {
  Graph& g = *model.graph;
  Observer& o = model.observer;
  check_keys(section, "[observer]", "observer", diagnostics);
  const Item* spin = section.find("spin");
  const Item* rotation = section.find("rotation");
  std::optional<Rotation> a;  // observer -> inertial axes
  const auto check = [&](const Vector& v, const Item& item) {
    for (int i = 0; i < 3; ++i)
      for (NodeId id : symbols({&v[i], 1})) {
        const Kind k = g.node(id).kind;
        if (k == Kind::jet || k == Kind::multiplier)
          throw Failure(item.span, "the observer's motion is given: it cannot depend on a coordinate");
      }
  };
  if (spin && rotation)
    throw Failure(rotation->key_span, "the observer's rotation is given twice: by 'spin' and by 'rotation'");
  if (spin) {
    o.spin = scope.vector(*spin);
    check(o.spin, *spin);
  } else if (rotation) {
    a = scope.rotation(*rotation);
    for (int k = 0; k < 3; ++k) check((*a)[k], *rotation);
    if (!a->by_turns) check_orthonormal(*a, model, rotation->span);
    o.spin = a->own_rate;
  }
  const char* const kOrigins[] = {"origin_acceleration", "origin_velocity", "origin_velocity_inertial",
                                  "origin_position_inertial"};
  const Item* origin = nullptr;
  for (const char* key : kOrigins) {
    const Item* item = section.find(key);
    if (!item) continue;
    if (origin)
      throw Failure(item->key_span, "the motion of the observer's origin is given twice: by '" + origin->key +
                                        "' and by '" + item->key + "'");
    origin = item;
  }
  o.inertial = is_zero(o.spin) && !origin;
  if (!origin) {
    o.origin_velocity = zero_vector(g);
    return;
  }
  const Vector v = scope.vector(*origin);
  check(v, *origin);
  const std::string& key = origin->key;
  if (key == "origin_acceleration") {
    o.origin_velocity.reset();  // known only up to a constant
    o.origin_acceleration = v;
  } else if (key == "origin_velocity") {
    o.origin_velocity = v;
    o.origin_acceleration = total_derivative(v) + cross(o.spin, v);  // [L]: v* + omega x v
  } else {
    // Inertial components: a0 = A^T dv/dt, with no omega x v.
    if (!a) a = rotation_of(o.spin);
    if (!a)
      throw Failure(
          origin->key_span,
          "inertial components need the observer's rotation, and this 'spin' cannot be integrated in closed form",
          "give rotation = \"…\" (observer to inertial axes) instead of spin, or origin_acceleration");
    const Vector velocity = key == "origin_position_inertial" ? total_derivative(v) : v;
    o.origin_velocity = transpose_times(*a, velocity);
    o.origin_acceleration = transpose_times(*a, total_derivative(velocity));
  }
}

}  // namespace anholon

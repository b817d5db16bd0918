#include "modelfile/mechanical/observer.h"

#include <algorithm>
#include <cmath>

#include "expr/normal.h"
#include "expr/table.h"
#include "model/jumps.h"
#include "modelfile/names/constant.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

// True for a constant in time. A step function of time is not constant, although its derivative is 0.
static bool constant_in_time(Expr e) {
  for (NodeId id : symbols({&e, 1}))
    if (e.graph->node(id).kind != Kind::parameter && e.graph->node(id).kind != Kind::pi) return false;
  return true;
}

// Integrates one term: constant * t^n or constant * f(a t + b).
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

// Returns the rotation A(t) whose angular velocity is `spin`, equal to 1 at t = 0; nullopt unless the direction of the
// spin is one of the axes.
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

// Checks at a few times that the axes are orthonormal, because only the user's formulas keep them so.
static void check_orthonormal(const Rotation& a, const Model& model, Span span, std::vector<Identity>& identities) {
  constexpr double kRounded = 1e-9;
  constexpr const char *kWhat = "the observer's axes are not of length 1 and at right angles",
                       *kHint = "spin = […] gives axes that are";
  Graph& g = *model.graph;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j <= i; ++j) {
      const Expr miss = dot(a[i], a[j]) - (i == j ? 1 : 0);
      if (proved_zero(miss)) continue;
      for (const Rational& t : {Rational(0), Rational(3, 10), Rational(2)}) {
        const Expr at =
            substitute({&miss, 1}, [&](NodeId id) { return g.node(id).kind == Kind::time ? g.number(t) : Expr{}; })[0];
        const auto value = constant_value(model, at);
        if (value && !(std::abs(*value) <= kRounded)) throw Failure(span, kWhat, kHint);
        add_identity(identities, at, kRounded, [=](double) { return std::string(kWhat); }, kHint, span);
      }
    }
}

static const char* const kGiven = "the observer's motion is given: ";

// Refuses tables that are not smooth enough: the inertial forces would contain pulses where a derivative of lower order
// jumps.
static void check_smooth(const ObserverFormula& f, const Model& model) {
  if (const auto name = too_rough(f.value, f.derivative))
    throw Failure(f.span,
                  "the observer's motion holds the table '" + *name +
                      "', whose fit is not smooth enough: " + "inertial forces need its derivative of order " +
                      std::to_string(f.derivative) + ", and would hold pulses",
                  "fit = \"monotone\" has one continuous derivative, fit = \"spline\" two");
  Expr e = f.value;
  for (int k = 0; k < f.derivative; ++k) {
    if (k > 0) e = put_state_rates(model, total_derivative(e), 1);
    if (jumps_at_a_point(model, e))
      throw Failure(f.span,
                    std::string(k == 0 ? "the observer's motion" : "the derivative of the observer's motion") +
                        " jumps: inertial forces would hold pulses",
                    "write a smooth function of t; origin_acceleration may jump");
  }
}

// Returns the states by whose rates a formula of states changes, including the states in these rates.
static std::vector<std::uint32_t> states_behind(Expr e, const Model& model) {
  std::vector<std::uint32_t> list;
  const auto add = [&](Expr part) {
    for (NodeId id : symbols({&part, 1}))
      if (const Node n = part.graph->node(id);
          n.kind == Kind::state && std::find(list.begin(), list.end(), n.index) == list.end())
        list.push_back(n.index);
  };
  add(e);
  for (std::size_t k = 0; k < list.size(); ++k) add(put_controls(model, {&model.states[list[k]].rate, 1})[0]);
  return list;
}

static bool an_event_sets(const Model& model, Expr symbol) {
  for (const Event& e : model.events)
    for (const Assignment& a : e.set)
      if (a.symbol == symbol) return true;
  return false;
}

static void check_function_of_time(const ObserverFormula& f, const Model& model) {
  Graph& g = *model.graph;
  for (NodeId id : symbols({&f.value, 1})) {
    const Node n = g.node(id);
    if (n.kind == Kind::control)
      if (const Control& u = model.controls[n.index];
          !u.value || holds_coordinates(put_controls(model, {&*u.value, 1})[0]))
        throw Failure(f.span,
                      kGiven + ("it cannot depend on the input '" + u.name + "', which is not a function of time"));
    if (n.kind == Kind::parameter && model.parameters[n.index].mode && f.derivative > 0)
      throw Failure(f.span,
                    kGiven + ("it cannot depend on the mode '" + model.parameters[n.index].name +
                              "', which jumps: inertial forces would hold pulses"),
                    "write a smooth function of t; origin_acceleration may depend on a mode");
  }
  for (std::uint32_t k : states_behind(put_controls(model, {&f.value, 1})[0], model)) {
    const StateVariable& z = model.states[k];
    const std::string which = "the state '" + z.name + "'";
    if (holds_coordinates(put_controls(model, {&z.rate, 1})[0]))
      throw Failure(f.span, kGiven + ("it cannot depend on " + which + ", whose rate depends on a coordinate"));
    if (f.derivative > 0 && an_event_sets(model, g.state(k, 0)))
      throw Failure(f.span, kGiven + ("it cannot depend on " + which + ", which an event sets: inertial forces would " +
                                      "hold pulses"));
  }
}

void check_observer(const std::vector<ObserverFormula>& formulas, const Model& model, Diagnostics& diagnostics) {
  for (const ObserverFormula& f : formulas) {
    const bool alone = collect(
        diagnostics,
        [&] {
          check_function_of_time(f, model);
          const Expr value = put_controls(model, {&f.value, 1})[0];
          if (value != f.value) check_smooth({value, f.derivative, f.span}, model);
        },
        f.span);
    if (!alone) return;
  }
}

std::vector<ObserverFormula> read_observer(const Item& section, Scope& scope, Model& model, Diagnostics& diagnostics) {
  Graph& g = *model.graph;
  std::vector<ObserverFormula> formulas;
  Observer& o = model.observer;
  check_keys(section, "[observer]", "observer", diagnostics);
  const Item* spin = section.find("spin");
  const Item* rotation = section.find("rotation");
  std::optional<Rotation> a;  // observer -> inertial axes
  const auto check = [&](const Vector& v, const Item& item, int derivative) {
    for (int i = 0; i < 3; ++i) {
      for (NodeId id : symbols({&v[i], 1})) {
        const Kind k = g.node(id).kind;
        if (k == Kind::jet || k == Kind::multiplier)
          throw Failure(item.span, kGiven + std::string("it cannot depend on a coordinate"));
      }
      formulas.push_back({v[i], derivative, item.span});
      check_smooth(formulas.back(), model);
    }
  };
  if (spin && rotation)
    throw Failure(rotation->key_span, "the observer's rotation is given twice: by 'spin' and by 'rotation'");
  if (spin) {
    o.spin = scope.vector(*spin);
    check(o.spin, *spin, 1);
  } else if (rotation) {
    a = scope.rotation(*rotation);
    for (int k = 0; k < 3; ++k) check((*a)[k], *rotation, 2);
    if (!a->by_turns) check_orthonormal(*a, model, rotation->span, scope.identities);
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
    return formulas;
  }
  const Vector v = scope.vector(*origin);
  const std::string& key = origin->key;
  check(v, *origin, key == "origin_acceleration" ? 0 : key == "origin_position_inertial" ? 2 : 1);
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
  return formulas;
}

}  // namespace anholon

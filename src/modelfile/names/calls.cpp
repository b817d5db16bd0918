// The meaning of calls in a model file: velocities and accelerations of points, angular velocities, the gravity field,
// components along a frame, given functions.
#include <algorithm>

#include "modelfile/names/names.h"
#include "numeric/number.h"

namespace anholon {

// The limit of calls of given functions over a whole file; more would expand without end.
static constexpr std::size_t kMostCalls = 100'000;

// vel(B, P): the velocity of the material point of B that coincides with P.
Vector Scope::material_velocity(std::size_t body, const Vector& place, Span use) {
  const Vector c = center(body, use);
  const Vector v = total_derivative(c);
  if (!has_orientation(body)) {
    if (is_zero(place - c)) return v;
    throw Failure(use, "the body '" + body_names_[body] + "' has no orientation: it has no material point there",
                  "give it orientation = \"…\", or angle = \"…\" in the plane");
  }
  // One after the other: nodes are numbered in the order of their creation, so that all compilers number them alike.
  const Vector rate = orientation(body, use).rate;
  const Vector arm = place - c;
  return v + cross(rate, arm);
}

// The inertial rate of change of a vector given by its moving components.
Vector Scope::inertial_rate(const Vector& v) { return total_derivative(v) + cross(model_.observer.spin, v); }

std::size_t Scope::body_argument(const Value& value, const Syntax& argument) const {
  if (const BodyName* b = std::get_if<BodyName>(&value)) return b->index;
  if (argument.op == Syntax::Op::name) return body(argument.text, argument.span);
  throw Failure(argument.span, std::string("a body is expected, this is ") + type_name(value));
}

Vector Scope::point_argument(const Value& v, const Syntax& argument) {
  const Value p = as_point(v, *this, argument.span);
  if (const Vector* a = std::get_if<Vector>(&p)) return *a;
  throw Failure(argument.span, std::string("a point is expected, this is ") + type_name(v), body_hint(v, *this));
}

// The three numbers of B(a, b, c): components along the axes of B.
static Vector components(const std::vector<Value>& a, const Syntax& s) {
  const auto number = [&](std::size_t i) {
    if (const Expr* e = std::get_if<Expr>(&a[i])) return *e;
    throw Failure(s.args[i].span, "a number is expected here");
  };
  return {number(0), number(1), number(2)};
}

// The value of the table; the motion ends at the border of a table that must not be left.
Expr Scope::look_up(std::size_t index, Expr x, Span use) {
  const TableEntry& entry = tables_[index];
  if (entry.table.outside == Outside::error) {
    Graph& g = *model_.graph;
    const Rational bounds[] = {entry.table.x.front(), entry.table.x.back()};
    for (int side : {0, 1}) {
      const std::string end = number_text(bounds[side].get_d(), 12);
      const std::string fault = "the argument of the table '" + entry.table.name + "' goes " +
                                (side ? "above its last" : "below its first") + " knot " + end;
      const Expr inside = side ? g.number(bounds[1]) - x : x - g.number(bounds[0]);
      if (is_number(inside) && number_value(inside) < 0) throw Failure(use, fault);
      if (is_number(inside) ||
          std::any_of(model_.bounds.begin(), model_.bounds.end(), [&](const Bound& b) { return b.inside == inside; }))
        continue;
      model_.bounds.push_back({inside, fault, use});
    }
  }
  return entry.function(x);
}

bool Scope::call(const std::string& f, const std::vector<Value>& a, const Syntax& s, Value& result) {
  Graph& g = *model_.graph;
  const auto is_body = [&](std::size_t i) {
    if (a[i].index() == 3) return true;
    return s.args[i].op == Syntax::Op::name && a[i].index() != 4 && find_body(s.args[i].text);
  };
  const auto count = [&](std::size_t least, std::size_t most) {
    if (a.size() < least || a.size() > most)
      throw Failure(s.span, f + " takes " + std::to_string(least) +
                                (most > least ? " or " + std::to_string(most) : std::string()) + " arguments, " +
                                std::to_string(a.size()) + (a.size() == 1 ? " is" : " are") + " given");
  };
  if (f == "vel" || f == "acc") {
    count(1, 2);
    if (a.size() == 2 && a[1].index() == 4) {
      const Vector p = point_argument(a[0], s.args[0]);
      const Observer& o = model_.observer;
      if (f == "acc") {
        result = o.origin_acceleration + inertial_rate(inertial_rate(p));
      } else {
        if (!o.origin_velocity)
          throw Failure(s.span, "the inertial velocity of the observer's origin is not known",
                        "give [observer] origin_velocity instead of origin_acceleration");
        result = *o.origin_velocity + inertial_rate(p);
      }
      return true;
    }
    if (f == "vel" && a.size() == 2 && is_body(0)) {
      result = material_velocity(body_argument(a[0], s.args[0]), point_argument(a[1], s.args[1]), s.span);
      return true;
    }
    if (f == "vel" && a.size() == 2) {
      const Vector p = point_argument(a[0], s.args[0]);
      result = total_derivative(p) - material_velocity(body_argument(a[1], s.args[1]), p, s.span);
      return true;
    }
    if (a.size() == 2) throw Failure(s.span, "acc(P) or acc(P, inertial)");
    const Vector v = total_derivative(point_argument(a[0], s.args[0]));
    result = f == "vel" ? v : total_derivative(v);
    return true;
  }
  if (f == "angvel" || f == "angacc") {
    count(1, 2);
    const auto rate = [&](std::size_t i) -> Vector {
      if (const Rotation* r = std::get_if<Rotation>(&a[i])) return r->rate;
      return orientation(body_argument(a[i], s.args[i]), s.args[i].span).rate;
    };
    Vector w = rate(0);
    if (f == "angacc") {
      count(1, 1);
      result = total_derivative(w);
      return true;
    }
    if (a.size() == 2) w = a[1].index() == 4 ? w + model_.observer.spin : w - rate(1);
    result = w;
    return true;
  }
  if (f == "gravity") {
    count(1, 1);
    result = gravity_at(point_argument(a[0], s.args[0]), s.span);
    return true;
  }
  const auto it = declarations_.find(f);
  if (it == declarations_.end()) {
    if (is_reaction(f)) {
      count(1, 1);
      result = reaction_on(body_argument(a[0], s.args[0]), s);
      return true;
    }
    const std::size_t* b = find_body(f);
    if (!b) return false;
    count(3, 3);
    result = orientation(*b, s.span) * components(a, s);
    return true;
  }
  Declaration& d = it->second;
  if (d.role == Role::frame) {
    count(3, 3);
    result = std::get<Rotation>(resolve(f, d, s.span)) * components(a, s);
    return true;
  }
  if (d.role == Role::table) {
    count(1, 1);
    const Expr* e = std::get_if<Expr>(&a[0]);
    if (!e)
      throw Failure(s.args[0].span, std::string("the argument of a table is a number, this is ") + type_name(a[0]));
    result = look_up(d.index, *e, s.span);
    return true;
  }
  if (d.role != Role::function) return false;
  if (d.arguments.empty()) {
    count(1, 1);
    const Expr* e = std::get_if<Expr>(&a[0]);
    if (!e) throw Failure(s.args[0].span, "a number is expected here");
    const Value body = resolve(f, d, s.span);
    if (*e == g.time()) {
      result = body;
      return true;
    }
    if (d.symbolic) throw Failure(s.args[0].span, "an unknown function is used at t only");
    const Expr formula = std::get<Expr>(body);
    const NodeId t = g.time().id;
    result = substitute({&formula, 1}, [&](NodeId id) { return id == t ? *e : Expr{}; })[0];
    return true;
  }
  count(d.arguments.size(), d.arguments.size());
  if (++calls_ > kMostCalls)
    throw Failure(s.span, "the functions unfold into more than " + std::to_string(kMostCalls) + " calls");
  if (d.state == Declaration::State::open) throw Failure(s.span, "the function '" + f + "' is defined through itself");
  if (!d.parsed) {
    d.body = parse_formula(d.formula);
    d.parsed = true;
  }
  std::map<std::string, Value> bound;
  for (std::size_t i = 0; i < a.size(); ++i) bound[d.arguments[i]] = a[i];
  arguments_.push_back(std::move(bound));
  d.state = Declaration::State::open;
  try {
    result = evaluate(d.body, *this);
  } catch (...) {
    d.state = Declaration::State::fresh;
    arguments_.pop_back();
    throw;
  }
  d.state = Declaration::State::fresh;
  arguments_.pop_back();
  return true;
}

}  // namespace anholon

// The meaning of calls in a model file: velocities and accelerations of points, angular velocities, the gravity field,
// components along a frame, given functions.
#include <algorithm>

#include "modelfile/names/names.h"
#include "numeric/number.h"

namespace anholon {

// The limit of calls of given functions over a whole file; more would expand without end.
static constexpr std::size_t kMostCalls = 100'000;

std::string Scope::what_is(std::size_t body) const {
  return (is_particle(body) ? "the particle '" : "the body '") + body_names_[body] + "'";
}

std::string Scope::orientation_hint(std::size_t body) const {
  return is_particle(body) ? "a particle is a point, and what acts on it acts at its place: on = \"" +
                                 body_names_[body] + "\"; a [[body]] has an orientation"
                           : "give it orientation = \"…\", or angle = \"…\" in the plane";
}

// Returns vel(B, P), the velocity of the material point of B that coincides with P.
Vector Scope::material_velocity(std::size_t body, const Vector& place, Span use) {
  const Vector c = center(body, use);
  const Vector v = total_derivative(c);
  if (!has_orientation(body)) {
    if (is_zero(place - c)) return v;
    throw Failure(use, what_is(body) + " has no orientation: it has no material point there", orientation_hint(body));
  }
  // Nodes are made one after the other: they are numbered in the order of their creation, which must not depend on the
  // compiler.
  const Vector rate = orientation(body, use).rate;
  const Vector arm = place - c;
  return v + cross(rate, arm);
}

// Returns the inertial rate of change of a vector given by its moving components.
Vector Scope::inertial_rate(const Vector& v) { return total_derivative(v) + cross(model_.observer.spin, v); }

// Returns the value of the table; the motion ends at the border of a table that must not be left.
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

// One call: the name of the function, its arguments, and their syntax.
class Scope::Call {
 public:
  Call(Scope& scope, const std::string& function, const std::vector<Value>& arguments, const Syntax& syntax)
      : scope_(scope), f_(function), a_(arguments), s_(syntax) {}

  // Returns nullopt if the scope knows no such function.
  std::optional<Value> value() {
    using Rule = Value (Call::*)();
    static const std::map<std::string, Rule> kinematics = {{"vel", &Call::velocity},
                                                           {"acc", &Call::acceleration},
                                                           {"angvel", &Call::angular_velocity},
                                                           {"angacc", &Call::angular_acceleration},
                                                           {"gravity", &Call::gravity}};
    if (const auto rule = kinematics.find(f_); rule != kinematics.end()) return (this->*rule->second)();
    const auto declared = scope_.declarations_.find(f_);
    if (declared != scope_.declarations_.end()) return of_declaration(declared->second);
    if (is_reaction(f_)) {
      count(1, 1);
      return scope_.reaction_on(body(0), s_);
    }
    const std::size_t* of_body = scope_.find_body(f_);
    if (!of_body) return std::nullopt;
    count(3, 3);
    return scope_.orientation(*of_body, s_.span) * components();
  }

 private:
  // ---- arguments

  void count(std::size_t least, std::size_t most) const {
    if (a_.size() < least || a_.size() > most)
      throw Failure(s_.span, f_ + " takes " + std::to_string(least) +
                                 (most > least ? " or " + std::to_string(most) : std::string()) + " arguments, " +
                                 std::to_string(a_.size()) + (a_.size() == 1 ? " is" : " are") + " given");
  }
  bool is_body_at(std::size_t i) const {
    if (is_body(a_[i])) return true;
    return s_.args[i].op == Syntax::Op::name && !is_inertial(a_[i]) && scope_.find_body(s_.args[i].text);
  }
  std::size_t body(std::size_t i) const {
    const Syntax& argument = s_.args[i];
    if (const BodyName* b = std::get_if<BodyName>(&a_[i])) return b->index;
    if (argument.op == Syntax::Op::name) return scope_.body(argument.text, argument.span);
    throw Failure(argument.span, std::string("a body is expected, this is ") + type_name(a_[i]));
  }
  Vector point(std::size_t i) const {
    const Span at = s_.args[i].span;
    const Value p = as_point(a_[i], scope_, at);
    if (const Vector* v = std::get_if<Vector>(&p)) return *v;
    throw Failure(at, std::string("a point is expected, this is ") + type_name(a_[i]), body_hint(a_[i], scope_));
  }
  Expr number(std::size_t i) const {
    if (const Expr* e = std::get_if<Expr>(&a_[i])) return *e;
    throw Failure(s_.args[i].span, "a number is expected here");
  }
  // Returns the three numbers of B(a, b, c): components along the axes of B.
  Vector components() const { return {number(0), number(1), number(2)}; }

  // ---- kinematics

  Value velocity() {
    count(1, 2);
    if (a_.size() == 1) return total_derivative(point(0));
    if (is_inertial(a_[1])) {
      const Vector p = point(0);
      const std::optional<Vector>& of_origin = scope_.model_.observer.origin_velocity;
      if (!of_origin)
        throw Failure(s_.span, "the inertial velocity of the observer's origin is not known",
                      "give [observer] origin_velocity instead of origin_acceleration");
      return *of_origin + scope_.inertial_rate(p);
    }
    // A particle is a point: if a body follows, the velocity of the particle relative to this body is meant.
    if (is_body_at(0) && !(scope_.is_particle(body(0)) && is_body_at(1))) {
      const std::size_t of = body(0);
      return scope_.material_velocity(of, point(1), s_.span);
    }
    const Vector p = point(0), of_body = scope_.material_velocity(body(1), p, s_.span);
    return total_derivative(p) - of_body;
  }

  Value acceleration() {
    count(1, 2);
    if (a_.size() == 1) return total_derivative(total_derivative(point(0)));
    if (!is_inertial(a_[1])) throw Failure(s_.span, "acc(P) or acc(P, inertial)");
    const Vector p = point(0);
    return scope_.model_.observer.origin_acceleration + scope_.inertial_rate(scope_.inertial_rate(p));
  }

  // Returns the rate of a rotation, or of a body.
  Vector rate_of(std::size_t i) const {
    if (const Rotation* r = std::get_if<Rotation>(&a_[i])) return r->rate;
    return scope_.orientation(body(i), s_.args[i].span).rate;
  }
  Value angular_velocity() {
    count(1, 2);
    const Vector w = rate_of(0);
    if (a_.size() == 1) return w;
    return is_inertial(a_[1]) ? w + scope_.model_.observer.spin : w - rate_of(1);
  }
  Value angular_acceleration() {
    count(1, 1);
    return total_derivative(rate_of(0));
  }

  Value gravity() {
    count(1, 1);
    return scope_.gravity_at(point(0), s_.span);
  }

  // ---- declared functions

  std::optional<Value> of_declaration(Declaration& d) {
    switch (d.role) {
    case Role::frame:
      count(3, 3);
      return std::get<Rotation>(scope_.resolve(f_, d, s_.span)) * components();
    case Role::table:
      return of_table(d);
    case Role::function:
      return d.arguments.empty() ? of_time(d) : of_arguments(d);
    case Role::coordinate:
    case Role::parameter:
    case Role::define:
    case Role::point:
    case Role::state:
    case Role::control:
      break;
    }
    return std::nullopt;
  }

  Value of_table(const Declaration& d) {
    count(1, 1);
    const Expr* e = std::get_if<Expr>(&a_[0]);
    if (!e)
      throw Failure(s_.args[0].span, std::string("the argument of a table is a number, this is ") + type_name(a_[0]));
    return scope_.look_up(d.index, *e, s_.span);
  }

  // Returns f(t), or the formula of f at another argument.
  Value of_time(Declaration& d) {
    count(1, 1);
    const Expr at = number(0);
    const Value body = scope_.resolve(f_, d, s_.span);
    const Expr time = scope_.graph().time();
    if (at == time) return body;
    if (d.symbolic) throw Failure(s_.args[0].span, "an unknown function is used at t only");
    const Expr formula = std::get<Expr>(body);
    return substitute({&formula, 1}, [&](NodeId id) { return id == time.id ? at : Expr{}; })[0];
  }

  Value of_arguments(Declaration& d) {
    count(d.arguments.size(), d.arguments.size());
    if (++scope_.calls_ > kMostCalls)
      throw Failure(s_.span, "the functions unfold into more than " + std::to_string(kMostCalls) + " calls");
    if (d.state == Declaration::State::open)
      throw Failure(s_.span, "the function '" + f_ + "' is defined through itself");
    if (!d.parsed) {
      d.body = parse_formula(d.formula);
      d.parsed = true;
    }
    std::map<std::string, Value> bound;
    for (std::size_t i = 0; i < a_.size(); ++i) bound[d.arguments[i]] = a_[i];
    scope_.arguments_.push_back(std::move(bound));
    d.state = Declaration::State::open;
    const auto restore = [&] {
      d.state = Declaration::State::fresh;
      scope_.arguments_.pop_back();
    };
    try {
      Value result = evaluate(d.body, scope_);
      restore();
      return result;
    } catch (...) {
      restore();
      throw;
    }
  }

  Scope& scope_;
  const std::string& f_;
  const std::vector<Value>& a_;
  const Syntax& s_;
};

std::optional<Value> Scope::call(const std::string& f, const std::vector<Value>& a, const Syntax& s) {
  return Call(*this, f, a, s).value();
}

}  // namespace anholon

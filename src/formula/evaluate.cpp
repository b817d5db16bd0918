#include <algorithm>

#include "base/assert.h"
#include "expr/normal.h"
#include "expr/table.h"
#include "formula/formula.h"
#include "formula/functions.h"
#include "formula/habits.h"
#include "formula/roots.h"
#include "formula/rotations.h"
#include "formula/units.h"

namespace anholon {

const char* type_name(const Value& v) {
  switch (v.index()) {
  case 0:
    return "a number";
  case 1:
    return "a vector";
  case 2:
    return "a rotation";
  case 3:
    return "a body";
  case 4:
    return "'inertial'";
  default:
    return std::get<IncompleteName>(v).is;
  }
}

namespace {

// Derivatives of a higher order are refused.
constexpr int kHighestDerivative = 20;

Expr* number(Value& v) { return std::get_if<Expr>(&v); }
Vector* vector(Value& v) { return std::get_if<Vector>(&v); }
Rotation* rotation(Value& v) { return std::get_if<Rotation>(&v); }

[[noreturn]] void mismatch(const char* what, const Value& a, const Value& b, Span at, std::string hint = {}) {
  throw Failure(at, std::string(what) + " of " + type_name(a) + " and " + type_name(b), std::move(hint));
}

// Returns the hint for that of both values which is a body.
std::string body_hint(const Value& a, const Value& b, const Names& names) {
  const std::string of_a = body_hint(a, names);
  return of_a.empty() ? body_hint(b, names) : of_a;
}

// The number 0 denotes the zero vector if the other side is a vector.
void lift_zero(Value& a, Value& b) {
  if (number(a) && vector(b) && is_zero(*number(a))) a = zero_vector(*vector(b)->x.graph);
  if (number(b) && vector(a) && is_zero(*number(b))) b = zero_vector(*vector(a)->x.graph);
}

Value add(Value a, Value b, bool minus, Span at, Names& names) {
  a = as_point(std::move(a), names, at);
  b = as_point(std::move(b), names, at);
  lift_zero(a, b);
  if (number(a) && number(b)) return minus ? *number(a) - *number(b) : *number(a) + *number(b);
  if (vector(a) && vector(b)) return minus ? *vector(a) - *vector(b) : *vector(a) + *vector(b);
  mismatch(minus ? "difference" : "sum", a, b, at, body_hint(a, b, names));
}

Value divide(Value a, Value b, Span at, Names& names) {
  a = as_point(std::move(a), names, at);
  if (!number(b)) throw Failure(at, std::string("division by ") + type_name(b));
  if (is_zero(*number(b))) throw Failure(at, "division by zero");
  if (number(a)) return *number(a) / *number(b);
  if (vector(a)) return pow(*number(b), -1) * *vector(a);
  mismatch("quotient", a, b, at, body_hint(a, names));
}

// A product of more different factors is refused: its derivative has as many terms, each with that number of factors.
constexpr std::uint32_t kMostFactors = 500;

Value multiply(Value a, Value b, Syntax::Op sign, Span at, Names& names) {
  a = as_point(as_frame(std::move(a), names, at), names, at);
  b = as_point(rotation(a) ? as_frame(std::move(b), names, at) : std::move(b), names, at);
  if (number(a) && number(b)) {
    const Expr product = *number(a) * *number(b);
    if (product.graph->node(product.id).count > kMostFactors && product.graph->node(product.id).kind == Kind::product)
      throw Failure(at, "a product of more than " + std::to_string(kMostFactors) + " different factors");
    return product;
  }
  if (number(a) && vector(b)) return *number(a) * *vector(b);
  if (vector(a) && number(b)) return *number(b) * *vector(a);
  if (vector(a) && vector(b)) {
    if (sign == Syntax::Op::dot) return dot(*vector(a), *vector(b));
    if (sign == Syntax::Op::cross) return cross(*vector(a), *vector(b));
    throw Failure(at, "product of two vectors", "write dot(a, b) or cross(a, b)");
  }
  if (rotation(a) && rotation(b)) return *rotation(a) * *rotation(b);
  if (rotation(a) && vector(b)) return *rotation(a) * *vector(b);
  mismatch("product", a, b, at, body_hint(a, b, names));
}

Expr integer_power(Expr base, const Rational& exponent, Span at) {
  if (is_zero(base) && exponent < 0) throw Failure(at, "zero to a negative power");
  if (abs(exponent) > 1000) throw Failure(at, "a power above 1000");
  if (is_number(base) && number_value(base) < 0 && !exponent.is_integer())
    throw Failure(at, "a negative number to a fractional power has no value",
                  exponent.get_num() == 1 && exponent.get_den() == 3
                      ? "the real cube root of -8 is -8^(1/3), without brackets"
                      : "take the power of the absolute value: abs(a)^(1/3)");
  return power_by_sides(base, exponent);
}

Value power(Value a, Value b, Span at) {
  if (!number(b)) throw Failure(at, std::string("the exponent is ") + type_name(b) + ", not a number");
  if (vector(a)) throw Failure(at, "power of a vector", "write norm2(a) for a·a");
  if (!number(a)) throw Failure(at, std::string("power of ") + type_name(a));
  const Expr base = *number(a), exponent = *number(b);
  if (is_number(exponent)) return integer_power(base, number_value(exponent), at);
  return exp(exponent * log(base));
}

Value differentiate(Value v, int times, Span at, Names& names) {
  v = as_point(std::move(v), names, at);
  if (times > kHighestDerivative)
    throw Failure(at, "a derivative of order " + std::to_string(times) + "; at most " +
                          std::to_string(kHighestDerivative) + " are read");
  if (is_body(v))
    throw Failure(at, "derivative of a body",
                  body_hint(v, names) + "; its angular velocity is angvel(" + names.body_name(std::get<BodyName>(v)) +
                      ")");
  const auto rough = [&](Expr e) {
    if (const auto name = too_rough(e, times))
      throw Failure(at,
                    "a derivative of order " + std::to_string(times) + " of the table '" + *name +
                        "', which its fit does not have",
                    "fit = \"monotone\" has one continuous derivative, fit = \"spline\" two");
  };
  if (const Expr* e = number(v))
    rough(*e);
  else if (const Vector* a = vector(v))
    rough(a->x), rough(a->y), rough(a->z);
  if (Expr* e = number(v))
    v = names.in_time(*e);
  else if (Vector* a = vector(v))
    v = Vector{names.in_time(a->x), names.in_time(a->y), names.in_time(a->z)};
  for (; times > 0; --times) {
    if (Expr* e = number(v))
      v = total_derivative(*e);
    else if (Vector* a = vector(v))
      v = total_derivative(*a);
    else
      throw Failure(at, std::string("derivative of ") + type_name(v), "take the derivative of its axes: R.x'");
  }
  if (Expr* e = number(v))
    if (jet_order(*e) > kHighestDerivative)
      throw Failure(at, "a derivative of order above " + std::to_string(kHighestDerivative));
  return v;
}

struct Arguments {
  const Syntax& call;
  std::vector<Value>& values;
  Names& names;

  void expect(std::size_t n) const {
    if (values.size() != n)
      throw Failure(call.span,
                    call.text + " takes " + std::to_string(n) + (n == 1 ? " argument, " : " arguments, ") +
                        std::to_string(values.size()) + (values.size() == 1 ? " is" : " are") + " given",
                    habit_of_call(call));
  }
  Expr number(std::size_t i) const {
    if (Expr* e = std::get_if<Expr>(&values[i])) return *e;
    throw Failure(call.args[i].span, "argument " + std::to_string(i + 1) + " of " + call.text + " is " +
                                         type_name(values[i]) + ", not a number");
  }
  Vector vector(std::size_t i) const {
    values[i] = as_point(values[i], names, call.args[i].span);
    if (Vector* v = std::get_if<Vector>(&values[i])) return *v;
    if (Expr* e = std::get_if<Expr>(&values[i]); e && is_zero(*e)) return zero_vector(*e->graph);
    throw Failure(call.args[i].span,
                  "argument " + std::to_string(i + 1) + " of " + call.text + " is " + type_name(values[i]) +
                      ", not a vector",
                  body_hint(values[i], names));
  }
  long integer(std::size_t i, long most) const {
    const Expr e = number(i);
    if (!is_number(e) || !number_value(e).is_integer() || number_value(e) < 0 || number_value(e) > most)
      throw Failure(call.args[i].span, "argument " + std::to_string(i + 1) + " of " + call.text +
                                           " is not a whole number between 0 and " + std::to_string(most));
    return number_value(e).to_long();
  }
};

// Returns a if s >= 0, else b, for two numbers or two vectors.
Value branch(Expr s, Value a, Value b, Span at, Names& names) {
  a = as_point(std::move(a), names, at);
  b = as_point(std::move(b), names, at);
  lift_zero(a, b);
  if (number(a) && number(b)) return select(s, *number(a), *number(b));
  if (vector(a) && vector(b)) {
    const Vector &u = *vector(a), &v = *vector(b);
    const Expr x = select(s, u.x, v.x), y = select(s, u.y, v.y), z = select(s, u.z, v.z);
    return Vector{x, y, z};
  }
  mismatch("a choice", a, b, at);
}

// Evaluates piecewise(c1, v1, c2, v2, …, else): the value of the first condition that holds.
Value piecewise(const Syntax& call, Names& names) {
  const std::size_t n = call.args.size();
  if (n < 3 || n % 2 == 0)
    throw Failure(call.span, "piecewise takes conditions with their values, and a value for all else",
                  "piecewise(x > 1, 1, x > 0, x, 0)");
  Value value = evaluate(call.args[n - 1], names);
  for (std::size_t k = n - 1; k >= 2; k -= 2) {
    const Syntax& c = call.args[k - 2];
    if (c.op != Syntax::Op::compare) throw Failure(c.span, "a condition is expected here", "such as x > 0");
    const Expr left = evaluate_number(c.args[0], names), right = evaluate_number(c.args[1], names);
    Value then = evaluate(call.args[k - 1], names);
    // The choice is by x >= 0 with its opposite x < 0, or by x <= 0 with its opposite x > 0.
    const bool greater = c.text[0] == '>', or_equal = c.text.size() > 1;
    const Expr gap = greater == or_equal ? left - right : right - left;
    value = or_equal ? branch(gap, then, value, c.span, names) : branch(gap, value, then, c.span, names);
  }
  return value;
}

// Evaluates choose(k, v1, v2, …): v_k, with k a mode or another whole number; the first value for k below 1, the last
// value for k above their number.
Value choose(const Arguments& in) {
  const std::size_t n = in.values.size();
  if (n < 2)
    throw Failure(in.call.span, "choose takes a number and the values to choose from", "choose(stage, 2500, 270, 0)");
  const Expr k = in.number(0);
  Value value = in.values[n - 1];
  for (std::size_t i = n - 1; i-- > 1;)
    value = branch(Expr(in.number(0).graph->number(Rational(2 * static_cast<int>(i) + 1, 2))) - k, in.values[i], value,
                   in.call.args[i].span, in.names);
  return value;
}

// Rejects a call of an unknown function in the notation of other systems: diff(x, t), if(x > 0, a, b), x(t).
void answer_habits(const Syntax& s, Names& names) {
  if (const std::string habit = habit_of_call(s); !habit.empty())
    throw Failure(s.span, "unknown function '" + s.text + "'", habit);
  if (s.args.size() != 1) return;
  std::optional<Value> value;
  try {
    value = names.name(s.text, s.span);
  } catch (const Failure&) {
    return;  // it is no name either
  }
  if (!number(*value)) return;
  const bool of_time = s.args[0].op == Syntax::Op::name && s.args[0].text == "t";
  throw Failure(s.span, "'" + s.text + "' is not a function" + (of_time ? ": it is the value at t" : ""),
                "write " + s.text +
                    (of_time
                         ? ""
                         : "*" + (s.args[0].op == Syntax::Op::add ? "(" + print(s.args[0]) + ")" : print(s.args[0])) +
                               " for a product"));
}

bool is_built_in(const std::string& f) {
  const std::vector<std::string> list = function_names();
  return std::find(list.begin(), list.end(), f) != list.end();
}

Value call(const Syntax& s, Names& names) {
  Graph& g = names.graph();
  const std::string& f = s.text;
  if (f == "piecewise") return piecewise(s, names);
  if (f == "sum" || f == "prod")  // the parser expands it over a declared range
    throw Failure(s.span, f + " runs over a range of [index]", f + "(k, …) with k = \"1..n\" under [index]");
  if (f == "matrix") return rotation_matrix(s, names);
  std::vector<Value> values;
  if (f == "euler") {
    if (s.args.size() < 2 || s.args[0].op != Syntax::Op::name)
      throw Failure(s.span, "euler takes its axis letters and the angles", "euler(zxz, psi, theta, phi)");
    for (std::size_t i = 1; i < s.args.size(); ++i) values.push_back(evaluate(s.args[i], names));
    return euler(s, values, g);
  }
  // The arguments of an "if" of another language are conditions.
  if (std::any_of(s.args.begin(), s.args.end(), [](const Syntax& a) { return a.op == Syntax::Op::compare; }) &&
      !is_built_in(f))
    answer_habits(s, names);
  for (const Syntax& a : s.args) values.push_back(evaluate(a, names));
  const Arguments in{s, values, names};

  if (std::optional<Value> value = names.call(f, values, s)) return *value;
  if (const int index = find_function(f); index >= 0) {
    in.expect(1);
    const Expr x = in.number(0);
    if (f == "tan" && is_zero(cos(x))) throw Failure(s.span, "the tangent has no value there");
    if (f == "log" && is_number(x) && number_value(x) <= 0)
      throw Failure(s.span, "logarithm of a number that is not positive");
    return g.apply(static_cast<Function>(index), x);
  }
  if (f == "sqrt") {
    in.expect(1);
    if (is_number(in.number(0)) && number_value(in.number(0)) < 0)
      throw Failure(s.span, "square root of a negative number");
    return power_by_sides(in.number(0), {1, 2});
  }
  if (f == "atan2") return in.expect(2), atan2(in.number(0), in.number(1));
  if (f == "min" || f == "max") {
    in.expect(2);
    const Expr a = in.number(0), b = in.number(1);
    return f == "max" ? select(a - b, a, b) : select(b - a, a, b);
  }
  if (f == "choose") return choose(in);
  if (f == "dot") return in.expect(2), dot(in.vector(0), in.vector(1));
  if (f == "cross") return in.expect(2), cross(in.vector(0), in.vector(1));
  if (f == "norm2") return in.expect(1), dot(in.vector(0), in.vector(0));
  if (f == "norm") return in.expect(1), sqrt(dot(in.vector(0), in.vector(0)));
  if (f == "unit") {
    in.expect(1);
    const Vector a = in.vector(0);
    if (is_zero(a)) throw Failure(s.span, "unit vector of the zero vector");
    return pow(dot(a, a), {-1, 2}) * a;
  }
  if (f == "D") {
    in.expect(2);
    return differentiate(values[0], static_cast<int>(in.integer(1, kHighestDerivative)), s.span, names);
  }
  if (f == "rotx" || f == "roty" || f == "rotz") return in.expect(1), turn(f[3] - 'x', in.number(0));
  if (f == "rot") {
    in.expect(2);
    const Vector axis = in.vector(0);
    if (is_zero(axis)) throw Failure(s.args[0].span, "the axis of rot is the zero vector");
    const Expr square = dot(axis, axis), angle = in.number(1);
    return turn(proved_zero(square - 1) ? axis : pow(square, {-1, 2}) * axis, angle);
  }
  if (f == "quat") {
    in.expect(4);
    const std::array<Expr, 4> e = {in.number(0), in.number(1), in.number(2), in.number(3)};
    names.quaternion(e, s);
    return quaternion(e[0], e[1], e[2], e[3]);
  }

  refuse_unknown_function(s, names);
}

// Evaluates a sum. All its terms are added at once, so that a long sum takes linear work.
Value sum_of(const Syntax& s, Names& names) {
  std::vector<Value> values;
  for (const Syntax& a : s.args) values.push_back(evaluate(a, names));
  const auto is_minus = [&](std::size_t i) { return i > 0 && s.operators[i - 1].op == Syntax::Op::subtract; };
  const auto all = [&](const auto& of_type) {
    return std::all_of(values.begin(), values.end(), [&](Value& v) { return of_type(v) != nullptr; });
  };
  const auto total_of = [&](const auto& part) {
    std::vector<std::pair<Rational, Expr>> parts;
    for (std::size_t i = 0; i < values.size(); ++i) parts.push_back({is_minus(i) ? -1 : 1, part(values[i])});
    return names.graph().sum(parts);
  };
  if (all(number)) return total_of([](Value& v) { return *number(v); });
  if (all(vector)) {
    Vector total;
    for (int axis = 0; axis < 3; ++axis) total[axis] = total_of([&](Value& v) { return (*vector(v))[axis]; });
    return total;
  }
  Value total = values[0];
  for (std::size_t i = 1; i < values.size(); ++i)
    total = add(total, values[i], is_minus(i), s.operators[i - 1].span, names);
  return total;
}

Value product_of(const Syntax& s, Names& names) {
  Value product = evaluate(s.args[0], names);
  for (std::size_t i = 1; i < s.args.size(); ++i) {
    const Syntax::Operator& o = s.operators[i - 1];
    Value factor = evaluate(s.args[i], names);
    product = o.op == Syntax::Op::divide ? divide(product, factor, o.span, names)
                                         : multiply(product, factor, o.op, o.span, names);
  }
  return product;
}

}  // namespace

void refuse_unknown_function(const Syntax& call, Names& names) {
  const std::string& f = call.text;
  answer_habits(call, names);
  std::vector<std::string> known = names.functions();
  const std::vector<std::string> built_in = function_names();
  known.insert(known.end(), built_in.begin(), built_in.end());
  const std::string near = did_you_mean(f, known);
  throw Failure(call.span, "unknown function '" + f + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                near.empty() ? "a product is written with '*'" : "");
}

static Value value_of(const Syntax& s, Names& names) {
  Graph& g = names.graph();
  switch (s.op) {
  case Syntax::Op::number: {
    const auto r = parse_rational(s.text);
    if (!r) throw Failure(s.span, "the number " + s.text.substr(0, 40) + " is out of all proportion");
    return g.number(*r);
  }
  case Syntax::Op::quantity: {
    const std::optional<Unit> unit = read_unit(s.text);
    ANHOLON_ASSERT(unit.has_value());
    const Expr number = evaluate_number(s.args[0], names), pi = pow(g.pi(), unit->pi);
    return unit->factor * (number * pi);
  }
  case Syntax::Op::name:
    return names.name(s.text, s.span);
  case Syntax::Op::call:
    return call(s, names);
  case Syntax::Op::member:
    return names.member(evaluate(s.args[0], names), s);
  case Syntax::Op::array: {
    if (s.args.size() != 3) throw Failure(s.span, "a vector has three components");
    return Vector{evaluate_number(s.args[0], names), evaluate_number(s.args[1], names),
                  evaluate_number(s.args[2], names)};
  }
  case Syntax::Op::compare:
    throw Failure(s.span, "a condition is not a number: it stands in piecewise only",
                  "write piecewise(" + print(s) + ", 1, 0) in place of (" + print(s) + ")");
  case Syntax::Op::negate: {
    Value v = as_point(evaluate(s.args[0], names), names, s.span);
    if (Expr* e = number(v)) return -*e;
    if (Vector* a = vector(v)) return g.number(-1) * *a;
    throw Failure(s.span, std::string("minus ") + type_name(v), body_hint(v, names));
  }
  case Syntax::Op::prime: {
    // x''' is three nested primes: count them here, so that each order is one step.
    int times = 1;
    const Syntax* inner = &s.args[0];
    for (; inner->op == Syntax::Op::prime; inner = &inner->args[0]) ++times;
    return differentiate(evaluate(*inner, names), times, s.span, names);
  }
  case Syntax::Op::power:
    return power(evaluate(s.args[0], names), evaluate(s.args[1], names), s.span);
  case Syntax::Op::add:
    return sum_of(s, names);
  case Syntax::Op::multiply:
    return product_of(s, names);
  case Syntax::Op::index:
  case Syntax::Op::apply:
    break;  // replaced by the parser
  case Syntax::Op::subtract:
  case Syntax::Op::divide:
  case Syntax::Op::dot:
  case Syntax::Op::cross:
    break;  // only inside `operators`
  }
  ANHOLON_ASSERT(false);
  return g.zero();
}

Value as_point(Value v, Names& names, Span use) {
  if (const BodyName* b = std::get_if<BodyName>(&v))
    if (const std::optional<Vector> p = names.point(*b, use)) return *p;
  return v;
}

Value as_frame(Value v, Names& names, Span use) {
  if (const BodyName* b = std::get_if<BodyName>(&v))
    if (const std::optional<Rotation> r = names.frame(*b, use)) return *r;
  return v;
}

std::string body_hint(const Value& v, const Names& names) {
  const BodyName* b = std::get_if<BodyName>(&v);
  return b ? "a body is not a point: write " + names.body_name(*b) + ".center" : std::string();
}

// A failure inside that has no position of its own (division by zero, too long a number) gets the position of this
// formula.
Value evaluate(const Syntax& s, Names& names) {
  try {
    return value_of(s, names);
  } catch (const Failure& f) {
    if (f.diagnostic.span.line > 0 || f.diagnostic.message.empty() || s.span.line == 0) throw;
    throw Failure(s.span, f.diagnostic.message, f.diagnostic.hint);
  }
}

Expr evaluate_number(const Syntax& s, Names& names) {
  Value v = evaluate(s, names);
  if (Expr* e = number(v)) return *e;
  throw Failure(s.span, std::string("a number is expected, this is ") + type_name(v),
                std::holds_alternative<Vector>(v) ? "take a component (.x, .y, .z), dot(…) or norm(…)" : "");
}

Vector evaluate_vector(const Syntax& s, Names& names) {
  Value v = as_point(evaluate(s, names), names, s.span);
  if (Vector* a = vector(v)) return *a;
  if (Expr* e = number(v); e && is_zero(*e)) return zero_vector(names.graph());
  throw Failure(s.span, std::string("a vector is expected, this is ") + type_name(v),
                is_body(v)     ? body_hint(v, names)
                : is_scalar(v) ? "along the first axis: x*ex, or [\"x\", \"0\", \"0\"]"
                               : "");
}

Rotation evaluate_rotation(const Syntax& s, Names& names) {
  Value v = as_frame(evaluate(s, names), names, s.span);
  if (Rotation* r = rotation(v)) return *r;
  throw Failure(s.span, std::string("a rotation is expected, this is ") + type_name(v),
                is_body(v) ? names.body_name(std::get<BodyName>(v)) + " has no orientation, and so no axes"
                           : "rotx(…), roty(…), rotz(…), rot(axis, angle) and products of these");
}

}  // namespace anholon

#include "modelfile/check/formula_dimensions.h"

#include <algorithm>

#include "base/assert.h"
#include "modelfile/language/language.h"

namespace anholon {

using Type = Measured::Type;

// The limit of calls of functions inside one another, over the whole file; calls beyond it are not checked.
static constexpr std::size_t kMostCalls = 20'000;

FormulaDimensions::FormulaDimensions(const Scope& scope, const Model& model, Overrides overrides)
    : scope_(scope), overrides_(overrides) {
  for (const std::string& name : model.names.coordinates) names_[name] = number(dimensions_.unknown(name));
}

DimensionForm FormulaDimensions::unit(const char* text) const {
  const std::optional<Unit> u = read_unit(text);
  ANHOLON_ASSERT(u.has_value());
  DimensionForm f;
  f.known = u->dimension;
  return f;
}

void FormulaDimensions::expect(const Measured& m, const DimensionForm& wanted, Span place) {
  if (m.type == Type::other || dimensions_.equate(m.dimension, wanted)) return;
  const std::string here = dimensions_.text(m.dimension);
  throw Failure(place, dimensions_.text(wanted) + " is expected here, this is " + here,
                here == "a pure number" ? "a bare number has any unit: 1*(…), or give it one: 1 m" : "");
}

void FormulaDimensions::expect(const Item& item, const DimensionForm& wanted) {
  if (item.is_formula() || item.kind == Item::Kind::array)
    expect(term(item), wanted, item.is_formula() ? item.formula.whole() : item.span);
}

void FormulaDimensions::expect_lengths(const Item& shape) {
  if (!shape.is_formula()) return;
  for (const Syntax& size : parse_formula(shape.formula).args) expect(of(size), unit("m"), size.span);
}

void FormulaDimensions::alike(const Measured& a, const Measured& b, Span place, const char* between,
                              const char* behind) {
  if (a.type == Type::other || b.type == Type::other || dimensions_.equate(a.dimension, b.dimension)) return;
  throw Failure(place, dimensions_.text(a.dimension) + between + dimensions_.text(b.dimension) + behind);
}

// Notes a unit of the file. Degrees alone do not determine the units of lengths and masses.
void FormulaDimensions::seen(const DimensionForm& unit) {
  if (!in_override_ && unit.known != Dimension{}) units_seen = true;
}

void FormulaDimensions::look_for_units(const Syntax& s) {
  if (s.op == Syntax::Op::quantity) seen(unit(s.text.c_str()));
  for (const Syntax& a : s.args) look_for_units(a);
}

void FormulaDimensions::pure(const Syntax& argument) { expect(of(argument), {}, argument.span); }

std::optional<Dimension> FormulaDimensions::known(const std::string& name) {
  const Measured m = named(name);
  return m.type == Type::other ? std::nullopt : dimensions_.known(m.dimension);
}

bool FormulaDimensions::is_body(const std::string& name) const {
  const auto& names = scope_.body_names();
  return std::find(names.begin(), names.end(), name) != names.end();
}

void FormulaDimensions::declarations(Diagnostics& found) {
  found_ = &found;
  // The order is that of the file, so that a clash is reported at its first place.
  std::vector<std::pair<std::pair<std::uint32_t, std::uint32_t>, std::string>> order;
  for (const auto& [name, d] : scope_.declarations()) order.push_back({{d.span.line, d.span.column}, name});
  std::sort(order.begin(), order.end());
  for (const auto& [place, name] : order)
    if (scope_.declarations().at(name).arguments.empty()) named(name);
}

Measured FormulaDimensions::named(const std::string& name) {
  if (!arguments_.empty())
    if (const auto it = arguments_.back().find(name); it != arguments_.back().end()) return it->second;
  if (name == "t") return number(unit("s"));
  if (name == "pi") return number();
  if (name == "ex" || name == "ey" || name == "ez") return vector();
  if (name == "here" && in_field) return vector(unit("m"));
  if (const auto it = names_.find(name); it != names_.end()) return it->second;
  const auto it = scope_.declarations().find(name);
  if (it == scope_.declarations().end()) {
    const std::size_t* body = scope_.find_body(name);
    return !body ? anything() : scope_.is_particle(*body) ? vector(unit("m")) : Measured{Type::body, {}};
  }
  if (!it->second.arguments.empty() || std::find(open_.begin(), open_.end(), name) != open_.end()) return anything();
  // A definition has the same meaning wherever it is used.
  const auto arguments = std::exchange(arguments_, {});
  const bool in_override = std::exchange(in_override_, !it->second.override.empty()),
             field = std::exchange(in_field, false);
  open_.push_back(name);
  Measured m;
  try {
    m = declared(name, it->second);
  } catch (const Failure& f) {
    Diagnostic d = f.diagnostic;
    if (!it->second.override.empty()) d.message = it->second.override + ": " + d.message;
    found_->add(std::move(d));
    m = anything();
  }
  open_.pop_back();
  arguments_ = arguments;
  in_override_ = in_override;
  in_field = field;
  return names_[name] = m;
}

Measured FormulaDimensions::declared(const std::string& name, const Scope::Declaration& d) {
  using Role = Scope::Role;
  switch (d.role) {
  case Role::parameter: {
    if (!d.override.empty() && d.unit.empty() && overrides_ == Overrides::ignored)
      return number(dimensions_.unknown(name));
    Measured m = d.item ? of(*d.item) : of(parse_formula(d.formula));
    if (!d.unit.empty()) {
      const DimensionForm given = unit(d.unit.c_str());
      seen(given);
      if (!d.override.empty() && has_unit(parse_formula(d.formula))) expect(m, given, {});
      return {m.type, given};
    }
    const Measured own{m.type, dimensions_.unknown(name)};
    alike(own, m, d.formula.whole(), " and ");
    return own;
  }
  case Role::function:
    if (d.symbolic) return number(dimensions_.unknown(name));
    return of(parse_formula(d.formula));
  case Role::define:
    return d.item ? of(*d.item) : of(parse_formula(d.formula));
  case Role::frame:
    return of(parse_formula(d.formula));
  case Role::point: {
    Measured m = d.item ? of(*d.item) : term(parse_formula(d.formula));
    expect(m, unit("m"), d.item ? d.item->span : d.formula.whole());
    return vector(unit("m"));
  }
  case Role::state:
  case Role::control:
    return number(dimensions_.unknown(name));
  default:
    return anything();
  }
}

Measured FormulaDimensions::of(const Item& item) {
  if (item.is_formula()) return of(parse_formula(item.formula));
  if (item.kind != Item::Kind::array || item.items.size() != 3) return anything();
  Measured first = of(item.items[0]);
  for (std::size_t k = 1; k < 3; ++k)
    alike(first, of(item.items[k]), item.items[k].is_formula() ? item.items[k].formula.whole() : item.items[k].span,
          " and ", " as components of one vector");
  return vector(first.dimension);
}

// Returns the exponent as a number, if it is written as one.
static std::optional<Rational> written_number(const Syntax& s) {
  switch (s.op) {
  case Syntax::Op::number:
    return parse_rational(s.text);
  case Syntax::Op::negate: {
    const auto r = written_number(s.args[0]);
    return r ? std::optional<Rational>(-*r) : std::nullopt;
  }
  case Syntax::Op::multiply: {
    std::optional<Rational> product = written_number(s.args[0]);
    for (std::size_t i = 1; i < s.args.size() && product; ++i) {
      const auto r = written_number(s.args[i]);
      const bool divide = s.operators[i - 1].op == Syntax::Op::divide;
      if (!r || (divide && *r == 0)) return std::nullopt;
      product = divide ? Rational(*product / *r) : Rational(*product * *r);
    }
    return product;
  }
  default:
    return std::nullopt;
  }
}

Measured FormulaDimensions::raised(const Syntax& s) {
  const Measured base = of(s.args[0]);
  if (const auto exponent = written_number(s.args[1])) return number(power(base.dimension, *exponent));
  pure(s.args[1]);
  // If the exponent is a parameter (Hertz's 3/2), only the power of a pure number has a known dimension.
  const auto known = dimensions_.known(base.dimension);
  return known && *known == Dimension{} ? number() : anything();
}

Measured FormulaDimensions::sum(const Syntax& s) {
  const auto summand = [&](const Syntax& a) {
    Measured m = term(a);
    const Syntax& number = a.op == Syntax::Op::negate ? a.args[0] : a;
    if (number.op == Syntax::Op::number && !in_override_ && parse_rational(number.text).value_or(0) != 0)
      bare_.insert_or_assign({number.span.file, number.span.line, number.span.column},
                             BareNumber{number.span, number.text, m.dimension});
    return m;
  };
  Measured total = summand(s.args[0]);
  for (std::size_t i = 1; i < s.args.size(); ++i) {
    const Measured next = summand(s.args[i]);
    alike(total, next, s.operators[i - 1].span, s.operators[i - 1].op == Syntax::Op::subtract ? " minus " : " plus ");
    if (total.type == Type::other || next.type == Type::vector) total = next;  // 0 is also the zero vector
  }
  return total;
}

std::vector<FormulaDimensions::BareTerm> FormulaDimensions::bare_terms() const {
  std::vector<BareTerm> list;
  for (const auto& [place, number] : bare_)
    if (const auto d = dimensions_.known(number.dimension); d && *d != Dimension{})
      list.push_back({number.span, number.text, *d});
  return list;
}

Measured FormulaDimensions::product(const Syntax& s) {
  Measured total = of(s.args[0]);
  for (std::size_t i = 1; i < s.args.size(); ++i) {
    const Measured factor = of(s.args[i]);
    const Syntax::Op op = s.operators[i - 1].op;
    if (total.type == Type::other || factor.type == Type::other) {
      total = anything();
      continue;
    }
    const bool both = total.type == Type::vector && factor.type == Type::vector;
    if (total.type == Type::rotation || total.type == Type::body)
      total.type = factor.type;
    else if (both)
      total.type = op == Syntax::Op::dot ? Type::number : Type::vector;
    else if (factor.type == Type::vector)
      total.type = Type::vector;
    total.dimension =
        op == Syntax::Op::divide ? total.dimension / factor.dimension : total.dimension * factor.dimension;
  }
  return total;
}

Measured FormulaDimensions::term(const Syntax& s) {
  if (s.op == Syntax::Op::negate) return term(s.args[0]);
  const Measured m = of(s);
  const bool axis = (s.op == Syntax::Op::name && (s.text == "ex" || s.text == "ey" || s.text == "ez")) ||
                    (s.op == Syntax::Op::member && s.text.size() == 1 && m.type == Type::vector);
  return axis ? vector(dimensions_.unknown()) : m;
}

Measured FormulaDimensions::of(const Syntax& s) {
  // A formula that is deeper than any written by a person is not checked.
  constexpr int kDeepest = 500;
  if (depth_ > kDeepest) return anything();
  ++depth_;
  try {
    Measured m = measured(s);
    --depth_;
    return m;
  } catch (...) {
    --depth_;
    throw;
  }
}

Measured FormulaDimensions::measured(const Syntax& s) {
  switch (s.op) {
  case Syntax::Op::number:
    return number(dimensions_.unknown());
  case Syntax::Op::quantity: {
    const DimensionForm given = unit(s.text.c_str());
    seen(given);
    return number(given);
  }
  case Syntax::Op::name:
    return named(s.text);
  case Syntax::Op::negate:
    return of(s.args[0]);
  case Syntax::Op::prime: {
    Measured m = of(s.args[0]);
    m.dimension = m.dimension / unit("s");
    return m;
  }
  case Syntax::Op::power:
    return raised(s);
  case Syntax::Op::multiply:
    return product(s);
  case Syntax::Op::add:
    return sum(s);
  case Syntax::Op::array: {
    if (s.args.size() != 3) return anything();
    const Measured first = of(s.args[0]);
    for (std::size_t k = 1; k < 3; ++k)
      alike(first, of(s.args[k]), s.args[k].span, " and ", " as components of one vector");
    return vector(first.dimension);
  }
  case Syntax::Op::member: {
    if (const std::string path = multiplier_path(s); !path.empty()) {
      const std::optional<DimensionForm> force = of_multiplier ? of_multiplier(path) : std::nullopt;
      return force ? number(*force) : anything();
    }
    const Measured object = of(s.args[0]);
    const bool axis = s.text == "x" || s.text == "y" || s.text == "z";
    if (object.type == Type::vector && axis) return number(object.dimension);
    if ((object.type == Type::rotation || object.type == Type::body) && axis) return vector();
    if (object.type == Type::body || (object.type == Type::vector && (s.text == "center" || s.text == "position")))
      return vector(unit("m"));
    return anything();
  }
  case Syntax::Op::call:
    return call(s);
  default:
    return anything();
  }
}

std::pair<DimensionForm, DimensionForm> FormulaDimensions::table(const std::string& name) {
  const auto it = tables_.find(name);
  if (it != tables_.end()) return it->second;
  // The unknowns are made one after the other, because they are numbered.
  DimensionForm x = dimensions_.unknown("the argument of " + name), y = dimensions_.unknown("the values of " + name);
  return tables_.emplace(name, std::pair(std::move(x), std::move(y))).first->second;
}

DimensionForm FormulaDimensions::given_unit(const std::string& text) {
  DimensionForm u = unit(text.c_str());
  seen(u);
  return u;
}

Measured FormulaDimensions::user_call(const Syntax& s, const Scope::Declaration& d) {
  if (d.role == Scope::Role::frame) return components(s);
  if (d.role == Scope::Role::table) {
    if (s.args.size() != 1) return anything();
    const auto [x, y] = table(s.text);
    expect(of(s.args[0]), x, s.args[0].span);
    return number(y);
  }
  if (d.role != Scope::Role::function) return anything();
  if (d.arguments.empty()) {
    if (!s.args.empty()) expect(of(s.args[0]), unit("s"), s.args[0].span);
    return named(s.text);
  }
  if (d.arguments.size() != s.args.size() || ++calls_ > kMostCalls ||
      std::find(open_.begin(), open_.end(), s.text) != open_.end())
    return anything();
  std::map<std::string, Measured> bound;
  for (std::size_t i = 0; i < s.args.size(); ++i) bound[d.arguments[i]] = of(s.args[i]);
  const auto it = functions_.find(s.text);
  const Syntax& body =
      it != functions_.end() ? it->second : functions_.emplace(s.text, parse_formula(d.formula)).first->second;
  arguments_.push_back(std::move(bound));
  open_.push_back(s.text);
  const auto restore = [&] { arguments_.pop_back(), open_.pop_back(); };
  try {
    const Measured m = of(body);
    restore();
    return m;
  } catch (...) {
    restore();
    throw;
  }
}

Measured FormulaDimensions::call(const Syntax& s) {
  const auto declared = scope_.declarations().find(s.text);
  if (declared != scope_.declarations().end() &&
      (declared->second.role == Scope::Role::function || declared->second.role == Scope::Role::frame ||
       declared->second.role == Scope::Role::table))
    return user_call(s, declared->second);
  if (is_body(s.text)) return components(s);
  for (const auto* table : {&function_table(), &kinematic_functions()})
    for (const FunctionRow& row : *table)
      if (row.name == s.text) return by_rule(s, row.dimension);
  return anything();
}

Measured FormulaDimensions::by_rule(const Syntax& s, DimensionRule rule) {
  switch (rule) {
  case DimensionRule::pure:
    for (const Syntax& a : s.args) pure(a);
    return number();
  case DimensionRule::same:
    return argument(s, 0);
  case DimensionRule::number:
    return argument(s, 0), number();
  case DimensionRule::root:
    return number(power(argument(s, 0).dimension, {1, 2}));
  case DimensionRule::square:
    return number(power(argument(s, 0).dimension, 2));
  case DimensionRule::length:
    return number(argument(s, 0).dimension);
  case DimensionRule::direction:
    return argument(s, 0), vector();
  case DimensionRule::alike:
    return one_dimension(s, " as arguments of " + s.text);
  case DimensionRule::angle:
    return one_dimension(s, " as arguments of " + s.text), number();
  case DimensionRule::choice:
  case DimensionRule::cases:
    return one_of_values(s, rule);
  case DimensionRule::dot:
  case DimensionRule::cross: {
    const DimensionForm a = argument(s, 0).dimension, b = argument(s, 1).dimension;
    return {rule == DimensionRule::dot ? Type::number : Type::vector, a * b};
  }
  case DimensionRule::derivative: {
    Measured m = argument(s, 0);
    const auto k = s.args.size() == 2 ? written_number(s.args[1]) : std::nullopt;
    if (!k) return anything();
    m.dimension = m.dimension / power(unit("s"), *k);
    return m;
  }
  case DimensionRule::rotation:
    for (const Syntax& a : s.args) pure(a);
    return {Type::rotation, {}};
  case DimensionRule::turns:
  case DimensionRule::turn_about:
    for (std::size_t i = 1; i < s.args.size(); ++i) pure(s.args[i]);
    if (rule == DimensionRule::turn_about) argument(s, 0);
    return {Type::rotation, {}};
  case DimensionRule::matrix:
    for (const Syntax& rows : s.args)
      for (const Syntax& row : rows.args)
        for (const Syntax& entry : row.args) pure(entry);
    return {Type::rotation, {}};
  case DimensionRule::force:
    return vector(unit("N"));
  case DimensionRule::torque:
    return vector(unit("N*m"));
  case DimensionRule::velocity:
    return rate_of_point(s, 1);
  case DimensionRule::acceleration:
    return rate_of_point(s, 2);
  case DimensionRule::angular_velocity:
    return vector(unit("s^-1"));
  case DimensionRule::angular_acceleration:
    return vector(unit("s^-2"));
  case DimensionRule::gravity:
    for (const Syntax& a : s.args) expect(of(a), unit("m"), a.span);
    return vector(unit("m/s^2"));
  case DimensionRule::open:
    break;
  }
  return anything();
}

Measured FormulaDimensions::argument(const Syntax& s, std::size_t i) {
  return i < s.args.size() ? of(s.args[i]) : anything();
}

Measured FormulaDimensions::one_dimension(const Syntax& s, const std::string& behind) {
  const Measured first = argument(s, 0);
  for (std::size_t k = 1; k < s.args.size(); ++k) alike(first, of(s.args[k]), s.span, " and ", behind.c_str());
  return first;
}

Measured FormulaDimensions::components(const Syntax& s) {
  const Measured first = argument(s, 0);
  for (std::size_t k = 1; k < s.args.size(); ++k)
    alike(first, of(s.args[k]), s.args[k].span, " and ", " as components of one vector");
  return vector(first.dimension);
}

// Handles choose(k, v1, v2, …) and piecewise(c1, v1, c2, v2, …, else): the values have one dimension, and so have the
// sides of a condition.
Measured FormulaDimensions::one_of_values(const Syntax& s, DimensionRule rule) {
  const auto is_condition = [&](std::size_t k) {
    return rule == DimensionRule::choice ? k == 0 : k % 2 == 0 && k + 1 < s.args.size();
  };
  std::optional<Measured> value;
  for (std::size_t k = 0; k < s.args.size(); ++k) {
    const Syntax& a = s.args[k];
    if (a.op == Syntax::Op::compare)
      alike(term(a.args[0]), term(a.args[1]), a.span, " compared with ");
    else if (is_condition(k))
      of(a);
    else if (!value)
      value = term(a);
    else
      alike(*value, term(a), a.span, " and ", (" as values of " + s.text).c_str());
  }
  return value ? *value : anything();
}

// Returns the dimension of the velocity of a point, which is its derivative; with a body (the material point) or
// `inertial` it is that of a velocity.
Measured FormulaDimensions::rate_of_point(const Syntax& s, int times) {
  const DimensionForm per = power(unit("s"), times);
  if (s.args.size() == 1) return vector(argument(s, 0).dimension / per);
  for (const Syntax& a : s.args)
    if (const Measured m = of(a); m.type == Type::vector) expect(m, unit("m"), a.span);
  return vector(unit("m") / per);
}

}  // namespace anholon

#include "published/vocabulary.h"

#include <algorithm>

#include "base/join.h"
#include "expr/table.h"
#include "formula/functions.h"
#include "mechanics/mechanics.h"
#include "modelfile/names/hints.h"
#include "proof/equations_of_motion.h"

namespace anholon {

namespace {

constexpr long kHighestDerivative = 20;

const char* const kNumbers[] = {"T_r", "S_r", "V_O", "V_omega", "h", "power_noncons", "power_constraint"};
const char* const kColumns[] = {"Q",     "QR", "QD",           "Qomega", "minus_dVO", "minus_dVomega",
                                "Gamma", "G",  "inertia_term", "N"};
const char* const kOfConstraints[] = {"phi", "f", "C", "g", "B", "mu", "lambda"};
const char* const kFunctions[] = {"partial", "Dt", "frozen", "reduced", "star", "along"};

template <std::size_t n>
bool among(const char* const (&list)[n], const std::string& name) {
  return std::any_of(std::begin(list), std::end(list), [&](const char* x) { return name == x; });
}

// Returns the path of a chain of members of a name; empty if s is not one.
std::string path_of(const Syntax& s) {
  if (s.op == Syntax::Op::name) return s.text;
  if (s.op != Syntax::Op::member) return {};
  const std::string inner = path_of(s.args[0]);
  return inner.empty() ? inner : inner + "." + s.text;
}

const Formulation* form_named(std::string name) {
  std::replace(name.begin(), name.end(), '_', '-');
  return find_formulation(name);
}

long whole_number(const Value& v, const Syntax& s) {
  const Expr* e = std::get_if<Expr>(&v);
  if (!e || !is_number(*e) || !number_value(*e).is_integer() || number_value(*e) < 0 ||
      number_value(*e) > kHighestDerivative)
    throw Failure(s.span, "a whole number between 0 and " + std::to_string(kHighestDerivative) + " is expected here");
  return number_value(*e).to_long();
}

void expect(const Syntax& call, std::size_t least, std::size_t most) {
  const std::size_t n = call.args.size();
  if (n >= least && n <= most) return;
  throw Failure(call.span, call.text + " takes " + std::to_string(least) +
                               (most > least ? " or " + std::to_string(most) : std::string()) +
                               (most == 1 ? " argument, " : " arguments, ") + std::to_string(n) +
                               (n == 1 ? " is given" : " are given"));
}

}  // namespace

Vocabulary::Vocabulary(const Mechanics& mechanics, std::shared_ptr<Names> model, EliminationOf elimination)
    : mechanics_(mechanics), model_(std::move(model)), elimination_(std::move(elimination)) {}

std::vector<std::string> Vocabulary::split(const std::string& path) {
  std::vector<std::string> parts;
  for (std::size_t from = 0; from <= path.size();) {
    const std::size_t dot = std::min(path.find('.', from), path.size());
    parts.push_back(path.substr(from, dot - from));
    from = dot + 1;
  }
  return parts;
}

bool Vocabulary::is_word(const std::string& first) const {
  if (first == "derived") return true;
  if (first != "lambda" && declares(first)) return false;
  return among(kColumns, first) || among(kOfConstraints, first) || form_named(first);
}

void Vocabulary::join(Syntax& s) const {
  if (s.op == Syntax::Op::member) {
    const Syntax* first = &s;
    while (first->op == Syntax::Op::member) first = &first->args[0];
    if (first->op == Syntax::Op::name && !lets_.count(first->text) && is_word(first->text)) {
      Span span = first->span;
      span.length = static_cast<std::uint32_t>(s.end - s.offset);
      s = Syntax{Syntax::Op::name, path_of(s), {}, span, s.offset, s.end, {}};
      return;
    }
  }
  for (Syntax& a : s.args) join(a);
}

std::vector<std::string> Vocabulary::local_names() const {
  std::vector<std::string> list;
  for (const auto& [name, value] : lets_) list.push_back(name);
  return list;
}

void Vocabulary::let(const std::string& name, Syntax value, Span span) {
  if (!is_identifier(name))
    throw Failure(span, "'" + name.substr(0, 40) + "' is not a name",
                  "letters (a-z, A-Z, Greek), digits and _, not starting with a digit");
  if (lets_.count(name)) throw Failure(span, "'" + name + "' is already defined in this file");
  if (declares(name)) throw Failure(span, "'" + name + "' is a name of the model");
  static const char* const reserved[] = {"t", "pi", "ex", "ey", "ez", "inertial", "here", "let", "derived"};
  if (among(reserved, name) || among(kNumbers, name) || is_word(name) || among(kFunctions, name))
    throw Failure(span, "the name '" + name + "' has a meaning in equations", "choose another name for the definition");
  Value v = evaluate(value, *this);
  lets_.emplace(name, Let{std::move(value), std::move(v)});
}

Expr Vocabulary::finished(Expr e) {
  if (used_quasi_) e = elimination_(true).in_coordinates({e})[0];
  return put_masses(*mechanics_.model, e);
}

Expr Vocabulary::number(const Syntax& s) { return put_rates(*mechanics_.model, number_before_rates(s)); }

Expr Vocabulary::number_before_rates(const Syntax& s) { return finished(evaluate_number(s, *this)); }

Value Vocabulary::value(const Syntax& s) {
  const Value v = as_point(evaluate(s, *this), *this, s.span);
  if (s.op == Syntax::Op::name && !declares(s.text) && column(s.text))
    throw Failure(s.span, "'" + s.text + "' has an entry for each coordinate",
                  s.text + "." + mechanics_.model->coordinates[0].name);
  if (v.index() > 1)
    throw Failure(s.span, std::string("a side of an equation is a number or a vector, this is ") + type_name(v),
                  body_hint(v, *this));
  return each(v, s.span, [this](Expr e) { return put_rates(*mechanics_.model, finished(e)); });
}

Value Vocabulary::each(const Value& v, Span span, const std::function<Expr(Expr)>& f) const {
  if (const Expr* e = std::get_if<Expr>(&v)) return f(*e);
  const Vector* a = std::get_if<Vector>(&v);
  if (!a) throw Failure(span, std::string("a number or a vector is expected here, this is ") + type_name(v));
  const Expr x = f(a->x), y = f(a->y), z = f(a->z);
  return Vector{x, y, z};
}

Expr Vocabulary::in_time(Expr e) { return put_masses(*mechanics_.model, e); }

Expr Vocabulary::with_frozen_masses(Expr e) const {
  std::unordered_map<NodeId, Expr> frozen;
  const std::vector<VaryingMass>& masses = mechanics_.model->masses;
  for (std::size_t i = 0; i < masses.size(); ++i)
    if (!is_number(masses[i].value))
      frozen.emplace(masses[i].value.id, mechanics_.graph().mass(static_cast<std::uint32_t>(i)));
  return frozen.empty() ? e : replace_nodes({&e, 1}, frozen)[0];
}

// ---- names -------------------------------------------------------------------------------------

std::vector<std::string> Vocabulary::functions() const {
  std::vector<std::string> list = model_->functions();
  list.insert(list.end(), std::begin(kFunctions), std::end(kFunctions));
  return list;
}

Value Vocabulary::name(const std::string& name, Span span) {
  if (const auto it = lets_.find(name); it != lets_.end()) return it->second.value;
  if (by_symbols_)
    if (const std::optional<Expr> u = quasi_velocity(name)) return *u;
  if (declares(name)) return model_->name(name, span);
  std::vector<std::string> path = split(name);
  if (path[0] == "derived" && path.size() > 1) path.erase(path.begin());
  const std::string first = path[0];
  path.erase(path.begin());
  if (const std::optional<Value> v = word(first, path, span)) return *v;
  try {
    return model_->name(name, span);
  } catch (Failure& f) {
    // Equations have definitions of their own, so the model need not change.
    if (f.diagnostic.hint == kGiveItAValue)
      f.diagnostic.hint = "define it above, in the names of the model: let " + name + " = …";
    throw;
  }
}

std::size_t Vocabulary::coordinate(const std::string& name, Span span) const {
  const std::vector<Coordinate>& list = mechanics_.model->coordinates;
  std::vector<std::string> known;
  for (std::size_t a = 0; a < list.size(); ++a) {
    if (list[a].name == name) return a;
    known.push_back(list[a].name);
  }
  const std::string near = did_you_mean(name, known);
  throw Failure(span, "there is no coordinate '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
}

std::size_t Vocabulary::coordinate(const Value& v, Span span) const {
  if (const Expr* e = std::get_if<Expr>(&v)) {
    const Node& n = mechanics_.graph().node(e->id);
    if (n.kind == Kind::jet && n.order == 0) return n.index;
  }
  throw Failure(span, "a coordinate is expected here");
}

const Column* Vocabulary::column(const std::string& name) {
  if (!among(kColumns, name)) return nullptr;
  if (const auto it = columns_.find(name); it != columns_.end()) return &it->second;
  const Mechanics& m = mechanics_;
  const Column c = name == "Q"               ? m.Q
                   : name == "QR"            ? m.QR
                   : name == "QD"            ? m.QD
                   : name == "Qomega"        ? m.Qomega
                   : name == "minus_dVO"     ? m.minus_dVO
                   : name == "minus_dVomega" ? m.minus_dVomega
                   : name == "Gamma"         ? m.Gamma
                   : name == "G"             ? forces(m)
                   : name == "N"             ? m.N
                                             : lagrange_operator(m);
  return &columns_.emplace(name, c.empty() ? Column(m.q.size(), m.graph().zero()) : c).first->second;
}

std::optional<Value> Vocabulary::word(const std::string& first, const std::vector<std::string>& rest, Span span) {
  Graph& g = graph();
  const std::string whole = rest.empty() ? first : first + "." + joined(rest, ".");
  const auto one_member = [&](const char* of) {
    if (rest.empty())
      throw Failure(span, "'" + first + "' is " + of, first + "." + mechanics_.model->coordinates[0].name);
    return joined(rest, ".");
  };
  if (among(kNumbers, first) && rest.empty()) {
    if (first == "T_r") return mechanics_.T;
    if (first == "S_r") return mechanics_.S;
    if (first == "V_O") return mechanics_.V_O;
    if (first == "V_omega") return mechanics_.V_omega;
    const Power p = power(mechanics_);
    return first == "h" ? p.h : first == "power_noncons" ? p.noncons : p.constraint;
  }
  if (const Column* c = column(first)) {
    if (rest.empty()) return IncompleteName{"a list of numbers (one is along(Q, x), or Q(x))"};
    return (*c)[coordinate(joined(rest, "."), span)];
  }
  if (first == "phi" || first == "mu") {
    std::vector<std::string> known;
    if (first == "phi")
      known = mechanics_.model->names.multipliers;
    else
      for (const VaryingMass& m : mechanics_.model->masses) known.push_back(m.name);
    if (known.empty())
      throw Failure(span, first == "phi" ? "the model has no constraints" : "no mass of the model varies");
    std::size_t k = 0;
    if (rest.empty() && known.size() > 1)
      throw Failure(span, "there are " + std::to_string(known.size()) + " of '" + first + "'", first + "." + known[0]);
    if (!rest.empty()) {
      const std::string wanted = joined(rest, ".");
      k = static_cast<std::size_t>(std::find(known.begin(), known.end(), wanted) - known.begin());
      const std::string near = did_you_mean(wanted, known);
      if (k == known.size())
        throw Failure(
            span, "there is no '" + whole + "'" + (near.empty() ? "" : "; did you mean '" + first + "." + near + "'?"),
            first + "." + known[0]);
    }
    return first == "phi" ? mechanics_.phi[k] : g.mass(static_cast<std::uint32_t>(k));
  }
  if (first == "f")
    return solved(one_member("the right side of a constraint solved for a coordinate's derivative"), span);
  if (first == "g") {
    const std::size_t s = coordinate(one_member("a coordinate's derivative as a function of quasi-velocities"), span);
    used_quasi_ = true;
    return elimination_(true).g()[s];
  }
  if (first == "C" || first == "B") {
    if (rest.size() != 2)
      throw Failure(span, "'" + first + "' has two members",
                    first == "C" ? "C.y.x, of the dependent y by the independent x"
                                 : "B.x.u, of the coordinate x by the quasi-velocity u");
    const Elimination& E = elimination_(first == "B");
    const std::size_t s = coordinate(rest[0], span);
    const auto u = E.free.index_of(rest[1]);
    if (!u) throw Failure(span, "'" + rest[1] + "' is not among the free quantities");
    if (first == "B") {
      used_quasi_ = true;
      return E.g_by_u()[s][*u];
    }
    const auto d = static_cast<std::size_t>(std::find(E.dependent.begin(), E.dependent.end(), s) - E.dependent.begin());
    if (d == E.dependent.size())
      throw Failure(span, "'" + rest[0] + "' is an independent coordinate here",
                    "--eliminate names the dependent coordinates");
    return E.C()[d][*u];
  }
  if (const Formulation* form = form_named(first)) return of_form(*form, rest, span);
  if (rest.empty())
    if (const std::optional<Expr> u = quasi_velocity(first)) return *u;
  return std::nullopt;
}

std::optional<Expr> Vocabulary::quasi_velocity(const std::string& name) {
  const std::vector<QuasiVelocity>& own = mechanics_.model->quasi;
  // u_x is a name that forms in quasi-velocities introduce if the model has too few.
  const bool may_be_automatic = name.rfind("u_", 0) == 0;
  if (!may_be_automatic && std::none_of(own.begin(), own.end(), [&](const QuasiVelocity& u) { return u.name == name; }))
    return std::nullopt;
  const Elimination& E = elimination_(true);
  const auto k = E.free.index_of(name);
  if (!k) return std::nullopt;
  used_quasi_ = true;
  return E.solved ? graph().quasi(static_cast<std::uint32_t>(*k), 0) : E.free.named[*k];
}

Expr Vocabulary::of_form(const Formulation& form, const std::vector<std::string>& rest, Span span) {
  if (const std::string why = obstacle(form, mechanics_); !why.empty())
    throw Failure(span, std::string("the form ") + form.name + " does not apply: " + why);
  const bool quasi = form.unknowns == Unknowns::quasi_velocities;
  static const Elimination nothing;
  const Elimination& E = form.eliminates() ? elimination_(quasi) : nothing;
  auto it = forms_.find(form.name);
  if (it == forms_.end()) it = forms_.emplace(form.name, form.equations(mechanics_, E)).first;
  const Equations& e = it->second;
  std::vector<std::string> known;
  if (e.left.size() == mechanics_.q.size())
    for (const Coordinate& c : mechanics_.model->coordinates) known.push_back(c.name);
  else
    known = E.free.names;
  std::vector<std::string> path = rest;
  const bool left = !path.empty() && path[0] == "left" && path.size() > 1,
             right = !path.empty() && path[0] == "right" && path.size() > 1;
  if (left || right) path.erase(path.begin());
  const std::string wanted = joined(path, ".");
  const auto k = static_cast<std::size_t>(std::find(known.begin(), known.end(), wanted) - known.begin());
  if (k == known.size()) {
    std::string list;
    for (const std::string& n : known) list += (list.empty() ? "" : ", ") + n;
    throw Failure(span, "the form " + std::string(form.name) + " has no equation '" + wanted + "'",
                  "its equations are " + list);
  }
  if (quasi) used_quasi_ = true;
  return left ? e.left[k] : right ? e.right[k] : e.left[k] - e.right[k];
}

// Returns the solved derivative of y; if the constraints are not solved, the derivative represents its value on the
// manifold.
Expr Vocabulary::solved(const std::string& y, Span span) {
  const Elimination& E = elimination_(false);
  const std::size_t s = coordinate(y, span);
  if (std::find(E.dependent.begin(), E.dependent.end(), s) == E.dependent.end())
    throw Failure(span, "'" + y + "' is an independent coordinate here: the constraints are not solved for it",
                  "--eliminate names the dependent coordinates");
  return E.g()[s];
}

// ---- functions ---------------------------------------------------------------------------------

std::optional<Value> Vocabulary::call(const std::string& f, const std::vector<Value>& a, const Syntax& s) {
  if (std::optional<Value> value = model_->call(f, a, s)) return value;
  if (const Column* c = declares(f) ? nullptr : column(f)) {
    expect(s, 1, 1);
    return (*c)[coordinate(a[0], s.args[0].span)];
  }
  if (!among(kFunctions, f)) return piece_of_table(f, a, s);
  if (f == "partial") {
    expect(s, 2, 2);
    return partial_of(s, a[0]);
  }
  if (f == "Dt") {
    expect(s, 1, 2);
    const auto times = static_cast<unsigned>(a.size() > 1 ? whole_number(a[1], s.args[1]) : 1);
    return each(as_point(a[0], *this, s.span), s.args[0].span,
                [&](Expr e) { return total_derivative(with_frozen_masses(e), times); });
  }
  if (f == "frozen") {
    expect(s, 1, 1);
    return each(as_point(a[0], *this, s.span), s.args[0].span, [&](Expr e) { return with_frozen_masses(e); });
  }
  if (f == "reduced" || f == "star") {
    expect(s, 1, 1);
    const bool quasi = f == "star";
    const Elimination& E = elimination_(quasi);
    if (quasi) used_quasi_ = true;
    return each(as_point(a[0], *this, s.span), s.args[0].span, [&](Expr e) { return E.on(e); });
  }
  expect(s, 2, 2);
  const Column* c =
      s.args[0].op == Syntax::Op::name ? column(s.args[0].text.substr(s.args[0].text.rfind('.') + 1)) : nullptr;
  if (!c) throw Failure(s.args[0].span, "the name of a force is expected here", "along(Q, x), along(QR, x), …");
  if (s.args[1].op != Syntax::Op::name)
    throw Failure(s.args[1].span, "an independent coordinate or a quasi-velocity is expected here");
  return along(*c, s.args[1].text, s.args[1].span);
}

// Returns f.c0(x) of a table f. The formulas of a model that use the table contain all its pieces that vary.
std::optional<Expr> Vocabulary::piece_of_table(const std::string& name, const std::vector<Value>& a, const Syntax& s) {
  const std::size_t dot = name.rfind('.');
  if (dot == std::string::npos || !is_piece_of_table(name.substr(dot + 1))) return std::nullopt;
  Graph& g = graph();
  for (NodeId id = 0; id < g.size(); ++id) {
    const Node& n = g.node(id);
    if (n.kind != Kind::lookup || g.step_function(n.index).name != name) continue;
    expect(s, 1, 1);
    if (const Expr* x = std::get_if<Expr>(&a[0])) return g.lookup(n.index, *x);
    throw Failure(s.args[0].span, std::string("the argument of a table is a number, this is ") + type_name(a[0]));
  }
  return std::nullopt;
}

Expr Vocabulary::along(const Column& c, const std::string& direction, Span span) {
  const std::vector<QuasiVelocity>& own = mechanics_.model->quasi;
  const bool quasi = std::any_of(own.begin(), own.end(), [&](const QuasiVelocity& u) { return u.name == direction; });
  const Elimination& E = elimination_(quasi);
  const auto k = E.free.index_of(direction);
  if (!k)
    throw Failure(span, "'" + direction + "' is not among the free quantities",
                  "--eliminate names the dependent coordinates");
  if (quasi) used_quasi_ = true;
  return E.contract(c)[*k];
}

}  // namespace anholon

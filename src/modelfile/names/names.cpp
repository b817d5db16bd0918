#include "modelfile/names/names.h"

#include <algorithm>
#include <tuple>

#include "formula/habits.h"
#include "formula/indices.h"
#include "formula/units.h"
#include "modelfile/language/language.h"
#include "modelfile/names/hints.h"

namespace anholon {

// The limit of nested definitions in one evaluation (for the stack); deeper ones are evaluated from their parts up
// (from_the_ground).
static constexpr std::size_t kDeepest = 200;

void Scope::check_name(const std::string& name, Span span) const {
  if (!is_element_name(name))
    throw Failure(span, "'" + name.substr(0, 40) + "' is not a name",
                  "letters (a-z, A-Z, Greek), digits and _, not starting with a digit");
  if (is_reserved(name)) throw Failure(span, "the name '" + name + "' is reserved");
  if (letters_.count(name.substr(0, name.find('['))))
    throw Failure(span, "the name '" + name + "' is reserved: it is an index");
}

void Scope::declare(const std::string& name, Declaration d) {
  check_name(name, d.span);
  for (const std::string& a : d.arguments)
    if (letters_.count(a)) throw Failure(d.span, "the argument '" + a + "' is an index");
  d.place = declarations_.size();
  const auto [it, fresh] = declarations_.emplace(name, d);
  if (!fresh)
    throw Failure(d.span, "'" + name + "' is already declared in " + line_of(it->second.span, model_.source_text));
}

void Scope::declare_body(const std::string& name, Span span) {
  parts_.emplace_back();
  body_names_.push_back(name);
  body_spans_.push_back(span);
  check_name(name, span);
  const auto [it, fresh] = bodies_.emplace(name, body_names_.size() - 1);
  if (!fresh)
    throw Failure(span, "a body '" + name + "' is already declared in " +
                            line_of(body_spans_[it->second], model_.source_text));
}

std::size_t Scope::add_table(Table table) {
  TableFunction function(*model_.graph, table);
  tables_.push_back({std::move(table), std::move(function)});
  return tables_.size() - 1;
}

std::size_t Scope::body(const std::string& name, Span span) const {
  if (const std::size_t* found = find_body(name)) return *found;
  if (const std::string members = members_known(name, body_names_); !members.empty())
    throw Failure(span, "there is no body or particle '" + name + "'" + members);
  const std::string near = did_you_mean(name, body_names_);
  // The nearest name comes first.
  constexpr std::size_t kMostListed = 8;
  std::string others;
  for (std::size_t i = 0, listed = 0; i < body_names_.size() && listed <= kMostListed; ++i) {
    if (body_names_[i] == near) continue;
    others += listed == kMostListed ? ", …" : (others.empty() && near.empty() ? "" : ", ") + body_names_[i];
    ++listed;
  }
  throw Failure(span,
                "there is no body or particle '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                others.empty() ? "" : "the model has the bodies and particles " + near + others);
}

const std::size_t* Scope::find_body(const std::string& name) const {
  const auto it = bodies_.find(name);
  return it == bodies_.end() ? nullptr : &it->second;
}

void Scope::refuse_unknown(const std::string& name, Span span) const {
  if (failed_.count(name)) throw silent_failure();
  // If there are more failures, no names are suggested: they would not help, and take long.
  constexpr std::size_t kMostGuesses = 100;
  if (failures.size() > kMostGuesses) throw Failure(span, "unknown name '" + name.substr(0, 60) + "'");
  std::vector<std::string> known;
  for (const ReservedName& r : reserved_names()) known.emplace_back(r.name);
  for (const auto& [n, d] : declarations_) known.push_back(n);
  known.insert(known.end(), body_names_.begin(), body_names_.end());
  const bool member = name.find('[') != std::string::npos;
  if (const std::string members = members_known(member ? name : name + "[", known); !members.empty())
    throw Failure(span,
                  member ? "there is no '" + name + "'" + members : "'" + name + "' is a family, not a name" + members);
  const auto varies = [&](const std::string& n) {
    const auto it = declarations_.find(n);
    return it != declarations_.end() &&
           (it->second.role == Role::coordinate || it->second.role == Role::state || it->second.role == Role::control);
  };
  if (const std::string habit = habit_of_name(name, varies); !habit.empty())
    throw Failure(span, "unknown name '" + name.substr(0, 60) + "'", habit);
  if (forces.of_contacts.declares(name))
    throw Failure(span, "'" + name + "' is a contact, and its gap has no name in formulas",
                  "write the gap with points and coordinates, as P.z - R; lambda." + name +
                      " is the normal force, in monitors, outputs, rates and events");
  const std::string near = did_you_mean(name, known);
  throw Failure(span,
                "unknown name '" + name.substr(0, 60) + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                near.empty() ? kGiveItAValue : "");
}

// ---- evaluation ------------------------------------------------------------------------------

Expr Scope::number(const Item& item) {
  if (!item.is_formula()) throw Failure(item.span, "a number or a formula is expected here");
  return evaluate_number(parse_formula(item.formula), *this);
}

Value Scope::evaluate_value(const Item& item) {
  if (item.kind == Item::Kind::array) return vector(item);
  if (!item.is_formula()) throw Failure(item.span, "a number or a formula is expected here");
  return evaluate(parse_formula(item.formula), *this);
}

Vector Scope::vector(const Item& item) {
  if (item.kind == Item::Kind::array) {
    if (item.items.size() != 3)
      throw Failure(item.span, "a vector has three components, " + std::to_string(item.items.size()) + " are given",
                    item.items.size() == 2 ? "in the plane the third is 0" : "");
    return {number(item.items[0]), number(item.items[1]), number(item.items[2])};
  }
  if (!item.is_formula()) throw Failure(item.span, "a vector is expected: [\"…\", \"…\", \"…\"] or a formula");
  return evaluate_vector(parse_formula(item.formula), *this);
}

Rotation Scope::rotation(const Item& item) {
  if (item.kind != Item::Kind::string)
    throw Failure(item.span, "a rotation is expected", "a formula such as \"rotz(theta)\"");
  return evaluate_rotation(parse_formula(item.formula), *this);
}

std::vector<Syntax> Scope::equation(const Item& item) {
  if (item.kind != Item::Kind::string)
    throw Failure(item.span, "an equation is expected", "a string such as \"x' = 0\"");
  std::vector<Syntax> sides = parse_equation(item.formula);
  if (sides.size() != 2)
    throw Failure(item.formula.whole(), "an equation needs '='", "write \"" + item.text().substr(0, 60) + " = 0\"");
  return sides;
}

bool has_unit(const Syntax& s) {
  return s.op == Syntax::Op::quantity || std::any_of(s.args.begin(), s.args.end(), has_unit);
}

// Returns the value in its unit: {value = 2, unit = "km"} is 2 km. A bare number from outside has this unit as well,
// and a number with a unit keeps its own.
Value Scope::in_its_unit(Value v, const Declaration& d) {
  if (d.unit.empty()) return v;
  const bool own = d.item ? std::any_of(d.item->items.begin(), d.item->items.end(),
                                        [](const Item& i) { return has_unit(parse_formula(i.formula)); })
                          : has_unit(parse_formula(d.formula));
  if (own && !d.override.empty()) return v;
  if (own)
    throw Failure(d.item ? d.item->span : d.formula.whole(), "the unit is given twice: with the value and by 'unit'");
  Graph& g = *model_.graph;
  const Unit unit = read_unit(d.unit).value_or(Unit{});
  const Expr factor = unit.factor * pow(g.pi(), unit.pi);
  if (const Expr* e = std::get_if<Expr>(&v)) return *e * factor;
  if (const Vector* a = std::get_if<Vector>(&v)) return factor * *a;
  return v;
}

Value Scope::evaluate_declaration(const std::string& name, Declaration& d) {
  Graph& g = *model_.graph;
  switch (d.role) {
  case Role::state:
    return g.state(static_cast<std::uint32_t>(d.index), 0);
  case Role::control:
    return g.control(static_cast<std::uint32_t>(d.index), 0);
  case Role::table:
    return IncompleteName{"a table (its value is NAME(x))"};
  case Role::coordinate:
    return g.jet(static_cast<std::uint32_t>(d.index), 0);
  case Role::function:
    if (d.symbolic) return g.given(static_cast<std::uint32_t>(d.index), 0);
    [[fallthrough]];
  case Role::define:
  case Role::parameter: {
    Value v = in_its_unit(d.item ? Value(vector(*d.item)) : evaluate(parse_formula(d.formula), *this), d);
    if (d.role != Role::parameter) {
      if (Expr* e = std::get_if<Expr>(&v)) {
        const Kind k = g.node(e->id).kind;
        if (k == Kind::sum || k == Kind::product || k == Kind::function || k == Kind::atan2)
          model_.names.defined.emplace(e->id, name);
      }
    }
    if (d.role == Role::define) return v;
    if (d.role == Role::function) {
      Expr* e = std::get_if<Expr>(&v);
      if (e && jet_order(*e) >= 0)
        throw Failure(d.span, "the given function '" + name + "' depends on a coordinate",
                      "functions of t stand under [functions], formulas with coordinates under [define]");
      return v;
    }
    const auto check = [&](Expr e) {
      for (NodeId id : symbols({&e, 1}))
        if (g.node(id).kind != Kind::parameter)
          throw Failure(d.span, "the parameter '" + name + "' is not constant",
                        "functions of t stand under [functions], formulas with coordinates under [define]");
    };
    if (Expr* e = std::get_if<Expr>(&v)) {
      check(*e);
      model_.parameters[d.index].value = *e;
      model_.parameters[d.index].unit = d.unit;
      return g.parameter(static_cast<std::uint32_t>(d.index));
    }
    if (Vector* a = std::get_if<Vector>(&v)) {
      for (int i = 0; i < 3; ++i) check((*a)[i]);
      model_.parameters[d.index].vector = true;
      return v;
    }
    throw Failure(d.span, std::string("a parameter is a number or a vector, this is ") + type_name(v));
  }
  case Role::frame:
    return evaluate_rotation(parse_formula(d.formula), *this);
  case Role::point:
    return d.item ? vector(*d.item) : evaluate_vector(parse_formula(d.formula), *this);
  }
  return InertialName{};
}

namespace {
// Marks a declaration as being evaluated until the evaluation ends, with or without a failure.
class Opened {
 public:
  Opened(bool& flag, std::size_t& depth) : flag_(flag), depth_(depth) { flag_ = true, ++depth_; }
  ~Opened() { flag_ = false, --depth_; }
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;

 private:
  bool& flag_;
  std::size_t& depth_;
};
}  // namespace

// Repeats the evaluation, each time beginning with the definition that was too deep before, until the first request
// succeeds.
void Scope::from_the_ground(const std::function<void()>& ask) {
  std::vector<TooDeep> waiting{{"", nullptr, {}, ask}};
  while (!waiting.empty()) {
    try {
      waiting.back().ask();
      waiting.pop_back();
    } catch (const TooDeep& deep) {
      const auto again =
          std::find_if(waiting.begin(), waiting.end(), [&](const TooDeep& w) { return w.name == deep.name; });
      if (again != waiting.end()) {
        std::string path;
        for (auto it = again; it != waiting.end(); ++it) path += it->name + " -> … -> ";
        const Failure f(deep.use, "'" + deep.name + "' is defined through itself: " + path + deep.name);
        if (!deep.declaration) throw f;
        deep.declaration->state = Declaration::State::failed;
        failures.push_back(f.diagnostic);
        throw silent_failure();
      }
      waiting.push_back(deep);
    } catch (const Failure&) {
      // The declaration stores its failure; the definitions that wait for it fail at its use.
      if (waiting.size() == 1 || !waiting.back().declaration) throw;
      waiting.pop_back();
    }
  }
}

const Value& Scope::resolve(const std::string& name, Declaration& d, Span use) {
  if (d.state == Declaration::State::done) return d.value;
  if (depth_ == 0)
    from_the_ground([&] { settle(name, d, use); });
  else
    settle(name, d, use);
  return d.value;
}

void Scope::settle(const std::string& name, Declaration& d, Span use) {
  using State = Declaration::State;
  if (d.state == State::done) return;
  if (d.state == State::failed) throw silent_failure();
  if (d.state == State::open) {
    std::string path;
    const auto from = std::find(open_.begin(), open_.end(), name);
    for (auto it = from; it != open_.end(); ++it) path += *it + " -> ";
    throw Failure(use, "'" + name + "' is defined through itself: " + path + name);
  }
  if (depth_ > kDeepest) throw TooDeep{name, &d, use, [this, name, &d, use] { settle(name, d, use); }};
  d.state = State::open;
  ++depth_;
  open_.push_back(name);
  // A definition has the same meaning wherever it is used: not frozen, not inside a call.
  const bool frozen = std::exchange(freeze_masses, false);
  const auto arguments = std::exchange(arguments_, {});
  const auto here = std::exchange(here_, std::nullopt);
  const auto restore = [&] {
    --depth_;
    open_.pop_back();
    freeze_masses = frozen;
    arguments_ = arguments;
    here_ = here;
  };
  try {
    d.value = evaluate_declaration(name, d);
    d.state = State::done;
  } catch (const Failure& f) {
    d.state = State::failed;
    restore();
    if (!is_silent(f.diagnostic)) {
      failures.push_back(f.diagnostic);
      if (name.find('[') != std::string::npos) failures.back().message = "in " + name + ": " + f.diagnostic.message;
      if (!d.override.empty()) failures.back().message = d.override + ": " + f.diagnostic.message;
    }
    throw silent_failure();
  } catch (const TooDeep&) {
    d.state = State::fresh;
    restore();
    throw;
  }
  restore();
}

void Scope::resolve_all() {
  // The order is that of the file; members of a family are in their order.
  std::vector<std::pair<const std::string*, Declaration*>> order;
  for (auto& [name, d] : declarations_) order.push_back({&name, &d});
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) {
    const auto key = [](const Declaration& d) { return std::tuple(d.span.file, d.span.line, d.span.column, d.place); };
    return key(*a.second) < key(*b.second);
  });
  for (const auto& [named, declared] : order) {
    const std::string& name = *named;
    Declaration& d = *declared;
    try {
      std::optional<ForcesInFormulas::Allowed> allowed;
      if (d.role == Role::define) allowed.emplace(forces);
      if (d.arguments.empty())
        resolve(name, d, d.span);
      else if (!d.parsed)
        parse_formula(d.formula);
    } catch (const Failure& f) {
      if (!is_silent(f.diagnostic)) failures.push_back(f.diagnostic);
    }
  }
}

Value Scope::name(const std::string& name, Span span) {
  Graph& g = *model_.graph;
  if (!arguments_.empty())
    if (const auto it = arguments_.back().find(name); it != arguments_.back().end()) return it->second;
  if (name == "t") return g.time();
  if (name == "pi") return g.pi();
  if (name == "ex" || name == "ey" || name == "ez") return identity_rotation(g)[name[1] - 'x'];
  if (name == "inertial") return InertialName{};
  if (name == "here") {
    if (!here_) throw Failure(span, "'here' has a meaning only in the field of [gravity]");
    return *here_;
  }
  if (name == "lambda") {
    if (forces.allowed()) return kMultipliers;
    throw Failure(span,
                  "a multiplier has no meaning here: it follows from the equations of which this formula is a part",
                  kWhereMultipliers);
  }
  const auto it = declarations_.find(name);
  if (it != declarations_.end()) {
    if (it->second.role == Role::table || !it->second.arguments.empty())
      throw Failure(span, "the function '" + name + "' is used without its arguments", name + "(…)");
    if (!forces.allowed() && holds_multiplier(name))
      throw Failure(
          span,
          "'" + name +
              "' holds a multiplier or a reaction, which follow from the equations of which this formula is a part",
          kWhereMultipliers);
    const Value v = resolve(name, it->second, span);
    if (freeze_masses)
      if (const Expr* e = std::get_if<Expr>(&v))
        for (std::size_t i = 0; i < model_.masses.size(); ++i)
          if (model_.masses[i].value == *e) return g.mass(static_cast<std::uint32_t>(i));
    return v;
  }
  if (const std::size_t* body = find_body(name)) return BodyName{*body};
  refuse_unknown(name, span);
}

std::vector<std::string> Scope::functions() const {
  std::vector<std::string> list;
  for (const FunctionRow& f : kinematic_functions()) list.push_back(f.name);
  for (const auto& [name, d] : declarations_)
    if (d.role == Role::function || d.role == Role::frame || d.role == Role::table) list.push_back(name);
  list.insert(list.end(), body_names_.begin(), body_names_.end());
  return list;
}

Value Scope::member(const Value& object, const Syntax& s) {
  const std::string& m = s.text;
  const int axis = m.size() == 1 && m[0] >= 'x' && m[0] <= 'z' ? m[0] - 'x' : -1;
  if (const Vector* v = std::get_if<Vector>(&object)) {
    if (axis >= 0) return (*v)[axis];
    const std::string habit = habit_of_member(s);
    throw Failure(s.span, "a vector has the members x, y and z", habit);
  }
  if (const Rotation* r = std::get_if<Rotation>(&object)) {
    if (axis >= 0) return (*r)[axis];
    throw Failure(s.span, "a frame has the members x, y and z");
  }
  if (const BodyName* b = std::get_if<BodyName>(&object)) {
    if (m == "center" || m == "position") return center(b->index, s.span);
    if (axis >= 0 && parts_[b->index].particle) return center(b->index, s.span)[axis];
    if (axis >= 0) return orientation(b->index, s.span)[axis];
    throw Failure(s.span, parts_[b->index].particle ? "a particle has the members position, x, y and z"
                                                    : "a body has the members center, x, y and z");
  }
  const auto is_force = [&] {
    const Expr* e = std::get_if<Expr>(&object);
    const Node* n = e ? &graph().node(e->id) : nullptr;
    return n && n->kind == Kind::multiplier && n->index >= kContactForces;
  };
  if (forces.allowed() && (is_incomplete(object) || is_force()))
    if (const std::string path = multiplier_path(s); !path.empty()) return multiplier(path, s.span);
  throw Failure(s.span, std::string(type_name(object)) + " has no member '" + m + "'",
                is_scalar(object) ? habit_of_member(s) : "");
}

// Returns the point of a particle, its position. (A body that merely has no orientation does not denote its centre.)
std::optional<Vector> Scope::point(const BodyName& body, Span use) {
  return parts_[body.index].particle ? std::optional(center(body.index, use)) : std::nullopt;
}

std::optional<Rotation> Scope::frame(const BodyName& body, Span use) {
  return has_orientation(body.index) ? std::optional(orientation(body.index, use)) : std::nullopt;
}

Vector Scope::center(std::size_t body, Span use) {
  if (depth_ == 0)
    from_the_ground([&] { settle_center(body, use); });
  else
    settle_center(body, use);
  return *parts_[body].center_value;
}

// Reports a failure once: a later use of the failed element fails silently.
static void keep_failure(bool& failed, const std::function<void()>& f) {
  try {
    f();
  } catch (const Failure&) {
    failed = true;
    throw;
  }
}

void Scope::settle_center(std::size_t body, Span use) {
  BodyParts& p = parts_[body];
  if (p.center_value) return;
  if (!p.center || p.center_failed) throw silent_failure();
  if (p.center_open) throw Failure(use, "the centre of '" + body_names_[body] + "' is defined through itself");
  if (depth_ > kDeepest)
    throw TooDeep{body_names_[body] + ".center", nullptr, use, [this, body, use] { settle_center(body, use); }};
  const Opened opened(p.center_open, depth_);
  keep_failure(p.center_failed, [&] { p.center_value = vector(*p.center); });
}

const Rotation& Scope::orientation(std::size_t body, Span use) {
  if (depth_ == 0)
    from_the_ground([&] { settle_orientation(body, use); });
  else
    settle_orientation(body, use);
  return *parts_[body].orientation_value;
}

void Scope::settle_orientation(std::size_t body, Span use) {
  BodyParts& p = parts_[body];
  if (p.orientation_value) return;
  if (p.orientation_failed) throw silent_failure();
  if (!has_orientation(body)) throw Failure(use, what_is(body) + " has no orientation", orientation_hint(body));
  if (p.orientation_open)
    throw Failure(use, "the orientation of '" + body_names_[body] + "' is defined through itself");
  if (depth_ > kDeepest)
    throw TooDeep{body_names_[body] + ".orientation", nullptr, use,
                  [this, body, use] { settle_orientation(body, use); }};
  const Opened opened(p.orientation_open, depth_);
  keep_failure(p.orientation_failed,
               [&] { p.orientation_value = p.orientation ? rotation(*p.orientation) : turn(2, number(*p.angle)); });
}

}  // namespace anholon

#include "modelfile/mechanical/contacts.h"

#include <algorithm>

#include "expr/normal.h"
#include "formula/indices.h"
#include "modelfile/mechanical/contact_shapes.h"
#include "modelfile/mechanical/gaps.h"
#include "modelfile/mechanical/tangential.h"
#include "modelfile/names/along.h"
#include "modelfile/names/constant.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

bool Contact::rough() const { return !slip.empty() && !(is_zero(friction) && is_zero(static_friction)); }

std::map<std::string, std::string> column_units(const std::vector<Contact>& contacts) {
  std::map<std::string, std::string> units;
  const auto add = [&](const std::string& column, const std::string& unit) {
    if (!unit.empty()) units[column] = unit;
  };
  for (const Contact& c : contacts) {
    if (c.under) {
      add(c.name + ".moment", c.units.friction);
      continue;
    }
    add(c.name + ".gap", c.units.gap);
    add(c.name + ".normal", c.units.normal);
    add(c.name + ".friction", c.units.friction);
  }
  return units;
}

std::string hint_for_coefficient(const std::string& name) {
  for (const std::string key :
       {"friction", "static_friction", "restitution", "rolling_resistance", "drilling_resistance"})
    if (name == key || name.ends_with("." + key))
      return "a coefficient that takes other values is a parameter: parameters = {c = 0.3} in the file, and " + key +
             " = \"c\" in the contact";
  return "";
}

namespace {

class ContactReader {
 public:
  ContactReader(Scope& scope, Model& model, Diagnostics& diagnostics)
      : scope_(scope), model_(model), diagnostics_(diagnostics) {}

  // Reads one contact with its resistance; for a box those of its corners.
  std::vector<Contact> read(const Item& c, std::size_t number) const {
    Contact contact = begin(c, "contact" + std::to_string(number + 1));
    if (!c.find("body")) read_formulas(c, contact);
    Graph& g = *model_.graph;
    const Item *friction = c.find("friction"), *fixed = c.find("static_friction"), *e = c.find("restitution");
    contact.friction = friction ? coefficient(*friction, contact) : g.zero();
    contact.static_friction = fixed ? coefficient(*fixed, contact) : contact.friction;
    contact.restitution = e ? coefficient(*e, contact) : g.zero();
    if (const Item* law = c.find("impact")) contact.law = impact_law(*law);
    if (c.find("body")) return by_shape(c, contact);
    for (const char* key : {"rolling_resistance", "drilling_resistance"})
      if (const Item* i = c.find(key))
        throw Failure(i->key_span,
                      "'" + std::string(key) + "' needs the angular velocity of a body, and this contact names none",
                      "body = \"ball\" in place of gap and slip");
    if (contact.slip.empty() && (friction || fixed))
      throw Failure(
          (friction ? friction : fixed)->key_span,
          "the contact '" + contact.name + "' has friction and no slip velocity",
          "slip = \"vel(B, P)\", the velocity of the material point at the contact, along = [\"ex\", \"ey\"]");
    return {contact};
  }

  // Reads a constraint with one_sided = true: it has no friction, and impacts do not rebound.
  Contact read_one_sided(const Item& c, std::size_t number) const {
    Contact contact = begin(c, "constraint" + std::to_string(number + 1));
    for (const char* key : {"by", "along"})
      if (const Item* other = c.find(key))
        throw Failure(other->key_span, std::string("'") + key + "' does not go with one_sided = true",
                      "one_sided goes with one equation of coordinates and time; friction needs a [[contact]]");
    const Item* equation = c.find("equation");
    if (!equation) throw Failure(c.span, "a constraint has no equation", "equation = \"P.z = 0\"");
    const std::vector<Syntax> sides = scope_.equation(*equation);
    const auto side = [&](const Syntax& s) { return evaluate_number(s, scope_); };
    contact.gap = put_masses(model_, side(sides[0]) - side(sides[1]));
    if (jet_order(contact.gap) != 0)
      throw Failure(equation->span,
                    "a constraint of one side is an equation of coordinates and time, without velocities",
                    "rolling and friction: a [[contact]] with slip = \"vel(B, P)\"");
    contact.friction = contact.static_friction = contact.restitution = model_.graph->zero();
    return contact;
  }

 private:
  // Begins a contact with its name and its place.
  static Contact begin(const Item& c, const std::string& without_name) {
    Contact contact;
    const Item* named = c.find("name");
    if (named && named->kind != Item::Kind::string) throw Failure(named->span, "a name is a text");
    contact.name = named ? normal_name(named->text()) : without_name;
    contact.element = contact.name;
    contact.span = named ? named->formula.whole() : c.span;
    if (!is_element_name(contact.name))
      throw Failure(contact.span, "'" + contact.name.substr(0, 40) + "' is not a name",
                    "a name has letters, digits and '_', and begins with a letter: name = \"floor\"");
    return contact;
  }

  static ImpactLaw impact_law(const Item& law) {
    const std::string word = law.kind == Item::Kind::string ? law.text() : std::string();
    if (word == "newton") return ImpactLaw::newton;
    if (word != "poisson") throw Failure(law.span, "the law of impacts is newton or poisson", "impact = \"poisson\"");
    return ImpactLaw::poisson;
  }

  void read_formulas(const Item& c, Contact& contact) const {
    for (const char* key : {"shape", "at", "on", "normal", "through"})
      if (const Item* i = c.find(key))
        throw Failure(i->key_span, "'" + std::string(key) + "' goes with 'body'", "body = \"ball\"");
    const Item* gap = c.find("gap");
    if (!gap && (is_misspelt("gap", c, "contact") || is_misspelt("body", c, "contact"))) throw silent_failure();
    if (!gap)
      throw Failure(contact.span, "the contact '" + contact.name + "' has no gap",
                    "gap = \"P.z - R\": the distance, which is not negative; or body = \"ball\", whose shape touches");
    contact.gap = formula(*gap, "a gap");
    if (touches_zero_only(contact.gap))
      throw Failure(gap->span, "the gap of the contact '" + contact.name + "' touches zero and does not pass it",
                    "a distance with a sign, which a body that passes makes negative: z in place of z^2 or abs(z), "
                    "norm(P) - R in "
                    "place of norm(P)");
    if (jet_order(contact.gap) < 0)
      throw Failure(gap->span, "the gap of the contact '" + contact.name + "' does not depend on coordinates",
                    "gap = \"P.z - R\": the distance of a point P that moves");
    if (jet_order(contact.gap) > 0)
      throw Failure(gap->span, "a gap is a formula of coordinates and time, without velocities",
                    "the velocity at the contact is the slip: slip = \"vel(B, P)\"");
    const Item* slip = c.find("slip");
    if (!slip) return;
    contact.slip = velocities(*slip, c.find("along"), contact.gap);
    check_slips(contact.gap, contact.slip, contact.name, slip->span, model_, diagnostics_);
  }

  std::vector<Contact> by_shape(const Item& c, const Contact& common) const {
    const std::vector<Touching> places = read_touching(c, scope_, model_);
    std::vector<Contact> list;
    for (const Touching& t : places) {
      Contact contact = common;
      if (places.size() > 1) contact.name += std::to_string(list.size() + 1);
      contact.shape = t.shape;
      contact.gap = put_masses(model_, t.gap);
      for (const Expr& size : t.sizes)
        if (constant_value(model_, size)) contact.sizes.push_back(size);
      if (jet_order(contact.gap) != 0)
        throw Failure(c.find("body")->span,
                      "the gap of the contact '" + contact.element + "' does not depend on coordinates",
                      "a contact is that of a body which moves");
      std::vector<Direction> across;
      if (const Item* along = c.find("along"))
        across = tangential_directions(*along, t);
      else
        for (const Vector& d : t.directions) across.push_back({"", d});
      int index = 0;
      for (const Direction& d : across) {
        const Expr v = put_masses(model_, component(t.slip, d, index++));
        if (!proved_zero(v)) contact.slip.push_back(v);
      }
      if (contact.slip.size() > 2) throw Failure(c.find("along")->span, "a slip velocity has one or two components");
      list.push_back(contact);
      const std::size_t place = list.size() - 1;
      add_resistance(c, "rolling_resistance", t, t.directions, contact, place, list);
      add_resistance(c, "drilling_resistance", t, {t.normal}, contact, place, list);
    }
    return list;
  }

  std::vector<Direction> tangential_directions(const Item& along, const Touching& t) const {
    std::vector<Direction> list = orthonormal_directions(along, scope_);
    std::vector<Vector> axes;
    for (const Direction& d : list)
      if (d.axis) axes.push_back(*d.axis);
    check_tangential(axes, t.normal, model_, along.span, scope_.identities);
    return list;
  }

  // Adds the resistance by a moment about the directions, which is at most the length of this key times the normal
  // force.
  void add_resistance(const Item& c, const std::string& key, const Touching& t, const std::vector<Vector>& directions,
                      const Contact& contact, std::size_t place, std::vector<Contact>& list) const {
    const Item* given = c.find(key);
    if (!given) return;
    const bool rolling = directions.size() > 1;
    if (t.shape == "box" || (rolling && t.shape == "point"))
      throw Failure(given->key_span,
                    "a " + t.shape +
                        (rolling ? " does not roll" : " touches with its corners, which resist drilling by friction"),
                    "leave out '" + key + "', or shape = \"ball(R)\" or \"disc(R)\"");
    if (!t.rate)
      throw Failure(given->key_span,
                    "the body of the contact '" + contact.name + "' has no orientation, so it has no angular velocity",
                    "orientation = \"roty(phi)\" in the body");
    Contact resistance = contact;
    resistance.name += rolling ? ".rolling" : ".drilling";
    resistance.element = resistance.name;
    resistance.span = given->span;
    resistance.given.clear();
    resistance.sizes.clear();
    resistance.friction = resistance.static_friction = coefficient(*given, resistance);
    resistance.under = place;
    resistance.slip.clear();
    for (const Vector& d : directions) {
      const Expr w = put_masses(model_, dot(*t.rate, d));
      if (!proved_zero(w)) resistance.slip.push_back(w);
    }
    if (resistance.slip.empty())
      throw Failure(given->key_span,
                    "the body of the contact '" + contact.name + "' never " +
                        (rolling ? "rolls: it turns about the normal alone" : "turns about the normal"),
                    "leave out '" + key + "'");
    list.push_back(std::move(resistance));
  }

  Expr formula(const Item& i, const std::string& what) const {
    if (!i.is_formula()) throw Failure(i.span, what + " is a formula");
    return put_masses(model_, evaluate_number(parse_formula(i.formula), scope_));
  }

  // Describes a symbol that a motion changes: "x'", "the time".
  std::string changing(const Node& n) const {
    if (n.kind == Kind::time) return "the time";
    if (n.kind != Kind::jet) return "the motion";
    return "'" + model_.coordinates[n.index].name + std::string(n.order, '\'') + "'";
  }

  // Reads a formula of parameters, and notes it in the contact.
  Expr coefficient(const Item& i, Contact& contact) const {
    const Expr e = formula(i, "a coefficient");
    for (NodeId id : symbols({&e, 1}))
      if (model_.graph->node(id).kind != Kind::parameter)
        throw Failure(i.span,
                      "'" + i.key + "' is a number or a formula of parameters, and this one changes with " +
                          changing(model_.graph->node(id)) + ": the laws of contacts have constant coefficients",
                      i.key.ends_with("resistance")
                          ? "a number, or a formula of parameters"
                          : "a contact for each part of the surface or of the time, which is open elsewhere: gap = "
                            "\"piecewise(x < 1, z, 1)\" in one and gap = \"piecewise(x < 1, 1, z)\" in the other");
    contact.given.push_back({i.key, e, i.span});
    return e;
  }

  // Reads a velocity by its components: a number, a list of numbers, or a vector along two directions.
  std::vector<Expr> velocities(const Item& slip, const Item* along, Expr gap) const {
    std::vector<Expr> list;
    const auto take = [&](Expr e) {
      const Expr v = put_masses(model_, e);
      if (!proved_zero(v)) list.push_back(v);
    };
    if (slip.kind == Item::Kind::array) {
      for (const Item& i : slip.items) take(formula(i, "a component of a slip velocity"));
    } else {
      if (!slip.is_formula()) throw Failure(slip.span, "a slip velocity is a formula, or a list of its components");
      const Value v = evaluate(parse_formula(slip.formula), scope_);
      if (const Expr* e = std::get_if<Expr>(&v)) {
        take(*e);
      } else if (const Vector* a = std::get_if<Vector>(&v)) {
        if (!along)
          throw Failure(slip.span, "the slip velocity is a vector: its tangential components count",
                        "along = [\"ex\", \"ey\"]");
        take_along(*a, *along, gap, take);
      } else {
        throw Failure(slip.span, std::string("a slip velocity is a number or a vector, this is ") + type_name(v));
      }
    }
    if (list.size() > 2)
      throw Failure(slip.span, "a slip velocity has one or two components, these are " + std::to_string(list.size()),
                    "along = [\"ex\", \"ey\"], the directions tangential to the contact");
    for (Expr v : list)
      if (jet_order(v) != 1)
        throw Failure(slip.span, "a slip velocity is of first order in the velocities", "slip = \"vel(B, P)\"");
    return list;
  }

  void take_along(const Vector& v, const Item& along, Expr gap, const std::function<void(Expr)>& take) const {
    std::vector<Vector> axes;
    for (const Direction& d : orthonormal_directions(along, scope_)) axes.push_back(*d.axis);
    for (const Vector& d : axes) take(dot(v, d));
    check_tangential(axes, gap, v, model_, along.span, scope_.identities);
  }

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
};

}  // namespace

bool is_switched(const Item& constraint) { return constraint.find("active") != nullptr; }

bool is_one_sided(const Item& constraint) {
  const Item* word = constraint.find("one_sided");
  if (!word) return false;
  if (word->kind != Item::Kind::boolean) throw Failure(word->span, "'one_sided' is true or false");
  return word->truth;
}

// The hint for a model with too many contacts.
static constexpr const char* kSoftContacts =
    "leave out contacts that stay open, or write soft ones, as many as you like: [[force]] with vector = \"-k*min(P.z, "
    "0)*ez\"";

std::vector<Contact> read_contacts(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  constexpr std::size_t kMost = 8;  // the modes of the touching contacts are enumerated
  std::vector<Contact> list;
  const ContactReader reader(scope, model, diagnostics);
  const auto touching = [&] {
    return static_cast<std::size_t>(std::count_if(list.begin(), list.end(), [](const Contact& o) { return !o.under; }));
  };
  const auto add = [&](Contact contact) {
    if (!contact.under && touching() == kMost)
      throw Failure(contact.span, "more than " + std::to_string(kMost) + " contacts; a box has one for each corner",
                    kSoftContacts);
    if (std::any_of(list.begin(), list.end(), [&](const Contact& o) { return o.name == contact.name; }))
      throw Failure(contact.span, "there are two contacts '" + contact.name + "'", "give one of them another name");
    list.push_back(std::move(contact));
  };
  const Item *items = root.find("contact"), *constraints = root.find("constraint");
  if (items && items->items.size() <= kMost)
    for_each_table(*items, "contact", diagnostics, [&](const Item& c, std::size_t k) {
      check_keys(c, "a contact", "contact", diagnostics);
      const std::size_t before = list.size();
      for (Contact& contact : reader.read(c, k)) {
        if (!list.empty() && list[0].law != contact.law)
          throw Failure(contact.span,
                        "the contacts '" + list[0].element + "' and '" + contact.element +
                            "' have different laws of impacts",
                        "one value of 'impact' in all contacts: they may strike at one time");
        if (contact.under) *contact.under += before;
        add(std::move(contact));
      }
    });
  std::size_t count = items ? items->items.size() : 0;
  // The place of the first contact beyond the limit.
  Span beyond = count > kMost ? items->items[kMost].span : Span{};
  if (constraints)
    for (std::size_t k = 0; k < constraints->items.size(); ++k) {
      const Item& c = constraints->items[k];
      if (c.kind != Item::Kind::table) continue;
      collect(diagnostics, [&] {
        const Item* word = c.find("one_sided");
        // A word that is neither true nor false is reported with the constraints.
        if (!word || word->kind != Item::Kind::boolean || !is_one_sided(c)) return;
        if (const Item* active = c.find("active"))
          throw Failure(active->key_span, "'active' does not go with one_sided = true",
                        "an event that sets a mode opens and closes a constraint with 'active'; one of one side opens "
                        "where it would pull");
        if (++count <= kMost) return add(reader.read_one_sided(c, k));
        if (count == kMost + 1) beyond = word->key_span;
      });
    }
  if (count > kMost)
    diagnostics.error(beyond, std::to_string(count) + " contacts; at most " + std::to_string(kMost) + " are accepted",
                      kSoftContacts);
  return list;
}

}  // namespace anholon

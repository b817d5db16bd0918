#include "modelfile/mechanical/contacts.h"

#include <algorithm>

#include "expr/normal.h"
#include "modelfile/names/along.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

bool Contact::rough() const { return !slip.empty() && !(is_zero(friction) && is_zero(static_friction)); }

namespace {

class ContactReader {
 public:
  ContactReader(Scope& scope, const Model& model) : scope_(scope), model_(model) {}

  Contact read(const Item& c, std::size_t number) const {
    Contact contact;
    const Item* named = c.find("name");
    if (named && named->kind != Item::Kind::string) throw Failure(named->span, "a name is a text");
    contact.name = named ? normal_name(named->text()) : "contact" + std::to_string(number + 1);
    contact.span = named ? named->formula.whole() : c.span;
    if (!is_element_name(contact.name))
      throw Failure(contact.span, "'" + contact.name.substr(0, 40) + "' is not a name");
    const Item* gap = c.find("gap");
    if (!gap)
      throw Failure(contact.span, "the contact '" + contact.name + "' has no gap",
                    "gap = \"P.z - R\": the distance, which is not negative");
    contact.gap = formula(*gap, "a gap");
    if (jet_order(contact.gap) != 0)
      throw Failure(gap->span, "a gap is a formula of coordinates and time, without velocities");
    if (const Item* slip = c.find("slip")) contact.slip = velocities(*slip, c.find("along"));
    Graph& g = *model_.graph;
    const Item *friction = c.find("friction"), *fixed = c.find("static_friction"), *e = c.find("restitution");
    contact.friction = friction ? coefficient(*friction) : g.zero();
    contact.static_friction = fixed ? coefficient(*fixed) : contact.friction;
    contact.restitution = e ? coefficient(*e) : g.zero();
    if (contact.slip.empty() && (friction || fixed))
      throw Failure(
          (friction ? friction : fixed)->key_span,
          "the contact '" + contact.name + "' has friction and no slip velocity",
          "slip = \"vel(B, P)\", the velocity of the material point at the contact, along = [\"ex\", \"ey\"]");
    return contact;
  }

 private:
  Expr formula(const Item& i, const std::string& what) const {
    if (!i.is_formula()) throw Failure(i.span, what + " is a formula");
    return put_masses(model_, evaluate_number(parse_formula(i.formula), scope_));
  }

  // A formula of parameters.
  Expr coefficient(const Item& i) const {
    const Expr e = formula(i, "a coefficient");
    for (NodeId id : symbols({&e, 1}))
      if (model_.graph->node(id).kind != Kind::parameter)
        throw Failure(i.span, "a coefficient of a contact is a number or a formula of parameters");
    return e;
  }

  // A velocity by its components: a number, a list of numbers, or a vector along two directions.
  std::vector<Expr> velocities(const Item& slip, const Item* along) const {
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
        int index = 0;
        for (const Direction& d : directions(along, scope_)) take(component(*a, d, index++));
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

  Scope& scope_;
  const Model& model_;
};

}  // namespace

std::vector<Contact> read_contacts(const Item& root, Scope& scope, const Model& model, Diagnostics& diagnostics) {
  std::vector<Contact> list;
  const Item* items = root.find("contact");
  if (!items) return list;
  constexpr std::size_t kMost = 4;  // the modes are enumerated
  if (items->items.size() > kMost) {
    diagnostics.error(items->key_span, std::to_string(items->items.size()) + " contacts; at most " +
                                           std::to_string(kMost) + " are accepted");
    return list;
  }
  const ContactReader reader(scope, model);
  for_each_table(*items, "contact", diagnostics, [&](const Item& c, std::size_t k) {
    check_keys(c, "a contact", "contact", diagnostics);
    Contact contact = reader.read(c, k);
    if (std::any_of(list.begin(), list.end(), [&](const Contact& o) { return o.name == contact.name; }))
      throw Failure(contact.span, "there are two contacts '" + contact.name + "'");
    list.push_back(std::move(contact));
  });
  return list;
}

}  // namespace anholon

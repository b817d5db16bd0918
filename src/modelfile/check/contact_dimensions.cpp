#include "modelfile/check/contact_dimensions.h"

#include "modelfile/text/collect.h"
#include "numeric/number.h"

namespace anholon {

namespace {

// Returns the formulas of a slip velocity.
std::vector<const Item*> components_of(const Item* slip) {
  std::vector<const Item*> list;
  if (slip && slip->is_formula()) list.push_back(slip);
  if (slip && !slip->is_formula())
    for (const Item& i : slip->items)
      if (i.is_formula()) list.push_back(&i);
  return list;
}

}  // namespace

void ContactDimensions::read(const Item& contact) {
  DimensionForm friction, distance;
  const Item *gap = contact.find("gap"), *slip = contact.find("slip");
  if (gap && gap->is_formula()) collect(found_, [&] { distance = formulas_.of(*gap).dimension; }, gap->span);
  std::optional<DimensionForm> velocity;
  if (slip) collect(found_, [&] { velocity = slip_velocity(slip); }, slip->span);
  if (gap && gap->is_formula() && velocity) friction = distance / (*velocity * formulas_.unit("s"));
  for (const char* key : {"friction", "static_friction"})
    if (contact.find("body") || velocity) expect(contact.find(key), friction);
  expect(contact.find("restitution"), DimensionForm{});
  for (const char* length : {"rolling_resistance", "drilling_resistance", "at", "through"})
    expect(contact.find(length), formulas_.unit("m"));
  for (const char* shape : {"shape", "on"})
    if (const Item* call = contact.find(shape)) collect(found_, [&] { formulas_.expect_lengths(*call); }, call->span);
}

void ContactDimensions::expect(const Item* item, const DimensionForm& wanted) {
  if (!item) return;
  collect(found_, [&] { formulas_.expect(*item, wanted); }, item->span);
}

// Returns the common dimension of the components of a slip velocity; reports components with different ones.
std::optional<DimensionForm> ContactDimensions::slip_velocity(const Item* slip) {
  const std::vector<const Item*> list = components_of(slip);
  if (list.empty()) return std::nullopt;
  const Measured first = formulas_.of(*list[0]);
  for (std::size_t k = 1; k < list.size(); ++k)
    formulas_.alike(first, formulas_.of(*list[k]), list[k]->span, " and ", " are components of one slip velocity");
  return first.dimension;
}

// Returns the dimension of a formula; nullopt if it is unknown or the formula has a clash, which is reported elsewhere.
std::optional<Dimension> ContactDimensions::known_dimension(const Item& i) {
  try {
    return formulas_.known(formulas_.of(i).dimension);
  } catch (const Failure&) {
    return std::nullopt;
  }
}

bool ContactDimensions::of_length_or_angle(const Dimension& d, int order) const {
  for (const char* unit : {"m", "rad"})
    if (d == *formulas_.known(formulas_.unit(unit) / power(formulas_.unit("s"), order))) return true;
  return false;
}

void ContactDimensions::check(const Item& c) {
  const auto right_dimension = [&](const Item& i, int order, const char* what, const char* hint) {
    const std::optional<Dimension> d = known_dimension(i);
    if (!d || of_length_or_angle(*d, order)) return true;
    found_.error(i.formula.whole(), std::string(what) + ", this is " + describe(*d), hint);
    return false;
  };
  const Item *gap = c.find("gap"), *slip = c.find("slip");
  bool right = gap && gap->is_formula();
  if (right)
    right = right_dimension(*gap, 0, "a gap is a length or an angle",
                            "the distance itself, and not a function of it: gap = \"R - norm(P)\"");
  for (const Item* i : components_of(slip))
    right = right_dimension(*i, 1, "a slip velocity is a velocity or an angular velocity",
                            "slip = \"vel(B, P)\", the velocity of the material point at the contact") &&
            right;
  if (right && !components_of(slip).empty()) note_bare_coefficients(c, *gap, *components_of(slip)[0]);
}

// Warns of coefficients that are numbers without a unit but have one by their contact: they may be meant as pure
// numbers.
void ContactDimensions::note_bare_coefficients(const Item& c, const Item& gap, const Item& slip) {
  const std::optional<Dimension> distance = known_dimension(gap), velocity = known_dimension(slip);
  if (!distance || !velocity) return;
  const bool of_angle = *distance == Dimension{}, turns = *velocity == *formulas_.known(formulas_.unit("s^-1"));
  if (of_angle == turns) return;
  const Dimension d = *formulas_.known(formulas_.unit(of_angle ? "m^-1" : "m"));
  for (const char* key : {"friction", "static_friction"}) {
    const Item* i = c.find(key);
    if (!i || !i->is_formula()) continue;
    const Syntax s = parse_formula(i->formula);
    if (s.op != Syntax::Op::number || parse_rational(s.text).value_or(0) == 0) continue;
    noted_.warning(i->formula.whole(),
                   s.text + " without a unit stands for " + describe(d) + ", as the gap is " +
                       (of_angle ? "an angle and the slip velocity is none of an angle"
                                 : "a length and the slip velocity is that of an angle"),
                   of_angle ? "1*" + s.text + " where that is meant, or a gap that is a length"
                            : "1*" + s.text + " where that is meant, or the velocity of a point: slip = \"R*phi'\"");
  }
}

// Returns the SI unit; empty if it does not follow.
std::string ContactDimensions::unit_of(const DimensionForm& form) const {
  const auto known = formulas_.known(form);
  return known ? print(*known) : std::string();
}

void ContactDimensions::measure(const Item& c, const std::string& name, std::vector<Contact>& list) {
  const Item *gap = c.find("gap"), *slip = c.find("slip"), *equation = c.find("equation");
  DimensionForm distance = formulas_.unit("m"), velocity = formulas_.unit("m/s");
  if (gap) distance = formulas_.of(*gap).dimension;
  if (equation) distance = formulas_.of(parse_equation(equation->formula)[0]).dimension;
  if (slip && slip->is_formula()) velocity = formulas_.of(*slip).dimension;
  if (slip && !slip->items.empty()) velocity = formulas_.of(slip->items[0]).dimension;
  const ContactUnits units{unit_of(distance), unit_of(formulas_.unit("J") / distance), unit_of(velocity),
                           unit_of(formulas_.unit("W") / velocity)},
      resistance{units.gap, units.normal, "1/s", "N*m"};
  for (Contact& contact : list) {
    const bool own = contact.under ? list[*contact.under].element == name : contact.element == name;
    if (own && !contact.held) contact.units = contact.under ? resistance : units;
  }
}

}  // namespace anholon

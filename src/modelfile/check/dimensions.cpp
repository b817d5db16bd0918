#include "modelfile/check/dimensions.h"

#include <algorithm>
#include <cctype>
#include <functional>
#include <map>

#include "modelfile/check/contact_dimensions.h"
#include "modelfile/text/collect.h"

namespace anholon {

namespace {

// True if the item contains a number, a blank and a letter, or a key 'unit'.
bool may_have_units(const Item& item) {
  if (item.key == "unit") return true;
  for (const char* prose : {"title", "source", "doc"})
    if (item.key == prose) return false;
  if (item.kind == Item::Kind::string) {
    const std::string& s = item.text();
    for (std::size_t i = 0; i + 2 < s.size(); ++i)
      if ((std::isdigit(static_cast<unsigned char>(s[i])) || s[i] == '.') &&
          (s[i + 1] == ' ' || static_cast<unsigned char>(s[i + 1]) >= 0x80 || s[i + 1] == '\t'))
        return true;
  }
  return std::any_of(item.items.begin(), item.items.end(), may_have_units);
}

// The equations between dimensions that each element of a model file gives.
class Elements {
 public:
  using Overrides = FormulaDimensions::Overrides;

  Elements(const Item& root, const Scope& scope, const Model& model, Overrides overrides = Overrides::read)
      : root_(root), model_(model), formulas_(scope, model, overrides), contacts_(formulas_, found_, noted_) {
    formulas_.of_multiplier = [this](const std::string& path) { return multiplier(path); };
  }

  bool run() {
    // Looks for units here, because a value given from outside may have replaced the only value with a unit.
    each("parameters", [&](const Item& i) {
      if (i.is_formula()) formulas_.look_for_units(parse_formula(i.formula));
    });
    tables();  // the units of their knots are given, not inferred
    formulas_.declarations(found_);
    observer();
    each("gravity", [&](const Item& i) {
      if (i.key == "field") formulas_.in_field = true, expect(i, "m/s^2"), formulas_.in_field = false;
    });
    bodies();
    forces();
    each("potential", [&](const Item& i) { expect(i, "J"); });
    each("dissipation", [&](const Item& i) { expect(i, "W"); });
    states();
    events();
    each("output", [&](const Item& i) { output(i); });
    list("constraint", [&](const Item& c) {
      if (const Item* e = c.find("equation")) equation(*e);
      if (const Item* a = c.find("active"); a && a->is_formula()) formulas_.of(*a);
    });
    list("contact", [&](const Item& c) { contacts_.read(c); });
    initial();
    each("monitor", [&](const Item& i) {
      if (i.is_formula()) formulas_.of(i);
    });
    each("simulate", [&](const Item& i) {
      if (i.key == "to" || i.key == "every") expect(i, "s");
      if (i.key == "at")
        for (const Item& t : i.items) expect(t, "s");
    });
    list("contact", [&](const Item& c) { contacts_.check(c); });
    return formulas_.units_seen;
  }

  // Gives the contacts their units. REQUIRES: the elements have been run.
  void measure(std::vector<Contact>& list) {
    for (const char* section : {"contact", "constraint"}) {
      const Item* items = root_.find(section);
      if (!items || items->kind != Item::Kind::array) continue;
      for (std::size_t k = 0; k < items->items.size(); ++k) {
        const Item& c = items->items[k];
        const Item* named = c.find("name");
        const std::string name = named ? normal_name(named->text()) : section + std::to_string(k + 1);
        guard([&] { contacts_.measure(c, name, list); }, c.span);
      }
    }
  }

  // Gives monitors, states and outputs without a unit their units. REQUIRES: the elements have been run.
  void measure(Model& model) {
    const auto record = [&](const std::string& name, Span span, const DimensionForm& form) {
      if (const std::string unit = unit_of(form); !unit.empty())
        model.outputs.push_back({name, unit, {}, {}, false, span});
    };
    each("monitor", [&](const Item& i) {
      if (i.is_formula()) record(normal_name(i.key), i.key_span, formulas_.of(i).dimension);
    });
    for (const StateVariable& z : model.states) guard([&] { record(z.name, z.span, named(z.name)); }, z.span);
    each("output", [&](const Item& i) {
      const Item* value = i.kind == Item::Kind::table ? i.find("value") : &i;
      for (OutputQuantity& o : model.outputs)
        if (value && o.name == i.key && o.unit.empty()) o.unit = unit_of(formulas_.term(*value).dimension);
    });
  }

  // Returns the scales of coordinates, then of states: those of one dimension have one number, and so have those whose
  // dimension does not follow. Empty if all have number 0. REQUIRES: the elements have been run.
  std::vector<std::uint32_t> scales() {
    std::vector<std::optional<Dimension>> kinds;
    std::vector<std::uint32_t> list;
    const auto add = [&](const std::string& name) {
      const std::optional<Dimension> d = formulas_.known(named(name));
      const auto at = std::find(kinds.begin(), kinds.end(), d);
      list.push_back(static_cast<std::uint32_t>(at - kinds.begin()));
      if (at == kinds.end()) kinds.push_back(d);
    };
    for (const std::string& name : model_.names.coordinates) add(name);
    for (const StateVariable& z : model_.states) add(z.name);
    return kinds.size() > 1 ? list : std::vector<std::uint32_t>{};
  }

  const std::vector<Diagnostic>& found() const { return found_.list(); }
  const std::vector<Diagnostic>& noted() const { return noted_.list(); }  // warnings
  FormulaDimensions& formulas() { return formulas_; }

 private:
  void guard(const std::function<void()>& f, Span place) { collect(found_, f, place); }

  void each(const char* section, const std::function<void(const Item&)>& f) {
    if (const Item* s = root_.find(section); s && s->kind == Item::Kind::table)
      for (const Item& i : s->items) guard([&] { f(i); }, i.span);
  }
  void list(const char* name, const std::function<void(const Item&)>& f) {
    if (const Item* s = root_.find(name); s && s->kind == Item::Kind::array)
      for (const Item& i : s->items) guard([&] { f(i); }, i.span);
  }

  void expect(const Item& i, const DimensionForm& wanted) {
    guard([&] { formulas_.expect(i, wanted); }, i.span);
  }
  void expect(const Item& i, const char* unit) { expect(i, formulas_.unit(unit)); }
  void expect(const Item* i, const char* unit) {
    if (i) expect(*i, unit);
  }

  // Returns the dimension of lambda: lambda dphi/dq^(m) is the force that has the power lambda dphi/dq^(m) q' of a
  // constraint of order m.
  std::optional<DimensionForm> multiplier(const std::string& path) {
    const auto c = std::find_if(model_.constraints.begin(), model_.constraints.end(),
                                [&](const Constraint& known) { return known.name == path && !known.by; });
    const Item* items = root_.find("constraint");
    if (c == model_.constraints.end() || !items || items->kind != Item::Kind::array) return std::nullopt;
    for (std::size_t k = 0; k < items->items.size(); ++k) {
      const Item *named = items->items[k].find("name"), *equation = items->items[k].find("equation");
      const std::string name = named ? normal_name(named->text()) : "constraint" + std::to_string(k + 1);
      if (!equation || equation->kind != Item::Kind::string || path.substr(0, name.size()) != name ||
          (path.size() > name.size() && path[name.size()] != '.'))
        continue;
      try {
        for (const Syntax& side : parse_equation(equation->formula))
          if (const DimensionForm phi = formulas_.term(side).dimension; formulas_.known(phi))
            return formulas_.unit("J") / (phi * power(formulas_.unit("s"), c->order));
      } catch (const Failure&) {
        // The failure is reported at the constraint.
      }
    }
    return std::nullopt;
  }

  void equation(const Item& i) {
    if (i.kind != Item::Kind::string) return;
    const std::vector<Syntax> sides = parse_equation(i.formula);
    const Measured left = formulas_.term(sides[0]);
    if (sides.size() == 2)
      formulas_.alike(left, formulas_.term(sides[1]), i.formula.whole(), " on the left side, ", " on the right side");
  }

  void observer() {
    each("observer", [&](const Item& i) {
      if (i.key == "spin")
        expect(i, "s^-1");
      else if (i.key == "rotation")
        formulas_.of(i);
      else if (i.key == "origin_acceleration")
        expect(i, "m/s^2");
      else if (i.key == "origin_velocity" || i.key == "origin_velocity_inertial")
        expect(i, "m/s");
      else if (i.key == "origin_position_inertial")
        expect(i, "m");
    });
  }

  void bodies() {
    for (const char* key : {"body", "particle"})
      list(key, [&](const Item& b) {
        expect(b.find("mass"), "kg");
        expect(b.find("center"), "m");
        expect(b.find("position"), "m");
        expect(b.find("expelled_velocity"), "m/s");
        expect(b.find("exit_point"), "m");
        expect(b.find("angle"), "rad");
        if (const Item* o = b.find("orientation")) guard([&] { formulas_.of(*o); }, o->span);
        if (const Item* inertia = b.find("inertia")) moments(*inertia);
        if (const Item* shape = b.find("shape")) guard([&] { formulas_.expect_lengths(*shape); }, shape->span);
        if (const Item* axes = b.find("axes"))
          for (const Item& a : axes->items)
            if (const Item *w = a.find("weight"), *v = a.find("vector"); w && v)
              guard([&] { expect(*w, formulas_.unit("kg*m^2") / power(formulas_.of(*v).dimension, 2)); }, a.span);
      });
  }

  void moments(const Item& inertia) {
    if (inertia.kind != Item::Kind::array) return expect(inertia, "kg*m^2");
    for (const Item& i : inertia.items) moments(i);
  }

  void forces() {
    list("force", [&](const Item& f) {
      expect(f.find("vector"), "N");
      expect(f.find("torque"), "N*m");
      expect(f.find("tension"), "N");
      for (const char* place : {"on", "from"})
        if (const Item* p = f.find(place); p && p->kind == Item::Kind::table) expect(p->find("at"), "m");
      if (const Item* g = f.find("generalized"); g && g->kind == Item::Kind::table)
        for (const Item& i : g->items) expect(i, formulas_.unit("J") / named(i.key));
    });
  }

  void states() {
    each("state", [&](const Item& s) {
      const DimensionForm z = named(s.key);
      if (const Item* rate = s.find("rate")) expect(*rate, z / formulas_.unit("s"));
      if (const Item* initial = s.find("initial")) expect(*initial, z);
    });
    each("input", [&](const Item& i) { expect(i, named(i.key)); });
  }

  // Reads the units of tables: the knots may have units as well.
  void tables() {
    list("table", [&](const Item& t) {
      const Item* name = t.find("name");
      if (!name) return;
      const auto [x, y] = formulas_.table(normal_name(name->text()));
      for (const auto& [key, dimension] : {std::pair{"x", x}, {"y", y}})
        if (const Item* values = t.find(key))
          for (const Item& v : values->items) expect(v, dimension);
    });
  }

  void events() {
    list("event", [&](const Item& e) {
      if (const Item* when = e.find("when")) guard([&] { formulas_.of(*when); }, when->span);
      if (const Item* set = e.find("set"))
        for (const Item& i : set->items) {
          std::string name = i.key;
          int order = 0;
          while (!name.empty() && name.back() == '\'') name.pop_back(), ++order;
          expect(i, named(name) / power(formulas_.unit("s"), order));
        }
    });
  }

  void output(const Item& i) {
    const Item* value = i.kind == Item::Kind::table ? i.find("value") : &i;
    if (!value) return;
    const Item* unit = i.kind == Item::Kind::table ? i.find("unit") : nullptr;
    if (unit)
      expect(*value, formulas_.given_unit(normal_name(unit->text())));
    else
      formulas_.term(*value);
  }

  // Returns the SI unit; empty if it does not follow.
  std::string unit_of(const DimensionForm& form) const {
    const auto known = formulas_.known(form);
    return known ? print(*known) : std::string();
  }

  DimensionForm named(const std::string& name) { return formulas_.named(name).dimension; }

  // Gives "x''" of [initial] the dimension of the derivative.
  void initial() {
    const Item* section = root_.find("initial");
    if (section) values(*section);
    if (const Item* guess = section ? section->find("guess") : nullptr) values(*guess);
  }

  void value(const Item& i, std::string name, int order) {
    while (!name.empty() && name.back() == '\'') name.pop_back(), ++order;
    if (name.rfind("D(", 0) == 0 && name.find(',') != std::string::npos) {
      order = std::atoi(name.c_str() + name.find(',') + 1);
      name = name.substr(2, name.find(',') - 2);
    }
    const auto& names = model_.names.coordinates;
    if (std::find(names.begin(), names.end(), name) != names.end())
      expect(i, named(name) / power(formulas_.unit("s"), order));
  }

  void values(const Item& table) {
    for (const Item& i : table.items) {
      if (i.key == "t")
        expect(i, "s");
      else if (i.key == "conditions")
        for (const Item& c : i.items) guard([&] { equation(c); }, c.span);
      else if (i.kind == Item::Kind::table)
        for (const auto& [key, order] : {std::pair{"q", 0}, {"qdot", 1}, {"qddot", 2}, {"qdddot", 3}}) {
          if (i.key == key)
            for (const Item& v : i.items) value(v, v.key, order);
        }
      else
        value(i, i.key, 0);
    }
  }

  const Item& root_;
  const Model& model_;
  FormulaDimensions formulas_;
  Diagnostics found_, noted_;
  ContactDimensions contacts_;
};

}  // namespace

// Notes numbers without a unit among others that have one: they may be meant in this unit, "b = 18" beside "r = 8 cm".
static void note_bare_numbers(const Scope& scope, Model& model) {
  const auto& names = model.names.parameters;
  std::map<std::string, std::string>
      measured;  // by SI unit: a parameter that is given with a unit, in its written form
  std::vector<std::pair<std::size_t, std::string>> bare;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Scope::Declaration& d = scope.declarations().at(names[i]);
    const std::string& si = model.parameter_units[i];
    if (si.empty() || si == "1" || d.item) continue;
    const Syntax s = parse_formula(d.formula);
    const Syntax& number = s.op == Syntax::Op::negate ? s.args[0] : s;
    if (number.op == Syntax::Op::quantity)
      measured.emplace(si, names[i] + " = " + d.formula.text());
    else if (!d.unit.empty())
      measured.emplace(si, names[i] + " = " + d.formula.text() + " " + d.unit);
    else if (number.op == Syntax::Op::number && parse_rational(number.text).value_or(0) != 0)
      bare.push_back({i, d.formula.text()});
  }
  std::map<std::string, std::pair<std::size_t, std::string>> lists;  // for each unit, how many and which
  std::vector<std::string> order;
  for (const auto& [i, text] : bare) {
    const std::string& unit = model.parameter_units[i];
    if (!measured.contains(unit)) continue;
    auto& [count, list] = lists[unit];
    if (count++ == 0) order.push_back(unit);
    list += (list.empty() ? "" : ", ") + names[i] + " = " + text;
  }
  for (const std::string& unit : order) {
    const auto& [count, list] = lists[unit];
    model.notes.push_back((count == 1 ? "parameter " : "parameters ") + list +
                          (count == 1 ? " has no unit and is in " : " have no unit and are in ") + unit + ", beside " +
                          measured.at(unit));
  }
}

// True if a file without units is consistent when the values from outside may have any dimension.
static bool consistent_without_overrides(const Item& root, const Scope& scope, const Model& model) {
  Elements elements(root, scope, model, Elements::Overrides::ignored);
  elements.run();
  return elements.found().empty();
}

// True if a value from outside has a unit.
static bool overrides_with_units(const Scope& scope) {
  return std::any_of(scope.declarations().begin(), scope.declarations().end(), [](const auto& d) {
    return !d.second.override.empty() && has_unit(parse_formula(d.second.formula));
  });
}

void check_dimensions(const Item& root, const Scope& scope, Model& model, std::vector<Contact>& contacts,
                      Diagnostics& diagnostics) {
  Elements elements(root, scope, model);
  const bool units_seen = elements.run();
  if (elements.found().empty()) model.scales = elements.scales();
  if (!may_have_units(root) && !overrides_with_units(scope)) return;
  // If the file has no units, the check accepts formulas that contradict one another, but not a unit from outside that
  // contradicts them.
  if (!elements.found().empty() && (units_seen || consistent_without_overrides(root, scope, model)))
    for (const Diagnostic& d : elements.found()) diagnostics.add(d);
  if (!units_seen) return;
  const auto units = [&](const std::vector<std::string>& names) {
    std::vector<std::string> list;
    for (const std::string& name : names) {
      const auto d = elements.formulas().known(name);
      list.push_back(d ? print(*d) : "");
    }
    return list;
  };
  model.coordinate_units = units(model.names.coordinates);
  model.parameter_units = units(model.names.parameters);
  note_bare_numbers(scope, model);
  for (const Diagnostic& d : elements.noted()) diagnostics.add(d);
  for (const FormulaDimensions::BareTerm& b : elements.formulas().bare_terms())
    diagnostics.warning(b.span, b.text + " without a unit stands beside " + describe(b.dimension),
                        b.text + " " + print(b.dimension) + ", or 1*" + b.text +
                            " where the number has its unit in SI");
  elements.measure(contacts);
  elements.measure(model);
}

std::map<std::string, std::string> implied_units(const Item& root, const Scope& scope, const Model& model) {
  Elements elements(root, scope, model);
  elements.run();
  std::map<std::string, std::string> units;
  if (!elements.found().empty()) return units;
  for (const auto* names : {&model.names.coordinates, &model.names.parameters})
    for (const std::string& name : *names)
      if (const auto d = elements.formulas().known(name)) units.emplace(name, print(*d));
  return units;
}

}  // namespace anholon

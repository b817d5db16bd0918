#include "modelfile/read.h"

#include <algorithm>
#include <functional>
#include <set>

#include "expr/normal.h"
#include "formula/indices.h"
#include "formula/units.h"
#include "modelfile/all_contacts.h"
#include "modelfile/check/coefficients.h"
#include "modelfile/check/dimensions.h"
#include "modelfile/check/doubled_gravity.h"
#include "modelfile/check/unknown_names.h"
#include "modelfile/check/values.h"
#include "modelfile/contacts.h"
#include "modelfile/implied_units.h"
#include "modelfile/language/language.h"
#include "modelfile/mechanical/bodies.h"
#include "modelfile/mechanical/constraints.h"
#include "modelfile/mechanical/contact_names.h"
#include "modelfile/mechanical/control.h"
#include "modelfile/mechanical/observer.h"
#include "modelfile/mechanical/potentials.h"
#include "modelfile/mechanical/tables.h"
#include "modelfile/motion/hybrid.h"
#include "modelfile/motion/initial.h"
#include "modelfile/motion/monitor.h"
#include "modelfile/motion/simulate.h"
#include "modelfile/motion/view.h"
#include "modelfile/names/constant.h"
#include "modelfile/names/names.h"
#include "modelfile/names/notation.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/families.h"
#include "modelfile/text/keys.h"
#include "modelfile/text/variants.h"

namespace anholon {

namespace {

// The position of an error about something missing that has no place of its own.
constexpr Span kTop{1, 1, 1};

// The limit of the work that a file's expressions may cost: a formula that expands without end is refused at its place.
// A chain of a thousand links takes a tenth of this.
constexpr std::size_t kWork = 700'000, kWorkPerByte = 1000, kWorkPerMember = 1000, kWorkLater = std::size_t{1} << 48;
class Reader {  // its references are used only while it runs
 public:
  Reader(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides,
         const std::vector<std::string>& cases)
      : diagnostics_(diagnostics), overrides_(overrides), cases_(cases), scope_(model_) {
    model_.graph = std::make_shared<Graph>();
    model_.source_text = source;
    Graph& g = *model_.graph;
    model_.observer.spin = model_.observer.origin_acceleration = zero_vector(g);
    model_.observer.origin_velocity = zero_vector(g);
    model_.initial.t = g.zero();
  }

  bool run() {
    Item& root = root_;
    const bool read = guard([&] { root = read_files(model_.source_text); });
    diagnostics_.others = model_.source_text.others;
    if (!read) return false;
    scenarios(root);
    const Families families = write_out_families(root, overrides_, diagnostics_);
    // A mistake in an index or a case would be repeated in every element.
    if (diagnostics_.has_errors()) return false;
    scope_.reserve(families.letters);
    index_overrides_ = families.used;
    std::size_t bytes = model_.source_text.text.size();
    for (const SourceText& s : model_.source_text.others) bytes += s.text.size();
    model_.graph->allow(kWork + kWorkPerByte * bytes + kWorkPerMember * families.members);
    sections(root);
    // Without coordinates every formula would fail as well.
    if (!guard([&] { coordinates(root); })) return false;
    parameters(root);
    declare_hybrid(root, scope_, model_, diagnostics_);
    declare_controls(root, scope_, model_, diagnostics_);
    declare_tables(root, scope_, model_, diagnostics_);
    declare_contacts(root, scope_);
    functions(root);
    named(root, "define", Scope::Role::define);
    named(root, "frame", Scope::Role::frame);
    named(root, "point", Scope::Role::point);
    named(root, "quasi", Scope::Role::define);
    // Bodies are declared before any evaluation; their parts are read together with the masses.
    BodyReader bodies(scope_, model_, diagnostics_);
    bodies.declare(root);
    observer(root);
    read_gravity(root, scope_, diagnostics_);
    read_controls(root, scope_, model_, diagnostics_);
    // A name that does not denote a value is reported once, at its use.
    bodies.read();
    bodies.read_forces(root);
    read_potentials(root, scope_, model_, diagnostics_);
    read_dissipation(root, scope_, model_, diagnostics_);
    ConstraintReader constraints(scope_, model_, diagnostics_);
    constraints.read(root);
    check_kept(model_, diagnostics_);
    quasi(root);
    read_states(root, scope_, model_, diagnostics_);
    scope_.resolve_all();
    const std::vector<UnitNorm> norms = constraints.norms_of_quaternions();
    const std::vector<Contact> switched = constraints.switched();
    read_initial(root, scope_, model_, diagnostics_);
    start_at_identity(norms, model_);
    if (const Item* m = table(root, "monitor")) read_monitors(*m, scope_, model_, diagnostics_);
    read_events(root, scope_, model_, diagnostics_);
    check_observer(observer_, model_, diagnostics_);
    read_outputs(root, scope_, model_, diagnostics_);
    contacts_ = read_all_contacts(root, switched, scope_, model_, diagnostics_);
    if (const Item* n = table(root, "notation")) {
      std::vector<std::string> declared;
      for (const auto& [name, d] : scope_.declarations()) declared.push_back(name);
      read_notation(*n, model_, declared, diagnostics_);
    }
    read_view(root, scope_, model_, diagnostics_);
    guard([&] { read_simulate(root, scope_, model_, diagnostics_); });
    for (const Diagnostic& d : scope_.failures)
      if (!is_repeated(diagnostics_, d)) diagnostics_.add(d);
    if (diagnostics_.has_errors()) report_unknown_names(root, scope_, overrides_, diagnostics_);
    gather_errors(root);
    if (!diagnostics_.has_errors()) check_values(model_, diagnostics_);
    if (!diagnostics_.has_errors())
      for (Diagnostic& d : wrong_coefficients(contacts_, model_)) diagnostics_.add(std::move(d));
    if (!diagnostics_.has_errors()) check_dimensions(root, scope_, model_, contacts_, diagnostics_);
    if (!diagnostics_.has_errors())
      for (const Replaced& r : replaced_) guard([&] { must_have_unit_of(r); });
    // From here on, expressions grow in proportion to the model.
    model_.graph->allow(kWorkLater);
    if (!diagnostics_.has_errors()) note_doubled_gravity(model_);
    if (!diagnostics_.has_errors() && model_.bodies.empty())
      diagnostics_.error(kTop, "the model has no body",
                         "add [[body]] or [[particle]] with name, mass and center or position");
    return !diagnostics_.has_errors();
  }

  std::map<std::string, std::string> implied_units() const { return anholon::implied_units(root_, scope_, model_); }

  Model& model() { return model_; }
  Scope& scope() { return scope_; }
  const std::vector<Contact>& contacts() const { return contacts_; }

 private:
  bool guard(const std::function<void()>& f, Span place = {}) { return collect(diagnostics_, f, place); }
  bool guard(const std::function<void()>& f, const Item& element) { return collect(diagnostics_, f, element); }

  // Declares a name by f. If f fails, the uses of the name fail silently.
  void declare(const std::string& name, const std::function<void()>& f, const Item& element) {
    if (!guard(f, element)) scope_.note_failed(name);
  }

  void observer(const Item& root) {
    if (const Item* o = table(root, "observer"))
      guard([&] { observer_ = read_observer(*o, scope_, model_, diagnostics_); }, o->span);
  }

  void scenarios(Item& root) {
    const Item cases = take_cases(root, diagnostics_);
    for (const Item& i : cases.items) model_.cases.push_back(i.key);
    for (const std::string& name : cases_) apply_case(root, cases, normal_name(name), diagnostics_);
  }

  void sections(const Item& root) {
    check_keys(root, "the model file", "", diagnostics_);
    for (auto [key, target] : {std::pair{"title", &model_.title}, {"source", &model_.source}})
      if (const Item* i = root.find(key)) {
        if (i->kind == Item::Kind::string)
          *target = i->text();
        else
          diagnostics_.error(i->span, std::string("'") + key + "' is a text");
      }
  }

  // Reports an unknown name once, and not at all if an unknown section declares it, such as "C" in [let].
  void gather_errors(const Item& root) {
    const std::vector<std::string> known = known_keys(language_section(""));
    std::set<std::string> declared;
    for (const Item& i : root.items) {
      if (std::find(known.begin(), known.end(), i.key) != known.end()) continue;
      if (i.kind != Item::Kind::table) declared.insert("unknown name '" + i.key + "'");
      for (const Item& inner : i.items) declared.insert("unknown name '" + inner.key + "'");
    }
    diagnostics_.leave_out([&](const std::string& message) {
      const std::size_t end = message.find("; did you mean '");
      return declared.contains(message.substr(0, end));
    });
    diagnostics_.gather([](const std::string& message) {
      return message.rfind("unknown name '", 0) == 0 || message.rfind("unknown function '", 0) == 0;
    });
  }

  const Item* table(const Item& root, const char* key) { return find_section(root, key, diagnostics_); }

  void coordinates(const Item& root) {
    const Item* list = root.find("coordinates");
    if (!list)
      throw Failure(kTop, "the model has no coordinates", "coordinates = [\"x\", \"y\"] at the top of the file");
    if (list->kind == Item::Kind::array && list->items.empty())
      throw Failure(list->span, "the list of coordinates is empty", "coordinates = [\"x\", \"y\"]");
    if (list->kind != Item::Kind::array)
      throw Failure(list->span, "coordinates is a list of names", "coordinates = [\"x\", \"y\"]");
    if (list->items.size() > kMostCoordinates)
      throw Failure(list->span, std::to_string(list->items.size()) + " coordinates; at most " +
                                    std::to_string(kMostCoordinates) + " are accepted");
    for (const Item& i : list->items)
      guard([&] {
        if (i.kind != Item::Kind::string) throw Failure(i.span, "a coordinate is a name in quotes");
        const std::string name = normal_name(i.text());
        Scope::Declaration d;
        d.role = Scope::Role::coordinate;
        d.index = model_.coordinates.size();
        d.span = i.formula.whole();
        scope_.declare(name, d);
        model_.coordinates.push_back({name, d.span});
        model_.names.coordinates.push_back(name);
      });
    dependent(root);
  }

  void dependent(const Item& root) {
    const Item* list = root.find("dependent");
    if (!list) return;
    if (list->kind != Item::Kind::array)
      throw Failure(list->span, "dependent is a list of coordinates", "dependent = [\"y\"]");
    for (const Item& i : list->items)
      guard([&] {
        const std::string name = i.kind == Item::Kind::string ? normal_name(i.text()) : std::string();
        const auto& names = model_.names.coordinates;
        const auto it = std::find(names.begin(), names.end(), name);
        if (it == names.end())
          throw Failure(i.span, "dependent is a list of coordinates, and '" + name + "' is none",
                        did_you_mean(name, names));
        const std::size_t a = static_cast<std::size_t>(it - names.begin());
        if (std::find(model_.dependent.begin(), model_.dependent.end(), a) != model_.dependent.end())
          throw Failure(i.span, "'" + name + "' is listed twice");
        model_.dependent.push_back(a);
      });
  }

  void quasi(const Item& root) {
    const Item* section = table(root, "quasi");
    if (!section) return;
    for (const Item& i : section->items)
      guard(
          [&] {
            const Value v = scope_.name(normal_name(i.key), i.key_span);
            if (!std::holds_alternative<Expr>(v))
              throw Failure(i.span, "a quasi-velocity is a number, this is " + std::string(type_name(v)));
            const Expr u = put_masses(model_, std::get<Expr>(v));
            const int order = jet_order(u);
            if (order < 1)
              throw Failure(i.span, "the quasi-velocity '" + i.key + "' depends on no velocity",
                            "u = \"x'*cos(theta) + y'*sin(theta)\"");
            model_.quasi.push_back({normal_name(i.key), u, order, i.span});
            model_.names.quasi.push_back(normal_name(i.key));
          },
          i);
  }

  void parameters(const Item& root) {
    std::vector<std::string> used;
    const Item* section = table(root, "parameters");
    if (section)
      for (const Item& i : section->items)
        declare(
            i.key,
            [&] {
              const Item* value = &i;
              std::string doc;
              if (i.kind == Item::Kind::table) {
                check_keys(i, "a parameter", "parameters", diagnostics_);
                value = i.find("value");
                if (!value) throw Failure(i.key_span, "the parameter '" + i.key + "' has no value");
                if (const Item* d = i.find("doc")) doc = d->text();
              }
              Scope::Declaration d;
              if (const Item* u = i.kind == Item::Kind::table ? i.find("unit") : nullptr)
                guard([&] { d.unit = unit_text(*u); });
              d.role = Scope::Role::parameter;
              d.index = model_.parameters.size();
              d.span = i.key_span;
              if (value->kind == Item::Kind::array)
                d.item = value;
              else if (value->is_formula())
                d.formula = value->formula;
              else
                throw Failure(value->span, "the value of a parameter is a number, a formula or a vector");
              if (const auto o = overrides_.find(i.key); o != overrides_.end()) {
                replaced_.push_back({d.formula.text(), o->second, "--set " + o->first + "=" + o->second + ": "});
                d.formula = FormulaText(o->second, Span{});
                d.override = "--set " + o->first + "=" + o->second;
                d.item = nullptr;
                used.push_back(o->first);
              }
              scope_.declare(i.key, d);
              model_.parameters.push_back({i.key, model_.graph->zero(), doc, d.span});
              model_.names.parameters.push_back(i.key);
            },
            i);
    for (const auto& [name, formula] : overrides_)
      if (!index_overrides_.count(name) && std::find(used.begin(), used.end(), name) == used.end()) {
        std::vector<std::string> known;
        for (const Parameter& p : model_.parameters) known.push_back(p.name);
        const std::string coefficient = hint_for_coefficient(name),
                          near = coefficient.empty() ? did_you_mean(name, known) : "";
        diagnostics_.error(
            {}, "--set: there is no parameter '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
            coefficient.empty() ? parameters_known(known) : coefficient);
      }
  }

  // A value of the file, and the value from outside that replaces it.
  struct Replaced {
    std::string before, given, called;
  };

  // Throws if a value from outside has the unit of another quantity than the value that it replaces. A clash with a
  // formula is reported at the formula.
  static void must_have_unit_of(const Replaced& r) {
    const auto dimension = [](const std::string& text) -> std::optional<Dimension> {
      try {
        return read_constant(text).dimension;
      } catch (const Failure&) {
        return std::nullopt;  // a formula
      }
    };
    const std::optional<Dimension> wanted = dimension(r.before), here = dimension(r.given);
    if (wanted && here && *wanted != *here)
      throw Failure({}, r.called + describe(*wanted) + " is expected here, this is " + describe(*here),
                    *wanted == Dimension{} ? "a bare number, or an angle: 30 deg"
                                           : "a number in " + print(*wanted) + ", or a bare number in SI units");
  }

  static std::string parameters_known(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 24;
    if (names.empty()) return "the model has no parameters";
    std::string list = names.size() == 1 ? "the parameter is " : "the parameters are ";
    for (std::size_t k = 0; k < names.size() && k < kMost; ++k) list += (k ? ", " : "") + names[k];
    return list + (names.size() > kMost ? ", …" : "");
  }

  void functions(const Item& root) {
    const Item* section = table(root, "functions");
    if (!section) return;
    for (const Item& i : section->items)
      declare(
          i.key.substr(0, i.key.find('(')),
          [&] {
            Scope::Declaration d;
            d.role = Scope::Role::function;
            d.span = i.key_span;
            std::string name = i.key;
            if (const std::size_t open = name.find('('); open != std::string::npos && name.back() == ')') {
              std::string list = name.substr(open + 1, name.size() - open - 2);
              name.resize(open);
              std::size_t from = 0;
              while (from <= list.size()) {
                const std::size_t comma = std::min(list.find(',', from), list.size());
                std::string argument = list.substr(from, comma - from);
                std::erase(argument, ' ');
                if (!is_identifier(argument))
                  throw Failure(i.key_span, "'" + argument + "' is not a name of an argument");
                d.arguments.push_back(argument);
                from = comma + 1;
              }
              if (d.arguments.size() == 1 && d.arguments[0] == "t") d.arguments.clear();
            }
            if (i.kind == Item::Kind::table && i.items.empty()) {
              d.symbolic = true;
              d.index = model_.unknown_functions.size();
              model_.unknown_functions.push_back(name);
              model_.names.given.push_back(name);
            } else if (i.is_formula()) {
              d.formula = i.formula;
            } else {
              throw Failure(i.span, "a given function is a formula, or {} where it is not known");
            }
            scope_.declare(name, d);
          },
          i);
  }

  void named(const Item& root, const char* key, Scope::Role role) {
    const Item* section = table(root, key);
    if (!section) return;
    for (const Item& i : section->items)
      declare(
          i.key,
          [&] {
            Scope::Declaration d;
            d.role = role;
            d.span = i.key_span;
            if (i.kind == Item::Kind::array && role != Scope::Role::frame)
              d.item = &i;
            else if (i.is_formula())
              d.formula = i.formula;
            else
              throw Failure(i.span, std::string("'") + i.key + "' in [" + key + "] is not a formula");
            scope_.declare(i.key, d);
          },
          i);
  }

  Diagnostics& diagnostics_;
  const Overrides& overrides_;
  const std::vector<std::string>& cases_;
  std::set<std::string> index_overrides_;
  std::vector<Replaced> replaced_;
  Item root_;  // referenced by the scope
  Model model_;
  Scope scope_;
  std::vector<ObserverFormula> observer_;
  std::vector<Contact> contacts_;
};

// The names of the file, and those of the derived equations.
class DerivedNames final : public Names {
 public:
  explicit DerivedNames(std::shared_ptr<Reader> reader) : reader_(std::move(reader)), scope_(reader_->scope()) {}

  Graph& graph() override { return scope_.graph(); }
  Value name(const std::string& name, Span span) override {
    const Model& model = reader_->model();
    if (name == "lambda" || name.rfind("lambda.", 0) == 0) return multiplier(name, span);
    if (name.rfind("m_", 0) == 0 && !scope_.declarations().count(name))
      for (std::size_t i = 0; i < model.masses.size(); ++i)
        if (name == mass_name(model, i)) return model.masses[i].value;
    return scope_.name(name, span);
  }
  std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                            const Syntax& syntax) override {
    return scope_.call(function, arguments, syntax);
  }
  Value member(const Value& object, const Syntax& syntax) override { return scope_.member(object, syntax); }
  std::vector<std::string> functions() const override { return scope_.functions(); }
  std::optional<Vector> point(const BodyName& body, Span use) override { return scope_.point(body, use); }
  std::optional<Rotation> frame(const BodyName& body, Span use) override { return scope_.frame(body, use); }
  std::string body_name(const BodyName& body) const override { return scope_.body_name(body); }
  const std::vector<Contact>& contacts() const { return reader_->contacts(); }
  const std::vector<Identity>& identities() const { return scope_.identities; }
  Model& model() { return reader_->model(); }
  bool declares(const std::string& name) const override {
    return scope_.declarations().count(name) > 0 || scope_.find_body(name) != nullptr;
  }

 private:
  Value multiplier(const std::string& name, Span span) {
    const std::vector<std::string>& known = reader_->model().names.multipliers;
    if (known.empty()) throw Failure(span, "the model has no constraints, and so no multipliers");
    if (name == "lambda") {
      if (known.size() == 1) return graph().multiplier(0, 0);
      throw Failure(span, "there are " + std::to_string(known.size()) + " multipliers", "lambda." + known[0]);
    }
    const std::string wanted = name.substr(7);
    for (std::size_t r = 0; r < known.size(); ++r)
      if (known[r] == wanted) return graph().multiplier(static_cast<std::uint32_t>(r), 0);
    const std::string near = did_you_mean(wanted, known);
    throw Failure(span,
                  "there is no constraint '" + wanted + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                  "lambda." + known[0]);
  }

  std::shared_ptr<Reader> reader_;
  Scope& scope_;
  ForcesInFormulas::Allowed multipliers_{scope_.forces};
};

}  // namespace

std::optional<Model> read_model(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides,
                                const std::vector<std::string>& cases) {
  Reader reader(source, diagnostics, overrides, cases);
  if (!reader.run()) return std::nullopt;
  return std::move(reader.model());
}

std::optional<OpenModel> open_model(const SourceText& source, Diagnostics& diagnostics, const Overrides& overrides,
                                    const std::vector<std::string>& cases) {
  const auto reader = std::make_shared<Reader>(source, diagnostics, overrides, cases);
  if (!reader->run()) return std::nullopt;
  return OpenModel{std::shared_ptr<const Model>(reader, &reader->model()), std::make_shared<DerivedNames>(reader)};
}

std::map<std::string, std::string> implied_units(const Model& model) {
  Diagnostics diagnostics;
  const Overrides overrides;
  const std::vector<std::string> cases;
  Reader reader(model.source_text, diagnostics, overrides, cases);
  if (!reader.run()) return {};
  return reader.implied_units();
}

Model& model_of(Names& names) { return dynamic_cast<DerivedNames&>(names).model(); }
const std::vector<Identity>& identities(const Names& names) {
  return dynamic_cast<const DerivedNames&>(names).identities();
}
const std::vector<Contact>& contacts(const Names& names) { return dynamic_cast<const DerivedNames&>(names).contacts(); }

}  // namespace anholon

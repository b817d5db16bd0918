#include "setup/choice.h"

#include <algorithm>

#include "formula/habits.h"
#include "modelfile/implied_units.h"

namespace anholon {

static std::string suggestion(const std::string& name, const std::vector<std::string>& names) {
  const std::string near = did_you_mean(name, names);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

static std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 24;
  std::string list;
  for (std::size_t k = 0; k < names.size() && k < kMost; ++k) list += (k ? ", " : "") + names[k];
  return list + (names.size() > kMost ? ", …" : "");
}

// Returns the sound of a name, to recognize names that are spelled by ear: its first letter and the consonants after
// it, doubled ones once.
static std::string sound(const std::string& name) {
  constexpr std::string_view kVowels = "aeiouy";
  std::string of;
  for (const char c : name)
    if (of.empty() || (kVowels.find(c) == std::string_view::npos && c != of.back())) of += c;
  return of;
}

// Returns the form that a wrong name means, by a misspelling, by one of the people in its name, or by their sound;
// empty if there is none.
static std::string near_form(const std::string& name, const std::vector<std::string>& forms) {
  constexpr std::size_t kLeast = 4;  // letters of a name
  if (std::string near = did_you_mean(name, forms); !near.empty() || name.size() < kLeast) return near;
  const auto among_words = [&](const auto& meant) -> std::string {
    for (const std::string& form : forms)
      for (std::size_t from = 0, end = 0; end != std::string::npos; from = end + 1) {
        end = form.find('-', from);
        const std::string word = form.substr(from, end == std::string::npos ? end : end - from);
        const bool of_people =
            word.size() >= kLeast && word != "type" && word != "order" && word != "quasi" && word != "reduced";
        if (of_people && meant(word)) return form;
      }
    return {};
  };
  std::string near =
      among_words([&](const std::string& word) { return word == name || !did_you_mean(name, {word}).empty(); });
  return near.empty() ? among_words([&](const std::string& word) { return sound(word) == sound(name); }) : near;
}

const Formulation& named_form(const std::string& name) {
  if (const Formulation* f = find_formulation(name)) return *f;
  std::vector<std::string> names;
  std::string list;
  for (const Formulation* f : formulations()) {
    names.emplace_back(f->name);
    list += (list.empty() ? "" : ", ") + std::string(f->name);
  }
  const std::string near = near_form(name, names);
  throw Failure({},
                name == "auto"
                    ? std::string("'auto' is a form for motions, to simulate, sweep and check")
                    : "there is no form '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                "the forms are " + list);
}

std::string forms_that_apply(const Mechanics& m, bool with_motions) {
  std::string list;
  for (const Formulation* f : formulations())
    if (obstacle(*f, m).empty() && !(with_motions && f->unknowns == Unknowns::variational))
      list += (list.empty() ? "" : ", ") + std::string(f->name);
  return list;
}

void must_apply(const Formulation& f, const Mechanics& m) {
  if (const std::string why = obstacle(f, m); !why.empty())
    throw Failure({}, "the form '" + std::string(f.name) + "' does not apply: " + why,
                  "these do: " + forms_that_apply(m, false));
}

void must_have_motions(const Formulation& f, const Mechanics& m) {
  if (f.unknowns == Unknowns::variational)
    throw Failure({},
                  "the form '" + std::string(f.name) +
                      "' is another mechanics: it is derived and compared, but no motion is computed with it",
                  "these give motions: " + forms_that_apply(m, true));
}

static std::size_t place(const std::vector<std::string>& names, const std::string& name, const std::string& what,
                         const std::string& called) {
  const auto it = std::find(names.begin(), names.end(), name);
  if (it == names.end())
    throw Failure({}, called + "there is no " + what + " '" + name + "'" + suggestion(name, names),
                  "the " + what + (names.size() == 1 ? " is " : "s are ") + listed(names));
  return static_cast<std::size_t>(it - names.begin());
}

std::size_t coordinate_of(const Model& model, const std::string& name, const std::string& called) {
  return place(model.names.coordinates, normal_name(name), "coordinate", called);
}

InitialName initial_name(const std::string& written) {
  InitialName n{written};
  while (!n.name.empty() && n.name.back() == '\'') n.name.pop_back(), ++n.order;
  n.name = normal_name(n.name);
  constexpr std::string_view kLambda = "lambda.";
  if (n.name.starts_with(kLambda)) n.multiplier = true, n.name.erase(0, kLambda.size());
  return n;
}

unsigned first_determined_order(const Model& model) {
  unsigned order = 2;
  for (const Constraint& c : model.constraints) order = std::max(order, static_cast<unsigned>(c.order));
  return order;
}

GivenQuantity::GivenQuantity(const Model& model, std::string name, std::string unit, unsigned order)
    : model_(&model), name_(std::move(name)), unit_(std::move(unit)), order_(order) {}

static std::string unit_at(const std::vector<std::string>& units, std::size_t index) {
  return index < units.size() ? units[index] : std::string();
}

GivenQuantity GivenQuantity::of_parameter(const Model& model, std::size_t index) {
  const Parameter& p = model.parameters[index];
  GivenQuantity of(model, p.name, unit_at(model.parameter_units, index), 0);
  of.declared_ = p.unit;
  of.bare_ = anholon::declared_unit(p);
  return of;
}
GivenQuantity GivenQuantity::of_coordinate(const Model& model, std::size_t index, unsigned order) {
  return {model, model.coordinates[index].name, unit_at(model.coordinate_units, index), order};
}

static std::optional<Dimension> dimension_of(const std::string& unit) {
  if (unit == "1") return Dimension{};
  const std::optional<Unit> read = read_unit(unit);
  return read ? std::optional(read->dimension) : std::nullopt;
}

// Returns the message about a value of another quantity.
static GivenQuantity::Misfit other_quantity(const Dimension& wanted, const Dimension& here) {
  return {describe(wanted) + " is expected here, this is " + describe(here), print(wanted)};
}

std::optional<GivenQuantity::Misfit> GivenQuantity::misfit(const Constant& value) {
  if (!value.dimension) return std::nullopt;
  const bool units = !model_->coordinate_units.empty() || !model_->parameter_units.empty();
  // In a file without units an angle may represent any number.
  if (!units && *value.dimension == Dimension{}) return std::nullopt;
  if (!units && !looked_) {
    const auto all = implied_units(*model_);
    const auto own = all.find(name_);
    unit_ = own == all.end() ? "" : own->second;
    looked_ = true;
  }
  std::optional<Dimension> wanted = dimension_of(unit_);
  if (!wanted && units) return std::nullopt;
  if (!wanted)
    return Misfit{"the model has no units from which that of '" + name_ + "' follows, and this is " +
                      describe(*value.dimension),
                  ""};
  (*wanted)[2] -= order_;
  if (*wanted == *value.dimension) return std::nullopt;
  Misfit found = other_quantity(*wanted, *value.dimension);
  if (!declared_.empty()) found.bare = declared_;
  return found;
}

std::string GivenQuantity::Misfit::hint(const std::string& before) const {
  if (unit.empty()) return "a bare number, in the units that the model is meant in";
  return unit == "1" ? "a bare number, or an angle: 30 deg" : before + "in " + unit + ", or a bare number in " + bare;
}

static Rational value_in(const Dimension& wanted, const Constant& value, const std::string& called) {
  if (value.dimension && *value.dimension != wanted) {
    const GivenQuantity::Misfit m = other_quantity(wanted, *value.dimension);
    throw Failure({}, called + m.message, m.hint("a number "));
  }
  return value.value;
}

Rational time_value(const Constant& value, const std::string& called) {
  return value_in(*dimension_of("s"), value, called);
}
Rational pure_value(const Constant& value, const std::string& called) { return value_in({}, value, called); }

// Throws if the name is that of a state of the model, whose initial value is a formula of the file.
static void must_be_no_state(const Model& model, const InitialName& of, const std::string& called) {
  const auto& states = model.names.states;
  const bool coordinate = std::find(model.names.coordinates.begin(), model.names.coordinates.end(), of.name) !=
                          model.names.coordinates.end();
  if (of.multiplier || coordinate || std::find(states.begin(), states.end(), of.name) == states.end()) return;
  const std::string own = of.name + "0";
  throw Failure({}, called + "'" + of.name + "' is a state of the model, whose initial value is given by a parameter",
                "parameters = {" + own + " = 0} in the file, and initial = \"" + own + "\" in the state; then set " +
                    own);
}

// Returns the index of a coordinate. A name such as x_dot means a velocity.
static std::size_t coordinate_with_value(const Model& model, const std::string& name, const std::string& called) {
  const std::vector<std::string>& known = model.names.coordinates;
  const auto varies = [&](const std::string& n) { return std::find(known.begin(), known.end(), n) != known.end(); };
  if (!varies(name))
    if (const std::string habit = habit_of_derivative(name, varies); !habit.empty())
      throw Failure({}, called + "there is no coordinate '" + name + "'",
                    habit + "; the coordinate" + (known.size() == 1 ? " is " : "s are ") + listed(known));
  return coordinate_of(model, name, called);
}

void give(StateChoice& choice, const Model& model, const InitialName& of, const Constant& value,
          const std::string& called) {
  must_be_no_state(model, of, called);
  const unsigned determined = first_determined_order(model);
  const std::size_t index = of.multiplier ? place(model.names.multipliers, of.name, "constraint", called)
                                          : coordinate_with_value(model, of.name, called);
  if (of.multiplier && of.order + 2 >= determined)
    throw Failure({}, called + "multipliers follow from the state",
                  "they are initial data for constraints of order 3 and more");
  if (!of.multiplier && of.order >= determined)
    throw Failure({}, called +
                          (determined == 2 ? std::string("accelerations follow")
                                           : "derivatives of order " + std::to_string(of.order) + " follow") +
                          " from the state");
  for (const StateOverride& before : choice.overrides)
    if (before.multiplier == of.multiplier && before.order == of.order && before.coordinate == index)
      throw Failure({}, called + "'" + of.name + std::string(of.order, '\'') + "' is given twice");
  if (!of.multiplier)
    if (const auto wrong = GivenQuantity::of_coordinate(model, index, of.order).misfit(value))
      throw Failure({}, called + wrong->message, wrong->hint("a number "));
  choice.overrides.push_back({of.order, index, value.value, of.multiplier, value.dimension.has_value()});
}

}  // namespace anholon

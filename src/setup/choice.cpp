#include "setup/choice.h"

#include <algorithm>

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

const Formulation& named_form(const std::string& name) {
  if (const Formulation* f = find_formulation(name)) return *f;
  std::vector<std::string> names;
  std::string list;
  for (const Formulation* f : formulations()) {
    names.emplace_back(f->name);
    list += (list.empty() ? "" : ", ") + std::string(f->name);
  }
  throw Failure({},
                name == "auto" ? std::string("'auto' is a form for motions, to simulate, sweep and check")
                               : "there is no form '" + name + "'" + suggestion(name, names),
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

// Throws if the value has a unit that the derivative of a coordinate cannot have.
static void must_fit(const Model& model, std::size_t coordinate, unsigned order, const Constant& value,
                     const std::string& called) {
  const std::string unit =
      coordinate < model.coordinate_units.size() ? model.coordinate_units[coordinate] : std::string();
  const std::optional<Unit> own = unit == "1" ? Unit{} : read_unit(unit);
  if (!value.dimension || !own) return;
  Dimension wanted = own->dimension;
  wanted[2] -= order;
  if (wanted == *value.dimension) return;
  throw Failure({}, called + describe(wanted) + " is expected here, this is " + describe(*value.dimension),
                wanted == Dimension{} ? "a bare number, or an angle: 30 deg"
                                      : "a number in " + print(wanted) + ", or a bare number in SI units");
}

void give(StateChoice& choice, const Model& model, const InitialName& of, const Constant& value,
          const std::string& called) {
  const unsigned determined = first_determined_order(model);
  const std::size_t index = of.multiplier ? place(model.names.multipliers, of.name, "constraint", called)
                                          : coordinate_of(model, of.name, called);
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
      throw Failure({}, called + "'" + of.name + "' is given twice");
  if (!of.multiplier) must_fit(model, index, of.order, value, called);
  choice.overrides.push_back({of.order, index, value.value, of.multiplier});
}

}  // namespace anholon

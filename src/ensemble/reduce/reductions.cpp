#include "ensemble/reduce/reductions.h"

#include <algorithm>
#include <utility>

#include "contact/mode/mode_model.h"
#include "formula/formula.h"
#include "modelfile/names/multiplier_names.h"
#include "setup/words/mistake_in_word.h"

namespace anholon {

namespace {

constexpr const char* kReductionHint =
    "max(FORMULA), min(FORMULA), mean(FORMULA), last(FORMULA), count(EVENT) or first(EVENT), such as max(theta')";

// Returns the kind that has this name elsewhere, or the nearest one to a misspelt name; "" if there is none.
std::string kind_meant_by(const std::string& word) {
  constexpr std::pair<const char*, const char*> kOthers[] = {
      {"maximum", "max"},  {"greatest", "max"}, {"largest", "max"}, {"minimum", "min"},   {"least", "min"},
      {"smallest", "min"}, {"average", "mean"}, {"avg", "mean"},    {"final", "last"},    {"end", "last"},
      {"number", "count"}, {"times", "count"},  {"when", "first"},  {"earliest", "first"}};
  for (const auto& [other, kind] : kOthers)
    if (word == other) return kind;
  return did_you_mean(word, {"max", "min", "mean", "last", "count", "first"});
}

std::optional<Reduction::Kind> kind_of(const std::string& word) {
  if (word == "max") return Reduction::Kind::greatest;
  if (word == "min") return Reduction::Kind::least;
  if (word == "mean") return Reduction::Kind::mean;
  if (word == "last") return Reduction::Kind::last;
  if (word == "count") return Reduction::Kind::count;
  if (word == "first") return Reduction::Kind::first;
  return std::nullopt;
}

// Returns the hint for the column NAME.WHAT of a contact that stays in the mode of the model: the multipliers that are
// its forces, by `kind`, such as "max".
std::string instead_of_column(const std::string& kind, const std::string& what, const Contact& contact,
                              const Model& model) {
  const std::vector<std::string>& known = model.names.multipliers;
  const auto has = [&](const std::string& name) { return std::find(known.begin(), known.end(), name) != known.end(); };
  const std::string lambda = "lambda." + contact.name;
  if (what == "mode") return "the contact keeps its mode";
  if (what == "gap")
    return has(contact.name) ? "the contact is closed, and its gap is 0"
                             : "write the gap with points and coordinates, as P.z - R";
  if (what == "normal")
    return has(contact.name) ? kind + "(" + lambda + ")" : "the contact is open, and its force is 0";
  if (has(contact.name + ".t2")) return kind + "(sqrt(" + lambda + ".t1^2 + " + lambda + ".t2^2))";
  if (has(contact.name + ".t1"))
    return kind + "(" + lambda + ".t1), or " + kind + "(abs(" + lambda + ".t1)) without its sign";
  return "it is 0 in a contact that does not stick in this mode";
}

// Throws MistakeInWord if the text has the form NAME.mode, or names another column of these contacts.
void must_be_no_column(const std::string& word, std::size_t at, const std::string& text, const OpenModel& model,
                       const std::vector<Contact>& moving) {
  for (const Contact& c : contacts(*model.names)) {
    const std::vector<std::string> columns = contact_columns({c}), events = contact_events({c});
    if (std::find(columns.begin(), columns.end(), text) == columns.end() || events.empty()) continue;
    mistake_in(word, at, text.size(), "'" + text + "' is a column of a contact, no formula",
               moving.empty()
                   ? instead_of_column(word.substr(0, word.find('(')), text.substr(c.name.size() + 1), c, *model.model)
                   : "rows at times have it: --at 1,2 --columns t," + text + "; events: count(" + events[0] +
                         "), first(" + events[0] + ")");
  }
}

// The reactions, and the forces of contacts and of constraints that are switched, differ from mode to mode, also in the
// equations that contain them.
[[noreturn]] void refuse_force(const std::string& word, std::size_t at, const std::string& text,
                               const std::vector<Contact>& moving) {
  const bool switched = std::any_of(moving.begin(), moving.end(), [](const Contact& c) { return c.held.has_value(); });
  mistake_in(
      word, at, text.size(),
      "'" + text + "' holds " + (switched ? "forces of constraints" : "reactions or forces of contacts") +
          ", which change with the modes",
      "a formula of coordinates, velocities, accelerations and t; rows at times have the forces: --at, --columns");
}

bool holds_contact_force(const std::vector<Contact>& contacts, std::size_t monitor) {
  using Formula = ContactForces::Formula;
  if (contacts.empty() || !contacts[0].forces) return false;
  const std::vector<Formula>& list = contacts[0].forces->formulas;
  return std::any_of(list.begin(), list.end(),
                     [&](const Formula& f) { return f.of == Formula::Of::monitor && f.index == monitor; });
}

// Returns the formula of a monitor, or one that is written out.
Expr formula_of(const std::string& word, std::size_t at, const std::string& text, const OpenModel& model,
                const std::vector<Contact>& moving) {
  for (const Monitor& m : model.model->monitors)
    if (m.name == text) return m.value;
  Value value;
  try {
    Span place;
    place.line = 1, place.column = static_cast<std::uint32_t>(at + 1);
    value = evaluate_with_multipliers(FormulaText(text, place), *model.names, model.model->names.multipliers);
  } catch (const Failure& f) {
    const auto of_force = [&](const Contact& c) { return text.find("lambda." + c.name) != std::string::npos; };
    if (std::any_of(moving.begin(), moving.end(), of_force)) refuse_force(word, at, text, moving);
    must_be_no_column(word, at, text, model, moving);
    throw MistakeInWord{f.diagnostic, word};
  }
  if (const Expr* e = std::get_if<Expr>(&value)) return put_masses(*model.model, *e);
  mistake_in(word, at, text.size(), "'" + text + "' is " + type_name(value) + ", no number",
             std::holds_alternative<Vector>(value) ? "a component, as " + text + ".x, or its length, norm(" + text + ")"
                                                   : "a formula that is a number");
}

// Throws MistakeInWord if the contacts move and the formula contains their forces.
void must_hold_no_forces(const std::string& word, std::size_t at, const std::string& text, Expr formula,
                         const Model& model, const std::vector<Contact>& moving) {
  if (moving.empty()) return;
  for (std::size_t i = 0; i < model.monitors.size(); ++i)
    if (model.monitors[i].name == text && holds_contact_force(moving, i)) refuse_force(word, at, text, moving);
  if (holds_multiplier(formula)) refuse_force(word, at, text, moving);
}

// Returns the name without the spaces around it, if there is such an event. Throws MistakeInWord.
std::string event_of(const std::string& word, std::size_t at, const std::string& text, const OpenModel& model,
                     const std::vector<Contact>& moving) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  const std::string name = text.substr(begin, end - begin + 1);
  std::vector<std::string> all;
  for (const Event& e : model.model->events) all.push_back(e.name);
  for (const std::string& event : contact_events(moving)) all.push_back(event);
  if (std::find(all.begin(), all.end(), name) != all.end()) return name;
  std::string near = did_you_mean(name, all);
  for (const std::string& event : all)
    if (near.empty() && event.starts_with(name + ".")) near = event;
  constexpr std::size_t kShown = 8;
  std::string shown;
  for (std::size_t k = 0; k < std::min(all.size(), kShown); ++k) shown += (k == 0 ? "" : ", ") + all[k];
  if (all.size() > kShown) shown += ", …";
  const bool one_mode = moving.empty() && !contacts(*model.names).empty();
  mistake_in(
      word, at + begin, name.size(),
      "there is no event '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
      one_mode ? "the contacts keep their modes: leave out the mode, and their changes are events"
      : all.empty()
          ? "the model has no events: an [[event]] with name and when, or a [[contact]], whose changes are events"
          : "the events are " + shown);
}

}  // namespace

void Reductions::add(const std::string& word, const OpenModel& model, const std::vector<Contact>& moving) {
  const std::size_t open = word.find('(');
  const std::string kind = word.substr(0, open);
  const std::optional<Reduction::Kind> known = kind_of(kind);
  if (open == std::string::npos)
    mistake_in(word, 0, word.size(), "this is not of the form KIND(FORMULA)", kReductionHint);
  if (!known) {
    const std::string near = kind_meant_by(kind);
    mistake_in(word, 0, open,
               "a motion is not summed up by '" + kind + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
               kReductionHint);
  }
  if (word.back() != ')') mistake_in(word, word.size(), 1, "a bracket is missing here", kReductionHint);
  for (const Reduction& before : list)
    if (before.name == word) mistake_in(word, 0, word.size(), "'" + word + "' is asked for twice", "once is enough");
  const std::string text = word.substr(open + 1, word.size() - open - 2);
  if (text.find_first_not_of(' ') == std::string::npos)
    mistake_in(word, open + 1, 1,
               std::string(Reduction{*known, 0, ""}.of_event() ? "an event" : "a formula") + " is missing here",
               kReductionHint);
  if (Reduction r{*known, 0, word}; r.of_event()) {
    const std::string name = event_of(word, open + 1, text, model, moving);
    const auto same = std::find(events.begin(), events.end(), name);
    r.of = static_cast<std::size_t>(same - events.begin());
    list.push_back(r);
    if (same == events.end()) events.push_back(name);
    return;
  }
  const Expr e = formula_of(word, open + 1, text, model, moving);
  must_hold_no_forces(word, open + 1, text, e, *model.model, moving);
  std::vector<Expr>& place = *known == Reduction::Kind::last ? ends : formulas;
  const auto same = std::find(place.begin(), place.end(), e);
  list.push_back({*known, static_cast<std::size_t>(same - place.begin()), word});
  if (same == place.end()) place.push_back(e);
}

}  // namespace anholon

#include "contact/mode/chosen_mode.h"

#include <algorithm>

#include "contact/mode/switched_model.h"
#include "modelfile/names/constant.h"
#include "tape/tape.h"

namespace anholon {

namespace {

struct Word {
  std::string all, name, value;
};

Word word(const std::string& text) {
  const std::size_t at = text.find('=');
  return {text, text.substr(0, at), at == std::string::npos ? "" : text.substr(at + 1)};
}

// Returns "; did you mean 'floor'?", or an empty string.
std::string meant(const std::string& name, const std::vector<std::string>& known) {
  const std::string near = did_you_mean(name, known);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

std::string modes_of(const std::string& contact) {
  return contact + "=open, " + contact + "=slips or " + contact + "=sticks";
}

std::vector<Touch> touches_of(const std::vector<Contact>& contacts, const std::vector<std::string>& words) {
  static const std::vector<std::string> kModes = {"open", "slips", "sticks"};
  std::vector<Touch> touches(contacts.size(), Touch::open);
  std::vector<std::string> names;
  for (const Contact& c : contacts) names.push_back(c.name);
  for (const std::string& text : words) {
    const Word w = word(text);
    const auto known = std::find(names.begin(), names.end(), w.name);
    if (known == names.end())
      throw Failure({}, "there is no contact '" + w.name + "'" + meant(w.name, names),
                    names.empty() ? "the model has none" : modes_of(names[0]));
    const auto mode = std::find(kModes.begin(), kModes.end(), w.value);
    if (mode == kModes.end())
      throw Failure({}, "'" + w.all + "' names no mode" + meant(w.value, kModes), modes_of(w.name));
    touches[static_cast<std::size_t>(known - names.begin())] = static_cast<Touch>(mode - kModes.begin());
  }
  return touches;
}

std::vector<std::string> names_of_modes(const Model& model) {
  std::vector<std::string> names;
  for (const Parameter& p : model.parameters)
    if (p.mode) names.push_back(p.name);
  return names;
}

std::vector<Rational> modes_of(const Model& model, const std::vector<std::string>& words, std::string& told) {
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  std::vector<Rational> modes;
  for (const double x : evaluate_parameters<double>(*model.graph, values)) modes.emplace_back(x);
  const std::vector<std::string> names = names_of_modes(model);
  for (const std::string& text : words) {
    const Word w = word(text);
    if (std::find(names.begin(), names.end(), w.name) == names.end())
      throw Failure({}, "there is no mode '" + w.name + "'" + meant(w.name, names), names[0] + "=1");
    const auto p = std::find_if(model.parameters.begin(), model.parameters.end(),
                                [&](const Parameter& o) { return o.name == w.name; });
    try {
      modes[static_cast<std::size_t>(p - model.parameters.begin())] = read_constant(w.value).value;
    } catch (const Failure&) {
      throw Failure({}, "'" + w.all + "' gives the mode no number", w.name + "=1");
    }
    told += (told.empty() ? "" : ", ") + w.name + " = " + w.value;
  }
  return modes;
}

std::size_t count_held(const std::vector<Contact>& contacts) {
  return static_cast<std::size_t>(
      std::count_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.held.has_value(); }));
}

}  // namespace

void put_chosen_mode(Model& model, const std::vector<Contact>& contacts, const std::vector<std::string>& words) {
  const std::size_t held = count_held(contacts);
  if (held == 0) return put_ideal_mode(model, contacts, touches_of(contacts, words));
  if (held < contacts.size())
    throw Failure({}, "a mode is one of contacts or of constraints with 'active', and the model has both",
                  "write what touches as a [[constraint]] with 'active'");
  std::string told;
  put_modes(model, contacts, modes_of(model, words, told));
  if (!told.empty()) model.title += (model.title.empty() ? "" : ": ") + told;
}

Failure needs_mode(const std::string& command, const Model& model, const std::vector<Contact>& contacts,
                   const std::string& option) {
  const auto held = std::find_if(contacts.begin(), contacts.end(), [](const Contact& c) { return c.held.has_value(); });
  if (held == contacts.end())
    return Failure(
        {}, "'" + command + "' needs the mode of the contacts, and the model has '" + contacts.front().name + "'",
        option + contacts.front().name + "=open, or slips, or sticks");
  return Failure({}, "'" + command + "' needs the mode, as the constraint '" + held->name + "' holds in some only",
                 option + names_of_modes(model).at(0) + "=0, or another number");
}

void hint_at_state_of_mode(Outcome& start, const Model& model, const std::vector<StateOverride>& given,
                           const std::string& options) {
  const std::vector<GivenValue>& of_file = model.initial.given;
  const bool takes_part =
      !model.initial.conditions.empty() || std::any_of(of_file.begin(), of_file.end(), [&](const GivenValue& v) {
        return !overridden(given, model.graph->node(v.symbol.id));
      });
  if (start.kind == OutcomeKind::inconsistent && takes_part)
    start.hint = "the file may start in another mode: give a state of the chosen one with " + options;
}

}  // namespace anholon

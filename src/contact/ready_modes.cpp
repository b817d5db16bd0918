#include "contact/ready_modes.h"

namespace anholon {

ReadyMode& ReadyModes::begin(const ContactModes& modes, const ContactState& at, Outcome& outcome, ModeEnds ends) {
  ReadyMode& mode = known_[{ends, mode_shape(contacts_, modes)}];
  const std::vector<Rational> numbers = mode_numbers(modes, at);
  if (mode.own) {
    const std::size_t first = mode.own->model->parameters.size() - numbers.size();
    for (std::size_t k = 0; k < numbers.size(); ++k) mode.own->set_parameter(first + k, numbers[k]);
    if (const std::optional<Outcome> begun = begin_anew(*mode.own)) {
      outcome = *begun;
      return mode;
    }
  }
  outcome = derive(modes, ends, numbers, mode);
  return mode;
}

Outcome ReadyModes::derive(const ContactModes& modes, ModeEnds ends, const std::vector<Rational>& numbers,
                           ReadyMode& mode) const {
  mode = {mode_model(*s_.model, contacts_, modes, ends), nullptr, {}};
  Model& model = *mode.of.model;
  const std::size_t first = model.parameters.size() - numbers.size();
  for (std::size_t k = 0; k < numbers.size(); ++k) model.parameters[first + k].value = model.graph->number(numbers[k]);
  Scenario scenario;
  if (Outcome o = make_scenario(mode.of.model, *s_.system.form, {}, scenario); !o.ok()) return o;
  mode.own = std::make_unique<Workspace>(scenario);
  return {};
}

}  // namespace anholon

#include "contact/mode/ready_modes.h"

#include <algorithm>
#include <cmath>

#include "numeric/told_time.h"

namespace anholon {

// Returns an outcome if a number with which the mode begins is not finite, as the direction of a slip with unbounded
// forces is.
static std::optional<Outcome> without_numbers(const ContactModes& modes, const ContactState& at) {
  const std::vector<double> numbers = mode_values(modes, at);
  if (std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })) return std::nullopt;
  const double t = at.t.get_d();
  return told({OutcomeKind::not_a_number, "the forces of the contacts have no finite values" + at_time(t),
               "end the motion before, or take coordinates that are regular there"},
              t);
}

ReadyMode& ReadyModes::begin(const ContactModes& modes, const ContactState& at, Outcome& outcome, ModeEnds ends) {
  if (const std::optional<Outcome> none = without_numbers(modes, at)) {
    outcome = *none;
    return nothing_;
  }
  std::vector<int> shape = mode_shape(contacts_, modes);
  for (std::size_t k = 0; k < at.borders.size() / 2; ++k) shape.push_back(at.borders[k] < 0 ? 1 : 0);
  ReadyMode& mode = known_[{ends, std::move(shape)}];
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

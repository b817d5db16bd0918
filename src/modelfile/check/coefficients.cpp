#include "modelfile/check/coefficients.h"

#include <algorithm>

#include "model/exponents.h"
#include "numeric/number.h"
#include "tape/tape.h"

namespace anholon {

std::vector<Diagnostic> wrong_coefficients(const std::vector<Contact>& contacts, const Model& model) {
  std::vector<Diagnostic> list;
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  const auto value_of = [&](const Expr& e) {
    values.push_back(with_whole_exponents(model, {model.graph->own(e)}, {}).front());
    const double value = evaluate_parameters<double>(*model.graph, values).back();
    values.pop_back();
    return value;
  };
  for (const Contact& contact : contacts) {
    const auto known = [&](Span span) {
      return std::any_of(list.begin(), list.end(), [&](const Diagnostic& o) {
        return o.span.file == span.file && o.span.line == span.line && o.span.column == span.column;
      });
    };
    for (const Expr& size : contact.sizes)
      if (const double value = value_of(size); !(value > 0) && !known(contact.span))
        list.push_back(
            {Severity::error, contact.span,
             "a size of the contact '" + contact.element + "' is " + number_text(value, 6) + ", and a size is positive",
             "leave out the values of parameters that make it so"});
    for (const Contact::Coefficient& c : contact.given) {
      const double value = value_of(c.value), sliding = value_of(contact.friction);
      const bool restitution = c.key == "restitution";
      const bool too_weak = c.key == "static_friction" && value >= 0 && value < sliding;
      if (value >= 0 && (value <= 1 || !restitution) && !too_weak) continue;
      if (known(c.span)) continue;
      list.push_back({Severity::error, c.span,
                      "'" + c.key + "' of the contact '" + contact.element + "' is " + number_text(value, 6) +
                          (too_weak      ? ", less than the " + number_text(sliding, 6) + " of 'friction'"
                           : restitution ? ", and a restitution lies between 0 and 1"
                                         : ", and it must not be negative"),
                      too_weak ? "what sticks holds at least the friction of what slips: leave out 'static_friction'"
                               : c.key + (restitution ? " = 0.5" : " = 0, or a positive number")});
    }
  }
  return list;
}

}  // namespace anholon

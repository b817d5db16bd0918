#include "contact/refused_options.h"

#include <algorithm>

namespace anholon {

bool are_switches(const std::vector<Contact>& contacts) { return !contacts.empty() && contacts.front().held; }

void refuse_options(const SimulationOptions& o, const Scenario& s, const std::vector<Contact>& contacts) {
  const bool switches = are_switches(contacts);
  if (std::any_of(contacts.begin(), contacts.end(), [&](const Contact& c) { return c.held.has_value() != switches; }))
    throw Failure(
        {}, "a motion knows contacts or constraints with 'active', and the model has both",
        "leave out 'active', or write the contact as a soft one: [[force]] with vector = \"-k*min(P.z, 0)*ez\"");
  const auto no = [switches](const std::string& what, const std::string& hint) {
    throw Failure(
        {}, std::string("a motion with ") + (switches ? "constraints that are switched " : "contacts ") + what, hint);
  };
  const Rational start = o.state.t ? *o.state.t : Rational(s.state.t);
  const Rational end = o.to && (o.at.empty() || *o.to > o.at.back()) ? *o.to : o.at.back();
  if (end < start) no("goes forwards only", "an end after the start");
  if (o.precision != Precision::real || o.digits > 16) no("is computed in doubles", "leave out --digits and --numbers");
  if (o.save || o.resume) no("is not saved", "leave out --save and --continue");
  if (o.rigorous) no("has no enclosure", "leave out --rigorous");
  if (o.integrator != Method::taylor) no("is computed by Taylor's method", "leave out --integrator");
  // Formulas that are followed need only the polynomials of each segment.
  if (o.dense && o.followed.empty()) no("has no polynomials", "leave out the dense output");
  if (s.system.form->eliminates()) no("needs a form with multipliers", "--form routh");
  if (!switches && sets_values(*s.model)) no("does not go with events that set values", "leave out 'set'");
}

}  // namespace anholon

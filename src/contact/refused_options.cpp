#include "contact/refused_options.h"

namespace anholon {

void refuse_options(const SimulationOptions& o, const Scenario& s, bool switches) {
  const auto no = [switches](const std::string& what, const std::string& hint) {
    throw Failure(
        {}, std::string("a motion with ") + (switches ? "constraints that are switched " : "contacts ") + what, hint);
  };
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

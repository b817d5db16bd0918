#include "cli/method.h"

#include <cstdio>

#include "cli/input.h"
#include "cli/say.h"

namespace anholon::cli {

namespace {

std::string title(Method m) {
  switch (m) {
  case Method::runge_kutta:
    return "Runge-Kutta 8";
  case Method::bdf:
    return "BDF";
  case Method::automatic:
  case Method::taylor:
    break;
  }
  return "Taylor";
}

std::string small(double x) { return number_text(x, 3); }

}  // namespace

void choose_method(const Options& o, const Scenario& s, SimulationOptions& options) {
  if (!o.method.empty()) {
    const auto wanted = find_method(o.method);
    if (!wanted) {
      const std::string near = did_you_mean(o.method, method_names());
      throw UsageError{"error: there is no method '" + o.method + "'" +
                       (near.empty() ? "" : "; did you mean '" + near + "'?") +
                       "\nhint: --method auto, taylor, rk or bdf\n"};
    }
    options.method = *wanted;
  }
  if (options.method == Method::automatic || options.method == Method::taylor) return;
  const std::string which = name(options.method);
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw UsageError{"error: the method '" + which + "' " + what +
                     "\nhint: " + (remedy.empty() ? "" : remedy + ", or ") + "use --method taylor\n"};
  };
  if (options.precision != Precision::real)
    refuse("computes in double", std::string("leave out ") + (o.digits > 16 ? "--digits" : "--numbers"));
  if (!o.save.empty() || options.resume)
    refuse("cannot go on with the same bits", std::string("leave out ") + (o.save.empty() ? "--continue" : "--save"));
  if (options.rigorous) refuse("has no dense output that is enclosed", "leave out --rigorous");
  if (options.order > 0) refuse("has no order to choose", "leave out --order");
  if (const std::string why = only_taylor(*s.model, program(s.system, s.structure)); !why.empty()) refuse(why, "");
  const double tolerance = options.tolerance.get_d();
  if (options.method == Method::bdf && tolerance < kLeastBdfTolerance)
    refuse("is of order 5 at most, for tolerances of " + small(kLeastBdfTolerance) + " and more", "--tolerance 1e-8");
  if (tolerance < kLeastRungeKuttaTolerance)
    say(stderr, "note: a tolerance below %s means %s to %s\n", small(kLeastRungeKuttaTolerance).c_str(),
        small(kLeastRungeKuttaTolerance).c_str(), which.c_str());
}

void print_method(const MethodReport& r) {
  if (!r.differs_from_taylor()) return;
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (r.asked == Method::automatic) {
    if (r.turns.empty()) add("Taylor, others were tried and not cheaper");
    for (const MethodReport::Turn& turn : r.turns)
      add(title(turn.to) + " from t = " + number_text(turn.t, 6) + " on, " + turn.why);
  } else {
    add(title(r.asked) + ", as asked");
    for (const MethodReport::Turn& turn : r.turns)
      add(title(turn.to) + " from t = " + number_text(turn.t, 6) + " on, " + turn.why);
  }
  if (r.steps > 0) {
    add(std::to_string(r.steps) + " steps (" + std::to_string(r.refused) + " refused), " +
        std::to_string(r.evaluations) + " evaluations");
    if (r.taylor_steps > 0) add(std::to_string(r.taylor_steps) + " steps by Taylor");
  }
  if (r.trials > 0)
    add(std::to_string(r.trials) + (r.trials == 1 ? " trial, " : " trials, ") + std::to_string(r.trial_evaluations) +
        " evaluations");
  say(stderr, "method: %s\n", text.c_str());
}

}  // namespace anholon::cli

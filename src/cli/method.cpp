#include "cli/method.h"

#include <cstdio>

#include "cli/input.h"
#include "cli/say.h"

namespace anholon::cli {

MethodDemands demands(const Options& o, const SimulationOptions& options) {
  return {options.precision != Precision::real, !o.save.empty() || options.resume, options.rigorous.has_value(),
          options.order > 0, options.tolerance.get_d()};
}

std::string option_of(MethodRefusal::Of of, const Options& o) {
  switch (of) {
  case MethodRefusal::Of::numbers:
    return o.digits > 16 ? "--digits" : "--numbers";
  case MethodRefusal::Of::saving:
    return o.save.empty() ? "--continue" : "--save";
  case MethodRefusal::Of::enclosing:
    return "--rigorous";
  case MethodRefusal::Of::order:
    return "--order";
  case MethodRefusal::Of::tolerance:
    return "--tolerance";
  }
  return {};
}

void say_raised(const MethodInfo& method, const SimulationOptions& options) {
  if (!(options.tolerance.get_d() < method.least_tolerance)) return;
  const std::string least = number_text(method.least_tolerance, 3);
  say(stderr, "note: a tolerance below %s means %s to %s\n", least.c_str(), least.c_str(), method.name);
}

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
  const MethodInfo& method = info(options.method);
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw UsageError{"error: the method '" + std::string(method.name) + "' " + what +
                     "\nhint: " + (remedy.empty() ? "" : remedy + ", or ") + "use --method taylor\n"};
  };
  const auto refused = refusal(method, demands(o, options));
  const bool tolerance = refused && refused->of == MethodRefusal::Of::tolerance;
  if (refused && !tolerance) refuse(refused->why, "leave out " + option_of(refused->of, o));
  if (const std::string why = only_taylor(*s.model, program(s.system, s.structure)); !why.empty()) refuse(why, "");
  if (tolerance) refuse(refused->why, "--tolerance 1e-8");
  say_raised(method, options);
}

void print_method(const MethodReport& r) {
  if (!r.differs_from_taylor()) return;
  std::string text;
  const auto add = [&](const std::string& part) { text += (text.empty() ? "" : "; ") + part; };
  if (r.asked == Method::automatic) {
    if (r.turns.empty()) add("Taylor, others were tried and not cheaper");
    for (const MethodReport::Turn& turn : r.turns)
      add(std::string(info(turn.to).title) + " from t = " + number_text(turn.t, 6) + " on, " + turn.why);
  } else {
    add(std::string(info(r.asked).title) + ", as asked");
    for (const MethodReport::Turn& turn : r.turns)
      add(std::string(info(turn.to).title) + " from t = " + number_text(turn.t, 6) + " on, " + turn.why);
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

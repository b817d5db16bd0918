#include "motion/form_choice.h"

#include <algorithm>
#include <cmath>

#include "integrate/stepper.h"
#include "motion/start.h"

namespace anholon {

namespace {

// A form without multipliers is chosen if Routh's equations cost at least this many times as much.
constexpr double kWorthIt = 1.25;
// With more unknowns the elimination of multipliers fills sparse matrices.
constexpr std::size_t kFewUnknowns = 12;
const double kLogTolerance = std::log(1e-12);

std::string why_no_kernel(const Scenario& s, const Program& p) {
  if (std::string why = no_plan(p); !why.empty()) return why;
  if (!s.model->events.empty() || !s.model->bounds.empty()) return "events are watched on the way";
  return {};
}

}  // namespace

FormCost cost_of(const Scenario& scenario, const StateChoice& choice, WritingEffort most) {
  Workspace s(scenario);
  FormCost cost;
  cost.form = s.system.form;
  const auto p = std::make_shared<const Program>(program(s.system, s.structure));
  cost.why = why_no_kernel(s, *p);
  if (!cost.why.empty()) return cost;
  Start<long double> start;
  if (const Outcome o = initial_state(s, choice, start); !o.ok()) {
    cost.why = o.message;
    return cost;
  }
  const std::vector<long double> parameters = parameter_values<long double>(*s.model);
  const std::vector<double> state(start.state.begin(), start.state.end());
  const double t = static_cast<double>(start.t);
  const auto derived = KernelPlan::make(p, taylor_order(kLogTolerance) - 1, parameters, t, state);
  if (!derived) {
    cost.why = "its equations are singular at the start";
    return cost;
  }
  const ToRepresent equations{derived, s.structure, {}, parameters, t, state, s.mechanics.get()};
  const bool stays = s.elimination.pivots().empty();
  for (const Representation& r : representations(equations, stays ? most : WritingEffort::at_once))
    cost.writings.push_back({r.writing, work_of(*r.plan), {}, r.velocities, r.clears_poles});
  // Writings that take less effort are enumerated first; known[effort] is the number of those up to an effort.
  const std::size_t known[] = {4, 5, 6};
  for (const WritingEffort effort : kWritingEfforts) {
    WritingCost* best = nullptr;
    for (WritingCost& w : cost.writings)
      if (static_cast<std::size_t>(w.writing) < known[static_cast<std::size_t>(effort)] &&
          (!best || (w.clears_poles == best->clears_poles ? w.work.total < best->work.total : w.clears_poles)))
        best = &w;
    if (!best->after) best->after = steps_before(effort);
    if (effort <= WritingEffort::long_motion) cost.total = best->work.total;
  }
  return cost;
}

static bool in_quasi_velocities(const FormCost& cost) {
  return std::any_of(cost.writings.begin(), cost.writings.end(),
                     [](const WritingCost& w) { return w.writing == Writing::quasi && w.after == 0U; });
}

FormChoice choose_form(const std::shared_ptr<const Model>& model, const StateChoice& choice, Costs costs) {
  FormChoice c;
  c.form = find_formulation("routh");
  const auto add = [&](const Formulation& form) {
    Scenario s;
    const Outcome o = make_scenario(model, form, choice, s);
    if (!o.ok() || !regular_at_start(s).ok())
      return c.costs.push_back({&form, {}, 0, o.ok() ? "its equations are singular at the start" : o.message});
    // If Routh's equations can be written in quasi-velocities, other writings are not tried.
    FormCost soon;
    if (&form == c.form && costs == Costs::where_needed) soon = cost_of(s, choice, WritingEffort::at_once);
    c.costs.push_back(in_quasi_velocities(soon) ? soon : cost_of(s, choice));
  };
  const Formulation& maggi = *find_formulation("maggi");
  if (model->constraints.empty())
    c.why = "there are no constraints to eliminate";
  else if (model->coordinates.size() + model->constraints.size() + model->states.size() > kFewUnknowns)
    c.why = "with more than " + std::to_string(kFewUnknowns) +
            " unknowns the sparse equations with multipliers are the cheap ones";
  else if (const std::string no = obstacle(maggi, mechanics(*clone(*model))); !no.empty())
    c.why = no;
  if (!c.why.empty() && costs == Costs::where_needed) return c;
  add(*c.form);
  if (c.why.empty() && c.costs[0].writings.empty()) c.why = c.costs[0].why;
  const bool quasi = in_quasi_velocities(c.costs[0]);
  if (c.why.empty() && quasi)
    c.why = "in quasi-velocities that make the energy short they need neither multipliers nor a mass matrix";
  if (!c.why.empty() && (!quasi || costs == Costs::where_needed)) return c;
  try {
    add(maggi);
  } catch (const Failure& e) {
    c.costs.push_back({&maggi, {}, 0, e.diagnostic.message});
  }
  if (quasi) return c;
  const FormCost &with = c.costs[0], &without = c.costs[1];
  if (without.writings.empty()) {
    c.why = without.why;
  } else {
    const double ratio = with.total / without.total;
    if (ratio >= kWorthIt) c.form = &maggi;
    c.why = "an expansion of Maggi's equations costs " + number_text(100 / ratio, 3) +
            " % of one of Routh's; they are taken up to " + number_text(100 / kWorthIt, 3) + " %";
  }
  return c;
}

}  // namespace anholon

#include "simulation/first_pull.h"

namespace anholon {

namespace {

class NoRowsOfPull final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>&) override {}
  void row(const Row&) override {}
};

// The time of the first event of a formula, or, if it has none, the one at which the motion begins.
struct FirstPassing {
  bool passes = false;
  double t = 0;
};

std::optional<FirstPassing> first_event(const Scenario& s, const SimulationOptions& o, Expr (*formula)(const Model&),
                                        const Support* support, int direction, double until, const Follow& simulate) {
  if (s.system.form->eliminates()) return std::nullopt;
  const std::shared_ptr<Model> model = given_model(s);
  Graph& g = *model->graph;
  const std::string name = "begins to pull";  // no name that a user can write
  const Expr when =
      formula ? formula(*model)
              : g.number(Rational(support->upwards)) * g.multiplier(static_cast<std::uint32_t>(support->constraint), 0);
  const Span span = support ? model->constraints[support->constraint].span : Span{};
  model->events.push_back({name, when, direction, {}, true, span});
  Scenario scenario;
  if (!make_scenario(model, *s.system.form, o.state, scenario).ok()) return std::nullopt;
  SimulationOptions own;
  own.state = o.state, own.tolerance = o.tolerance, own.order = o.order, own.most_steps = o.most_steps;
  own.cancelled = o.cancelled;
  own.at = {Rational(until)};
  own.watches_floors = false;
  NoRowsOfPull rows;
  const SimulationReport r = simulate(scenario, own, rows);
  for (const EventReport& e : r.events)
    if (e.name == name) return FirstPassing{true, e.t.value};
  if (!r.outcome.ok()) return std::nullopt;
  return FirstPassing{false, o.state.t ? o.state.t->get_d() : to_double(scenario.state.t)};
}

}  // namespace

std::optional<double> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support, double until,
                                 const Follow& simulate) {
  const auto first = first_event(s, o, nullptr, &support, -1, until, simulate);
  return first && first->passes ? std::optional(first->t) : std::nullopt;
}

std::optional<double> first_passing(const Scenario& s, const SimulationOptions& o, Expr (*formula)(const Model&),
                                    int direction, double until, const Follow& simulate) {
  const auto first = first_event(s, o, formula, nullptr, direction, until, simulate);
  return first ? std::optional(first->t) : std::nullopt;
}

}  // namespace anholon

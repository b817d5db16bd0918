#include "simulation/first_pull.h"

namespace anholon {

namespace {

class NoRowsOfPull final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>&) override {}
  void row(const Row&) override {}
};

}  // namespace

std::optional<double> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support, double until,
                                 const Follow& simulate) {
  if (s.system.form->eliminates()) return std::nullopt;
  const std::shared_ptr<Model> model = given_model(s);
  Graph& g = *model->graph;
  const std::string name = "begins to pull";  // no name that a user can write
  const Expr load =
      g.number(Rational(support.upwards)) * g.multiplier(static_cast<std::uint32_t>(support.constraint), 0);
  model->events.push_back({name, load, -1, {}, true, model->constraints[support.constraint].span});
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
    if (e.name == name) return e.t.value;
  return std::nullopt;
}

}  // namespace anholon

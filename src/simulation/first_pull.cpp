#include "simulation/first_pull.h"

namespace anholon {

namespace {

// Keeps a number of the first row.
class FirstRow final : public RowSink {
 public:
  explicit FirstRow(std::string column) : wanted_(std::move(column)) {}
  void columns(const std::vector<RunColumn>& columns) override {
    for (std::size_t k = 0; k < columns.size(); ++k)
      if (columns[k].name == wanted_) at_ = k;
  }
  void row(const Row& row) override {
    if (at_ && !value_) value_ = row.values[*at_];
  }
  std::optional<double> value() const { return value_; }

 private:
  std::string wanted_;
  std::optional<std::size_t> at_;
  std::optional<double> value_;
};

// The time of the first event of a formula; if it has none, the time at which the motion begins.
struct FirstPassing {
  bool passes = false;
  double t = 0;
  double multiplier = 0;  // of the support, at the start
};

std::optional<FirstPassing> first_event(const Scenario& s, const SimulationOptions& o, const FormulaOf& formula,
                                        const Support* support, int direction, double until, const Follow& simulate) {
  // The event is located in a form whose unknowns contain the multipliers; the motion is the same in all forms.
  const Formulation& form = s.system.form->eliminates() ? *find_formulation("routh") : *s.system.form;
  const std::shared_ptr<Model> model = given_model(s);
  Graph& g = *model->graph;
  const std::string name = "begins to pull";  // a name that a user cannot write
  const Expr when =
      formula ? formula(*model)
              : g.number(Rational(support->upwards)) * g.multiplier(static_cast<std::uint32_t>(support->constraint), 0);
  const Span span = support ? model->constraints[support->constraint].span : Span{};
  model->events.push_back({name, when, direction, {}, true, span});
  Scenario scenario;
  if (!make_scenario(model, form, o.state, scenario).ok()) return std::nullopt;
  SimulationOptions own;
  own.state = o.state, own.tolerance = o.tolerance, own.order = o.order, own.most_steps = o.most_steps;
  own.cancelled = o.cancelled;
  own.at = {Rational(until)};
  const double start = o.state.t ? o.state.t->get_d() : to_double(scenario.state.t);
  if (support && start != until) own.at.insert(own.at.begin(), o.state.t ? *o.state.t : Rational(start));
  own.watches_floors = false;
  own.watches_ranges = false;
  FirstRow rows(support ? multiplier_name(*model, support->constraint) : "");
  const SimulationReport r = simulate(scenario, own, rows);
  for (const EventReport& e : r.events)
    if (e.name == name) return FirstPassing{true, e.t.value, rows.value().value_or(0)};
  if (!r.outcome.ok()) return std::nullopt;
  return FirstPassing{false, start, rows.value().value_or(0)};
}

}  // namespace

std::optional<SupportWatch::Begin> first_pull(const Scenario& s, const SimulationOptions& o, const Support& support,
                                              double until, const Follow& simulate) {
  const auto first = first_event(s, o, nullptr, &support, -1, until, simulate);
  if (!first) return std::nullopt;
  return SupportWatch::Begin{first->passes ? std::optional(first->t) : std::nullopt,
                             support.upwards * first->multiplier > 0};
}

std::optional<double> first_passing(const Scenario& s, const SimulationOptions& o, const FormulaOf& formula,
                                    int direction, double until, const Follow& simulate) {
  const auto first = first_event(s, o, formula, nullptr, direction, until, simulate);
  return first ? std::optional(first->t) : std::nullopt;
}

}  // namespace anholon

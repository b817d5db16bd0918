#include "run/cases.h"

#include <algorithm>
#include <cstdlib>

#include "run/watch.h"

namespace anholon {

namespace {

// The parameters by those that are varied: what is derived from others follows.
Tape parameter_tape(const Model& model, const std::vector<Varied>& varied) {
  Graph& g = *model.graph;
  Column values;
  for (const Parameter& p : model.parameters) values.push_back(p.value);
  for (const Varied& v : varied)
    if (v.kind == Varied::Kind::parameter) values[v.index] = g.parameter(static_cast<std::uint32_t>(v.index));
  Column es = values;
  for (std::size_t depth = 0; depth <= values.size(); ++depth)
    es = substitute(es, [&](NodeId id) {
      const Node& n = g.node(id);
      return n.kind == Kind::parameter ? values[n.index] : Expr{};
    });
  return compile(es);
}

std::vector<StateOverride> overrides_of(const EnsembleOptions& o, const std::vector<Rational>* values) {
  std::vector<StateOverride> list = o.state.overrides;
  for (std::size_t i = 0; i < o.varied.size(); ++i)
    if (const Varied& v = o.varied[i]; v.kind == Varied::Kind::initial) list.push_back({v.order, v.index, values ? (*values)[i] : Rational(0)});
  return list;
}

template <Number N>
std::vector<N> evaluated(const Tape& tape, const std::vector<Varied>& varied, const std::vector<Rational>& values, std::size_t parameters) {
  std::vector<N> given(parameters, N(0));
  for (std::size_t i = 0; i < varied.size(); ++i)
    if (varied[i].kind == Varied::Kind::parameter) given[varied[i].index] = from_rational<N>(values[i]);
  Machine<N> machine(tape, 0, given);
  machine.evaluate();
  for (std::size_t i = 0; i < parameters; ++i) given[i] = machine.value(i);
  return given;
}

}  // namespace

std::vector<std::string> ensemble_columns(const Model& model) {
  std::vector<std::string> names;
  for (const unsigned k : {0U, 1U})
    for (const Coordinate& c : model.coordinates) names.push_back(derivative_name(c.name, k, Format::text));
  for (const StateVariable& z : model.states) names.push_back(z.name);
  for (const Monitor& m : model.monitors) names.push_back(m.name);
  return names;
}

EnsemblePlan::EnsemblePlan(const Scenario& s, const EnsembleOptions& o) : scenario(s), options(o) {
  const Model& model = *s.model;
  Graph& g = *model.graph;
  settings = {natural_logarithm(o.tolerance), o.order, o.most_steps, o.cancelled};
  plain = !s.routh && s.redundant.empty() && s.elimination.pivots().empty() && model.events.empty() && model.bounds.empty();
  if (!plain) return;
  if (!model.parameters.empty()) parameters = parameter_tape(model, o.varied);
  start.emplace(*s.mechanics, overrides_of(o, nullptr));
  for (std::size_t j = 0; j < s.system.size(); ++j)
    for (int k = 0; k < s.structure.d[j]; ++k) entries.push_back(g.node(s.system.symbol(j, static_cast<unsigned>(k)).id));
  Column masses;
  for (const VaryingMass& m : model.masses) masses.push_back(m.value);
  program = anholon::program(s.system, s.structure, masses);
  Column watched;
  for (const Monitor& m : model.monitors) watched.push_back(m.value);
  stages = std::max(orders_beyond(s, s.structure.d), orders_needed(s, watched));
  if (watched.empty()) return;
  outputs = compile(OutputTape<Wider<double>>::put(s, watched));
  for (const Input& in : outputs->inputs) {
    const Node& n = g.node(in.symbol);
    output_inputs.push_back({in.slot, s.system.variable(in.symbol), n.kind == Kind::time ? 0 : n.order});
  }
}

// Reading and deriving the model once more gives the same graph, in which a thread may build.
struct CaseWorker::Own {
  std::shared_ptr<Model> model;
  Scenario scenario;
  std::size_t cases = 0;  // that were computed in it
};

void CaseWorker::integrate(std::span<CaseResult> results) {
  for (CaseResult& r : results) {
    const EnsembleCase numbers = plan_.options.numbers(r.number);
    for (const Rational& v : numbers.values) r.values.push_back(from_rational<double>(v));
    try {
      if (plan_.plain && plainly(numbers, r)) continue;
      r.last.clear();
      r.rows.clear();
      by_simulation(numbers, r);
    } catch (const Failure& e) {
      r.outcome = {OutcomeKind::too_large, e.diagnostic.message, e.diagnostic.hint};
    } catch (const std::bad_alloc&) {
      r.outcome = {OutcomeKind::too_large, "out of memory", "fewer threads need less"};
    }
  }
}

// The numbers of the case, in its workspaces; false if a parameter has no value.
bool CaseWorker::set_parameters(const EnsembleCase& numbers) {
  const std::size_t n = plan_.scenario.model->parameters.size();
  const std::vector<Varied>& varied = plan_.options.varied;
  if (n > 0) {
    parameters_ = evaluated<W>(plan_.parameters, varied, numbers.values, n);
    narrow_parameters_ = evaluated<double>(plan_.parameters, varied, numbers.values, n);
  }
  const bool same = point_ && parameters_ == given_;
  given_ = parameters_;
  // A stepper begins anew: what it met with other numbers must leave no trace.
  stepper_.emplace(*plan_.program, narrow_parameters_, parameters_, plan_.settings);
  if (!same) {
    point_.emplace(*plan_.program, parameters_, std::max(1, plan_.stages));
    if (plan_.outputs) outputs_.emplace(*plan_.outputs, 0, parameters_);
  }
  return std::all_of(parameters_.begin(), parameters_.end(), [](const W& p) { return is_finite(p); });
}

// False if the case has to go the other way.
bool CaseWorker::plainly(const EnsembleCase& numbers, CaseResult& r) {
  if (!set_parameters(numbers)) {
    r.outcome = {OutcomeKind::not_a_number, "a parameter has no value", "look for roots of negative numbers and divisions by zero among the parameters"};
    return true;
  }
  const InitialProblem<W> problem{plan_.scenario.mechanics.get(), parameters_, overrides_of(plan_.options, &numbers.values), plan_.options.state.t, nullptr, &*plan_.start};
  r.outcome = consistent_state(problem, named_);
  r.t = to_double(named_.t);
  if (!r.outcome.ok()) return true;
  std::vector<W> state;
  for (const Node& n : plan_.entries) {
    const W* known = named_.value(n);
    state.push_back(known ? *known : W(0));
  }
  return walk(named_.t, state, numbers, r);
}

bool CaseWorker::walk(const W& t0, const std::vector<W>& state, const EnsembleCase& numbers, CaseResult& r) {
  const EnsembleOptions& o = plan_.options;
  if (!stepper_->start(t0, state).ok()) return false;
  const W end = from_rational<W>(numbers.to ? *numbers.to : o.to);
  const bool forward = !(end < t0);
  std::vector<W> times;
  for (const Rational& t : o.at)
    if (const W at = from_rational<W>(t); forward ? at <= end : at >= end) times.push_back(at);
  if (!forward) std::reverse(times.begin(), times.end());
  const auto rows = [&] {
    for (; r.rows.size() < times.size(); ) {
      const W& t = times[r.rows.size()];
      if (forward ? t > stepper_->time() : t < stepper_->time()) break;
      std::vector<double> row = {to_double(t)};
      if (!keep(t, row)) return false;
      r.rows.push_back(std::move(row));
    }
    return true;
  };
  if (!rows()) return false;
  while (!(stepper_->time() == end)) {
    if (!stepper_->step(end).ok()) return false;
    for (std::size_t i = 0; i < plan_.program->quadratures; ++i)
      if (!plan_.scenario.model->masses[i].weight && stepper_->quadrature(i, stepper_->time() - stepper_->before()) < W(0)) return false;
    if (!rows()) return false;
  }
  r.t = to_double(end);
  r.steps = stepper_->steps();
  return keep(end, r.last);
}

// What is kept of the state at t, which lies in the last step.
bool CaseWorker::keep(const W& t, std::vector<double>& values) {
  const System& system = plan_.scenario.system;
  if (!stepper_->at(t, *point_).ok() || (plan_.stages > 0 && !point_->extend().ok())) return false;
  for (const int k : {0, 1})
    for (std::size_t a = 0; a < system.coordinates; ++a) values.push_back(to_double(point_->derivative(a, k)));
  for (std::size_t j = system.mechanical(); j < system.size(); ++j) values.push_back(to_double(point_->derivative(j, 0)));
  if (!outputs_) return true;
  for (const EnsemblePlan::Entry& e : plan_.output_inputs) outputs_->series(e.slot)[0] = e.variable ? point_->derivative(*e.variable, e.order) : point_->time();
  outputs_->evaluate();
  for (std::size_t i = 0; i < plan_.outputs->roots.size(); ++i) values.push_back(to_double(outputs_->value(i)));
  return true;
}

namespace {

// Rows of `simulate`, of which the columns of an ensemble are kept.
class Kept final : public RowSink {
 public:
  Kept(const Scenario& s, const std::vector<Rational>& times, CaseResult& result) : s_(s), times_(times), result_(result) {}
  void columns(const std::vector<std::string>& names) override {
    const Model& model = *s_.model;
    const std::size_t n = model.coordinates.size();
    for (std::size_t i = 1; i <= 2 * n; ++i) columns_.push_back(i);
    const std::size_t monitors = names.size() - model.monitors.size(), states = monitors - n - model.states.size();
    for (std::size_t i = states; i < monitors - n; ++i) columns_.push_back(i);
    for (std::size_t i = monitors; i < names.size(); ++i) columns_.push_back(i);
  }
  void row(const std::vector<std::string>& texts) override {
    const double t = std::strtod(texts[0].c_str(), nullptr);
    result_.t = t;
    result_.last.clear();
    for (std::size_t c : columns_) result_.last.push_back(std::strtod(texts[c].c_str(), nullptr));
    const auto wanted = [&](const Rational& at) { return from_rational<double>(at) == t; };
    if (std::none_of(times_.begin(), times_.end(), wanted)) return;
    std::vector<double> row = {t};
    row.insert(row.end(), result_.last.begin(), result_.last.end());
    result_.rows.push_back(std::move(row));
  }

 private:
  const Scenario& s_;
  const std::vector<Rational>& times_;
  CaseResult& result_;
  std::vector<std::size_t> columns_;
};

}  // namespace

void CaseWorker::simulate_in(Own& own, const Rational& to, std::vector<StateOverride> overrides, CaseResult& r) {
  const EnsembleOptions& o = plan_.options;
  SimulationOptions options;
  options.state = o.state;
  options.state.overrides = std::move(overrides);
  for (const Rational& t : o.at)
    if (to < Rational(own.scenario.state.t) ? t > to : t < to) options.at.push_back(t);
  options.at.push_back(to);
  std::sort(options.at.begin(), options.at.end());
  options.tolerance = o.tolerance;
  options.order = o.order;
  options.most_steps = o.most_steps;
  options.cancelled = o.cancelled;
  Kept rows(own.scenario, o.at, r);
  const SimulationReport report = simulate(own.scenario, options, rows);
  r.outcome = report.outcome;
  r.steps = report.steps;
  r.t = std::strtod(report.t.c_str(), nullptr);
}

std::shared_ptr<CaseWorker::Own> CaseWorker::make_own() {
  const EnsembleOptions& o = plan_.options;
  const Scenario& s = plan_.scenario;
  auto own = std::make_shared<Own>();
  own->model = std::make_shared<Model>(*o.again());
  make_scenario(own->model, *s.system.form, o.state, own->scenario);
  // What all cases build, the motion of the file builds first.
  CaseResult nothing;
  simulate_in(*own, o.to, o.state.overrides, nothing);
  return own;
}

// Expressions that a case builds stand before those of later cases, and their order is that of sums. So no case may be computed
// where another one has left some: a graph that has grown is thrown away, and a case that made it grow is computed in a new one.
void CaseWorker::by_simulation(const EnsembleCase& numbers, CaseResult& r) {
  const EnsembleOptions& o = plan_.options;
  ++again_;
  for (;;) {
    if (!own_) own_ = make_own();
    const std::shared_ptr<Own> own = std::exchange(own_, nullptr);
    Graph& g = *own->model->graph;
    for (std::size_t i = 0; i < o.varied.size(); ++i)
      if (o.varied[i].kind == Varied::Kind::parameter) own->model->parameters[o.varied[i].index].value = g.number(numbers.values[i]);
    const std::size_t before = g.size();
    r.rows.clear();
    r.last.clear();
    simulate_in(*own, numbers.to ? *numbers.to : o.to, overrides_of(o, &numbers.values), r);
    const bool first = own->cases++ == 0, grown = g.size() != before;
    if (!grown) own_ = own;
    if (!grown || first) return;
  }
}

}  // namespace anholon

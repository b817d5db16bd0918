#include "contact/switched_motion.h"

#include <algorithm>
#include <cmath>

#include "contact/joined_report.h"
#include "contact/law/contact_dynamics.h"
#include "contact/mode/switched_model.h"
#include "contact/segment_rows.h"
#include "numeric/told_time.h"

namespace anholon {

namespace {

class SwitchedMotion {
 public:
  SwitchedMotion(Workspace& s, const std::vector<Contact>& contacts, const SimulationOptions& o, RowSink& sink)
      : s_(s), contacts_(contacts), o_(o), rows_(sink, contacts), joined_(*s.model, {}),
        parameters_(parameter_values<long double>(*s.model)) {
    at_.t = o.state.t ? *o.state.t : Rational(s.state.t);
    at_.q = s.state.q, at_.qd = s.state.qd, at_.states = s.state.states;
    end_ = o.to && (o.at.empty() || *o.to > o.at.back()) ? *o.to : o.at.back();
    times_ = times_of_rows(o, at_.t, end_);
    rows_.only_at(times_);
    for (const Event& e : s.model->events)
      for (const Assignment& a : e.set) must_be_of_state(e, a);
  }

  SimulationReport go() {
    Outcome outcome;
    constexpr std::size_t kMostSegments = 100'000, kMostAtOnce = 16;
    std::size_t at_once = 0;
    // A motion that ends where it begins has one row, too.
    for (std::size_t k = 0; outcome.ok() && (at_.t < end_ || k == 0); ++k) {
      const Rational before = at_.t;
      if (k == kMostSegments)
        outcome = told({OutcomeKind::interrupted, "more than 100000 changes of the modes" + at_time(now()),
                        "end the motion earlier"},
                       now());
      else if (!segment(outcome))
        break;
      at_once = at_.t == before ? at_once + 1 : 0;
      if (outcome.ok() && at_once == kMostAtOnce)
        outcome = told({OutcomeKind::step_collapse,
                        "events accumulate: '" + last_event_ + "' and others fire again and again" + at_time(now()),
                        "let an event end the motion (stop = true), or set a mode in which it does not happen"},
                       now());
    }
    if (at_.t < end_) rows_.end_early();
    return joined_.report(std::move(outcome), at_.t.get_d(), rows_.rows());
  }

 private:
  double now() const { return at_.t.get_d(); }

  static void must_be_of_state(const Event& e, const Assignment& a) {
    for (const NodeId id : symbols({&a.value, 1})) {
      const Node& n = a.value.graph->node(id);
      if (n.kind == Kind::multiplier || n.order > 1)
        throw Failure(a.span,
                      "the event '" + e.name +
                          "' sets a value by a force or an acceleration, in a model with "
                          "constraints that are switched",
                      "write the value by positions and velocities");
    }
  }

  std::vector<Rational> modes() const {
    std::vector<Rational> list;
    for (const long double x : parameters_) list.emplace_back(static_cast<double>(x));
    return list;
  }

  // Applies the values that an event sets; all formulas of one event use the values before it.
  std::vector<EventReport::Change> set(const Event& e) {
    std::vector<EventReport::Change> changes;
    if (e.set.empty()) return changes;
    Column values;
    for (const Assignment& a : e.set) values.push_back(a.value);
    const Graph& g = *s_.model->graph;
    const Tape tape = compile(values);
    Machine<long double> machine(tape, 0, parameters_);
    bind(machine, g, [&](const Node& n, NodeId) -> long double {
      if (n.kind == Kind::time) return at_.t.get_d();
      if (n.kind == Kind::jet) return n.order == 0 ? at_.q[n.index] : at_.qd[n.index];
      return n.kind == Kind::state ? at_.states[n.index] : 0;
    });
    machine.evaluate();
    for (std::size_t i = 0; i < e.set.size(); ++i) {
      const Node& n = g.node(e.set[i].symbol.id);
      const auto value = static_cast<double>(machine.value(i));
      const std::string name = print(e.set[i].symbol, s_.model->names, Format::text);
      double before = 0;
      if (n.kind == Kind::parameter)
        before = static_cast<double>(std::exchange(parameters_[n.index], value));
      else if (n.kind == Kind::state)
        before = std::exchange(at_.states[n.index], value);
      else
        before = std::exchange(n.order == 0 ? at_.q[n.index] : at_.qd[n.index], value);
      changes.push_back({name, {before, ""}, {value, ""}});
    }
    return changes;
  }

  // True if an event changes nothing: it only sets modes to their present values.
  bool idle(const Event& e) const {
    return !e.set.empty() && !e.stop && std::all_of(e.set.begin(), e.set.end(), [&](const Assignment& a) {
      const Node& n = a.symbol.graph->node(a.symbol.id);
      return n.kind == Kind::parameter && is_number(a.value) &&
             from_rational<double>(number_value(a.value)) == static_cast<double>(parameters_[n.index]);
    });
  }

  // Returns the model of the present modes, which begins at the present state. The velocities are first guesses; the
  // nearest ones in the mass norm that satisfy the constraints are taken.
  std::shared_ptr<Model> model(std::map<std::string, ModeEvent>& setting) const {
    const std::shared_ptr<Model> m = clone(*s_.model);
    put_modes(*m, contacts_, modes());
    Graph& g = *m->graph;
    m->initial = {};
    m->initial.t = g.number(at_.t);
    for (std::size_t a = 0; a < at_.q.size(); ++a) {
      const auto index = static_cast<std::uint32_t>(a);
      m->initial.given.push_back({g.jet(index, 0), g.number(Rational(at_.q[a])), m->coordinates[a].span});
      m->initial.guess.push_back({g.jet(index, 1), g.number(Rational(at_.qd[a])), m->coordinates[a].span});
    }
    for (std::size_t k = 0; k < at_.states.size(); ++k) m->states[k].initial = g.number(Rational(at_.states[k]));
    for (std::size_t k = 0; k < m->events.size(); ++k) {
      Event& e = m->events[k];
      if (e.set.empty()) continue;
      if (idle(s_.model->events[k])) e.when = g.one();
      e.set.clear();
      e.stop = true;
      setting[e.name] = {};
    }
    const std::vector<bool> holds = constraints_that_hold(*m, contacts_);
    std::uint32_t place = static_cast<std::uint32_t>(m->constraints.size());
    place -= static_cast<std::uint32_t>(std::count(holds.begin(), holds.end(), true));
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const Span span = contacts_[c].span;
      m->monitors.push_back({contacts_[c].name + ".active", g.number(holds[c] ? 1 : 0), span});
      m->monitors.push_back({"lambda." + contacts_[c].name, holds[c] ? g.multiplier(place++, 0) : g.zero(), span});
    }
    return m;
  }

  // Reports the events that have set something, with the changes of the velocities by the constraints.
  void tell(const std::vector<double>& before) {
    constexpr double kRoundOff = 1e-13;
    double size = 0;
    for (const double v : before) size = std::max(size, std::abs(v));
    for (std::size_t a = 0; a < before.size(); ++a) {
      if (std::abs(at_.qd[a] - before[a]) <= kRoundOff * size) continue;
      const std::string name = s_.model->coordinates[a].name + "'";
      const auto known =
          std::find_if(changes_.begin(), changes_.end(), [&](const EventReport::Change& c) { return c.name == name; });
      if (known != changes_.end())
        known->after = {at_.qd[a], ""};
      else
        changes_.push_back({name, {before[a], ""}, {at_.qd[a], ""}});
    }
    if (!changes_.empty()) joined_.set(at_.t.get_d(), changes_, "impact");
    changes_.clear();
  }

  // Makes the scenario of the present modes at the present state. The velocities found for it satisfy the constraints;
  // the velocities of least change follow from linear equations with all digits, and the scenario is made again with
  // them.
  bool begin(std::map<std::string, ModeEvent>& setting, Scenario& scenario, Outcome& outcome) {
    const std::vector<double> before = at_.qd;
    constexpr int kPasses = 3;
    for (int k = 0; k < kPasses; ++k) {
      scenario = {};
      outcome = make_scenario(model(setting), *s_.system.form, {}, scenario);
      if (!outcome.ok()) {
        if (!last_event_.empty())
          outcome =
              told({outcome.kind, "after the event '" + last_event_ + "'" + at_time(now()) + ": " + outcome.message,
                    outcome.hint, outcome.place},
                   now());
        return false;
      }
      const std::vector<double> found = scenario.state.qd;
      at_.q = scenario.state.q, at_.qd = found;
      if (joined_.segments() == 0 || scenario.independent.empty()) break;
      Workspace own(scenario);
      ContactDynamics dynamics(own, {});
      dynamics.go(at_);
      if (const auto nearest = dynamics.nearest(before, at_)) at_.qd = *nearest;
      if (at_.qd == found) break;
    }
    at_.qd = scenario.state.qd;
    if (joined_.segments() > 0) tell(before);
    return true;
  }

  // Follows the motion in the present modes to an event that sets something; returns false if the motion ends there.
  bool segment(Outcome& outcome) {
    std::map<std::string, ModeEvent> setting;
    Scenario scenario;
    if (!begin(setting, scenario, outcome)) return false;
    Workspace own(scenario);
    SimulationOptions o = o_;
    o.most_steps -= std::min(o.most_steps, joined_.steps());
    o.state = {};
    o.state.t = at_.t;
    o.to = end_;
    o.every.reset();
    o.at_text.clear();
    o.at.clear();
    for (std::size_t k = rows_.due(); k < times_.size(); ++k)
      if (joined_.segments() == 0 ? times_[k] >= at_.t : times_[k] > at_.t) o.at.push_back(times_[k]);
    o.estimate = ErrorEstimate::never;
    o.conserved.clear();
    o.note = nullptr;
    if (o_.progress) o.progress = [this](double t, std::size_t steps) { o_.progress(t, joined_.steps() + steps); };
    rows_.begin_segment();
    const SimulationReport r = simulate_in(own, o, rows_);
    outcome = r.outcome;
    rows_.end_segment(true);
    rows_.last_state(at_);
    bool goes_on = joined_.add(r, setting);
    if (!outcome.ok()) return false;
    for (const EventReport& fired : r.events) {
      const auto& events = s_.model->events;
      const auto e = std::find_if(events.begin(), events.end(), [&](const Event& k) { return k.name == fired.name; });
      if (e == events.end() || e->set.empty()) continue;
      last_event_ = e->name;
      const std::vector<EventReport::Change> changes = set(*e);
      changes_.insert(changes_.end(), changes.begin(), changes.end());
      goes_on = goes_on && !e->stop;
    }
    return goes_on && at_.t < end_;
  }

  Workspace& s_;
  const std::vector<Contact>& contacts_;
  const SimulationOptions& o_;
  ContactState at_;
  SegmentRows rows_;
  JoinedReport joined_;
  std::vector<long double> parameters_;  // with the present modes
  Rational end_;
  std::vector<Rational> times_;
  std::string last_event_;  // the last event that has set something
  std::vector<EventReport::Change> changes_;
};

}  // namespace

SimulationReport simulate_with_switches(Workspace& s, const std::vector<Contact>& contacts,
                                        const SimulationOptions& options, RowSink& sink) {
  SimulationReport r = SwitchedMotion(s, contacts, options, sink).go();
  r.no_error = "a motion with constraints that are switched has no estimate of its error";
  return r;
}

}  // namespace anholon

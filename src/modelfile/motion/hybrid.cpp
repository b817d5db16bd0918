#include "modelfile/motion/hybrid.h"

#include <algorithm>

#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

namespace {

void declare_state(const Item& i, Scope& scope, Model& model, Diagnostics& diagnostics) {
  if (i.kind != Item::Kind::table)
    throw Failure(i.span, "a state is a table with its rate and its initial value",
                  i.key + " = {rate = \"-flow\", initial = 1}");
  check_keys(i, "a state", "state", diagnostics);
  // The state is declared all the same, so that its uses are no further errors.
  if (!i.find("rate"))
    diagnostics.error(i.key_span, "the state '" + i.key + "' has no rate", "rate = \"…\", its derivative by time");
  if (!i.find("initial"))
    diagnostics.error(i.key_span, "the state '" + i.key + "' has no initial value", "initial = 0");
  Scope::Declaration d;
  d.role = Scope::Role::state;
  d.index = model.states.size();
  d.span = i.key_span;
  scope.declare(i.key, d);
  Graph& g = *model.graph;
  model.states.push_back({i.key, g.zero(), g.zero(), i.key_span});
  model.names.states.push_back(i.key);
}

void declare_mode(const Item& i, Scope& scope, Model& model) {
  if (!i.is_formula()) throw Failure(i.span, "a mode is a number: where it starts", i.key + " = 1");
  Scope::Declaration d;
  d.role = Scope::Role::parameter;
  d.index = model.parameters.size();
  d.span = i.key_span;
  d.formula = i.formula;
  scope.declare(i.key, d);
  model.parameters.push_back({i.key, model.graph->zero(), "", i.key_span, true});
  model.names.parameters.push_back(i.key);
}

void no_multiplier(const Model& model, Expr e, Span span, const std::string& what) {
  for (NodeId id : symbols({&e, 1}))
    if (model.graph->node(id).kind == Kind::multiplier) throw Failure(span, what + " depends on a multiplier");
}

class EventReader {
 public:
  EventReader(Scope& scope, Model& model, Diagnostics& diagnostics)
      : scope_(scope), allowed_(scope.forces), model_(model), diagnostics_(diagnostics) {}

  void read(const Item& e, std::size_t number) {
    check_keys(e, "an event", "event", diagnostics_);
    Event event;
    const Item* named = e.find("name");
    if (named && named->kind != Item::Kind::string) throw Failure(named->span, "a name is a text");
    event.name = named ? normal_name(named->text()) : "event" + std::to_string(number + 1);
    event.span = named ? named->formula.whole() : e.span;
    if (std::any_of(model_.events.begin(), model_.events.end(), [&](const Event& o) { return o.name == event.name; }))
      throw Failure(event.span, "there are two events '" + event.name + "'");
    const Item* when = e.find("when");
    if (!when)
      throw Failure(event.span, "the event '" + event.name + "' does not say when",
                    "when = \"x - 1\": a formula that passes zero then");
    if (!when->is_formula()) throw Failure(when->span, "'when' is a formula that passes zero at the event");
    const Expr as_read = evaluate_number(parse_formula(when->formula), scope_);
    event.when = put_masses(model_, as_read);
    event.open_when = open_form(model_, as_read);
    const std::vector<NodeId> all = symbols({&event.when, 1});
    if (std::none_of(all.begin(), all.end(), [&](NodeId id) { return model_.graph->node(id).kind != Kind::parameter; }))
      throw Failure(when->span, "nothing in this formula changes along the motion: it never passes zero",
                    without_motion(all));
    if (const Item* d = e.find("direction")) {
      if (d->kind != Item::Kind::string || (d->text() != "up" && d->text() != "down"))
        throw Failure(d->span, "a direction is \"up\" or \"down\"", "leave it out for both");
      event.direction = d->text() == "up" ? 1 : -1;
    }
    if (const Item* stop = e.find("stop")) {
      if (stop->kind != Item::Kind::boolean) throw Failure(stop->span, "'stop' is true or false");
      event.stop = stop->truth;
    }
    if (const Item* set = e.find("set")) {
      if (set->kind != Item::Kind::table)
        throw Failure(set->span, "'set' is a table of new values", "set = {\"x'\" = \"-0.8*x'\"}");
      for (const Item& i : set->items) collect(diagnostics_, [&] { event.set.push_back(assignment(i)); });
    }
    model_.events.push_back(std::move(event));
  }

 private:
  // Returns the hint for a formula that holds these parameters only.
  std::string without_motion(const std::vector<NodeId>& parameters) const {
    for (const NodeId id : parameters)
      if (const Parameter& p = model_.parameters[model_.graph->node(id).index]; p.mode)
        return "an event that sets '" + p.name + "' makes it jump over zero; when = \"piecewise(" + p.name +
               " > 3.5, x, 1)\" passes zero with x, the formula of that event, as soon as " + p.name + " is 4";
    return "when = \"x - 1\": a formula of coordinates, velocities, states or t";
  }

  Assignment assignment(const Item& i) {
    if (!i.is_formula()) throw Failure(i.span, "a new value is a number or a formula");
    const Expr as_read = evaluate_number(parse_formula(i.formula), scope_);
    const Expr value = put_masses(model_, as_read), open = open_form(model_, as_read);
    std::string name = i.key;
    unsigned order = 0;
    while (!name.empty() && name.back() == '\'') name.pop_back(), ++order;
    const auto it = scope_.declarations().find(name);
    const auto unknown = [&] {
      std::vector<std::string> known;
      for (const auto& [n, d] : scope_.declarations())
        if (settable(d)) known.push_back(n);
      const std::string near = did_you_mean(name, known);
      throw Failure(i.key_span,
                    "'" + i.key + "' is not a mode, a state or a coordinate" +
                        (near.empty() ? "" : "; did you mean '" + near + "'?"),
                    "an event sets modes, states, coordinates and their velocities");
    };
    if (it == scope_.declarations().end() || !settable(it->second)) unknown();
    const Scope::Declaration& d = it->second;
    const auto index = static_cast<std::uint32_t>(d.index);
    Graph& g = *model_.graph;
    if (d.role == Scope::Role::coordinate) {
      if (order > 1)
        throw Failure(i.key_span, "an event sets coordinates and velocities; '" + i.key + "' follows from them");
      return {g.jet(index, order), value, i.key_span, open};
    }
    if (order > 0) throw Failure(i.key_span, "the rate of '" + name + "' follows from its formula: it cannot be set");
    return {d.role == Scope::Role::state ? g.state(index, 0) : g.parameter(index), value, i.key_span, open};
  }

  bool settable(const Scope::Declaration& d) const {
    return d.role == Scope::Role::coordinate || d.role == Scope::Role::state ||
           (d.role == Scope::Role::parameter && model_.parameters[d.index].mode);
  }

  Scope& scope_;
  const ForcesInFormulas::Allowed allowed_;
  Model& model_;
  Diagnostics& diagnostics_;
};

}  // namespace

void declare_hybrid(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  if (const Item* section = find_section(root, "state", diagnostics))
    for (const Item& i : section->items)
      if (!collect(diagnostics, [&] { declare_state(i, scope, model, diagnostics); })) scope.note_failed(i.key);
  if (const Item* section = find_section(root, "mode", diagnostics))
    for (const Item& i : section->items)
      if (!collect(diagnostics, [&] { declare_mode(i, scope, model); })) scope.note_failed(i.key);
}

void read_states(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* section = root.find("state");
  if (!section || section->kind != Item::Kind::table) return;
  const ForcesInFormulas::Allowed allowed(scope.forces);
  for (const Item& i : section->items) {
    const auto z =
        std::find_if(model.states.begin(), model.states.end(), [&](const StateVariable& s) { return s.name == i.key; });
    if (z == model.states.end()) continue;
    collect(diagnostics, [&] {
      if (!i.find("rate")) return;
      const Item& rate = *i.find("rate");
      if (!rate.is_formula()) throw Failure(rate.span, "a rate is a formula");
      const Expr as_read = evaluate_number(parse_formula(rate.formula), scope);
      z->rate = put_masses(model, as_read);
      z->open_rate = open_form(model, as_read);
      for (NodeId id : symbols({&z->rate, 1}))
        if (const Node& n = model.graph->node(id); n.kind == Kind::state && n.order > 0)
          throw Failure(rate.span, "the rate of '" + i.key + "' holds the rate of '" + model.states[n.index].name + "'",
                        "write out the formula of that rate");
    });
    collect(diagnostics, [&] {
      if (!i.find("initial")) return;
      const Item& initial = *i.find("initial");
      z->initial = scope.number(initial);
      no_multiplier(model, z->initial, initial.span, "an initial value");
      for (NodeId id : symbols({&z->initial, 1}))
        if (model.graph->node(id).kind != Kind::parameter)
          throw Failure(initial.span, "an initial value is a number or a formula of parameters");
    });
  }
}

void read_events(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* list = root.find("event");
  if (!list) return;
  EventReader reader(scope, model, diagnostics);
  for_each_table(*list, "event", diagnostics, [&](const Item& e, std::size_t k) { reader.read(e, k); });
}

}  // namespace anholon

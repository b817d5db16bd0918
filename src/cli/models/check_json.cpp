#include <cstdio>

#include "base/json.h"
#include "cli/models/check_report.h"
#include "cli/models/conserved.h"
#include "cli/say.h"
#include "motion/start.h"

namespace anholon::cli {

namespace {

void constraint(JsonWriter& j, const Scenario& s, const Explanation& x, std::size_t r) {
  const ConstraintFacts& facts = x.constraints[r];
  if (const auto by = s.model->constraints[r].by) {
    j.key("reactions").string("servo").key("by").string(s.model->controls[*by].name);
    return;
  }
  j.key("reactions").string(name(facts.hypothesis));
  j.key("work")
      .open_object()
      .key("none")
      .boolean(is_zero(facts.power_factor))
      .key("power")
      .string(power_text(s, x.constraints[r], r))
      .close();
  if (!s.classes[r].redundant) return;
  j.key("follows_from").open_array();
  for (std::size_t k : facts.follows_from) j.string(s.model->constraints[k].name);
  j.close();
}

void integrability(JsonWriter& j, const Scenario& s, const Explanation& x) {
  const Integrability& i = x.integrability;
  const Model& model = *s.model;
  const auto text = [&](Expr e) { return print(e, model.names, Format::text); };
  j.key("integrability").open_object();
  if (!i.undecided.empty()) {
    j.key("decided").boolean(false).key("message").string(i.undecided).key("derived_flag").open_array();
    for (int d : i.flag) j.integer(d);
    j.close().close();
    return;
  }
  j.key("decided").boolean(true).key("constraints").open_array();
  for (std::size_t r : i.constraints) j.string(model.constraints[r].name);
  j.close().key("time_as_coordinate").boolean(i.time).key("derived_flag").open_array();
  for (int d : i.flag) j.integer(d);
  j.close().key("integrable").integer(i.integrable()).key("proved").boolean(i.proved);
  j.key("for_these_values_only").boolean(i.these_values);
  if (x.accessible) j.key("accessible_dimension").integer(*x.accessible);
  j.key("combinations").open_array();
  for (const IntegrableCombination& c : i.combinations) {
    j.open_object().key("coefficients").open_object();
    for (std::size_t r = 0; r < c.coefficients.size(); ++r)
      if (!is_zero(c.coefficients[r])) j.key(model.constraints[r].name).string(text(c.coefficients[r]));
    j.close().key("integral");
    c.integral ? j.string(text(*c.integral)) : j.null();
    j.close();
  }
  j.close().close();
}

void structure(JsonWriter& j, const Scenario& s, const Explanation& x) {
  j.key("hidden_constraints").open_array();
  for (const HiddenConstraint& h : x.hidden) {
    j.open_object().key("equation").string(s.system.equation_names[h.equation]).key("derivatives").open_array();
    for (std::size_t k = 0; k < h.orders.size(); ++k) j.integer(static_cast<long long>(k));
    j.close().key("on").open_array();
    for (int order : h.orders) order == kAbsent ? j.null() : j.integer(order);
    j.close().close();
  }
  j.close().key("blocks").open_array();
  for (const Block& b : x.blocks) {
    j.open_array();
    for (std::size_t k : b.unknowns) j.string(s.system.variable_names[k]);
    j.close();
  }
  j.close();
}

// The numbers of the structure: dimensions, offsets c and d, the signature matrix.
void dimensions(JsonWriter& j, const Scenario& s) {
  j.key("degrees_of_freedom").integer(s.structure.degrees_of_freedom);
  j.key("configuration_dimension").integer(s.structure.configuration_dimension);
  j.key("state_dimension").integer(s.structure.state_dimension);
  j.key("offsets").open_object().key("c").open_object();
  for (std::size_t i = 0; i < s.system.size(); ++i) j.key(s.system.equation_names[i]).integer(s.structure.c[i]);
  j.close().key("d").open_object();
  for (std::size_t i = 0; i < s.system.size(); ++i) j.key(s.system.variable_names[i]).integer(s.structure.d[i]);
  j.close().close();
  j.key("signature").open_array();
  for (const auto& row : s.structure.sigma) {
    j.open_array();
    for (int e : row) e == kAbsent ? j.null() : j.integer(e);
    j.close();
  }
  j.close();
}

// The consistent initial state, each value with its origin.
void initial_state(JsonWriter& j, const Scenario& s) {
  const Model& model = *s.model;
  const InitialState<double> x = start_as_in_rows(s);
  j.key("initial").open_object().key("t").number(number_text(x.t));
  for (std::size_t a = 0; a < s.state.q.size(); ++a)
    for (int k = 0; k < 2; ++k) {
      j.key(model.coordinates[a].name + (k ? "'" : "")).open_object();
      j.key("value").number(number_text(k ? x.qd[a] : x.q[a]));
      j.key("origin").string(name(k ? x.qd_origin[a] : x.q_origin[a])).close();
    }
  for (const StateEntry& e : higher_state(s))
    j.key(e.name).open_object().key("value").number(number_text(e.value)).key("origin").string(name(e.origin)).close();
  j.close();
}

}  // namespace

void check_json(Workspace& s, const Explanation& x, const Outcome& outcome) {
  const Model& model = *s.model;
  JsonWriter j;
  j.open_object();
  j.key("title").string(model.title);
  j.key("source").string(model.source);
  if (!model.cases.empty()) {
    j.key("cases").open_array();
    for (const std::string& c : model.cases) j.string(c);
    j.close();
  }
  j.key("coordinates").open_array();
  for (const Coordinate& c : model.coordinates) j.string(c.name);
  j.close();
  j.key("constraints").open_array();
  for (std::size_t r = 0; r < model.constraints.size(); ++r) {
    const Constraint& c = model.constraints[r];
    j.open_object();
    j.key("name").string(c.name).key("order").integer(c.order).key("kind").string(s.classes[r].kind);
    j.key("homogeneous").boolean(s.classes[r].homogeneous).key("rheonomic").boolean(s.classes[r].rheonomic);
    j.key("redundant").boolean(s.classes[r].redundant).key("equation").string(c.equation);
    constraint(j, s, x, r);
    j.close();
  }
  j.close();
  const auto strings = [&](const char* key, const std::vector<std::string>& list) {
    j.key(key).open_array();
    for (const std::string& text : list) j.string(text);
    j.close();
  };
  if (!model.coordinate_units.empty()) {
    j.key("units").open_object();
    for (const auto& [names, units] : {std::pair{&model.names.coordinates, &model.coordinate_units},
                                       {&model.names.parameters, &model.parameter_units}})
      for (std::size_t k = 0; k < units->size(); ++k) {
        j.key((*names)[k]);
        (*units)[k].empty() ? j.null() : j.string((*units)[k]);
      }
    j.close();
  }
  strings("effects", effects(model));
  strings("external_forces", external_forces(model));
  j.key("reactions_hypothesis").string(model.constraints.empty() ? "none" : "ideal (Chetaev-Niu)");
  if (!x.integrability.constraints.empty() || !x.integrability.undecided.empty()) integrability(j, s, x);
  if (outcome.ok()) {
    dimensions(j, s);
    structure(j, s, x);
    initial_state(j, s);
    write_conserved(j, *s.mechanics);
  }
  strings("notes", s.notes);
  j.key("outcome").string(name(outcome.kind));
  if (!outcome.ok()) j.key("message").string(outcome.message).key("hint").string(outcome.hint);
  j.close();
  hand_out(j.text() + "\n");
}

}  // namespace anholon::cli

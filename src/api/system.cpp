#include "anholon/system.h"

#include "api/data.h"
#include "motion/form_choice.h"
#include "motion/start.h"

namespace anholon::v1 {

static_assert(static_cast<int>(Origin::corrected) == static_cast<int>(inner::Origin::corrected));

std::shared_ptr<const System::Data> system_of(const Model& model, const PrepareOptions& options,
                                              inner::Outcome& start) {
  auto data = std::make_shared<System::Data>();
  data->model = std::make_shared<const Model::Data>(model.data());
  data->choice = state_choice(options, *model.data().model);
  data->choice.open_parameters.emplace();
  std::string form = options.form;
  if (form == "auto") form = inner::choose_form(model.data().model, data->choice).form->name;
  start = make_system(model.data().model, form, data->choice, data->scenario);
  model.data().hint_at_state(start, data->choice);
  if (start.ok())
    for (std::string& text : inner::notes_of_redundancy(data->scenario))
      data->scenario.state.notes.push_back(std::move(text));
  return data;
}

Result<System> prepare(const Model& model, const PrepareOptions& options) {
  return guarded(model.data().source, [&]() -> Result<System> {
    inner::Outcome start;
    System system(system_of(model, options, start));
    if (!start.ok()) return error_of(start);
    return system;
  });
}

std::string System::form() const { return data_->scenario.system.form->name; }
double System::start() const { return data_->scenario.state.t; }
int System::degrees_of_freedom() const { return data_->scenario.structure.degrees_of_freedom; }
const std::vector<std::string>& System::notes() const { return data_->scenario.state.notes; }
Model System::model() const { return Model(data_->model); }

std::vector<InitialValue> System::initial() const {
  const inner::Scenario& s = data_->scenario;
  const inner::InitialState<double> x = inner::start_as_in_rows(s);
  std::vector<InitialValue> list;
  const auto add = [&](const std::string& name, double value, inner::Origin origin) {
    list.push_back({name, value, static_cast<Origin>(origin)});
  };
  const std::vector<inner::Coordinate>& q = s.model->coordinates;
  for (std::size_t a = 0; a < x.q.size(); ++a) add(q[a].name, x.q[a], x.q_origin[a]);
  for (std::size_t a = 0; a < x.qd.size(); ++a) add(q[a].name + "'", x.qd[a], x.qd_origin[a]);
  for (std::size_t z = 0; z < x.states.size(); ++z) add(s.model->states[z].name, x.states[z], x.states_origin[z]);
  return list;
}

std::vector<ConstraintClass> System::constraints() const {
  const inner::Scenario& s = data_->scenario;
  std::vector<ConstraintClass> list;
  for (std::size_t r = 0; r < s.classes.size(); ++r) {
    const inner::ConstraintClass& c = s.classes[r];
    list.push_back({s.model->constraints[r].name, c.kind, c.homogeneous, c.rheonomic, c.redundant});
  }
  return list;
}

}  // namespace anholon::v1

#include "anholon/model.h"

#include <algorithm>
#include <limits>

#include "anholon/version.h"
#include "api/data.h"
#include "contact/mode/chosen_mode.h"
#include "modelfile/text/shipped.h"

namespace anholon::v1 {

namespace {

// Reads the model from the source text in the data.
Result<Model> opened(std::shared_ptr<Model::Data> data) {
  inner::Diagnostics diagnostics;
  const auto model = data->open_again(diagnostics);
  if (diagnostics.has_errors() || !model) return error_of(diagnostics, data->source);
  data->model = model->model;
  data->contacts_of_file = inner::contacts(*model->names);
  data->identities = inner::identities(*model->names);
  if (data->mode.empty()) data->contacts = data->contacts_of_file;
  for (const inner::Diagnostic& d : diagnostics.list()) data->remarks.push_back(to_public(d, data->model->source_text));
  return Model(std::move(data));
}

}  // namespace

Result<Model> opened(inner::SourceText source, const ReadOptions& options) {
  auto data = std::make_shared<Model::Data>();
  data->source = std::move(source);
  data->cases = options.cases;
  for (const auto& [name, value] : options.set) data->overrides[inner::normal_name(name)] = value.text();
  data->mode = options.mode;
  return opened(std::move(data));
}

void Model::Data::without_contacts(const std::string& what) const {
  if (!contacts.empty()) throw inner::needs_mode(what, *model, contacts, "the mode ");
}

void Model::Data::hint_at_state(inner::Outcome& start, const inner::StateChoice& choice) const {
  if (!mode.empty()) inner::hint_at_state_of_mode(start, *model, choice.overrides, "initial={…}");
}

std::optional<inner::OpenModel> Model::Data::open_again(inner::Diagnostics& diagnostics) const {
  std::optional<inner::OpenModel> open = inner::open_model(source, diagnostics, overrides, cases);
  if (!open || mode.empty()) return open;
  try {
    inner::put_chosen_mode(inner::model_of(*open->names), inner::contacts(*open->names), mode);
  } catch (const inner::Failure& f) {
    throw inner::Failure({}, "mode: " + f.diagnostic.message, f.diagnostic.hint);
  }
  return open;
}

Result<Model> with_scenario(const Model& model, const std::string& scenario) {
  auto data = std::make_shared<Model::Data>();
  data->source = model.data().source;
  data->overrides = model.data().overrides, data->mode = model.data().mode;
  data->cases = model.data().cases;
  data->cases.push_back(scenario);
  return opened(std::move(data));
}

const char* version() { return ANHOLON_VERSION; }

const std::string& Model::title() const { return data_->model->title; }
const std::vector<Diagnostic>& Model::remarks() const { return data_->remarks; }
const std::string& Model::text() const { return data_->source.text; }
std::size_t Model::base_files() const { return data_->model->source_text.others.size(); }

std::vector<Coordinate> Model::coordinates() const {
  const inner::Model& m = *data_->model;
  std::vector<Coordinate> list;
  for (std::size_t i = 0; i < m.coordinates.size(); ++i)
    list.push_back({m.coordinates[i].name, i < m.coordinate_units.size() ? m.coordinate_units[i] : ""});
  return list;
}

std::vector<Parameter> Model::parameters() const {
  const inner::Model& m = *data_->model;
  std::vector<double> values;
  try {
    values = inner::parameters_as_given(m);
  } catch (const inner::Failure&) {
    // A parameter has no value: the model serves for equations alone.
    values.assign(m.parameters.size(), std::numeric_limits<double>::quiet_NaN());
  }
  std::vector<Parameter> list;
  for (std::size_t i = 0; i < m.parameters.size(); ++i)
    list.push_back({m.parameters[i].name, values[i], inner::unit_of_parameter(m, i)});
  return list;
}

std::vector<Constraint> Model::constraints() const {
  std::vector<Constraint> list;
  for (const inner::Constraint& c : data_->model->constraints) list.push_back({c.name, static_cast<int>(c.order)});
  return list;
}

template <class List>
static std::vector<std::string> names(const List& list) {
  std::vector<std::string> result;
  for (const auto& element : list) result.push_back(element.name);
  return result;
}

std::vector<std::string> Model::states() const { return names(data_->model->states); }
std::vector<std::string> Model::inputs() const { return names(data_->model->controls); }
std::vector<std::string> Model::monitors() const { return names(data_->model->monitors); }
std::vector<std::string> Model::cases() const { return data_->model->cases; }

Result<std::vector<Form>> Model::forms() const {
  return guarded(data_->source, [&]() -> Result<std::vector<Form>> {
    const std::shared_ptr<const inner::Model> model = data_->own_copy();
    const inner::Mechanics m = inner::mechanics(*model);
    std::vector<Form> list;
    for (const inner::Formulation* f : inner::formulations()) {
      const std::string why = inner::obstacle(*f, m);
      list.push_back({f->name, f->title, f->equation, f->source, why.empty(), why});
    }
    return list;
  });
}

std::vector<ShippedModel> shipped_models() {
  std::vector<ShippedModel> list;
  for (const inner::ShippedFile& f : inner::shipped_files(inner::Shipped::models))
    list.push_back({f.name, f.path, f.title});
  return list;
}

Result<Model> read_file(const std::string& path, const ReadOptions& options) {
  return guarded({}, [&] { return opened(inner::model_text(path), options); });
}

Result<Model> read_text(const std::string& text, const ReadOptions& options, const std::string& name) {
  return guarded({name, text}, [&] { return opened({name, text}, options); });
}

}  // namespace anholon::v1

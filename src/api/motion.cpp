#include "anholon/motion.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "api/run_data.h"
#include "base/stop.h"
#include "contact/hybrid.h"
#include "mechanics/conserved.h"
#include "report/columns.h"
#include "result/format.h"
#include "result/json_run.h"
#include "simulation/report_json.h"
#include "simulation/request.h"
#include "simulation/simulate.h"

namespace anholon::v1 {

OptionWords words_of_members(const MotionOptions& asked) {
  OptionWords list;
  const auto set = [&](const char* name, std::vector<std::string> words) { list.emplace_back(name, std::move(words)); };
  for (const auto& [name, number] :
       {std::pair{"to", asked.to}, std::pair{"every", asked.every}, std::pair{"tolerance", asked.tolerance}})
    if (number) set(name, {number->text()});
  std::vector<std::string> times;
  for (const Number& t : asked.at) times.push_back(t.text());
  if (!times.empty()) set("at", std::move(times));
  if (asked.order != 0) set("order", {std::to_string(asked.order)});
  if (asked.digits != 16) set("digits", {std::to_string(asked.digits)});
  if (!asked.method.empty()) set("method", {asked.method});
  if (!asked.error_estimate) set("error-estimate", {"never"});
  if (asked.most_steps) set("most-steps", {std::to_string(*asked.most_steps)});
  return list;
}

namespace {

// Keeps the rows and the meaning of their columns.
class RowKeeper final : public inner::RowSink {
 public:
  RowKeeper(Run::Data& data, const inner::Model& model) : data_(data), model_(model) {}
  void columns(const std::vector<inner::RunColumn>& columns) override {
    data_.run.table.set_columns(inner::names_of(columns));
    for (const inner::RunColumn& c : columns) {
      data_.columns.push_back({c.name, inner::name(c.kind), c.unit, c.order,
                               inner::column_formula(model_, c, inner::Format::latex),
                               inner::column_formula(model_, c, inner::Format::mathml)});
      if (!c.unit.empty()) data_.run.units[c.name] = c.unit;
    }
  }
  void row(const inner::Row& row) override { data_.run.table.add_row(row); }
  void step(double t) override { data_.run.steps.push_back(t); }

 private:
  Run::Data& data_;
  const inner::Model& model_;
};

Report public_report(const inner::SimulationReport& r) {
  Report p;
  p.newton = r.newton, p.projected = r.projected, p.constraints = r.constraints_kept;
  p.before_projection = r.constraints, p.power = r.power;
  p.smallest_sigma = r.smallest_sigma, p.smallest_sigma_t = r.smallest_sigma_t;
  p.steps = r.steps, p.order = r.order, p.method = inner::name(r.method.last), p.seconds = r.seconds;
  if (r.error)
    for (const inner::KindError& k : r.error->kinds) p.trust.push_back({inner::name(k.kind), k.digits, k.error, k.of});
  p.no_trust = r.no_error;
  for (const bool conserved : {true, false})
    for (const inner::WatchedReport& w : conserved ? r.conserved : r.monitors)
      p.watched.push_back(
          {w.name, w.first.value, w.last.value, w.least.value, w.greatest.value, w.largest_change, conserved});
  for (const inner::Warning& w : r.warnings) p.warnings.push_back(w.message + "; " + w.hint);
  p.notes = r.notes;
  p.rows_looked_at = r.rows_looked_at;
  return p;
}

// Throws Failure.
inner::MotionSettings settings_of(const MotionOptions& asked) {
  inner::MotionSettings settings;
  const auto set = [&](const std::string& name, const std::vector<std::string>& words) {
    const inner::MotionOption& option = inner::motion_option(name);
    inner::set(settings, option, words, name,
               [&](const std::string& text) { return option_value(Number(text), option); });
  };
  for (const auto& [name, words] : words_of_members(asked)) set(name, words);
  for (const auto& [name, word] : asked.others) {
    std::vector<std::string> known;
    for (const inner::MotionOption& o : inner::motion_options()) known.emplace_back(o.name);
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      const std::string near = inner::did_you_mean(name, known);
      throw inner::Failure({}, "there is no option '" + name + "'" +
                                   (near.empty() ? "" : "; did you mean '" + near + "'?"));
    }
    if (name == "form") throw inner::Failure({}, "the form belongs to the system", "PrepareOptions::form");
    set(name, {word});
  }
  return settings;
}

void keep_polynomials(Run::Data& data, const inner::Model& model, inner::SimulationOptions& o) {
  if (o.method != inner::Method::automatic && o.method != inner::Method::taylor)
    throw inner::Failure({}, "dense output comes from the polynomials of Taylor's method", "method = \"taylor\"");
  o.method = inner::Method::taylor;
  DenseOutput& dense = data.dense;
  for (const inner::Coordinate& c : model.coordinates) dense.names.push_back(c.name);
  for (const auto& z : model.states) dense.names.push_back(z.name);
  o.dense = [&dense](const inner::StepPolynomials& step) {
    dense.order = step.order;
    dense.begin.push_back(step.begin), dense.end.push_back(step.end);
    for (std::size_t j = 0; j < dense.names.size(); ++j)
      for (int k = 0; k <= step.order; ++k) dense.coefficients.push_back(step.coefficient(j, k));
  };
}

// Returns the k-th derivative at h of the polynomial with these `order` + 1 coefficients.
double derivative(const double* c, int order, int k, double h) {
  double sum = 0;
  for (int i = order; i >= k; --i) {
    double factor = 1;
    for (int m = 0; m < k; ++m) factor *= i - m;
    sum = sum * h + factor * c[i];
  }
  return sum;
}

constexpr std::size_t kTimesBetweenLooks = 4096;

bool stop_requested() {
  try {
    inner::look_for_stop();
    return false;
  } catch (const inner::StopRequested&) {
    return true;
  }
}

}  // namespace

Result<Run> simulate(const System& system, const MotionOptions& asked) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Run> {
    inner::Workspace s(of.scenario);
    inner::SimulationOptions o;
    o.state = of.choice;
    const auto data = std::shared_ptr<Run::Data>(new Run::Data{system, {}, {}, {}, {}, {}, {}, {}});
    const inner::Asker asker{"", "", [&](const std::string& note) { data->notes.push_back(note); }};
    if (const std::string& replaced = s.state.replaced.note; !replaced.empty()) data->notes.push_back(replaced);
    inner::ask(inner::merged(settings_of(asked), s.model->simulate), s, asker, o);
    if (asked.dense) keep_polynomials(*data, *s.model, o);
    o.cancelled = asked.cancelled;
    o.progress = asked.progress;
    if (!inner::sets_values(*s.model)) o.conserved = inner::conserved(*s.mechanics);
    RowKeeper rows(*data, *s.model);
    const std::vector<inner::Contact>& contacts = of.model->contacts;
    const inner::SimulationReport r =
        contacts.empty() ? inner::simulate_in(s, o, rows) : inner::simulate_with_contacts(s, contacts, o, rows);
    data->run.table.values.settle();
    data->outcome = to_public(r.outcome);
    data->report = public_report(r);
    data->report.notes.insert(data->report.notes.begin(), data->notes.begin(), data->notes.end());
    for (const inner::EventReport& e : r.events) {
      Event& event = data->events.emplace_back();
      event.name = e.name, event.t = e.t.value, event.stop = e.stop;
      for (const inner::EventReport::Change& c : e.changes)
        event.changes.push_back({c.name, c.before.value, c.after.value});
    }
    data->run.title = s.model->title;
    data->run.created_by = std::string("anholon ") + ANHOLON_VERSION;
    const inner::SourceText& source = s.model->source_text;
    data->run.model.push_back({source.name, source.text});
    for (const inner::SourceText& other : source.others) data->run.model.push_back({other.name, other.text});
    data->run.report = inner::report_json(r);
    return Run(data);
  });
}

const Outcome& Run::outcome() const { return data_->outcome; }
std::size_t Run::rows() const { return data_->run.table.rows(); }
const std::vector<Column>& Run::columns() const { return data_->columns; }
const std::vector<Event>& Run::events() const { return data_->events; }
const Report& Run::report() const { return data_->report; }

std::span<const double> Run::column(const std::string& name) const {
  const inner::RunTable& table = data_->run.table;
  const std::size_t k = table.find(name);
  return k < table.columns.size() ? table.values[k] : std::span<const double>();
}

std::span<const double> Run::block() const { return data_->run.table.values.block(); }

std::string Run::text(std::size_t row, const std::string& column) const {
  const inner::RunTable& table = data_->run.table;
  const std::size_t k = table.find(column);
  return k < table.columns.size() && row < table.rows() ? table.text(row, k) : std::string();
}

std::string Run::json() const {
  try {
    return inner::json_run(data_->run);
  } catch (const inner::StopRequested&) {
    return {};
  }
}

bool Run::has_dense() const { return !data_->dense.begin.empty(); }

std::vector<double> Run::at(const std::string& name, std::span<const double> times, int order) const {
  const DenseOutput& dense = data_->dense;
  std::vector<double> values(times.size(), std::numeric_limits<double>::quiet_NaN());
  const auto known = std::find(dense.names.begin(), dense.names.end(), name);
  if (dense.begin.empty() || known == dense.names.end() || order < 0) return values;
  const std::size_t j = static_cast<std::size_t>(known - dense.names.begin()),
                    size = static_cast<std::size_t>(dense.order) + 1;
  const double direction = dense.end.front() < dense.begin.front() ? -1 : 1;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (i % kTimesBetweenLooks == 0 && stop_requested()) return values;
    const double t = times[i];
    // The first step that ends at t or after t.
    const auto step =
        std::partition_point(dense.end.begin(), dense.end.end(), [&](double end) { return direction * (end - t) < 0; });
    if (step == dense.end.end() || direction * (t - dense.begin.front()) < 0 || std::isnan(t)) continue;
    const std::size_t k = static_cast<std::size_t>(step - dense.end.begin());
    values[i] =
        derivative(&dense.coefficients[(k * dense.names.size() + j) * size], dense.order, order, t - dense.begin[k]);
  }
  return values;
}

Result<std::string> Run::write(const std::string& path) const {
  const inner::ResultFormat* format = inner::format_of(path);
  if (!format) return mistake("'" + path + "' names no format", "end it in " + inner::known_files(""));
  return guarded(data_->system.data().model->source, [&]() -> Result<std::string> {
    if (const std::string why = format->write(path, data_->run); !why.empty()) return mistake(why);
    return path;
  });
}

}  // namespace anholon::v1

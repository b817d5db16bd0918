#include "anholon/motion.h"

#include <algorithm>

#include "api/data.h"
#include "mechanics/conserved.h"
#include "result/format.h"
#include "result/json_run.h"
#include "simulation/report_json.h"
#include "simulation/simulate.h"

namespace anholon::v1 {

struct Run::Data {
  inner::RunFile run;
  Outcome outcome;
  std::vector<Column> columns;
  std::vector<Event> events;
  Report report;
};

namespace {

// Keeps the rows, and what their columns hold.
class RowKeeper final : public inner::RowSink {
 public:
  explicit RowKeeper(Run::Data& data) : data_(data) {}
  void columns(const std::vector<inner::RunColumn>& columns) override {
    data_.run.table.set_columns(inner::names_of(columns));
    for (const inner::RunColumn& c : columns) {
      data_.columns.push_back({c.name, inner::name(c.kind), c.unit, c.order});
      if (!c.unit.empty()) data_.run.units[c.name] = c.unit;
    }
  }
  void row(const inner::Row& row) override { data_.run.table.add_row(row); }
  void step(double t) override { data_.run.steps.push_back(t); }

 private:
  Run::Data& data_;
};

Report to_public(const inner::SimulationReport& r) {
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
  return p;
}

// The times of the rows and the end, from the options or the file. Throws Failure.
void set_times(const MotionOptions& asked, const inner::Scenario& s, inner::SimulationOptions& o) {
  constexpr long kMostRows = 5'000'000;
  const inner::SimulationSettings& file = s.model->simulate;
  o.to = asked.to ? std::optional(exact(*asked.to, "to")) : file.to;
  if (asked.every) o.every = exact(*asked.every, "every");
  if (o.every && *o.every <= 0) throw inner::Failure({}, "every is a positive time");
  for (const Number& t : asked.at) o.at.push_back(exact(t, "at"));
  if (o.at.empty() && !o.every) o.at = file.at, o.every = file.every;
  if (!o.at.empty()) o.every.reset();
  if (!asked.at.empty() && !asked.to) o.to.reset();
  std::sort(o.at.begin(), o.at.end());
  if (o.at.empty() && !o.to)
    throw inner::Failure({}, "no end time", "MotionOptions::to, or [simulate] to = 10 in the model");
  const inner::Rational start(s.state.t);
  if (!o.at.empty() && o.at.front() < start && o.at.back() > start)
    throw inner::Failure({}, "the time " + o.at.front().get_str() + " lies before the start, t = " + start.get_str());
  const inner::Rational end = o.at.empty() ? *o.to : o.at.front() < start ? o.at.front() : o.at.back();
  if (o.every && abs(inner::Rational(end - start)) > kMostRows * *o.every)
    throw inner::Failure({}, "every asks for more than " + std::to_string(kMostRows) + " rows");
  if (sets_values(*s.model) && end < start)
    throw inner::Failure({}, "events that set values are irreversible", "integrate forwards in time");
}

// Throws Failure.
void set_accuracy(const MotionOptions& asked, const inner::Scenario& s, inner::SimulationOptions& o) {
  const inner::Rational least(1, 5'000'000'000'000'000L);  // 2e-16, the least that double precision supports
  o.digits = asked.digits;
  o.order = asked.order;
  o.most_steps = asked.most_steps;
  if (asked.digits > 16) {
    o.precision = inner::Precision::multi;
    o.tolerance = exact(Number("1e-" + std::to_string(asked.digits + 2)), "digits");
  } else if (s.model->simulate.tolerance) {
    o.tolerance = *s.model->simulate.tolerance;
  }
  if (asked.tolerance) o.tolerance = exact(*asked.tolerance, "tolerance");
  if (o.tolerance <= 0 || o.tolerance >= 1) throw inner::Failure({}, "the tolerance lies between 0 and 1");
  if (o.precision == inner::Precision::real && o.tolerance < least) o.tolerance = least;
  const auto method = inner::find_method(asked.method);
  if (!method) throw inner::Failure({}, "there is no method '" + asked.method + "'", "auto, taylor, rk or bdf");
  o.method = *method;
  if (o.method == inner::Method::automatic || o.method == inner::Method::taylor) return;
  const auto refuse = [&](const std::string& why) {
    throw inner::Failure({}, "the method '" + asked.method + "' " + why, "use the method taylor");
  };
  const bool wide = o.precision != inner::Precision::real;
  if (const auto refused =
          inner::refusal(inner::info(o.method), {wide, false, false, o.order > 0, o.tolerance.get_d()}))
    refuse(refused->why);
  if (const std::string why = inner::only_taylor(*s.model, inner::program(s.system, s.structure)); !why.empty())
    refuse(why);
}

}  // namespace

Result<Run> simulate(const System& system, const MotionOptions& asked) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Run> {
    inner::Workspace s(of.scenario);
    inner::SimulationOptions o;
    o.state = of.choice;
    set_times(asked, s, o);
    set_accuracy(asked, s, o);
    o.estimate = asked.error_estimate ? inner::ErrorEstimate::short_runs : inner::ErrorEstimate::never;
    o.cancelled = asked.cancelled;
    o.progress = asked.progress;
    if (!sets_values(*s.model)) o.conserved = inner::conserved(*s.mechanics);
    auto data = std::make_shared<Run::Data>();
    RowKeeper rows(*data);
    const inner::SimulationReport r = inner::simulate_in(s, o, rows);
    data->outcome = to_public(r.outcome);
    data->report = to_public(r);
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
    return Run(std::move(data));
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
  return k < table.columns.size() ? std::span<const double>(table.values[k]) : std::span<const double>();
}

std::string Run::text(std::size_t row, const std::string& column) const {
  const inner::RunTable& table = data_->run.table;
  const std::size_t k = table.find(column);
  return k < table.columns.size() && row < table.rows() ? table.text(row, k) : std::string();
}

std::string Run::json() const { return inner::json_run(data_->run); }

Result<std::string> Run::write(const std::string& path) const {
  const inner::ResultFormat* format = inner::format_of(path);
  if (!format) return mistake("'" + path + "' names no format", "end it in " + inner::known_files(""));
  if (const std::string why = format->write(path, data_->run); !why.empty()) return mistake(why);
  return path;
}

}  // namespace anholon::v1

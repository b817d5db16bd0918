// Writes a sweep in memory to a file, with the columns and cells of `anholon sweep -o FILE`.
#include "api/sweep_data.h"
#include "result/format.h"

namespace anholon::v1 {

namespace {

inner::SweepInfo info_of(const Sweep::Data& d) {
  inner::SweepInfo info;
  const inner::Model& model = *d.model->model;
  info.origin.title = model.title;
  info.origin.created_by = std::string("anholon ") + ANHOLON_VERSION;
  info.origin.model.push_back({model.source_text.name, model.source_text.text});
  for (const inner::SourceText& other : model.source_text.others) info.origin.model.push_back({other.name, other.text});
  info.origin.units = d.units;
  info.form = d.form;
  info.columns = d.table->columns();
  return info;
}

inner::CaseResult case_of(const Sweep::Data& d, std::size_t number) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  inner::CaseResult r;
  for (const std::vector<double>& values : d.varied) r.values.push_back(values[number]);
  r.outcome.kind = static_cast<inner::OutcomeKind>(d.outcomes[number].kind);
  if (!d.events.empty()) r.event = d.events[number];
  r.t = d.t[number], r.steps = d.steps[number];
  r.last.assign(d.all_of_state, kNone), r.reduced.assign(d.all_reductions, kNone);
  for (std::size_t k = 0; k < d.places.size(); ++k) {
    const std::size_t place = d.places[k];
    (place < d.all_of_state ? r.last[place] : r.reduced[place - d.all_of_state]) = d.values[k][number];
  }
  for (std::size_t i = 0; i < d.times.size(); ++i) {
    std::vector<double>& row = r.rows.emplace_back(1 + d.all_of_state, kNone);
    row[0] = d.times[i];
    for (std::size_t k = 0; k < d.of_state; ++k) row[1 + d.places[k]] = d.rows[k][number * d.times.size() + i];
  }
  return r;
}

}  // namespace

Result<std::string> Sweep::write(const std::string& path) const {
  const inner::ResultFormat* format = inner::format_of(path);
  if (!format || !format->open_sweep)
    return mistake("'" + path + "' names no format that holds sweeps",
                   "end it in " + inner::known_files("", inner::sweep_formats()));
  if (format->missing) return mistake(format->missing, format->missing_hint);
  const std::unique_ptr<inner::SweepWriter> file = format->open_sweep(path, info_of(*data_));
  if (!file->error().empty()) return mistake(file->error());
  inner::SweepTable table = *data_->table;
  for (std::size_t number = 0; number < data_->report.done; ++number)
    table.rows(case_of(*data_, number), number, scenario(number),
               [&](std::span<const inner::SweepCell> cells) { file->row(cells); });
  const std::string why = file->close(inner::sweep_report_json(data_->stopped, data_->report));
  if (!why.empty()) return mistake(why);
  return path;
}

}  // namespace anholon::v1

#include "report/page/data.h"

#include "numeric/number.h"
#include "report/columns.h"
#include "report/contact_bands.h"
#include "report/markup.h"
#include "report/observer_path.h"
#include "simulation/report_json.h"

namespace anholon {

namespace {

void numbers(JsonWriter& j, const char* key, const std::vector<double>& list) { j.key(key).string(packed(list)); }

void columns(JsonWriter& j, const PlotData& d) {
  j.key("columns").open_array();
  for (const PlotColumn& k : d.columns) {
    j.open_object()
        .key("name")
        .string(k.name)
        .key("html")
        .string(math(k.math))
        .key("unit")
        .string(k.unit)
        .key("group")
        .string(k.group);
    numbers(j, "data", k.values);
    if (!k.t.empty()) numbers(j, "t", k.t);
    j.close();
  }
  j.close().key("groups").open_array();
  for (const PlotGroup& k : d.groups)
    j.open_object().key("id").string(k.id).key("title").string(k.title).key("log").boolean(k.log).close();
  j.close().key("left_out").integer(static_cast<long long>(d.left_out));
}

void frames(JsonWriter& j, const PlotData& d) {
  j.key("frames");
  if (d.frame_t.empty()) {
    j.null();
    return;
  }
  j.open_object();
  numbers(j, "t", d.frame_t);
  j.key("data").open_object();
  for (const auto& [column, values] : d.frames) numbers(j, std::to_string(column).c_str(), values);
  j.close().close();
}

void events(JsonWriter& j, const std::optional<SimulationReport>& r) {
  j.key("events").open_array();
  if (r)
    for (const EventReport& e : r->events)
      j.open_object().key("t").number(json_number(e.t.text())).key("name").string(e.name).close();
  j.close();
}

void bands(JsonWriter& j, const RunTable& table, const std::optional<SimulationReport>& r) {
  const std::vector<ContactBand> list = contact_bands(table, r ? r->events : std::vector<EventReport>());
  if (list.empty()) return;
  j.key("bands").open_array();
  for (const ContactBand& b : list) {
    j.open_object().key("name").string(b.name).key("spans").open_array();
    for (const ContactSpan& s : b.spans)
      j.open_array().number(number_text(s.begin)).number(number_text(s.end)).integer(s.mode).close();
    j.close().close();
  }
  j.close();
}

void observer(JsonWriter& j, const Model& model, const PlotData& d) {
  const std::vector<double>& t = d.frame_t.empty() ? d.t : d.frame_t;
  std::vector<double> quaternions, origins;
  for (const ObserverPose& p : observer_path(model, parameter_values<double>(model), t)) {
    quaternions.insert(quaternions.end(), p.quaternion.begin(), p.quaternion.end());
    origins.insert(origins.end(), p.origin.begin(), p.origin.end());
  }
  j.open_object();
  numbers(j, "t", t);
  numbers(j, "quaternion", quaternions);
  numbers(j, "origin", origins);
  j.close();
}

void one_case(JsonWriter& j, const PageCase& c) {
  const Model& model = *c.scenario->model;
  const Scene picture = scene(*c.scenario->mechanics, has_contacts(c.run.table));
  const PlotData d = plot_data(*c.scenario, c.conserved, c.run, picture);
  j.open_object()
      .key("name")
      .string(c.name)
      .key("rows")
      .integer(static_cast<long long>(d.rows))
      .key("shown")
      .integer(static_cast<long long>(d.shown));
  numbers(j, "t", d.t);
  j.key("unit").string(model.coordinate_units.empty() ? "" : "s");
  columns(j, d);
  frames(j, d);
  events(j, read_report(c.run.report));
  bands(j, c.run.table, read_report(c.run.report));
  j.key("scene");
  // In the page the time is not a column.
  const ColumnOf in_table = column_of(model, c.run.table);
  const ColumnOf column = [&](const Node& n) -> std::optional<int> {
    const auto k = in_table(n);
    return k && *k >= 0 ? std::optional<int>(*k - 1) : k;
  };
  write_scene(
      j, picture, *model.graph, column,
      model.observer.inertial ? std::function<void(JsonWriter&)>() : [&](JsonWriter& w) { observer(w, model, d); });
  j.close();
}

}  // namespace

std::string page_data(const Page& page) {
  JsonWriter j;
  j.open_object().key("format").integer(1).key("title").string(page_title(page)).key("cases").open_array();
  for (const PageCase& c : page.cases) one_case(j, c);
  j.close().close();
  // "</script>" in a name must not end the element.
  std::string out;
  for (char ch : j.text()) out += ch == '<' ? "\\u003c" : std::string(1, ch);
  return out;
}

}  // namespace anholon

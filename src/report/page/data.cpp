#include "report/page/data.h"

#include <algorithm>

#include "base/stop.h"
#include "numeric/number.h"
#include "report/columns.h"
#include "report/markup.h"
#include "report/observer_path.h"
#include "report/rows/contact_bands.h"
#include "simulation/report_json.h"

namespace anholon {

namespace {

void numbers(JsonWriter& j, const char* key, const std::vector<double>& list) { j.key(key).string(packed(list)); }

// The part of a motion that a page contains.
struct Extent {
  std::string (*pack)(const std::vector<double>&) = packed;  // for values, not for times
  std::vector<std::string> groups = {};                      // the groups that are plotted; empty: all
};

// Removes what is neither plotted nor in the picture; the other columns keep their places.
void reduce(PlotData& d, const std::vector<std::string>& groups, const std::vector<int>& in_picture) {
  const auto plotted = [&](const std::string& group) {
    return std::any_of(groups.begin(), groups.end(),
                       [&](const std::string& kind) { return group == kind || group.starts_with(kind + ' '); });
  };
  for (std::size_t k = 0; k < d.columns.size(); ++k) {
    PlotColumn& c = d.columns[k];
    if (plotted(c.group)) continue;
    c.group.clear(), c.math.clear();
    if (std::find(in_picture.begin(), in_picture.end(), static_cast<int>(k)) != in_picture.end()) continue;
    // The column has no rows, so its own list of times is empty.
    c = {c.name, "", "", "", {}, {}};
  }
  std::erase_if(d.groups, [&](const PlotGroup& g) { return !plotted(g.id); });
}

void columns(JsonWriter& j, const PlotData& d, const Extent& extent) {
  j.key("columns").open_array();
  for (const PlotColumn& k : d.columns) {
    look_for_stop();
    j.open_object()
        .key("name")
        .string(k.name)
        .key("html")
        .string(k.math.empty() ? "" : math(k.math))
        .key("unit")
        .string(k.unit)
        .key("group")
        .string(k.group);
    j.key("data").string(k.values.empty() ? "" : extent.pack(k.values));
    if (!k.t.empty() || k.values.empty()) numbers(j, "t", k.t);
    j.close();
  }
  j.close().key("groups").open_array();
  for (const PlotGroup& k : d.groups)
    j.open_object()
        .key("id")
        .string(k.id)
        .key("title")
        .string(k.title)
        .key("log")
        .boolean(k.log)
        .key("columns")
        .integer(static_cast<long long>(k.columns))
        .close();
  j.close();
}

void frames(JsonWriter& j, const PlotData& d, const Extent& extent) {
  j.key("frames");
  if (d.frame_t.empty()) {
    j.null();
    return;
  }
  j.open_object();
  numbers(j, "t", d.frame_t);
  j.key("data").open_object();
  for (const auto& [column, values] : d.frames) j.key(std::to_string(column).c_str()).string(extent.pack(values));
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

void one_case(JsonWriter& j, const PageCase& c, const Extent& extent) {
  const Model& model = *c.scenario->model;
  const Scene picture = scene(*c.scenario->mechanics, has_contacts(c.run.table));
  const ColumnOf in_table = column_of(model, c.run.table);
  // The time is not a column of the page.
  const ColumnOf column = [&](const Node& n) -> std::optional<int> {
    const auto k = in_table(n);
    return k && *k >= 0 ? std::optional<int>(*k - 1) : k;
  };
  PlotData d = c.plots ? *c.plots : plots_of(c, {});
  if (!extent.groups.empty()) reduce(d, extent.groups, columns_of(picture, *model.graph, column));
  j.open_object()
      .key("name")
      .string(c.name)
      .key("rows")
      .integer(static_cast<long long>(d.rows))
      .key("shown")
      .integer(static_cast<long long>(d.shown))
      .key("caution")
      .string(d.caution)
      .key("rough")
      .boolean(d.rough);
  numbers(j, "t", d.t);
  j.key("unit").string(model.coordinate_units.empty() ? "" : "s");
  columns(j, d, extent);
  frames(j, d, extent);
  events(j, read_report(c.run.report));
  bands(j, c.run.table, read_report(c.run.report));
  j.key("scene");
  write_scene(
      j, picture, *model.graph, column,
      model.observer.inertial ? std::function<void(JsonWriter&)>() : [&](JsonWriter& w) { observer(w, model, d); });
  j.close();
}

std::string data(const Page& page, const Extent& extent) {
  JsonWriter j;
  j.open_object().key("format").integer(1).key("title").string(page_title(page)).key("cases").open_array();
  for (const PageCase& c : page.cases) one_case(j, c, extent);
  j.close().close();
  // "</script>" in a name must not end the element.
  std::string out;
  for (char ch : j.text()) out += ch == '<' ? "\\u003c" : std::string(1, ch);
  return out;
}

}  // namespace

PlotData plots_of(const PageCase& c, const std::vector<std::string>& chosen) {
  return plot_data(*c.scenario, c.conserved, c.run, scene(*c.scenario->mechanics, has_contacts(c.run.table)), chosen);
}

std::string page_data(const Page& page) { return data(page, {}); }

std::string brief_page_data(const Page& page) {
  return data(page, {packed_for_pictures, {"coordinates", "velocities", "states", "monitors"}});
}

}  // namespace anholon

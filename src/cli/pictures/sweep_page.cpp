#include "cli/pictures/sweep_page.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "api/pictures/sweep_cases.h"
#include "base/escape.h"
#include "base/json.h"
#include "cli/say.h"
#include "report/assets.h"
#include "report/columns.h"
#include "result/file.h"

namespace anholon::cli {

namespace {

const std::string kHead =
    "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
    "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
    "<meta name=\"color-scheme\" content=\"light dark\">\n"
    "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; style-src "
    "'unsafe-inline'; font-src data:; img-src data: blob:\">\n<title>";
// The script that begins a page without motions.
constexpr const char* kStart = R"js(
anholon_map(document.querySelector("main"), JSON.parse(document.getElementById("data").textContent),
  {invitation: "A click on a cell tells its case.", picked: () => {}});
)js";
// The script that begins a page with motions, as soon as the viewer is loaded.
constexpr const char* kStartWithMotions = R"js(
addEventListener("DOMContentLoaded", () => {
  const held = new Map(JSON.parse(document.getElementById("motions").textContent).map(m => [m.number, m]));
  const element = (tag, name, ...children) => {
    const e = document.createElement(tag);
    if (name) e.className = name;
    e.append(...children);
    return e;
  };
  const map = anholon_map(document.querySelector("main"), JSON.parse(document.getElementById("data").textContent), {
    invitation: "A click on a cell shows the motion of its case. A dot marks the cases whose motion is in the page.",
    has: number => held.has(number),
    picked(number) {
      const motion = held.get(number), player = element("div", "player"), plots = element("div", "plots");
      window.anholon.show(motion.data, () => {
        map.motion.replaceChildren(element("h2", "", `The motion of case ${number}`),
          ...(motion.outcome ? [element("p", "warning", motion.outcome)] : []), player, plots);
        return {player, plots};
      });
      document.documentElement.dataset.shown = String(number);
    },
  });
});
)js";

constexpr std::size_t kMostNumbers = 4'000'000;  // numbers in a page, some 40 MB

// Returns the last row of each case. If these have more than kMostNumbers numbers, at most one row is kept in each of
// 256 x 256 cells.
std::vector<std::size_t> rows_to_show(const std::vector<double>& numbers, const std::vector<plot::NamedColumn>& axes,
                                      std::size_t columns) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < numbers.size(); ++row)
    if (row + 1 == numbers.size() || numbers[row + 1] != numbers[row]) rows.push_back(row);
  if (rows.size() * columns <= kMostNumbers) return rows;
  std::set<std::vector<int>> seen;
  std::vector<std::pair<double, double>> ranges;
  for (const plot::NamedColumn& a : axes) {
    const auto [least, greatest] = std::minmax_element(a.values.begin(), a.values.end());
    ranges.emplace_back(*least, std::max(*greatest - *least, 1e-300));
  }
  std::erase_if(rows, [&](std::size_t row) {
    std::vector<int> cell;
    for (std::size_t k = 0; k < axes.size(); ++k)
      cell.push_back(static_cast<int>(256 * (axes[k].values[row] - ranges[k].first) / ranges[k].second));
    return !seen.insert(cell).second;
  });
  return rows;
}

template <class T>
std::vector<T> chosen(const std::vector<T>& all, const std::vector<std::size_t>& rows) {
  std::vector<T> list;
  for (const std::size_t row : rows) list.push_back(all[row]);
  return list;
}

std::string label(const plot::NamedColumn& c) {
  return plot::plain_text(plot::axis_label(c, "", plot::LabelStyle::unicode));
}

// Returns an element that holds data for the scripts, with '<' escaped: the text of a model may hold an end tag.
std::string script_data(const std::string& id, std::string data) {
  for (std::size_t at = 0; (at = data.find('<', at)) != std::string::npos; at += 6) data.replace(at, 1, "\\u003c");
  return "<script type=\"application/json\" id=\"" + id + "\">" + data + "</script>\n";
}

// Returns the axes of the map: the columns that the options name, then the varied ones, at most two in all.
std::vector<std::string> axes_of(const v1::SweepCases& cases, const PlotCommand& o) {
  std::vector<std::string> names;
  for (const std::string& given : {o.abscissa, o.ordinate})
    if (!given.empty()) names.push_back(given);
  for (const std::string& name : cases.varied())
    if (names.size() < 2 && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  if (names.empty())
    throw Failure({}, "the columns of the sweep do not tell what varies", "--x and --y name columns of the sweep");
  return names;
}

// Writes how much of the folder is computed, and by which program.
void write_progress(JsonWriter& j, const SweepStore& store) {
  const std::size_t there = store.present().size();
  j.key("parts").integer(static_cast<long long>(there)).key("all_parts").integer(static_cast<long long>(store.parts()));
  j.key("cases").integer(static_cast<long long>(store.cases()));
  const std::string& made_by = store.request().program;
  constexpr const char* kThis = "anholon " ANHOLON_VERSION;
  j.key("program").string(made_by).key("other_program").string(made_by == kThis ? "" : kThis);
}

// Returns for each row a number that stands for its outcome; empty if the sweep has no column `outcome`.
std::vector<double> outcomes(const v1::SweepCases& cases, const std::vector<std::size_t>& rows) {
  std::vector<std::string> words;
  const std::vector<std::string>& names = cases.names();
  if (std::find(names.begin(), names.end(), "outcome") == names.end()) return {};
  return chosen(cases.read({"outcome"}, words)[0].values, rows);
}

void write_column(JsonWriter& j, const v1::SweepCases& cases, const std::string& name,
                  const std::vector<std::size_t>& rows) {
  std::vector<std::string> words;
  const plot::NamedColumn c = cases.read({name}, words)[0];
  j.open_object().key("name").string(name).key("label").string(label(c));
  j.key("data").string(packed(chosen(c.values, rows))).key("words").open_array();
  for (const std::string& word : words) j.string(word);
  j.close().close();
}

// Returns the title of the options, else that of the model, else the name of the model or of the sweep.
std::string title_of(const v1::SweepCases& cases, const PlotCommand& o) {
  if (!o.title.empty()) return o.title;
  if (!cases.store()) return o.run;
  if (const std::string& title = cases.store()->asked("title"); !title.empty()) return title;
  const std::string& name = cases.store()->request().model_name;
  return name.empty() ? o.run : name;
}

}  // namespace

SweepMap map_of_sweep(const PlotCommand& o) {
  const v1::SweepCases cases(o.run);
  const std::vector<std::string> axis_names = axes_of(cases, o), asked = split(o.columns);
  if (asked.size() > 1) throw Failure({}, "a page of a sweep begins with one column", "its menu has all columns");
  const std::string shown = asked.empty() ? "outcome" : asked[0];
  std::vector<std::string> words, none;
  std::vector<plot::NamedColumn> axes = cases.read(axis_names, words);
  if (!words.empty()) throw Failure({}, "an axis shows numbers, and a column of words was named", "--x theta --y phi");
  cases.read({shown}, words);
  const std::vector<double> numbers = cases.read({"case"}, none)[0].values;
  if (numbers.empty()) throw Failure({}, "no part is in " + o.run, "the command of the sweep computes them");
  const std::vector<std::size_t> rows = rows_to_show(numbers, axes, cases.names().size());

  std::vector<unsigned> generations = cases.generations();
  if (!generations.empty()) generations = chosen(generations, rows);
  for (plot::NamedColumn& a : axes) a.values = chosen(a.values, rows);
  SweepMap map;
  map.title = title_of(cases, o);
  JsonWriter j;
  j.open_object().key("title").string(map.title).key("shown").string(shown).key("command").string(cases.command());
  j.key("model").string(cases.store() ? cases.store()->asked("model") : "");
  j.key("folder").string(cases.command().empty() && cases.store() ? o.run : "");
  j.key("varied").open_array();
  for (const std::string& name : cases.varied()) j.string(name);
  // A scenario that varies is not an axis.
  if (std::find(cases.names().begin(), cases.names().end(), "case_name") != cases.names().end()) j.string("case_name");
  j.close().key("axes").open_array();
  for (const plot::NamedColumn& a : axes)
    j.open_object().key("name").string(a.name).key("label").string(label(a)).close();
  j.close().key("columns").open_array();
  for (const std::string& name : cases.names()) write_column(j, cases, name, rows);
  j.close();
  if (axes.size() == 2) {
    std::vector<double> corners;
    for (const plot::HeatMap::Finer& cell : plot::cells_of_cases(axes[0], axes[1], generations))
      for (const double v : {cell.from.x, cell.to.x, cell.from.y, cell.to.y}) corners.push_back(v);
    j.key("cells").string(packed(corners));
  }
  if (cases.store()) write_progress(j, *cases.store());
  map.data = j.key("all").integer(static_cast<long long>(numbers.size())).close().text();
  const std::vector<double> ends = outcomes(cases, rows);
  for (std::size_t k = 0; k < rows.size(); ++k)
    map.cases.push_back({static_cast<std::size_t>(numbers[rows[k]]),
                         {{axes[0].values[k], axes.size() > 1 ? axes[1].values[k] : 0},
                          generations.empty() ? 0 : generations[k],
                          ends.empty() ? 0 : ends[k]}});
  return map;
}

int write_page_of_sweep(const PlotCommand& o) {
  if (const std::string why = obstacle_to_writing(o.output); !why.empty()) throw UsageError{"error: " + why + "\n"};
  if (o.motions > 0 && viewer_script().empty())
    throw UsageError{
        "error: this program was built without the viewer, which shows motions\nhint: without --motions the page tells "
        "the commands of the motions\n"};
  const SweepMap map = map_of_sweep(o);
  std::string style = std::string(page_style()) + std::string(map_style()), data = script_data("data", map.data);
  std::string scripts, start = kStart;
  HeldMotions held;
  if (o.motions > 0) {
    held = held_motions(o, map.cases);
    if (held.stopped) {
      say(stderr, "stopped (interrupted): no page was written\n");
      return kStopped;
    }
    style += viewer_style();
    data += script_data("motions", held.data);
    scripts = "<script>" + std::string(viewer_script()) + "</script>\n";
    start = kStartWithMotions;
  }
  scripts += "<script>\n" + std::string(map_script()) + start + "</script>\n";
  const std::string page =
      kHead + markup_escape(map.title) + "</title>\n<style>\n" + style +
      "</style>\n</head>\n<body>\n<header class=\"page\"><div class=\"tools\"></div><h1 dir=\"auto\">" +
      markup_escape(map.title) + "</h1></header>\n<main></main>\n" + data + scripts + "</body></html>\n";
  if (const std::string why = write_whole(o.output, page); !why.empty()) throw UsageError{"error: " + why + "\n"};
  if (o.motions > 0)
    say(stderr, "page: %s, %.0f kB; %zu motions of %.0f kB each\n", o.output.c_str(),
        static_cast<double>(page.size()) / 1000, held.count,
        static_cast<double>(held.data.size()) / 1000 / static_cast<double>(held.count));
  return kOk;
}

}  // namespace anholon::cli

#include <algorithm>
#include <cmath>

#include "numeric/number.h"
#include "report/markup.h"
#include "report/page/sections.h"
#include "simulation/report_text.h"

namespace anholon {

namespace {

constexpr const char* kNotKnown = "–";

std::string residual(double x, int digits = 3) { return std::isnan(x) ? kNotKnown : number_text(x, digits); }

// Returns "coordinates 13, velocities 12, by a second run …".
std::string digits(const SimulationReport& r) {
  if (!r.error) return r.no_error.empty() ? "not estimated" : r.no_error;
  std::string list;
  for (const KindError& k : r.error->kinds)
    list += (list.empty() ? "" : ", ") + std::string(name(k.kind)) + " " + std::to_string(k.digits);
  if (r.error->until)
    list += ", up to t = " + number_text(*r.error->until, 6) + " (the second run stopped: " + r.error->stopped + ")";
  return list + ", by " + r.error->means + not_vouched_for(*r.error);
}

// `units`: of columns, and of "conserved NAME", as far as they are known.
std::string watched(const SimulationReport& r, const std::map<std::string, std::string>& units, const std::string& of) {
  constexpr std::size_t kMostEvents = 50;
  const auto unit = [&](const std::string& name) {
    const auto it = units.find(name);
    return it == units.end() ? std::string() : user(it->second);
  };
  std::vector<std::string> head = {"", "first", "last", "least", "greatest", "largest change, relative"};
  if (!units.empty()) head.insert(head.end() - 1, "unit");
  std::vector<std::vector<std::string>> rows;
  for (const std::vector<WatchedReport>* list : {&r.conserved, &r.monitors})
    for (const WatchedReport& w : *list) {
      const std::string name = list == &r.conserved && unit(w.name).empty() ? "conserved " + w.name : w.name;
      rows.push_back(
          {user(w.name), w.first.text(), w.last.text(), w.least.text(), w.greatest.text(), residual(w.largest_change)});
      if (!units.empty()) rows.back().insert(rows.back().end() - 1, unit(name));
    }
  std::string out = table("Integrals of the motion and what was watched" + of, head, rows);
  std::vector<std::vector<std::string>> events;
  for (std::size_t k = 0; k < std::min(r.events.size(), kMostEvents); ++k) {
    const EventReport& e = r.events[k];
    std::string set;
    for (const EventReport::Change& c : e.changes)
      set += (set.empty() ? "" : ", ") + user(c.name) + " " + c.before.text() + " → " + c.after.text() +
             (unit(c.name).empty() ? "" : " " + unit(c.name));
    events.push_back({user(e.name), e.t.text(), set});
  }
  out += table("Events" + of, {"", unit("t").empty() ? "t" : "t (" + unit("t") + ")", "what was set"}, events);
  for (const std::string& note : r.notes) out += warning_box({sentence(note), ""});
  for (const Warning& w : r.warnings) out += warning_box(w);
  return out;
}

}  // namespace

std::string trust_section(const Page& page, const CaseReports& reports) {
  std::string out = "<p>By another way than the equations that were integrated: Newton's law point by point, and the "
                    "balance of power, each in relation to its largest term.</p>\n";
  std::vector<std::string> head = {""};
  std::vector<std::vector<std::string>> rows = {{"Newton's law with ideal reactions"},
                                                {"the same without multipliers"},
                                                {"constraints and their derivatives, at the rows"},
                                                {"before projection"},
                                                {"rows at which these were computed"},
                                                {"balance of power"},
                                                {"digits to trust, estimated"},
                                                {"smallest scaled singular value of the system Jacobian"},
                                                {"steps, order"}};
  for (std::size_t k = 0; k < reports.size(); ++k) {
    const std::optional<SimulationReport>& r = reports[k];
    const std::string& name = page.cases[k].name;
    head.push_back(name.empty() ? (reports.size() > 1 ? "as the file says" : "") : user(name));
    std::vector<std::string> shown(rows.size(), kNotKnown);
    if (r)
      shown = {residual(r->newton),
               residual(r->projected),
               residual(r->constraints_kept),
               residual(r->constraints),
               std::to_string(r->rows_looked_at),
               residual(r->power),
               user(digits(*r)),
               residual(r->smallest_sigma) + " at t = " + residual(r->smallest_sigma_t, 6),
               std::to_string(r->steps) + ", " + std::to_string(r->order)};
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(shown[i]);
  }
  out += table("Residual report", reports.size() > 1 ? head : std::vector<std::string>{}, rows);
  for (std::size_t k = 0; k < reports.size(); ++k)
    if (reports[k])
      out += watched(*reports[k], page.cases[k].run.units, page.cases[k].name.empty() ? "" : ", " + page.cases[k].name);
  return out;
}

}  // namespace anholon

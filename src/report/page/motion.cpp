#include <algorithm>
#include <cmath>
#include <span>

#include "report/assets.h"
#include "report/markup.h"
#include "report/page/sections.h"

namespace anholon {

namespace {

// The animation and the plots of each case, or its rows if there is no viewer.
class MotionSection {
 public:
  MotionSection(const Page& page, const CaseReports& reports) : p_(page), reports_(reports) {}

  std::string write() const {
    std::string out;
    for (std::size_t k = 0; k < p_.cases.size(); ++k) {
      const PageCase& c = p_.cases[k];
      const std::string which = " data-case=\"" + std::to_string(k) + "\"";
      out += "<article class=\"case\">\n";
      if (p_.cases.size() > 1)
        out += "<h3 dir=\"auto\">" + markup_escape(c.name.empty() ? "As the file says" : c.name) + "</h3>\n";
      out += outcome(reports_[k], c.run);
      if (c.plots && !c.plots->caution.empty())
        out += warning_box({c.plots->caution + ".", std::string(c.plots->rough ? "Paths are left out. " : "") +
                                                        "A motion that ends earlier (--to)"
                                                        ", or more rows, shows more."});
      if (viewer_script().empty())
        out += "<p class=\"note\">This program was built without the viewer, so the page has no animation; the numbers "
               "are below, and <code>anholon plot</code> draws the run.</p>\n" +
               table_of_rows(c);
      else
        out += "<div class=\"player\"" + which +
               "><p class=\"note\">The animation needs a browser that runs the scripts of this page.</p></div>\n<div "
               "class=\"plots\"" +
               which + "><div class=\"static\">" + table_of_rows(c) + "</div></div>\n";
      out += "</article>\n";
    }
    return p_.cases.size() > 1 ? "<div class=\"cases\">\n" + out + "</div>\n" : out;
  }

 private:
  // Without a drawing the page still shows the start and the end of the motion.
  std::string table_of_rows(const PageCase& c) const {
    const RunTable& t = c.run.table;
    if (t.rows() == 0) return "";
    constexpr std::size_t kMostColumns = 64;
    const bool units = !c.run.units.empty();
    std::string out = "<div class=\"wide\"><table><thead><tr><td></td><th>first row</th><th>last row</th>" +
                      std::string(units ? "<th>unit</th>" : "") + "</tr></thead><tbody>\n";
    for (std::size_t k = 0; k < std::min(t.columns.size(), kMostColumns); ++k) {
      const auto unit = c.run.units.find(t.columns[k]);
      out += "<tr><th scope=\"row\">" + user(t.columns[k]) + "</th><td>" + text(t, 0, k) + "</td><td>" +
             text(t, t.rows() - 1, k) + "</td>" +
             (units ? "<td>" + (unit == c.run.units.end() ? "" : user(unit->second)) + "</td>" : "") + "</tr>\n";
    }
    return out + "</tbody></table></div>\n";
  }

  // A number that the start has computed in place of a zero, such as 5e-57 in a column of numbers of size 1, is shown
  // as zero.
  static std::string text(const RunTable& t, std::size_t row, std::size_t column) {
    constexpr double kNothing = 1e-30;  // far below the round-off of doubles
    const std::span<const double> all = t.values[column];
    const double most = std::abs(
        *std::max_element(all.begin(), all.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
    return std::abs(all[row]) < kNothing * most ? "0" : markup_escape(t.text(row, column));
  }

  // A file with rows alone does not contain the outcome of the motion.
  static std::string outcome(const std::optional<SimulationReport>& r, const RunFile& run) {
    if (!r && run.model.empty() && run.created_by.empty()) return "";
    if (!r) return warning_box({"The run was not finished; the rows up to here are shown.", ""});
    if (r->outcome.ok()) return "";
    return warning_box({r->outcome.message.empty() ? name(r->outcome.kind) : r->outcome.message, r->outcome.hint});
  }

  const Page& p_;
  const CaseReports& reports_;
};

}  // namespace

std::string motion_section(const Page& page, const CaseReports& reports) {
  return MotionSection(page, reports).write();
}

}  // namespace anholon

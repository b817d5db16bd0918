#include "report/page.h"

#include <algorithm>

#include "base/base64.h"
#include "numeric/number.h"
#include "print/print_names.h"
#include "report/assets.h"
#include "report/bibliography.h"
#include "report/markup.h"
#include "report/math_lines.h"
#include "report/page_data.h"
#include "simulation/report_json.h"
#include "structure/blocks.h"

namespace anholon {

namespace {

// The comment at the head of a model file that describes the model.
std::string picture_in_words(const std::string& source) {
  std::string out;
  bool begun = false;
  std::size_t at = 0;
  while (at < source.size()) {
    const std::size_t end = std::min(source.find('\n', at), source.size());
    const std::string line = source.substr(at, end - at);
    at = end + 1;
    if (line.rfind("# oracle", 0) == 0) continue;
    if (line.rfind('#', 0) == 0) {
      const std::string text = line.substr(std::min<std::size_t>(line.size(), line.rfind("# ", 0) == 0 ? 2 : 1));
      if (text.empty() || text[0] == ' ') {
        if (begun) break;  // only the first paragraph; lists are longer than a page needs
      } else {
        out += (begun ? " " : "") + text, begun = true;
      }
    } else if (begun || line.rfind("coordinates", 0) == 0) {
      break;
    }
  }
  return out;
}

class Writer {
 public:
  explicit Writer(const Page& p) : p_(p), model_(*p.cases[0].scenario->model) {
    for (const PageCase& c : p.cases) reports_.push_back(read_report(c.run.report));
  }

  std::string write() {
    sources();
    std::string sections;
    const auto section = [&](const char* id, const char* title, const std::string& body) {
      if (body.empty()) return;
      contents_ += std::string("<li><a href=\"#") + id + "\">" + title + "</a></li>";
      sections += std::string("<section id=\"") + id + "\"><h2>" + title + "</h2>\n" + body + "</section>\n";
    };
    section("motion", "Motion", motion());
    section("system", "System", system());
    section("equations", "Equations of motion", equations());
    section("structure", "Structure", structure());
    section("proof", "Proof that the forms agree", proof());
    section("report", "How far the motion can be trusted", trust());
    section("again", "To make it again", again());
    section("literature", "Literature", literature_list());

    std::string out = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta "
                      "name=\"color-scheme\" content=\"light dark\">\n";
    out += "<meta name=\"generator\" content=\"" + markup_escape(p_.version) + "\">\n<title>" + markup_escape(title()) +
           "</title>\n";
    out += "<style>\n" + std::string(page_style()) + std::string(viewer_style()) + "</style>\n</head>\n<body>\n";
    out += "<a class=\"skip\" href=\"#motion\">Skip to the motion</a>\n<header class=\"page\">\n<div "
           "class=\"tools\"></div>\n";
    out += "<h1 dir=\"auto\">" + markup_escape(title()) + "</h1>\n";
    if (!model_.source.empty()) out += "<p class=\"source\" dir=\"auto\">" + markup_escape(model_.source) + "</p>\n";
    if (const std::string words = picture_in_words(p_.source.text); !words.empty())
      out += "<p class=\"lead\" dir=\"auto\">" + markup_escape(words) + "</p>\n";
    out +=
        "</header>\n<nav aria-label=\"Contents\"><ul>" + contents_ + "</ul></nav>\n<main>\n" + sections + "</main>\n";
    out += "<footer><p>Made by " + markup_escape(p_.version) + ". The page needs nothing but itself.</p></footer>\n";
    if (!viewer_script().empty())
      out += "<script type=\"application/json\" id=\"anholon-data\">" + page_data(p_) + "</script>\n<script>" +
             std::string(viewer_script()) + "</script>\n";
    return out + "</body>\n</html>\n";
  }

 private:
  std::string title() const { return page_title(p_); }

  // ---- motion -----------------------------------------------------------------------------------

  std::string motion() {
    std::string out;
    for (std::size_t k = 0; k < p_.cases.size(); ++k) {
      const PageCase& c = p_.cases[k];
      const std::string which = " data-case=\"" + std::to_string(k) + "\"";
      out += "<article class=\"case\">\n";
      if (p_.cases.size() > 1)
        out += "<h3 dir=\"auto\">" + markup_escape(c.name.empty() ? "As the file says" : c.name) + "</h3>\n";
      out += outcome(reports_[k]);
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

  // Without a drawing the page still shows the start and the end of the motion.
  std::string table_of_rows(const PageCase& c) const {
    const RunTable& t = c.run.table;
    if (t.rows() == 0) return "";
    constexpr std::size_t kMostColumns = 64;
    std::string out =
        "<div class=\"wide\"><table><thead><tr><th></th><th>first row</th><th>last row</th></tr></thead><tbody>\n";
    for (std::size_t k = 0; k < std::min(t.columns.size(), kMostColumns); ++k)
      out += "<tr><th scope=\"row\">" + user(t.columns[k]) + "</th><td>" + markup_escape(t.text(0, k)) + "</td><td>" +
             markup_escape(t.text(t.rows() - 1, k)) + "</td></tr>\n";
    return out + "</tbody></table></div>\n";
  }

  static std::string outcome(const std::optional<SimulationReport>& r) {
    if (!r) return warning({"The run was not finished; the rows up to here are shown.", ""});
    if (r->outcome.ok()) return "";
    return warning({r->outcome.message.empty() ? name(r->outcome.kind) : r->outcome.message, r->outcome.hint});
  }

  static std::string warning(const Warning& w) {
    std::string out = "<p class=\"warning\" role=\"note\" dir=\"auto\">" + markup_escape(w.message);
    if (!w.hint.empty()) out += " <span class=\"hint\">" + markup_escape(w.hint) + "</span>";
    return out + "</p>\n";
  }

  // ---- system -----------------------------------------------------------------------------------

  std::string name_math(const std::string& name, unsigned order = 0) const {
    const auto chosen = model_.names.notation.find(name);
    return math(derivative_name(chosen == model_.names.notation.end() ? mathml_name(name) : chosen->second.mathml,
                                order, Format::mathml));
  }

  std::string system() const {
    const Scenario& s = *p_.cases[0].scenario;
    std::string out = "<p>" + std::to_string(s.structure.degrees_of_freedom) +
                      (s.structure.degrees_of_freedom == 1 ? " degree" : " degrees") +
                      " of freedom, configurations of " + std::to_string(s.structure.configuration_dimension) +
                      (s.structure.configuration_dimension == 1 ? " dimension, " : " dimensions, ") + "a state of " +
                      std::to_string(s.structure.state_dimension) + ".";
    for (const std::string& e : effects(model_)) out += " " + user(sentence(e));
    out += "</p>\n" + bodies() + constraints() + parameters();
    for (const PageCase& c : p_.cases) out += initial_data(c);
    return out;
  }

  static std::string sentence(std::string s) {
    if (!s.empty() && s[0] >= 'a' && s[0] <= 'z') s[0] = static_cast<char>(s[0] - 'a' + 'A');
    return s + ".";
  }

  std::string bodies() const {
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 40;
    for (std::size_t k = 0; k < std::min(model_.bodies.size(), kMost); ++k) {
      const Body& b = model_.bodies[k];
      rows.push_back({user(b.name),
                      b.particle ? "particle"
                      : b.shape  ? markup_escape(b.shape->kind)
                                 : "body",
                      wrapping_math(print(put_masses(model_, b.mass), model_.names, Format::mathml)),
                      b.expelled_velocity ? "expels or collects matter" : ""});
    }
    return table("Bodies", {"", "kind", "mass", ""}, rows);
  }

  std::string constraints() const {
    const Scenario& s = *p_.cases[0].scenario;
    const Explanation& x = *p_.cases[0].explanation;
    constexpr std::size_t kLongestPower = 80, kMost = 60;
    std::vector<std::vector<std::string>> rows;
    for (std::size_t r = 0; r < std::min(model_.constraints.size(), kMost); ++r) {
      const Constraint& c = model_.constraints[r];
      std::string kind = description(s.classes[r], c.order);
      if (s.classes[r].redundant) kind += "; redundant here";
      const std::string reaction = c.by ? "kept by the input " + model_.controls[*c.by].name
                                        : std::string(in_words(x.constraints[r].hypothesis));
      rows.push_back({user(c.name), "<code>" + user(c.equation) + "</code>", markup_escape(kind),
                      markup_escape(work(s, x, r, kLongestPower)), markup_escape(reaction)});
    }
    return table("Constraints", {"", "as written", "kind", "its reaction", "hypothesis"}, rows);
  }

  std::string parameters() const {
    const std::vector<double> values = parameter_values<double>(model_);
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 80;
    for (std::size_t k = 0; k < std::min(values.size(), kMost); ++k) {
      const std::string unit = k < model_.parameter_units.size() ? model_.parameter_units[k] : "";
      rows.push_back({math(print(model_.graph->parameter(static_cast<std::uint32_t>(k)), model_.names, Format::mathml)),
                      markup_escape(number_text(values[k])), user(unit), user(model_.parameters[k].doc)});
    }
    return table("Parameters", {"", "value", "unit", ""}, rows);
  }

  std::string initial_data(const PageCase& c) const {
    const InitialState<double>& x = c.scenario->state;
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 60;
    for (std::size_t a = 0; a < std::min(x.q.size(), kMost); ++a)
      rows.push_back({name_math(model_.coordinates[a].name), markup_escape(number_text(x.q[a])), name(x.q_origin[a]),
                      name_math(model_.coordinates[a].name, 1), markup_escape(number_text(x.qd[a])),
                      name(x.qd_origin[a])});
    for (const StateEntry& e : higher_state(*c.scenario))
      rows.push_back({user(e.name), markup_escape(number_text(e.value)), name(e.origin), "", "", ""});
    return table("Initial data at t = " + number_text(x.t) + (c.name.empty() ? "" : ", " + c.name),
                 {"", "position", "", "", "velocity", ""}, rows);
  }

  // ---- equations --------------------------------------------------------------------------------

  // One equation: it wraps, is read out as text, and is copied as LaTeX.
  static std::string equation(const std::string& label, const std::string& left, const std::string& right,
                              const std::string& latex, const std::string& text) {
    std::string out = "<div class=\"equation\"" + attribute("data-latex", latex) + ">";
    if (!label.empty()) out += "<span class=\"label\">" + label + "</span>";
    out += "<div class=\"formula\" role=\"math\"" + attribute("aria-label", text) + ">" + left;
    if (!right.empty()) out += " <math><mo form=\"infix\" lspace=\"0\" rspace=\"0\">=</mo></math> " + right;
    return out + "</div></div>\n";
  }

  struct Prints {
    std::vector<std::string> mathml, latex, text;
    Prints(const Column& es, const SymbolNames& names)
        : mathml(print(es, names, Format::mathml)), latex(print(es, names, Format::latex)),
          text(print(es, names, Format::text)) {}
  };

  std::string lines(const Derivation& d, const std::vector<Line>& list, bool zero) const {
    Column left, right;
    for (const Line& l : list) left.push_back(l.left ? *l.left : l.right), right.push_back(l.right);
    if (left.empty()) return "";
    const Prints a(left, d.names), b(right, d.names);
    std::string out;
    for (std::size_t k = 0; k < list.size(); ++k)
      out += zero ? equation(user(list[k].name), wrapping_math(a.mathml[k]), math("<mn>0</mn>"), a.latex[k] + " = 0",
                             a.text[k] + " = 0")
             : list[k].left
                 ? equation(user(list[k].name), wrapping_math(a.mathml[k]), wrapping_math(b.mathml[k]),
                            a.latex[k] + " = " + b.latex[k], a.text[k] + " = " + b.text[k])
                 : equation(user(list[k].name),
                            math(list[k].mathml.empty() ? "<mtext>" + markup_escape(list[k].name) + "</mtext>"
                                                        : list[k].mathml),
                            wrapping_math(b.mathml[k]), b.latex[k], list[k].name + " = " + b.text[k]);
    return out;
  }

  std::string parts(const Derivation& d) const {
    constexpr std::size_t kMost = 200;
    if (d.parts.empty()) return "";
    if (d.parts.size() > kMost)
      return "<p class=\"note\">The names stand for " + std::to_string(d.parts.size()) +
             " parts: <code>anholon derive " + markup_escape(p_.source.name) + " --form " + d.form->name +
             " --expand parts</code> prints them.</p>\n";
    const std::vector<std::string> mathml = print_contents(d.parts, d.names, Format::mathml),
                                   latex = print_contents(d.parts, d.names, Format::latex),
                                   text = print_contents(d.parts, d.names, Format::text);
    std::string out = "<details><summary>" + std::to_string(d.parts.size()) + " parts, each with a name</summary>\n";
    for (std::size_t k = 0; k < d.parts.size(); ++k) {
      const std::string& name = d.names.defined.at(d.parts[k].id);
      out += equation("", math(mathml_name(name)), wrapping_math(mathml[k]), latex_name(name) + " = " + latex[k],
                      name + " = " + text[k]);
    }
    return out + "</details>\n";
  }

  std::string masses(const Derivation& d) const {
    std::string out;
    for (std::size_t k = 0; k < model_.masses.size(); ++k) {
      SymbolNames plain = model_.names;
      plain.defined.erase(model_.masses[k].value.id);
      const Expr m = model_.masses[k].value;
      out += equation("", math(mathml_name(d.names.masses[k])), wrapping_math(print(m, plain, Format::mathml)),
                      latex_name(d.names.masses[k]) + " = " + print(m, plain, Format::latex),
                      d.names.masses[k] + " = " + print(m, plain, Format::text));
    }
    return out;
  }

  std::string equations() const {
    std::string out;
    for (std::size_t k = 0; k < p_.equations.size(); ++k) {
      const Derivation& d = p_.equations[k];
      out += "<article class=\"form\"><h3>" + markup_escape(d.form->title) + "</h3><p class=\"source\">" +
             markup_escape(citation(*d.form)) + "</p>\n";
      if (k < p_.eliminations.size() && !p_.eliminations[k].empty()) out += "<p>" + user(p_.eliminations[k]) + "</p>\n";
      out += lines(d, d.equations, false);
      if (!d.constraints.empty()) out += "<h4>with the constraints</h4>\n" + lines(d, d.constraints, true);
      out += parts(d);
      for (const auto& [heading, list] : d.steps)
        if (!list.empty())
          out += "<details><summary>" + user(sentence(heading)) + "</summary>\n" + lines(d, joined(list), false) +
                 "</details>\n";
      out += "</article>\n";
    }
    if (!p_.equations.empty() && !model_.masses.empty())
      out += "<article class=\"form\"><h4>Masses</h4>\n" + masses(p_.equations[0]) + "</article>\n";
    return out;
  }

  // ---- structure --------------------------------------------------------------------------------

  std::string structure() const {
    const Scenario& s = *p_.cases[0].scenario;
    const Structure& x = s.structure;
    constexpr std::size_t kMost = 24;
    if (x.sigma.empty()) return "";
    if (x.sigma.size() > kMost)
      return "<p>" + std::to_string(x.sigma.size()) +
             " equations; <code>anholon check</code> prints their signature.</p>\n";
    std::vector<std::string> head = {""};
    const auto unknown = [&](std::size_t j) {
      return math(print(s.system.symbol(j, 0), model_.names, Format::mathml));
    };
    for (std::size_t j = 0; j < x.d.size(); ++j) head.push_back(unknown(j));
    head.push_back(math("<mi>c</mi>"));
    std::vector<std::vector<std::string>> rows;
    for (std::size_t i = 0; i < x.sigma.size(); ++i) {
      std::vector<std::string> r = {user((i < s.system.coordinates ? "motion, " : "") + s.system.equation_names[i])};
      for (std::size_t j = 0; j < x.sigma[i].size(); ++j) {
        const std::string v = x.sigma[i][j] == kAbsent ? "·" : std::to_string(x.sigma[i][j]);
        r.push_back(static_cast<std::size_t>(x.transversal[i]) == j ? "<strong>" + v + "</strong>" : v);
      }
      r.push_back(std::to_string(x.c[i]));
      rows.push_back(r);
    }
    std::vector<std::string> d = {math("<mi>d</mi>")};
    for (int k : x.d) d.push_back(std::to_string(k));
    d.emplace_back("");
    rows.push_back(d);
    return "<p>Which derivative of which unknown each equation holds (signature), and how often an equation is "
           "differentiated (<i>c</i>) and an unknown solved for (<i>d</i>). "
           "The bold entries are the transversal of highest value.</p>\n" +
           table("Signature and offsets of " + std::string(s.system.form->title), head, rows);
  }

  // ---- proof ------------------------------------------------------------------------------------

  std::string proof() const {
    if (!p_.proof) return p_.no_proof.empty() ? "" : "<p>" + user(p_.no_proof) + "</p>\n";
    const Proof& proof = *p_.proof;
    std::string out = "<p>Every form against every other, by exact algebra: <b class=\"eq\">=</b> proved equal, <b "
                      "class=\"ne\">≠</b> shown different at a point, <b>?</b> not decided.</p>\n";
    out += "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Proof matrix\"><table "
           "class=\"matrix\"><caption>Proof matrix</caption><thead><tr><th></th><th></th>";
    for (std::size_t k = 0; k < proof.forms.size(); ++k)
      out += "<th scope=\"col\" title=\"" + markup_escape(proof.forms[k].form->title) + "\">" + std::to_string(k + 1) +
             "</th>";
    out += "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < proof.forms.size(); ++i) {
      out += "<tr><th scope=\"row\">" + std::to_string(i + 1) + "</th><th scope=\"row\" class=\"form\">" +
             markup_escape(proof.forms[i].form->title) + "</th>";
      for (std::size_t j = 0; j < proof.forms.size(); ++j) {
        const Verdict v = i == j ? Verdict::proved : proof.between(i, j);
        out += i == j                  ? "<td class=\"self\">·</td>"
               : v == Verdict::proved  ? "<td class=\"eq\">=</td>"
               : v == Verdict::refuted ? "<td class=\"ne\">≠</td>"
                                       : "<td>?</td>";
      }
      out += "</tr>\n";
    }
    out += "</tbody></table></div>\n";
    for (const FormProof& f : proof.forms)
      for (const Difference& d : f.differences) {
        if (d.verdict == Verdict::proved) continue;
        out += "<p>" + markup_escape(f.form->title) + (d.verdict == Verdict::refuted ? " differ" : " may differ") +
               " from Routh's equations in the equation of " + user(d.component) + ": " + user(d.detail) + ".</p>\n";
        break;
      }
    if (!p_.meaning.empty()) out += "<p>" + user(p_.meaning) + "</p>\n";
    if (!p_.hypotheses.empty()) {
      out += "<p>Given:</p><ul>";
      for (const std::string& h : p_.hypotheses) out += "<li>" + user(h) + "</li>";
      out += "</ul>\n";
    }
    return out + certificate();
  }

  // The certificate in the page itself, if it is not too long.
  std::string certificate() const {
    constexpr std::size_t kMost = 240'000;
    if (p_.certificate.empty()) return "";
    const std::string source = p_.source.name.substr(p_.source.name.rfind('/') + 1),
                      name = source.substr(0, source.rfind('.')) + ".proof.json";
    std::string out =
        "<p>The certificate holds " + std::to_string(p_.claims) + " claims, " +
        (p_.confirmed == p_.claims ? "all" : std::to_string(p_.confirmed)) +
        " confirmed when this page was made by the checker, which shares nothing with the prover. To check it again: ";
    if (p_.certificate.size() <= kMost)
      out += "<a" + attribute("download", name) + " href=\"data:application/json;base64," + to_base64(p_.certificate) +
             "\">save " + user(name) + "</a> (" + std::to_string((p_.certificate.size() + 999) / 1000) + " kB), ";
    else
      out += "<code>anholon prove " + markup_escape(p_.source.name) + " -o " + markup_escape(name) + "</code>, ";
    return out + "<code>anholon verify " + markup_escape(name) + "</code>.</p>\n";
  }

  // ---- report -----------------------------------------------------------------------------------

  std::string trust() const {
    std::string out = "<p>By another way than the equations that were integrated: Newton's law point by point, and the "
                      "balance of power, each in relation to its largest term.</p>\n";
    std::vector<std::string> head = {""};
    std::vector<std::vector<std::string>> rows = {{"Newton's law with ideal reactions"},
                                                  {"the same without multipliers"},
                                                  {"constraints and their derivatives, at the rows"},
                                                  {"before projection"},
                                                  {"balance of power"},
                                                  {"digits to trust, estimated"},
                                                  {"smallest scaled singular value of the system Jacobian"},
                                                  {"steps, order"}};
    for (std::size_t k = 0; k < reports_.size(); ++k) {
      const std::optional<SimulationReport>& r = reports_[k];
      const std::string& name = p_.cases[k].name;
      head.push_back(name.empty() ? (reports_.size() > 1 ? "as the file says" : "") : user(name));
      std::vector<std::string> shown(rows.size(), kNotKnown);
      if (r)
        shown = {residual(r->newton),
                 residual(r->projected),
                 residual(r->constraints_kept),
                 residual(r->constraints),
                 residual(r->power),
                 user(digits(*r)),
                 residual(r->smallest_sigma) + " at t = " + residual(r->smallest_sigma_t, 6),
                 std::to_string(r->steps) + ", " + std::to_string(r->order)};
      for (std::size_t i = 0; i < rows.size(); ++i) rows[i].push_back(shown[i]);
    }
    out += table("Residual report", reports_.size() > 1 ? head : std::vector<std::string>{}, rows);
    for (std::size_t k = 0; k < reports_.size(); ++k)
      if (reports_[k]) out += watched(*reports_[k], p_.cases[k].name.empty() ? "" : ", " + p_.cases[k].name);
    return out;
  }

  static constexpr const char* kNotKnown = "–";

  static std::string residual(double x, int digits = 3) { return std::isnan(x) ? kNotKnown : number_text(x, digits); }

  // "coordinates 13, velocities 12, by a second run …"
  static std::string digits(const SimulationReport& r) {
    if (!r.error) return r.no_error.empty() ? "not estimated" : r.no_error;
    std::string list;
    for (const KindError& k : r.error->kinds)
      list += (list.empty() ? "" : ", ") + std::string(name(k.kind)) + " " + std::to_string(k.digits);
    if (r.error->until)
      list += ", up to t = " + number_text(*r.error->until, 6) + " (the second run stopped: " + r.error->stopped + ")";
    return list + ", by " + r.error->means;
  }

  static std::string watched(const SimulationReport& r, const std::string& of) {
    constexpr std::size_t kMostEvents = 50;
    std::vector<std::vector<std::string>> rows;
    for (const std::vector<WatchedReport>* list : {&r.conserved, &r.monitors})
      for (const WatchedReport& w : *list)
        rows.push_back({user(w.name), w.first.text(), w.last.text(), w.least.text(), w.greatest.text(),
                        residual(w.largest_change)});
    std::string out = table("Integrals of the motion and what was watched" + of,
                            {"", "first", "last", "least", "greatest", "largest change, relative"}, rows);
    std::vector<std::vector<std::string>> events;
    for (std::size_t k = 0; k < std::min(r.events.size(), kMostEvents); ++k) {
      const EventReport& e = r.events[k];
      std::string set;
      for (const EventReport::Change& c : e.changes)
        set += (set.empty() ? "" : ", ") + user(c.name) + " " + c.before.text() + " → " + c.after.text();
      events.push_back({user(e.name), e.t.text(), set});
    }
    out += table("Events" + of, {"", "t", "what was set"}, events);
    for (const Warning& w : r.warnings) out += warning(w);
    return out;
  }

  // ---- the rest ---------------------------------------------------------------------------------

  std::string again() const {
    std::string out = "<pre class=\"command\"><code>" + markup_escape(p_.command) + "</code></pre>\n<p>" +
                      markup_escape(p_.version) + "; SHA-256 of the model <code class=\"hash\">" +
                      markup_escape(p_.model_hash) + "</code>.</p>\n";
    for (const PageCase& c : p_.cases)
      if (!c.run.command.empty() && c.run.command != p_.command)
        out += "<p>The run: <code>" + markup_escape(c.run.command) + "</code></p>\n";
    const auto file = [&](const SourceText& s) {
      out += "<details><summary>The model file " + user(s.name) + "</summary><pre dir=\"ltr\"><code>" +
             markup_lines(s.text) + "</code></pre></details>\n";
    };
    file(p_.source);
    for (const SourceText& s : p_.source.others) file(s);
    return out;
  }

  void sources() {
    if (!model_.source.empty()) literature_.source(model_.source);
    for (const Derivation& d : p_.equations) literature_.source(d.form->source);
    literature_.key("Pryce2001");
    literature_.key("NedialkovPryce2005");
    for (const std::optional<SimulationReport>& r : reports_) {
      if (!r) continue;
      const auto cite = [&](const MethodInfo& method) {
        if (method.citation[0]) literature_.key(method.citation);
      };
      cite(info(r->method.last));
      for (const MethodReport::Turn& turn : r->method.turns) cite(info(turn.to));
      if (r->second) cite(info(r->second->integrator));
    }
    literature_.key("JorbaZou2005");
    literature_.key("Neumaier1974");
  }

  std::string literature_list() const {
    std::string out = "<ol class=\"literature\">";
    for (const std::string& e : literature_.entries()) out += "<li dir=\"auto\">" + markup_escape(e) + "</li>\n";
    return out + "</ol>\n";
  }

  const Page& p_;
  const Model& model_;
  std::vector<std::optional<SimulationReport>> reports_;  // of the cases; nullopt for an unfinished run
  Bibliography literature_;
  std::string contents_;
};

}  // namespace

std::string html(const Page& page) { return Writer(page).write(); }

}  // namespace anholon

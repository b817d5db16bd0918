#include "report/page.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "expr/print_names.h"
#include "numeric/number.h"
#include "report/assets.h"
#include "report/bibliography.h"
#include "report/columns.h"
#include "report/math_lines.h"
#include "report/observer_path.h"
#include "structure/blocks.h"

namespace anholon {

namespace {

using Json = nlohmann::json;

std::string math(const std::string& row) { return "<math>" + row + "</math>"; }

// Text of a model: escaped, and kept apart where it runs the other way.
std::string user(const std::string& text) { return "<bdi>" + html_escape(text) + "</bdi>"; }

std::string attribute(const char* name, const std::string& value) { return std::string(" ") + name + "=\"" + html_escape(value) + "\""; }

// The comment at the head of a model file that says what it is.
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
        if (begun) break;  // the first paragraph; lists say more than a page needs
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
  explicit Writer(const Page& p) : p_(p), model_(*p.cases[0].scenario->model) {}

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
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta name=\"color-scheme\" content=\"light dark\">\n";
    out += "<meta name=\"generator\" content=\"" + html_escape(p_.version) + "\">\n<title>" + html_escape(title()) + "</title>\n";
    out += "<style>\n" + std::string(page_style()) + std::string(viewer_style()) + "</style>\n</head>\n<body>\n";
    out += "<a class=\"skip\" href=\"#motion\">Skip to the motion</a>\n<header class=\"page\">\n<div class=\"tools\"></div>\n";
    out += "<h1 dir=\"auto\">" + html_escape(title()) + "</h1>\n";
    if (!model_.source.empty()) out += "<p class=\"source\" dir=\"auto\">" + html_escape(model_.source) + "</p>\n";
    if (const std::string words = picture_in_words(p_.source.text); !words.empty()) out += "<p class=\"lead\" dir=\"auto\">" + html_escape(words) + "</p>\n";
    out += "</header>\n<nav aria-label=\"Contents\"><ul>" + contents_ + "</ul></nav>\n<main>\n" + sections + "</main>\n";
    out += "<footer><p>Made by " + html_escape(p_.version) + ". The page needs nothing but itself.</p></footer>\n";
    if (!viewer_script().empty()) out += "<script type=\"application/json\" id=\"anholon-data\">" + data() + "</script>\n<script>" + std::string(viewer_script()) + "</script>\n";
    return out + "</body>\n</html>\n";
  }

  std::string stage(bool dark, const std::string& script) const {
    std::string out = "<!doctype html>\n<html lang=\"en\" data-theme=\"" + std::string(dark ? "dark" : "light") + "\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + html_escape(title()) + "</title>\n";
    out += "<style>\n" + std::string(page_style()) + std::string(viewer_style()) + "</style>\n</head>\n<body>\n<div class=\"player\" data-case=\"0\"></div>\n";
    out += "<script type=\"application/json\" id=\"anholon-data\">" + data() + "</script>\n<script>" + std::string(viewer_script()) + "</script>\n<script>\n" + script + "</script>\n";
    return out + "</body>\n</html>\n";
  }

 private:
  std::string title() const { return model_.title.empty() ? p_.source.name : model_.title; }

  // ---- motion -----------------------------------------------------------------------------------

  std::string motion() {
    std::string out;
    for (std::size_t k = 0; k < p_.cases.size(); ++k) {
      const PageCase& c = p_.cases[k];
      const std::string which = " data-case=\"" + std::to_string(k) + "\"";
      out += "<article class=\"case\">\n";
      if (p_.cases.size() > 1) out += "<h3 dir=\"auto\">" + html_escape(c.name.empty() ? "As the file says" : c.name) + "</h3>\n";
      out += outcome(c);
      if (viewer_script().empty())
        out += "<p class=\"note\">This program was built without the viewer, so the page has no animation; the numbers are below, and <code>anholon plot</code> draws the run.</p>\n" + table_of_rows(c);
      else
        out += "<div class=\"player\"" + which + "><p class=\"note\">The animation needs a browser that runs the scripts of this page.</p></div>\n<div class=\"plots\"" + which +
               "><div class=\"static\">" + table_of_rows(c) + "</div></div>\n";
      out += "</article>\n";
    }
    return p_.cases.size() > 1 ? "<div class=\"cases\">\n" + out + "</div>\n" : out;
  }

  // The page still says where the motion begins and ends when nothing draws it.
  std::string table_of_rows(const PageCase& c) const {
    const RunTable& t = c.run.table;
    if (t.rows() == 0) return "";
    constexpr std::size_t kMostColumns = 64;
    std::string out = "<div class=\"wide\"><table><thead><tr><th></th><th>first row</th><th>last row</th></tr></thead><tbody>\n";
    for (std::size_t k = 0; k < std::min(t.columns.size(), kMostColumns); ++k)
      out += "<tr><th scope=\"row\">" + user(t.columns[k]) + "</th><td>" + html_escape(t.text(0, k)) + "</td><td>" + html_escape(t.text(t.rows() - 1, k)) + "</td></tr>\n";
    return out + "</tbody></table></div>\n";
  }

  static Json report(const PageCase& c) {
    const Json j = Json::parse(c.run.report, nullptr, false);
    return j.is_object() ? j : Json::object();
  }

  std::string outcome(const PageCase& c) const {
    const Json j = report(c);
    const std::string kind = j.value("outcome", "");
    if (kind == "finished") return "";
    const std::string words = kind.empty() ? "The run was not finished; the rows up to here are shown." : j.value("message", kind);
    std::string out = "<p class=\"warning\" role=\"note\" dir=\"auto\">" + html_escape(words);
    if (const std::string hint = j.value("hint", ""); !hint.empty()) out += " <span class=\"hint\">" + html_escape(hint) + "</span>";
    return out + "</p>\n";
  }

  // ---- system -----------------------------------------------------------------------------------

  static std::string row(const std::vector<std::string>& cells, const char* tag = "td") {
    std::string out = "<tr>";
    for (std::size_t k = 0; k < cells.size(); ++k)
      out += k == 0 && tag[1] == 'd' ? "<th scope=\"row\">" + cells[k] + "</th>" : std::string("<") + tag + ">" + cells[k] + "</" + tag + ">";
    return out + "</tr>\n";
  }

  // `caption` is ours.
  static std::string table(const std::string& caption, const std::vector<std::string>& head, const std::vector<std::vector<std::string>>& rows) {
    if (rows.empty()) return "";
    std::string out = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"" + caption + "\"><table><caption>" + caption + "</caption>";
    if (!head.empty()) out += "<thead>" + row(head, "th") + "</thead>";
    out += "<tbody>\n";
    for (const auto& r : rows) out += row(r);
    return out + "</tbody></table></div>\n";
  }

  std::string name_math(const std::string& name, unsigned order = 0) const {
    const auto chosen = model_.names.notation.find(name);
    return math(derivative_name(chosen == model_.names.notation.end() ? mathml_name(name) : chosen->second.mathml, order, Format::mathml));
  }

  std::string system() const {
    const Scenario& s = *p_.cases[0].scenario;
    std::string out = "<p>" + std::to_string(s.structure.degrees_of_freedom) + (s.structure.degrees_of_freedom == 1 ? " degree" : " degrees") + " of freedom, configurations of " +
                      std::to_string(s.structure.configuration_dimension) + (s.structure.configuration_dimension == 1 ? " dimension, " : " dimensions, ") + "a state of " +
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
      rows.push_back({user(b.name), b.particle ? "particle" : b.shape ? html_escape(b.shape->kind) : "body", wrapping_math(print(put_masses(model_, b.mass), model_.names, Format::mathml)),
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
      const std::string reaction = c.by ? "kept by the input " + model_.controls[*c.by].name : std::string(in_words(x.constraints[r].hypothesis));
      rows.push_back({user(c.name), "<code>" + user(c.equation) + "</code>", html_escape(kind), html_escape(work(s, x, r, kLongestPower)), html_escape(reaction)});
    }
    return table("Constraints", {"", "as written", "kind", "its reaction", "hypothesis"}, rows);
  }

  std::string parameters() const {
    const std::vector<double> values = parameter_values<double>(model_);
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 80;
    for (std::size_t k = 0; k < std::min(values.size(), kMost); ++k) {
      const std::string unit = k < model_.parameter_units.size() ? model_.parameter_units[k] : "";
      rows.push_back({math(print(model_.graph->parameter(static_cast<std::uint32_t>(k)), model_.names, Format::mathml)), html_escape(number_text(values[k])), user(unit), user(model_.parameters[k].doc)});
    }
    return table("Parameters", {"", "value", "unit", ""}, rows);
  }

  std::string initial_data(const PageCase& c) const {
    const InitialState<double>& x = c.scenario->state;
    std::vector<std::vector<std::string>> rows;
    constexpr std::size_t kMost = 60;
    for (std::size_t a = 0; a < std::min(x.q.size(), kMost); ++a)
      rows.push_back({name_math(model_.coordinates[a].name), html_escape(number_text(x.q[a])), name(x.q_origin[a]), name_math(model_.coordinates[a].name, 1), html_escape(number_text(x.qd[a])), name(x.qd_origin[a])});
    for (const StateEntry& e : higher_state(*c.scenario)) rows.push_back({user(e.name), html_escape(number_text(e.value)), name(e.origin), "", "", ""});
    return table("Initial data at t = " + number_text(x.t) + (c.name.empty() ? "" : ", " + html_escape(c.name)), {"", "position", "", "", "velocity", ""}, rows);
  }

  // ---- equations --------------------------------------------------------------------------------

  // One equation: wraps, is read out as text, copied as LaTeX.
  static std::string equation(const std::string& label, const std::string& left, const std::string& right, const std::string& latex, const std::string& text) {
    std::string out = "<div class=\"equation\"" + attribute("data-latex", latex) + ">";
    if (!label.empty()) out += "<span class=\"label\">" + label + "</span>";
    out += "<div class=\"formula\" role=\"math\"" + attribute("aria-label", text) + ">" + left;
    if (!right.empty()) out += " <math><mo form=\"infix\" lspace=\"0\" rspace=\"0\">=</mo></math> " + right;
    return out + "</div></div>\n";
  }

  struct Prints {
    std::vector<std::string> mathml, latex, text;
    Prints(const Column& es, const SymbolNames& names)
        : mathml(print(es, names, Format::mathml)), latex(print(es, names, Format::latex)), text(print(es, names, Format::text)) {}
  };

  std::string lines(const Derivation& d, const std::vector<Line>& list, bool zero) const {
    Column left, right;
    for (const Line& l : list) left.push_back(l.left ? *l.left : l.right), right.push_back(l.right);
    if (left.empty()) return "";
    const Prints a(left, d.names), b(right, d.names);
    std::string out;
    for (std::size_t k = 0; k < list.size(); ++k)
      out += zero ? equation(user(list[k].name), wrapping_math(a.mathml[k]), math("<mn>0</mn>"), a.latex[k] + " = 0", a.text[k] + " = 0")
             : list[k].left ? equation(user(list[k].name), wrapping_math(a.mathml[k]), wrapping_math(b.mathml[k]), a.latex[k] + " = " + b.latex[k], a.text[k] + " = " + b.text[k])
                            : equation(user(list[k].name), math("<mtext>" + xml_escape(list[k].name) + "</mtext>"), wrapping_math(b.mathml[k]), b.latex[k], list[k].name + " = " + b.text[k]);
    return out;
  }

  std::string parts(const Derivation& d) const {
    constexpr std::size_t kMost = 200;
    if (d.parts.empty()) return "";
    if (d.parts.size() > kMost)
      return "<p class=\"note\">The names stand for " + std::to_string(d.parts.size()) + " parts: <code>anholon derive " + html_escape(p_.source.name) + " --form " + d.form->name + " --expand parts</code> prints them.</p>\n";
    const std::vector<std::string> mathml = print_contents(d.parts, d.names, Format::mathml), latex = print_contents(d.parts, d.names, Format::latex),
                                   text = print_contents(d.parts, d.names, Format::text);
    std::string out = "<details><summary>" + std::to_string(d.parts.size()) + " parts, each with a name</summary>\n";
    for (std::size_t k = 0; k < d.parts.size(); ++k) {
      const std::string& name = d.names.defined.at(d.parts[k].id);
      out += equation("", math(mathml_name(name)), wrapping_math(mathml[k]), latex_name(name) + " = " + latex[k], name + " = " + text[k]);
    }
    return out + "</details>\n";
  }

  std::string masses(const Derivation& d) const {
    std::string out;
    for (std::size_t k = 0; k < model_.masses.size(); ++k) {
      SymbolNames plain = model_.names;
      plain.defined.erase(model_.masses[k].value.id);
      const Expr m = model_.masses[k].value;
      out += equation("", math(mathml_name(d.names.masses[k])), wrapping_math(print(m, plain, Format::mathml)), latex_name(d.names.masses[k]) + " = " + print(m, plain, Format::latex),
                      d.names.masses[k] + " = " + print(m, plain, Format::text));
    }
    return out;
  }

  std::string equations() const {
    std::string out;
    for (std::size_t k = 0; k < p_.equations.size(); ++k) {
      const Derivation& d = p_.equations[k];
      out += "<article class=\"form\"><h3>" + html_escape(d.form->title) + "</h3><p class=\"source\">" + html_escape(citation(*d.form)) + "</p>\n";
      if (k < p_.eliminations.size() && !p_.eliminations[k].empty()) out += "<p>" + user(p_.eliminations[k]) + "</p>\n";
      out += lines(d, d.equations, false);
      if (!d.constraints.empty()) out += "<h4>with the constraints</h4>\n" + lines(d, d.constraints, true);
      out += parts(d);
      for (const auto& [heading, list] : d.steps)
        if (!list.empty()) out += "<details><summary>" + user(sentence(heading)) + "</summary>\n" + lines(d, list, false) + "</details>\n";
      out += "</article>\n";
    }
    if (!p_.equations.empty() && !model_.masses.empty()) out += "<article class=\"form\"><h4>Masses</h4>\n" + masses(p_.equations[0]) + "</article>\n";
    return out;
  }

  // ---- structure --------------------------------------------------------------------------------

  std::string structure() const {
    const Scenario& s = *p_.cases[0].scenario;
    const Structure& x = s.structure;
    constexpr std::size_t kMost = 24;
    if (x.sigma.empty()) return "";
    if (x.sigma.size() > kMost) return "<p>" + std::to_string(x.sigma.size()) + " equations; <code>anholon check</code> prints their signature.</p>\n";
    std::vector<std::string> head = {""};
    const auto unknown = [&](std::size_t j) { return math(print(s.system.symbol(j, 0), model_.names, Format::mathml)); };
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
    return "<p>Which derivative of which unknown each equation holds (signature), and how often an equation is differentiated (<i>c</i>) and an unknown solved for (<i>d</i>). "
           "The bold entries are the transversal of highest value.</p>\n" + table("Signature and offsets of " + std::string(s.system.form->title), head, rows);
  }

  // ---- proof ------------------------------------------------------------------------------------

  std::string proof() const {
    if (!p_.proof) return p_.no_proof.empty() ? "" : "<p>" + user(p_.no_proof) + "</p>\n";
    const Proof& proof = *p_.proof;
    std::string out = "<p>Every form against every other, by exact algebra: <b class=\"eq\">=</b> proved equal, <b class=\"ne\">≠</b> shown different at a point, <b>?</b> not decided.</p>\n";
    out += "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Proof matrix\"><table class=\"matrix\"><caption>Proof matrix</caption><thead><tr><th></th><th></th>";
    for (std::size_t k = 0; k < proof.forms.size(); ++k) out += "<th scope=\"col\" title=\"" + html_escape(proof.forms[k].form->title) + "\">" + std::to_string(k + 1) + "</th>";
    out += "</tr></thead><tbody>\n";
    for (std::size_t i = 0; i < proof.forms.size(); ++i) {
      out += "<tr><th scope=\"row\">" + std::to_string(i + 1) + "</th><th scope=\"row\" class=\"form\">" + html_escape(proof.forms[i].form->title) + "</th>";
      for (std::size_t j = 0; j < proof.forms.size(); ++j) {
        const Verdict v = i == j ? Verdict::proved : proof.between(i, j);
        out += i == j ? "<td class=\"self\">·</td>" : v == Verdict::proved ? "<td class=\"eq\">=</td>" : v == Verdict::refuted ? "<td class=\"ne\">≠</td>" : "<td>?</td>";
      }
      out += "</tr>\n";
    }
    out += "</tbody></table></div>\n";
    for (const FormProof& f : proof.forms)
      for (const Difference& d : f.differences) {
        if (d.verdict == Verdict::proved) continue;
        out += "<p>" + html_escape(f.form->title) + (d.verdict == Verdict::refuted ? " differ" : " may differ") + " from Routh's equations in the equation of " + user(d.component) + ": " + user(d.detail) + ".</p>\n";
        break;
      }
    if (!p_.meaning.empty()) out += "<p>" + user(p_.meaning) + "</p>\n";
    if (!p_.hypotheses.empty()) {
      out += "<p>Given:</p><ul>";
      for (const std::string& h : p_.hypotheses) out += "<li>" + user(h) + "</li>";
      out += "</ul>\n";
    }
    return out + "<p>The certificate, to be checked by the small program that trusts nobody: <code>anholon prove " + html_escape(p_.source.name) + " -o proof.json</code>, <code>anholon verify proof.json</code>.</p>\n";
  }

  // ---- report -----------------------------------------------------------------------------------

  static std::string number_of(const Json& j, const char* key) { return j.contains(key) && !j[key].is_null() ? html_escape(j[key].is_string() ? j[key].get<std::string>() : j[key].dump()) : "–"; }

  std::string trust() const {
    std::string out = "<p>By another way than the equations that were integrated: Newton's law point by point, and the balance of power, each in relation to its largest term.</p>\n";
    std::vector<std::string> head = {""};
    std::vector<std::vector<std::string>> rows = {{"Newton's law with ideal reactions"}, {"the same without multipliers"}, {"constraints and their derivatives, at the rows"}, {"before projection"},
                                                  {"balance of power"}, {"digits to trust, estimated"}, {"smallest scaled singular value of the system Jacobian"}, {"steps, order"}};
    for (const PageCase& c : p_.cases) {
      head.push_back(c.name.empty() ? (p_.cases.size() > 1 ? "as the file says" : "") : user(c.name));
      const Json j = report(c);
      const Json residuals = j.value("residuals", Json::object()), error = j.value("error_estimate", Json::object());
      const auto shown = [&](std::size_t k, const std::string& s) { rows[k].push_back(s); };
      shown(0, number_of(residuals, "newton"));
      shown(1, number_of(residuals, "projected"));
      shown(2, number_of(residuals, "constraints"));
      shown(3, number_of(residuals, "constraints_before_projection"));
      shown(4, number_of(residuals, "power"));
      shown(5, error.contains("digits") && !error["digits"].is_null() ? number_of(error, "digits") + ", by " + user(error.value("means", "")) : user(error.value("reason", "not estimated")));
      shown(6, number_of(residuals, "smallest_sigma") + " at t = " + number_of(j, "smallest_sigma_t"));
      shown(7, number_of(j, "steps") + ", " + number_of(j, "order"));
    }
    out += table("Residual report", p_.cases.size() > 1 ? head : std::vector<std::string>{}, rows);
    for (const PageCase& c : p_.cases) out += watched(c);
    return out;
  }

  std::string watched(const PageCase& c) const {
    const Json j = report(c);
    std::string out;
    std::vector<std::vector<std::string>> rows;
    for (const char* list : {"conserved", "monitors"}) {
      const Json all = j.value(list, Json::object());
      for (const auto& [name, w] : all.items())
        rows.push_back({user(name), number_of(w, "first"), number_of(w, "last"), number_of(w, "min"), number_of(w, "max"), number_of(w, "largest_change")});
    }
    out += table("Integrals of the motion and what was watched" + (c.name.empty() ? "" : ", " + html_escape(c.name)), {"", "first", "last", "least", "greatest", "largest change, relative"}, rows);
    std::vector<std::vector<std::string>> events;
    const Json fired = j.value("events", Json::array());
    for (const Json& e : fired) {
      std::string set;
      const Json changes = e.value("set", Json::object());
      for (const auto& [name, change] : changes.items())
        set += (set.empty() ? "" : ", ") + user(name) + " " + number_of(change, "before") + " → " + number_of(change, "after");
      events.push_back({user(e.value("name", "")), number_of(e, "t"), set});
      if (events.size() == 50) break;
    }
    out += table("Events" + (c.name.empty() ? "" : ", " + html_escape(c.name)), {"", "t", "what was set"}, events);
    const Json warnings = j.value("warnings", Json::array());
    for (const Json& w : warnings)
      out += "<p class=\"warning\" role=\"note\" dir=\"auto\">" + html_escape(w.value("message", "")) + " <span class=\"hint\">" + html_escape(w.value("hint", "")) + "</span></p>\n";
    return out;
  }

  // ---- the rest ---------------------------------------------------------------------------------

  std::string again() const {
    std::string out = "<pre class=\"command\"><code>" + html_escape(p_.command) + "</code></pre>\n<p>" + html_escape(p_.version) + "; SHA-256 of the model <code class=\"hash\">" + html_escape(p_.model_hash) +
                      "</code>.</p>\n";
    for (const PageCase& c : p_.cases)
      if (!c.run.command.empty() && c.run.command != p_.command) out += "<p>The run: <code>" + html_escape(c.run.command) + "</code></p>\n";
    const auto file = [&](const SourceText& s) {
      out += "<details><summary>The model file " + user(s.name) + "</summary><pre dir=\"ltr\"><code>" + html_escape(s.text) + "</code></pre></details>\n";
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
    for (const PageCase& c : p_.cases) {
      const Json j = report(c);
      const std::string text = j.dump();
      if (text.find("cvode") != std::string::npos || text.find("\"ida\"") != std::string::npos || text.find("bdf") != std::string::npos) literature_.key("Hindmarsh2005");
      if (text.find("\"rk\"") != std::string::npos) literature_.key("PrinceDormand1981");
    }
    literature_.key("JorbaZou2005");
    literature_.key("Neumaier1974");
  }

  std::string literature_list() const {
    std::string out = "<ol class=\"literature\">";
    for (const std::string& e : literature_.entries()) out += "<li dir=\"auto\">" + html_escape(e) + "</li>\n";
    return out + "</ol>\n";
  }

  // ---- data of the viewer -----------------------------------------------------------------------

  std::string data() const {
    JsonWriter j;
    j.open_object().key("format").integer(1).key("title").string(title()).key("cases").open_array();
    for (const PageCase& c : p_.cases) case_data(j, c);
    j.close().close();
    // "</script>" in a name must not end the element.
    std::string out;
    for (char ch : j.text()) out += ch == '<' ? "\\u003c" : std::string(1, ch);
    return out;
  }

  void case_data(JsonWriter& j, const PageCase& c) const {
    const Scenario& s = *c.scenario;
    const Graph& g = *s.model->graph;
    const Scene picture = scene(*s.mechanics);
    const PlotData d = plot_data(s, c.conserved, c.run, picture);
    const auto numbers = [&](const char* key, const std::vector<double>& list) { j.key(key).string(base64(list)); };
    const bool units = !s.model->coordinate_units.empty();
    j.open_object().key("name").string(c.name).key("rows").integer(static_cast<long long>(d.rows)).key("shown").integer(static_cast<long long>(d.shown));
    numbers("t", d.t);
    j.key("unit").string(units ? "s" : "").key("columns").open_array();
    for (const PlotColumn& k : d.columns) {
      j.open_object().key("name").string(k.name).key("html").string("<math>" + k.math + "</math>").key("unit").string(k.unit).key("group").string(k.group);
      numbers("data", k.values);
      if (!k.t.empty()) numbers("t", k.t);
      j.close();
    }
    j.close().key("groups").open_array();
    for (const PlotGroup& k : d.groups) j.open_object().key("id").string(k.id).key("title").string(k.title).key("log").boolean(k.log).close();
    j.close().key("left_out").integer(static_cast<long long>(d.left_out)).key("frames");
    if (d.frame_t.empty()) j.null();
    else {
      j.open_object();
      numbers("t", d.frame_t);
      j.key("data").open_object();
      for (const auto& [column, values] : d.frames) j.key(std::to_string(column)).string(base64(values));
      j.close().close();
    }
    j.key("events").open_array();
    const Json events = report(c).value("events", Json::array());
    for (const Json& e : events) j.open_object().key("t").number(number_of(e, "t")).key("name").string(e.value("name", "")).close();
    j.close().key("scene");
    // In the page the time is no column.
    const ColumnOf in_table = column_of(*s.model, c.run.table);
    const ColumnOf column = [&](const Node& n) -> std::optional<int> {
      const auto k = in_table(n);
      return k && *k >= 0 ? std::optional<int>(*k - 1) : k;
    };
    write_scene(j, picture, g, column, s.model->observer.inertial ? std::function<void(JsonWriter&)>() : [&](JsonWriter& w) { observer(w, s, d); });
    j.close();
  }

  static void observer(JsonWriter& j, const Scenario& s, const PlotData& d) {
    const std::vector<double>& all = d.frame_t.empty() ? d.t : d.frame_t;
    const std::vector<ObserverPose> poses = observer_path(*s.model, parameter_values<double>(*s.model), all);
    std::vector<double> quaternions, origins;
    for (const ObserverPose& p : poses) {
      quaternions.insert(quaternions.end(), p.quaternion.begin(), p.quaternion.end());
      origins.insert(origins.end(), p.origin.begin(), p.origin.end());
    }
    j.open_object().key("t").string(base64(all)).key("quaternion").string(base64(quaternions)).key("origin").string(base64(origins)).close();
  }

  const Page& p_;
  const Model& model_;
  Bibliography literature_;
  std::string contents_;
};

}  // namespace

std::string html(const Page& page) { return Writer(page).write(); }

std::string stage_html(const Page& page, bool dark, const std::string& script) { return Writer(page).stage(dark, script); }

std::string html_escape(const std::string& text) {
  std::string out;
  for (char c : text) switch (c) {
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '&': out += "&amp;"; break;
      case '"': out += "&quot;"; break;
      case '\'': out += "&#39;"; break;
      default: out += c;
    }
  return out;
}

}  // namespace anholon

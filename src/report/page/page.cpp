#include "report/page/page.h"

#include <algorithm>

#include "report/assets.h"
#include "report/bibliography.h"
#include "report/markup.h"
#include "report/page/data.h"
#include "report/page/sections.h"
#include "simulation/report_json.h"

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

// The frame of a page: its head, the contents, the sections in turn, the literature.
class PageWriter {
 public:
  explicit PageWriter(const Page& p) : p_(p), model_(*p.cases[0].scenario->model) {
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
    section("motion", "Motion", motion_section(p_, reports_));
    section("system", "System", system_section(p_));
    section("equations", "Equations of motion", equations_section(p_));
    section("structure", "Structure", structure_section(p_));
    section("proof", "Proof that the forms agree", proof_section(p_));
    section("report", "How far the motion can be trusted", trust_section(p_, reports_));
    section("again", "To make it again", again_section(p_));
    section("literature", "Literature", literature_list());

    std::string out = "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
                      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<meta "
                      "name=\"color-scheme\" content=\"light dark\">\n";
    out += "<meta name=\"generator\" content=\"" + markup_escape(p_.version) + "\">\n<title>" +
           markup_escape(page_title(p_)) + "</title>\n";
    out += "<style>\n" + std::string(page_style()) + std::string(viewer_style()) + "</style>\n</head>\n<body>\n";
    out += "<a class=\"skip\" href=\"#motion\">Skip to the motion</a>\n<header class=\"page\">\n<div "
           "class=\"tools\"></div>\n";
    out += "<h1 dir=\"auto\">" + markup_escape(page_title(p_)) + "</h1>\n";
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
  // Cites the sources of the page.
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
  CaseReports reports_;
  Bibliography literature_;
  std::string contents_;
};

}  // namespace

std::string warning_box(const Warning& w) {
  std::string out = "<p class=\"warning\" role=\"note\" dir=\"auto\">" + markup_escape(w.message);
  if (!w.hint.empty()) out += " <span class=\"hint\">hint: " + markup_escape(w.hint) + "</span>";
  return out + "</p>\n";
}

std::string sentence(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text + ".";
}

std::string again_section(const Page& page) {
  std::string out = "<pre class=\"command\"><code>" + markup_escape(page.command) + "</code></pre>\n<p>" +
                    markup_escape(page.version) + "; SHA-256 of the model <code class=\"hash\">" +
                    markup_escape(page.model_hash) + "</code>.</p>\n";
  for (const PageCase& c : page.cases)
    if (!c.run.command.empty() && c.run.command != page.command)
      out += "<p>The run: <code>" + markup_escape(c.run.command) + "</code></p>\n";
  const auto file = [&](const SourceText& s) {
    out += "<details><summary>The model file " + user(s.name) + "</summary><pre dir=\"ltr\"><code>" +
           markup_lines(s.text) + "</code></pre></details>\n";
  };
  file(page.source);
  for (const SourceText& s : page.source.others) file(s);
  return out;
}

std::string html(const Page& page) { return PageWriter(page).write(); }

std::string stage_html(const Page& page, bool dark, const std::string& script) {
  std::string out = "<!doctype html>\n<html lang=\"en\" data-theme=\"" + std::string(dark ? "dark" : "light") +
                    "\">\n<head>\n<meta charset=\"utf-8\">\n<title>" + markup_escape(page_title(page)) + "</title>\n";
  out += "<style>\n" + std::string(page_style()) + std::string(viewer_style()) +
         "</style>\n</head>\n<body>\n<div class=\"player\" data-case=\"0\"></div>\n";
  out += "<script type=\"application/json\" id=\"anholon-data\">" + page_data(page) + "</script>\n<script>" +
         std::string(viewer_script()) + "</script>\n<script>\n" + script + "</script>\n";
  return out + "</body>\n</html>\n";
}

}  // namespace anholon

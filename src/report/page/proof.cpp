#include "base/base64.h"
#include "report/markup.h"
#include "report/page/sections.h"

namespace anholon {

namespace {

// Returns a table of every form against every other.
std::string matrix(const Proof& proof) {
  std::string out = "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Proof matrix\"><table "
                    "class=\"matrix\"><caption>Proof matrix</caption><thead><tr><td></td><td></td>";
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
  return out;
}

// The certificate in the page itself, if it is not too long.
std::string certificate(const Page& p) {
  constexpr std::size_t kMost = 240'000;
  if (p.certificate.empty()) return "";
  const std::string source = p.source.name.substr(p.source.name.rfind('/') + 1),
                    name = source.substr(0, source.rfind('.')) + ".proof.json";
  std::string out =
      "<p>The certificate holds " + std::to_string(p.claims) + " claims, " +
      (p.confirmed == p.claims ? "all" : std::to_string(p.confirmed)) +
      " confirmed when this page was made by the checker, which shares nothing with the prover. To check it again: ";
  if (p.certificate.size() <= kMost)
    out += "<a" + attribute("download", name) + " href=\"data:application/json;base64," + to_base64(p.certificate) +
           "\">save " + user(name) + "</a> (" + std::to_string((p.certificate.size() + 999) / 1000) + " kB), ";
  else
    out += "<code>anholon prove " + markup_escape(p.source.name) + " -o " + markup_escape(name) + "</code>, ";
  return out + "<code>anholon verify " + markup_escape(name) + "</code>.</p>\n";
}

}  // namespace

std::string proof_section(const Page& p) {
  if (!p.proof) return p.no_proof.empty() ? "" : "<p>" + user(p.no_proof) + "</p>\n";
  const Proof& proof = *p.proof;
  std::string out = "<p>Every form against every other, by exact algebra: <b class=\"eq\">=</b> proved equal, <b "
                    "class=\"ne\">≠</b> shown different at a point, <b>?</b> not decided.</p>\n";
  out += matrix(proof);
  for (const FormProof& f : proof.forms)
    for (const Difference& d : f.differences) {
      if (d.verdict == Verdict::proved) continue;
      out += "<p>" + markup_escape(f.form->title) + (d.verdict == Verdict::refuted ? " differ" : " may differ") +
             " from Routh's equations in the equation of " + user(d.component) + ": " + user(d.detail) + ".</p>\n";
      break;
    }
  if (!p.meaning.empty()) out += "<p>" + user(p.meaning) + "</p>\n";
  if (!p.hypotheses.empty()) {
    out += "<p>Given:</p><ul>";
    for (const std::string& h : p.hypotheses) out += "<li>" + user(h) + "</li>";
    out += "</ul>\n";
  }
  return out + certificate(p);
}

}  // namespace anholon

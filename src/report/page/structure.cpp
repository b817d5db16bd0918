#include "report/markup.h"
#include "report/page/sections.h"
#include "structure/blocks.h"

namespace anholon {

std::string structure_section(const Page& page) {
  const SymbolNames& names = page.cases[0].scenario->model->names;
  const Scenario& s = *page.cases[0].scenario;
  const Structure& x = s.structure;
  constexpr std::size_t kMost = 24;
  if (x.sigma.empty()) return "";
  if (x.sigma.size() > kMost)
    return "<p>" + std::to_string(x.sigma.size()) +
           " equations; <code>anholon check</code> prints their signature.</p>\n";
  std::vector<std::string> head = {""};
  const auto unknown = [&](std::size_t j) { return math(print(s.system.symbol(j, 0), names, Format::mathml)); };
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

}  // namespace anholon

#include "print/print_names.h"
#include "report/bibliography.h"
#include "report/markup.h"
#include "report/math_lines.h"
#include "report/page/sections.h"

namespace anholon {

namespace {

// The equations of each form, with their parts and the steps of their derivation.
class EquationsSection {
 public:
  explicit EquationsSection(const Page& page) : p_(page), model_(*page.cases[0].scenario->model) {}

  std::string write() const {
    std::string out;
    for (const ModelNote& note : model_.notes) out += "<p>" + user(sentence(note.text)) + "</p>\n";
    for (std::size_t k = 0; k < p_.equations.size(); ++k) {
      const Derivation& d = p_.equations[k];
      out += "<article class=\"form\"><h3>" + markup_escape(d.form->title) + "</h3><p class=\"source\">" +
             markup_escape(citation(*d.form)) + "</p>\n";
      if (k < p_.eliminations.size() && !p_.eliminations[k].empty()) out += "<p>" + user(p_.eliminations[k]) + "</p>\n";
      out += lines(d, d.equations, false);
      if (!d.constraints.empty()) out += "<h4>with the constraints</h4>\n" + lines(d, d.constraints, true);
      if (!d.rates.empty()) out += "<h4>with the rates of the states</h4>\n" + lines(d, d.rates, false);
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

 private:
  // Writes one equation: it wraps, is read out as text, and is copied as LaTeX.
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

  const Page& p_;
  const Model& model_;
};

}  // namespace

std::string equations_section(const Page& page) { return EquationsSection(page).write(); }

}  // namespace anholon

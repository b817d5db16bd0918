#include "formulation/label.h"

namespace anholon {

namespace {

std::string fraction(const std::string& above, const std::string& below) {
  return "<mfrac><mrow>" + above + "</mrow><mrow>" + below + "</mrow></mfrac>";
}

Label applied(const std::string& text, const std::string& d, const Label& of) {
  return {text + " " + of.text, "\\frac{" + d + "}{" + d + "t} " + of.latex,
          fraction("<mi>" + d + "</mi>", "<mi>" + d + "</mi><mi>t</mi>") + of.mathml};
}

}  // namespace

Label letter(const std::string& name) { return {name, latex_name(name), mathml_name(name)}; }

Label energy(const std::string& name, unsigned k, Over over) {
  Label out = letter(name);
  const std::string order = std::to_string(k), latex = k ? "(" + order + ")" : "",
                    mathml = k ? "<mo>(</mo><mn>" + order + "</mn><mo>)</mo>" : "";
  std::string star_latex, star_mathml;
  switch (over) {
  case Over::nothing:
    break;
  case Over::tilde:
    out = {name + "~", "\\tilde{" + out.latex + "}", "<mover accent=\"true\">" + out.mathml + "<mo>~</mo></mover>"};
    break;
  case Over::star:
    out.text += "*";
    star_latex = "*";
    star_mathml = "<mo>*</mo>";
    break;
  case Over::bar:
    out = {name + "bar", "\\bar{" + out.latex + "}", "<mover accent=\"true\">" + out.mathml + "<mo>¯</mo></mover>"};
    break;
  }
  if (k) out.text += "^(" + order + ")";
  if (!k && star_latex.empty()) return out;
  out.latex += "^{" + star_latex + latex + "}";
  out.mathml = "<msup>" + out.mathml + "<mrow>" + star_mathml + mathml + "</mrow></msup>";
  return out;
}

Label indexed(const Label& of, const std::string& text, const std::vector<Label>& parts) {
  std::string latex, mathml;
  for (const Label& p : parts) {
    latex += (latex.empty() ? "" : ",") + p.latex;
    mathml += (mathml.empty() ? "" : "<mo>,</mo>") + p.mathml;
  }
  return {of.text + "." + text, of.latex + "_{" + latex + "}",
          "<msub><mrow>" + of.mathml + "</mrow><mrow>" + mathml + "</mrow></msub>"};
}

Label with_superscript(const std::string& text, const Label& base, const Label& upper) {
  return {text, base.latex + "^{" + upper.latex + "}",
          "<msup>" + base.mathml + "<mrow>" + upper.mathml + "</mrow></msup>"};
}

Label minus(const Label& of) { return {"-" + of.text, "-" + of.latex, "<mo>-</mo>" + of.mathml}; }

Label operator-(const Label& a, const Label& b) {
  return {a.text + " - " + b.text, a.latex + " - " + b.latex, a.mathml + "<mo>−</mo>" + b.mathml};
}

Label name_of(const Model& model, const std::string& name) { return derivative_of(model, name, 0); }

Label derivative_of(const Model& model, const std::string& name, unsigned k) {
  const auto chosen = model.names.notation.find(name);
  const bool own = chosen != model.names.notation.end();
  return {derivative_name(name, k, Format::text),
          derivative_name(own ? chosen->second.latex : latex_name(name), k, Format::latex),
          derivative_name(own ? chosen->second.mathml : mathml_name(name), k, Format::mathml)};
}

Labels jet_labels(const Mechanics& M, unsigned k) {
  Labels out;
  for (const Coordinate& c : M.model->coordinates) out.push_back(derivative_of(*M.model, c.name, k));
  return out;
}

Labels free_labels(const Mechanics& M, const Elimination& E, unsigned more) {
  Labels out;
  for (std::size_t a = 0; a < E.free.names.size(); ++a)
    out.push_back(derivative_of(*M.model, E.free.names[a], E.free.orders[a] + more));
  return out;
}

Labels pick(const Labels& all, const std::vector<std::size_t>& which) {
  Labels out;
  for (std::size_t a : which) out.push_back(all[a]);
  return out;
}

Label partial(const Label& of, const Label& by) {
  return {"d " + of.text + "/d " + by.text, "\\frac{\\partial " + of.latex + "}{\\partial " + by.latex + "}",
          fraction("<mo>∂</mo>" + of.mathml, "<mo>∂</mo>" + by.mathml)};
}

Labels partial(const Label& of, const Labels& by) {
  Labels out;
  for (const Label& l : by) out.push_back(partial(of, l));
  return out;
}

Label frozen_rate(const Label& of) { return applied("D/Dt", "D", of); }

Label rate(const Label& of) { return applied("d/dt", "d", of); }

}  // namespace anholon

#include "print/spelling.h"

#include "print/long_name.h"

namespace anholon {

// Converts "\\sin" -> "sin", "\\operatorname{sgn}" -> "sgn".
static std::string function_name(const std::string& latex) {
  const std::size_t brace = latex.find('{');
  return brace == std::string::npos ? latex.substr(1) : latex.substr(brace + 1, latex.size() - brace - 2);
}

static bool ends_with_long_name(const std::string& mathml) {
  const std::size_t last = mathml.rfind("<mi");
  return last != std::string::npos && is_long_name(std::string_view(mathml).substr(last));
}

// True if the text begins with a long name; scripts, accents and rows begin with their first child.
static bool begins_with_long_name(std::string_view mathml) {
  for (bool goes_on = true; goes_on;) {
    goes_on = false;
    for (const std::string_view open : {"<msub>", "<msup>", "<msubsup>", "<mrow>"})
      if (mathml.substr(0, open.size()) == open) mathml.remove_prefix(open.size()), goes_on = true;
  }
  const std::size_t end = mathml.find("</mi>");
  return end != std::string_view::npos && is_long_name(mathml.substr(0, end + 5));
}

std::string Spelling::cut(std::string s) const {
  if (s.size() <= longest_) return s;
  return mathml() ? "<mtext>…</mtext>" : "…";
}

std::string Spelling::brackets(const std::string& s) const {
  if (mathml()) return row("<mo>(</mo>" + s + "<mo>)</mo>");
  return latex() ? "\\left(" + s + "\\right)" : "(" + s + ")";
}

std::string Spelling::call(const std::string& name, const std::string& latex_text, const std::string& arguments) const {
  if (mathml()) return cut("<mi>" + function_name(latex_text) + "</mi><mo>&#x2061;</mo>" + brackets(arguments));
  return cut((latex() ? latex_text : name) + brackets(arguments));
}

std::string Spelling::fraction(const std::string& top, const std::string& bottom) const {
  if (mathml()) return "<mfrac>" + row(top) + row(bottom) + "</mfrac>";
  return latex() ? "\\frac{" + top + "}{" + bottom + "}" : top + "/" + bottom;
}

Printed Spelling::number(const Rational& r) const {
  if (r < 0) return negated(number(-r));
  if (r.is_integer()) return {whole(r.get_num())};
  return {fraction(whole(r.get_num()), whole(r.get_den())), kProduct};
}

std::string Spelling::join(const std::string& a, const std::string& b) const {
  if (a.empty() || b.empty()) return a + b;
  if (!mathml()) return a + (latex() ? " \\, " : "*") + b;
  // A name of several letters is spaced from its neighbours, which MathML Core does not do: m sin, mass u.
  const bool wide = ends_with_long_name(a) || begins_with_long_name(b);
  return a + (wide ? "<mo rspace=\"0.1667em\">&#x2062;</mo>" : "<mo>&#x2062;</mo>") + b;
}

Printed Spelling::power(const Printed& base, const Rational& exponent) const {
  if (exponent == 1) return base;
  if (exponent == Rational(1, 2)) {
    if (mathml()) return {"<msqrt>" + base.text + "</msqrt>"};
    return {latex() ? "\\sqrt{" + base.text + "}" : "sqrt(" + base.text + ")"};
  }
  const std::string b = wrap(base, kAtom);
  if (mathml()) return {"<msup>" + row(b) + row(number(exponent).text) + "</msup>", kPower};
  if (latex()) return {"{" + b + "}^{" + exponent.get_str() + "}", kPower};
  const bool plain = exponent.is_integer() && exponent > 0;
  return {b + "^" + (plain ? exponent.get_str() : "(" + exponent.get_str() + ")"), kPower};
}

std::string Spelling::weighted(const Rational& c, const Printed& p) const {
  const std::string body = p.opposite.empty() ? wrap(p, kProduct) : wrap(p.opposite, p.opposite_strength, kProduct);
  if (c == 1) return body;
  if (c.is_integer()) return join(whole(c.get_num()), body);
  if (format_ != Format::text) return join(number(c).text, body);
  const std::string top = c.get_num() == 1 ? body : join(whole(c.get_num()), body);
  return top + "/" + c.get_den().get_str();
}

// Returns a term of an exponent without its sign.
static Printed term_of_exponent(const Spelling& s, const std::unordered_map<NodeId, Printed>& of,
                                const FactorOfExponent& f) {
  const Rational c = abs(f.factor);
  if (f.of.size() == 1 && f.of[0].second == 1) {
    const Printed& p = of.at(f.of[0].first);
    if (c == 1) return p.strength < kProduct ? Printed{s.brackets(p.text)} : Printed{p.text, p.strength};
    return {p.opposite.empty() ? s.weighted(c, p) : s.join(s.number(c).text, s.brackets(p.text)), kProduct};
  }
  std::string all = c == 1 ? "" : s.wrap(s.number(c), c.is_integer() ? kAtom : kPower);
  for (const auto& [node, exponent] : f.of) all = s.join(all, s.wrap(s.power(of.at(node), exponent), kPower));
  return {all, kProduct};
}

Printed text_of(const Spelling& s, const std::unordered_map<NodeId, Printed>& of, const GeneralPower& p) {
  Printed exponent;
  for (const FactorOfExponent& f : p.terms) {
    const Printed one = term_of_exponent(s, of, f);
    const bool first = exponent.text.empty();
    exponent.text += f.factor < 0 ? first ? s.minus() : s.minus_between() : first ? "" : s.plus_between();
    exponent.text += one.text;
    exponent.strength = first && f.factor > 0 ? one.strength : kSum;
  }
  if (p.constant != 0) {
    exponent.text += (p.constant < 0 ? s.minus_between() : s.plus_between()) + s.number(abs(p.constant)).text;
    exponent.strength = kSum;
  }
  const std::string base = s.wrap(of.at(p.base), kAtom);
  if (s.mathml()) return {"<msup>" + row(base) + row(exponent.text) + "</msup>", kPower};
  if (s.latex()) return {"{" + base + "}^{" + exponent.text + "}", kPower};
  return {s.cut(base + "^" + s.wrap(exponent, kAtom)), kPower};
}

}  // namespace anholon

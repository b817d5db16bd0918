#include "modelfile/names/notation.h"

#include <algorithm>
#include <cctype>

#include "base/utf8.h"
#include "modelfile/text/collect.h"

namespace anholon {

namespace {

using Named = std::pair<const char*, const char*>;

constexpr Named kLetters[] = {
    {"alpha", "α"},    {"beta", "β"},    {"gamma", "γ"},  {"delta", "δ"},    {"epsilon", "ϵ"},  {"varepsilon", "ε"},
    {"zeta", "ζ"},     {"eta", "η"},     {"theta", "θ"},  {"vartheta", "ϑ"}, {"iota", "ι"},     {"kappa", "κ"},
    {"varkappa", "ϰ"}, {"lambda", "λ"},  {"mu", "μ"},     {"nu", "ν"},       {"xi", "ξ"},       {"pi", "π"},
    {"varpi", "ϖ"},    {"rho", "ρ"},     {"varrho", "ϱ"}, {"sigma", "σ"},    {"varsigma", "ς"}, {"tau", "τ"},
    {"upsilon", "υ"},  {"phi", "ϕ"},     {"varphi", "φ"}, {"chi", "χ"},      {"psi", "ψ"},      {"omega", "ω"},
    {"Gamma", "Γ"},    {"Delta", "Δ"},   {"Theta", "Θ"},  {"Lambda", "Λ"},   {"Xi", "Ξ"},       {"Pi", "Π"},
    {"Sigma", "Σ"},    {"Upsilon", "Υ"}, {"Phi", "Φ"},    {"Psi", "Ψ"},      {"Omega", "Ω"},    {"ell", "ℓ"},
    {"hbar", "ℏ"},     {"partial", "∂"}, {"infty", "∞"}};
constexpr Named kSigns[] = {{"prime", "′"},    {"ast", "∗"},  {"star", "⋆"},
                            {"parallel", "∥"}, {"perp", "⊥"}, {"circ", "∘"}};
constexpr Named kAccents[] = {{"bar", "¯"}, {"overline", "¯"}, {"hat", "^"}, {"tilde", "~"}, {"vec", "→"}};
constexpr Named kStyles[] = {
    {"mathrm", "normal"}, {"text", "normal"}, {"mathbf", "bold"}, {"mathcal", "script"}, {"mathsf", "sans-serif"}};

template <std::size_t N>
const char* find(const Named (&list)[N], const std::string& name) {
  for (const Named& n : list)
    if (name == n.first) return n.second;
  return nullptr;
}

class Latex {
 public:
  explicit Latex(const FormulaText& source) : source_(source), text_(source.text()) {}

  std::string run() {
    const std::string out = sequence(false);
    if (out.empty()) throw Failure(source_.whole(), "this notation is empty");
    return out;
  }

 private:
  [[noreturn]] void fail(std::string message, std::string hint = {}) const {
    throw Failure(source_.span(utf8_length(text_.substr(0, at_)), 1), std::move(message), std::move(hint));
  }
  bool end() const { return at_ >= text_.size(); }
  static std::string row(const std::string& parts) { return "<mrow>" + parts + "</mrow>"; }

  // Reads up to the end, or up to the closing brace.
  std::string sequence(bool braced) {
    if (++depth_ > 20) fail("nested deeper than 20 levels");
    std::string out;
    std::size_t count = 0;
    for (; !end() && text_[at_] != '}'; ++count) {
      if (text_[at_] == ' ') {
        ++at_, --count;
        continue;
      }
      out += item();
    }
    if (braced && end()) fail("'}' is missing");
    if (!braced && !end()) fail("'}' closes nothing");
    --depth_;
    return count > 1 ? row(out) : out;
  }

  std::string group() {
    while (!end() && text_[at_] == ' ') ++at_;
    if (end()) fail("something is missing at the end");
    if (text_[at_] != '{') return atom();
    ++at_;
    const std::string out = sequence(true);
    ++at_;
    return out.empty() ? row("") : out;
  }

  std::string item() {
    const std::string base = group();
    std::string below, above;
    while (!end() && (text_[at_] == '_' || text_[at_] == '^')) {
      std::string& place = text_[at_] == '_' ? below : above;
      if (!place.empty()) fail("two of these on one letter");
      ++at_;
      place = group();
    }
    if (!below.empty() && !above.empty()) return "<msubsup>" + base + below + above + "</msubsup>";
    if (!below.empty()) return "<msub>" + base + below + "</msub>";
    return above.empty() ? base : "<msup>" + base + above + "</msup>";
  }

  std::string atom() {
    const char c = text_[at_];
    if (c == '\\') return command();
    if (std::isdigit(static_cast<unsigned char>(c))) {
      std::string digits;
      for (; !end() && std::isdigit(static_cast<unsigned char>(text_[at_])); ++at_) digits += text_[at_];
      return "<mn>" + digits + "</mn>";
    }
    if (std::isalpha(static_cast<unsigned char>(c))) {
      ++at_;
      return std::string("<mi>") + c + "</mi>";
    }
    if (c == '+' || c == '-' || c == '*' || c == ',') {
      ++at_;
      return std::string("<mo>") + (c == '-' ? "−" : std::string(1, c)) + "</mo>";
    }
    fail("'" + text_.substr(at_, utf8_width(text_, at_)) + "' means nothing in a notation",
         "letters, digits, \\theta, \\mathrm{in}, \\bar{x}, _ and ^");
  }

  std::string command() {
    const std::size_t start = at_++;
    std::string name;
    for (; !end() && std::isalpha(static_cast<unsigned char>(text_[at_])); ++at_) name += text_[at_];
    if (const char* letter = find(kLetters, name)) return std::string("<mi>") + letter + "</mi>";
    if (const char* sign = find(kSigns, name)) return std::string("<mo>") + sign + "</mo>";
    if (const char* accent = find(kAccents, name)) {
      const std::string base = group();
      return "<mover accent=\"true\">" + base + "<mo>" + accent + "</mo></mover>";
    }
    if (const char* style = find(kStyles, name)) {
      if (end() || text_[at_] != '{') fail("'{' is expected after \\" + name);
      std::string word;
      for (++at_; !end() && text_[at_] != '}'; ++at_) {
        const char c = text_[at_];
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != ' ' && c != '-' && c != '.')
          fail(std::string("'") + c + "' means nothing in \\" + name + "{…}");
        word += c;
      }
      if (end()) fail("'}' is missing");
      ++at_;
      return std::string("<mi mathvariant=\"") + style + "\">" + word + "</mi>";
    }
    std::vector<std::string> known;
    for (const Named& n : kLetters) known.emplace_back(n.first);
    for (const Named& n : kSigns) known.emplace_back(n.first);
    for (const Named& n : kAccents) known.emplace_back(n.first);
    for (const Named& n : kStyles) known.emplace_back(n.first);
    at_ = start;
    const std::string near = did_you_mean(name, known);
    fail("\\" + name + " is not read in a notation" + (near.empty() ? "" : "; did you mean '\\" + near + "'?"),
         "letters of the Greek alphabet, \\bar, \\hat, \\tilde, \\vec, \\mathrm, \\mathbf, _ and ^");
  }

  const FormulaText& source_;
  const std::string& text_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace

std::string mathml_of(const FormulaText& latex) { return Latex(latex).run(); }

void read_notation(const Item& section, Model& model, const std::vector<std::string>& declared,
                   Diagnostics& diagnostics) {
  std::vector<std::string> known = declared;
  for (const auto* list : {&model.names.coordinates, &model.names.parameters, &model.names.given, &model.names.quasi,
                           &model.names.multipliers})
    known.insert(known.end(), list->begin(), list->end());
  for (const Item& i : section.items)
    collect(diagnostics, [&] {
      if (std::find(known.begin(), known.end(), i.key) == known.end()) {
        const std::string near = did_you_mean(i.key, known);
        throw Failure(i.key_span, "there is no name '" + i.key.substr(0, 60) + "' to be written" +
                                      (near.empty() ? "" : "; did you mean '" + near + "'?"));
      }
      if (i.kind != Item::Kind::string)
        throw Failure(i.span, "a notation is a text of LaTeX", "theta = \"\\\\vartheta\", or theta = '\\vartheta'");
      model.names.notation[i.key] = {i.text(), mathml_of(i.formula)};
    });
}

}  // namespace anholon

#include "print/print_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <vector>

#include "print/long_name.h"

namespace anholon {

static const std::array kGreekNames = {
    "alpha", "beta",  "gamma", "delta", "epsilon", "zeta",  "eta", "theta",   "iota", "kappa", "lambda",
    "mu",    "nu",    "xi",    "pi",    "rho",     "sigma", "tau", "upsilon", "phi",  "chi",   "psi",
    "omega", "Gamma", "Delta", "Theta", "Lambda",  "Xi",    "Pi",  "Sigma",   "Phi",  "Psi",   "Omega"};

static const std::array<const char*, kGreekNames.size()> kGreekLetters = {
    "α", "β", "γ", "δ", "ε", "ζ", "η", "θ", "ι", "κ", "λ", "μ", "ν", "ξ", "π", "ρ", "σ",
    "τ", "υ", "φ", "χ", "ψ", "ω", "Γ", "Δ", "Θ", "Λ", "Ξ", "Π", "Σ", "Φ", "Ψ", "Ω"};

static bool is_greek(const std::string& s) {
  return std::find(kGreekNames.begin(), kGreekNames.end(), s) != kGreekNames.end();
}

std::optional<std::pair<std::string, std::string>> indexed_name(const std::string& name) {
  const std::size_t open = name.find('['), close = name.find(']');
  if (open == std::string::npos || close == std::string::npos || close < open) return std::nullopt;
  return std::pair{name.substr(0, open) + name.substr(close + 1), name.substr(open + 1, close - open - 1)};
}

// Returns the parts of a subscript: "left_wheel" is "left" and "wheel" on one level, since deeper levels are too small
// to read. An underscore at an end, or beside another, divides nothing.
static std::vector<std::string> parts_of(const std::string& subscript) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t at = 1; at + 1 < subscript.size(); ++at) {
    if (subscript[at] != '_' || subscript[at - 1] == '_' || subscript[at + 1] == '_') continue;
    parts.push_back(subscript.substr(begin, at - begin));
    begin = at + 1;
  }
  parts.push_back(subscript.substr(begin));
  return parts;
}

std::string latex_name(const std::string& name) {
  if (const auto indexed = indexed_name(name)) {
    const auto& [base, index] = *indexed;
    const std::string written = latex_name(base);
    // One subscript holds the subscript of the name and the index: x_{1,3}.
    if (written.find("_{") != std::string::npos && written.back() == '}')
      return written.substr(0, written.size() - 1) + "," + index + "}";
    return written + "_{" + index + "}";
  }
  if (is_greek(name)) return "\\" + name;
  if (name.size() == 1) return name;
  std::size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1]))) --digits;
  const std::size_t underscore = name.find('_');
  if (digits < name.size() && digits > 0 && underscore == std::string::npos)
    return latex_name(name.substr(0, digits)) + "_{" + name.substr(digits) + "}";
  if (underscore != std::string::npos && underscore > 0 && underscore + 1 < name.size()) {
    std::string below;
    for (const std::string& part : parts_of(name.substr(underscore + 1)))
      below += (below.empty() ? "" : "\\,") + latex_name(part);
    return latex_name(name.substr(0, underscore)) + "_{" + below + "}";
  }
  return "\\mathrm{" + latex_escape(name) + "}";
}

std::string mathml_name(const std::string& name) {
  if (const auto indexed = indexed_name(name)) {
    const auto& [base, index] = *indexed;
    std::string own = "<mn>";
    for (const char c : index) own += c == ',' ? std::string("</mn><mo>,</mo><mn>") : std::string(1, c);
    own += "</mn>";
    const std::string written = mathml_name(base), open = "<msub>", close = "</msub>";
    if (written.rfind(open, 0) != 0)
      return open + written + (index.find(',') == std::string::npos ? own : row(own)) + close;
    // The second child, which is the subscript, comes before the index.
    const std::size_t underscore = base.find('_'), digit = base.find_last_not_of("0123456789") + 1;
    const std::string root = mathml_name(base.substr(0, underscore != std::string::npos ? underscore : digit));
    const std::size_t start = open.size() + root.size();
    return open + root + row(written.substr(start, written.size() - start - close.size()) + "<mo>,</mo>" + own) + close;
  }
  const auto greek = std::find(kGreekNames.begin(), kGreekNames.end(), name);
  if (greek != kGreekNames.end())
    return std::string("<mi>") + kGreekLetters[static_cast<std::size_t>(greek - kGreekNames.begin())] + "</mi>";
  std::size_t digits = name.size();
  while (digits > 0 && std::isdigit(static_cast<unsigned char>(name[digits - 1]))) --digits;
  if (digits == 0) return "<mn>" + name + "</mn>";
  if (name.size() == 1) return "<mi>" + markup_escape(name) + "</mi>";
  const std::size_t underscore = name.find('_');
  if (digits < name.size() && underscore == std::string::npos)
    return "<msub>" + mathml_name(name.substr(0, digits)) + "<mn>" + name.substr(digits) + "</mn></msub>";
  if (underscore != std::string::npos && underscore > 0 && underscore + 1 < name.size()) {
    const std::vector<std::string> parts = parts_of(name.substr(underscore + 1));
    std::string below;
    for (const std::string& part : parts)
      below += (below.empty() ? "" : "<mspace width=\"0.1667em\"/>") + mathml_name(part);
    return "<msub>" + mathml_name(name.substr(0, underscore)) + (parts.size() > 1 ? row(below) : below) + "</msub>";
  }
  return "<mi mathvariant=\"normal\">" + markup_escape(name) + "</mi>";
}

// Returns the end of the first element of `mathml`.
static std::size_t first_element(const std::string& mathml) {
  std::size_t at = 0;
  int depth = 0;
  do {
    const std::size_t open = mathml.find('<', at), close = mathml.find('>', open);
    if (open == std::string::npos || close == std::string::npos) return mathml.size();
    if (mathml[open + 1] == '/')
      --depth;
    else if (mathml[close - 1] != '/')
      ++depth;
    at = close + 1;
  } while (depth > 0);
  return at;
}

// Prints a derivative of order 1 to 3 as dots over the letter, not over its index. A name of several letters has primes
// instead, because dots would be over one of its letters. With accent="true" browsers place the dots on the letter,
// where they cannot be read; without it, `scriptlevel` gives the dots their size.
static std::string with_dots(const std::string& name, unsigned order) {
  static const char* const kDots[] = {"˙", "¨", "⃛"};
  static const char* const kPrimes[] = {"′", "″", "‴"};
  for (const std::string tag : {"msub", "msup", "msubsup"}) {
    const std::string open = "<" + tag + ">", close = "</" + tag + ">";
    if (name.rfind(open, 0) != 0) continue;
    const std::string inside = name.substr(open.size(), name.size() - open.size() - close.size());
    const std::size_t end = first_element(inside);
    return open + with_dots(inside.substr(0, end), order) + inside.substr(end) + close;
  }
  // The primes of fonts are raised already.
  if (is_long_name(name)) return name.substr(0, name.rfind("</mi>")) + kPrimes[order - 1] + "</mi>";
  return "<mover>" + name + "<mo stretchy=\"false\" scriptlevel=\"+0\">" + kDots[order - 1] + "</mo></mover>";
}

bool is_long_name(std::string_view element) {
  constexpr std::string_view close = "</mi>";
  if (element.substr(0, 3) != "<mi" || first_element(std::string(element)) != element.size()) return false;
  std::size_t letters = 0;
  for (std::size_t at = element.find('>') + 1; at + close.size() < element.size(); ++at)
    letters += (static_cast<unsigned char>(element[at]) & 0xC0) != 0x80;
  return letters > 1;
}

std::string derivative_name(const std::string& name, unsigned order, Format format) {
  if (order == 0) return name;
  switch (format) {
  case Format::text:
    if (order <= 3) return name + std::string(order, '\'');
    return "D(" + name + "," + std::to_string(order) + ")";
  case Format::latex: {
    static const char* const kDots[] = {"\\dot{", "\\ddot{", "\\dddot{"};
    if (order <= 3) return kDots[order - 1] + name + "}";
    return name + "^{(" + std::to_string(order) + ")}";
  }
  case Format::mathml:
    if (order <= 3) return with_dots(name, order);
    return "<msup>" + name + row("<mo>(</mo><mn>" + std::to_string(order) + "</mn><mo>)</mo>") + "</msup>";
  }
  return name;
}

}  // namespace anholon

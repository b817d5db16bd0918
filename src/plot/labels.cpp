#include "plot/labels.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <utility>

#include "base/escape.h"
#include "base/utf8.h"
#include "print/print.h"

namespace anholon::plot {

namespace {

constexpr std::array<std::pair<const char*, const char*>, 33> kGreek = {
    {{"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"},  {"epsilon", "ε"}, {"zeta", "ζ"},   {"eta", "η"},
     {"theta", "θ"}, {"iota", "ι"},  {"kappa", "κ"}, {"lambda", "λ"}, {"mu", "μ"},      {"nu", "ν"},     {"xi", "ξ"},
     {"pi", "π"},    {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},    {"upsilon", "υ"}, {"phi", "φ"},    {"chi", "χ"},
     {"psi", "ψ"},   {"omega", "ω"}, {"Gamma", "Γ"}, {"Delta", "Δ"},  {"Theta", "Θ"},   {"Lambda", "Λ"}, {"Xi", "Ξ"},
     {"Pi", "Π"},    {"Sigma", "Σ"}, {"Phi", "Φ"},   {"Psi", "Ψ"},    {"Omega", "Ω"}}};

std::string greek(const std::string& name) {
  for (const auto& [word, letter] : kGreek)
    if (name == word) return letter;
  return name;
}

bool is_identifier(const std::string& name) {
  return !name.empty() && !std::isdigit(static_cast<unsigned char>(name[0])) &&
         std::all_of(name.begin(), name.end(), [](unsigned char c) {
           return std::isalnum(c) || c == '_' || c == '.' || c == '[' || c == ']' || c == ',';
         });
}

// A column as its letter, derivative and index.
struct Symbol {
  std::string name;  // without marks of derivatives
  unsigned order = 0;
  std::string root, sub;
  std::string after;  // an initial value's (0), the part of a quantile: x(0), x 10 %
};

// Returns where the name of a column of a sweep ends.
std::size_t end_of_name(const std::string& column) {
  constexpr std::string_view kAtStart = "(0)", kPart = " %";
  std::size_t end = column.size();
  if (column.ends_with(kPart)) {
    const std::size_t space = column.rfind(' ', end - kPart.size() - 1);
    if (space != std::string::npos && space + 1 < end - kPart.size() &&
        column.find_first_not_of("0123456789", space + 1) == end - kPart.size())
      end = space;
  }
  const std::string_view name = std::string_view(column).substr(0, end);
  return name.ends_with(kAtStart) && name.size() > kAtStart.size() ? end - kAtStart.size() : end;
}

Symbol symbol(const std::string& whole) {
  Symbol s;
  const std::string column = whole.substr(0, end_of_name(whole));
  s.after = whole.substr(column.size());
  s.name = column;
  if (column.rfind("D(", 0) == 0 && column.back() == ')')
    if (const std::size_t comma = column.rfind(',');
        comma != std::string::npos && comma + 2 < column.size() && column.size() - comma < 6 &&
        column.find_first_not_of("0123456789", comma + 1) == column.size() - 1) {
      s.name = column.substr(2, comma - 2);
      s.order = static_cast<unsigned>(std::stoul(column.substr(comma + 1)));
    }
  while (!s.name.empty() && s.name.back() == '\'') s.name.pop_back(), ++s.order;
  if (!is_identifier(s.name)) {
    s.name = s.root = column;
    s.order = 0;
    return s;
  }
  // Examples are lambda.blade, phi_wheel, x12, P[1,2].
  std::size_t split = s.name.find_first_of("._[");
  std::string index;
  if (split == 0) split = std::string::npos;
  if (split == std::string::npos) {
    split = s.name.find_last_not_of("0123456789") + 1;
    s.sub = s.name.substr(split);
  } else {
    s.sub = s.name.substr(s.name[split] == '[' ? split : split + 1);
  }
  s.root = greek(s.name.substr(0, split));
  // A subscript that is a coordinate may be a Greek letter: N.theta.
  if (const std::size_t bracket = s.sub.find('['); bracket != std::string::npos) {
    index = s.sub.substr(bracket + 1);
    if (!index.empty() && index.back() == ']') index.pop_back();
    s.sub.resize(bracket);
  }
  s.sub = greek(s.sub);
  if (!index.empty()) s.sub += (s.sub.empty() ? "" : ",") + index;
  return s;
}

bool one_letter(const std::string& root) { return utf8_length(root) == 1; }

std::string superscript(unsigned n) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out;
  for (const char c : std::to_string(n)) out += kDigits[c - '0'];
  return "⁽" + out + "⁾";
}

// Digits have their own subscript characters.
std::string subscript(const std::string& sub) {
  static const char* const kDigits[] = {"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
  if (sub.empty()) return {};
  if (sub.find_first_not_of("0123456789,") != std::string::npos) return "_" + sub;
  std::string out;
  for (const char c : sub) out += c == ',' ? std::string(",") : kDigits[c - '0'];
  return out;
}

// The marks after a letter are dots above it; after a word they are primes.
std::string marks(unsigned order, bool letter) {
  static const char* const kDots[] = {"", "\u0307", "\u0308", "\u20DB"};
  static const char* const kPrimes[] = {"", "′", "″", "‴"};
  return order > 3 ? superscript(order) : letter ? kDots[order] : kPrimes[order];
}

std::string in_unit(const std::string& unit) { return unit.empty() || unit == "1" ? "" : " (" + shown(unit) + ")"; }

}  // namespace

std::string text_label(const std::string& as_written, const std::string& unit, LabelStyle style) {
  if (style == LabelStyle::latex) return latex_label(as_written, unit);
  const std::string column = shown(as_written);
  if (style == LabelStyle::plain) return column + in_unit(unit);
  const Symbol s = symbol(column);
  return s.root + marks(s.order, one_letter(s.root)) + subscript(s.sub) + s.after + in_unit(unit);
}

RichText rich_label(const std::string& column, const std::string& unit, LabelStyle style) {
  if (style != LabelStyle::unicode) return {{text_label(column, unit, style)}};
  const Symbol s = symbol(shown(column));
  const bool letter = one_letter(s.root);
  RichText text = {{s.root, letter, false, letter && s.order <= 3 ? s.order : 0}};
  if (s.order > 3 || (s.order > 0 && !letter)) text.push_back({marks(s.order, false)});
  if (!s.sub.empty())
    text.push_back({s.sub, one_letter(s.sub) && !std::isdigit(static_cast<unsigned char>(s.sub[0])), true});
  if (const std::string rest = s.after + in_unit(unit); !rest.empty()) text.push_back({rest});
  return text;
}

std::string latex_label(const std::string& column, const std::string& unit) {
  const Symbol s = symbol(column);
  const std::string base = column.substr(0, column.size() - s.after.size());
  if (s.root == base && utf8_length(base) != 1 && !is_identifier(base)) return latex_escape(column + in_unit(unit));
  std::string name = s.name;
  // A point begins a subscript, like an underscore.
  if (const std::size_t point = name.find('.'); point != std::string::npos && name.find('_') > point) name[point] = '_';
  return "$" + derivative_name(latex_name(name), s.order, Format::latex) + "$" + latex_escape(s.after) +
         (in_unit(unit).empty() ? "" : " (" + latex_escape(unit) + ")");
}

std::size_t shown_width(const std::string& text) {
  std::size_t width = 0;
  for (std::size_t i = 0; i < text.size();) {
    const std::size_t n = utf8_width(text, i);
    const std::string_view c = std::string_view(text).substr(i, n);
    if (c != "\u0307" && c != "\u0308" && c != "\u20DB") ++width;
    i += n;
  }
  return width;
}

std::string plain_text(const RichText& text) {
  std::string out;
  for (const TextPiece& p : text) out += p.sub ? subscript(p.text) : p.text + marks(p.dots, true);
  return out;
}

}  // namespace anholon::plot

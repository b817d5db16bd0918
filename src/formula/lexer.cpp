#include "formula/lexer.h"

#include <cctype>

#include "base/utf8.h"
#include "formula/habits.h"

namespace anholon {

namespace {

struct Greek {
  const char* letter;
  const char* name;
};
constexpr Greek kGreek[] = {
    {"α", "alpha"},   {"β", "beta"},  {"γ", "gamma"}, {"δ", "delta"},  {"ε", "epsilon"}, {"ζ", "zeta"},    {"η", "eta"},
    {"θ", "theta"},   {"ι", "iota"},  {"κ", "kappa"}, {"λ", "lambda"}, {"μ", "mu"},      {"ν", "nu"},      {"ξ", "xi"},
    {"ο", "omicron"}, {"π", "pi"},    {"ρ", "rho"},   {"σ", "sigma"},  {"τ", "tau"},     {"υ", "upsilon"}, {"φ", "phi"},
    {"χ", "chi"},     {"ψ", "psi"},   {"ω", "omega"}, {"ϑ", "theta"},  {"ϕ", "phi"},     {"ϵ", "epsilon"}, {"ϱ", "rho"},
    {"µ", "mu"},      {"Γ", "Gamma"}, {"Δ", "Delta"}, {"Θ", "Theta"},  {"Λ", "Lambda"},  {"Ξ", "Xi"},      {"Π", "Pi"},
    {"Σ", "Sigma"},   {"Φ", "Phi"},   {"Ψ", "Psi"},   {"Ω", "Omega"}};

const char* greek_name(std::string_view letter) {
  for (const Greek& g : kGreek)
    if (letter == g.letter) return g.name;
  return nullptr;
}

bool is_name_start(std::string_view c) {
  return std::isalpha(static_cast<unsigned char>(c[0])) || c[0] == '_' || greek_name(c) != nullptr;
}
bool is_name_part(std::string_view c) { return is_name_start(c) || std::isdigit(static_cast<unsigned char>(c[0])); }

class Lexer {
 public:
  explicit Lexer(const FormulaText& source) : source_(source) {}

  std::vector<Lexeme> run() {
    const std::string& s = source_.text();
    std::size_t i = 0, offset = 0;
    const auto push = [&](Token t, std::size_t bytes, std::size_t chars, std::string text) {
      lexemes_.push_back({t, std::move(text), offset, chars});
      i += bytes;
      offset += chars;
    };
    while (i < s.size()) {
      const std::size_t width = utf8_width(s, i);
      const std::string_view c(s.data() + i, width);
      if (c == " " || c == "\t" || c == "\n" || c == "\r" || c == "\u00a0") {
        i += width;
        ++offset;
      } else if (c == "#") {
        while (i < s.size() && s[i] != '\n') i += utf8_width(s, i), ++offset;
      } else if (std::isdigit(static_cast<unsigned char>(c[0])) ||
                 (c == "." && !after_name(offset) && i + 1 < s.size() &&
                  std::isdigit(static_cast<unsigned char>(s[i + 1])))) {
        std::size_t j = i;
        while (j < s.size() && std::isdigit(static_cast<unsigned char>(s[j]))) ++j;
        const bool member = !lexemes_.empty() && lexemes_.back().token == Token::point;  // lambda.blade.1
        if (member) {
          push(Token::number, j - i, j - i, s.substr(i, j - i));
          continue;
        }
        if (j < s.size() && s[j] == '.')
          for (++j; j < s.size() && std::isdigit(static_cast<unsigned char>(s[j]));) ++j;
        if (j < s.size() && (s[j] == 'e' || s[j] == 'E')) {
          std::size_t k = j + 1;
          if (k < s.size() && (s[k] == '+' || s[k] == '-')) ++k;
          if (k < s.size() && std::isdigit(static_cast<unsigned char>(s[k]))) {
            while (k < s.size() && std::isdigit(static_cast<unsigned char>(s[k]))) ++k;
            j = k;
          }
        }
        push(Token::number, j - i, j - i, s.substr(i, j - i));
      } else if (is_name_start(c)) {
        std::size_t j = i, chars = 0;
        std::string text;
        while (j < s.size()) {
          const std::string_view part(s.data() + j, utf8_width(s, j));
          if (!is_name_part(part)) break;
          j += part.size();
          ++chars;
        }
        text = s.substr(i, j - i);
        push(Token::name, j - i, chars, normal_name(text));
      } else if (c == "\"") {
        // "zxz": the axis letters of euler(…) may be quoted.
        const std::size_t close = s.find('"', i + 1);
        if (close == std::string::npos) throw Failure(source_.span(offset, 1), "this quote is not closed");
        const std::string text = s.substr(i + 1, close - i - 1);
        push(Token::name, close + 1 - i, utf8_length(text) + 2, text);
      } else {
        const auto sign = [&](Token t) { push(t, width, 1, std::string(c)); };
        if (c == "+")
          sign(Token::plus);
        else if (c == "-" || c == "−" || c == "–")
          sign(Token::minus);
        else if (c == "*" && i + 1 < s.size() && s[i + 1] == '*')
          push(Token::caret, 2, 2, "**");
        else if (c == "*")
          sign(Token::times);
        else if (c == "/")
          sign(Token::over);
        else if (c == "^")
          sign(Token::caret);
        else if (c == "'" || c == "′" || c == "’")
          sign(Token::prime);
        else if (c == "²")
          push(Token::superscript, width, 1, "2");
        else if (c == "³")
          push(Token::superscript, width, 1, "3");
        else if (c == "·" || c == "⋅")
          sign(Token::middle_dot);
        else if (c == "×")
          sign(Token::cross_sign);
        else if (c == "(")
          sign(Token::open);
        else if (c == ")")
          sign(Token::close);
        else if (c == "[")
          sign(Token::left);
        else if (c == "]")
          sign(Token::right);
        else if (c == ",")
          sign(Token::comma);
        else if (c == ".")
          sign(Token::point);
        else if ((c == ">" || c == "<") && i + 1 < s.size() && s[i + 1] == '=')
          push(Token::compare, 2, 2, std::string(c) + "=");
        else if (c == ">" || c == "<")
          sign(Token::compare);
        else if (c == "≥" || c == "≤")
          push(Token::compare, width, 1, c == "≥" ? ">=" : "<=");
        else if (c == "=" && i + 1 < s.size() && s[i + 1] == '=')
          push(Token::equals, 2, 2, "==");
        else if (c == "=")
          sign(Token::equals);
        else {
          const bool printable = width > 1 || std::isprint(static_cast<unsigned char>(c[0]));
          throw Failure(source_.span(offset, 1),
                        printable ? "'" + std::string(c) + "' means nothing in a formula"
                                  : "a character that means nothing in a formula",
                        habit_of_sign(std::string(c)));
        }
      }
    }
    lexemes_.push_back({Token::end, "", offset, 1});
    return std::move(lexemes_);
  }

 private:
  // Whether a name ends here, in which case a '.' is followed by a member.
  bool after_name(std::size_t offset) const {
    return !lexemes_.empty() && lexemes_.back().token == Token::name &&
           lexemes_.back().offset + lexemes_.back().length == offset;
  }

  const FormulaText& source_;
  std::vector<Lexeme> lexemes_;
};

}  // namespace

std::vector<Lexeme> lexemes(const FormulaText& source) { return Lexer(source).run(); }

std::string normal_name(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size();) {
    const std::string_view c = name.substr(i, utf8_width(name, i));
    if (const char* g = greek_name(c))
      out += g;
    else
      out += c;
    i += c.size();
  }
  return out;
}

bool is_identifier(std::string_view name) {
  if (name.empty()) return false;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const unsigned char c = static_cast<unsigned char>(name[i]);
    if (!(std::isalpha(c) || c == '_' || (i > 0 && std::isdigit(c)))) return false;
  }
  return true;
}

}  // namespace anholon

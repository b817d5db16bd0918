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

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

// The operators in all their spellings; of two that begin alike, the longer one comes first.
struct Sign {
  std::string_view spelling;
  Token token;
  std::string_view text = {};  // text of the lexeme, if it differs from the spelling
};
constexpr Sign kSigns[] = {
    {"+", Token::plus},
    {"-", Token::minus},
    {"−", Token::minus},
    {"–", Token::minus},
    {"**", Token::caret},
    {"*", Token::times},
    {"/", Token::over},
    {"^", Token::caret},
    {"'", Token::prime},
    {"′", Token::prime},
    {"’", Token::prime},
    {"²", Token::superscript, "2"},
    {"³", Token::superscript, "3"},
    {"·", Token::middle_dot},
    {"⋅", Token::middle_dot},
    {"×", Token::cross_sign},
    {"(", Token::open},
    {")", Token::close},
    {"[", Token::left},
    {"]", Token::right},
    {",", Token::comma},
    {".", Token::point},
    {">=", Token::compare},
    {"<=", Token::compare},
    {">", Token::compare},
    {"<", Token::compare},
    {"≥", Token::compare, ">="},
    {"≤", Token::compare, "<="},
    {"==", Token::equals},
    {"=", Token::equals},
};

class Lexer {
 public:
  explicit Lexer(const FormulaText& source) : source_(source), s_(source.text()) {}

  std::vector<Lexeme> run() {
    while (at_ < s_.size()) {
      const std::string_view c(s_.data() + at_, utf8_width(s_, at_));
      if (c == " " || c == "\t" || c == "\n" || c == "\r" || c == "\u00a0")
        skip(c.size());
      else if (c == "#")
        comment();
      else if (is_digit(c[0]) || (c == "." && !after_name() && is_digit(byte(at_ + 1))))
        number();
      else if (is_name_start(c))
        name();
      else if (c == "\"")
        quoted();
      else
        sign(c);
    }
    lexemes_.push_back({Token::end, "", offset_, 1});
    return std::move(lexemes_);
  }

 private:
  // Returns the byte at i; 0 beyond the end.
  char byte(std::size_t i) const { return i < s_.size() ? s_[i] : '\0'; }
  std::size_t after_digits(std::size_t i) const {
    while (is_digit(byte(i))) ++i;
    return i;
  }
  void skip(std::size_t bytes) {
    at_ += bytes;
    ++offset_;
  }
  void push(Token token, std::size_t bytes, std::size_t characters, std::string text) {
    lexemes_.push_back({token, std::move(text), offset_, characters});
    at_ += bytes;
    offset_ += characters;
  }

  void comment() {
    while (at_ < s_.size() && s_[at_] != '\n') skip(utf8_width(s_, at_));
  }

  void number() {
    std::size_t end = after_digits(at_);
    const bool is_member = !lexemes_.empty() && lexemes_.back().token == Token::point;  // lambda.blade.1
    if (!is_member) {
      if (byte(end) == '.') end = after_digits(end + 1);
      if (byte(end) == 'e' || byte(end) == 'E') {
        const std::size_t digits = end + (byte(end + 1) == '+' || byte(end + 1) == '-' ? 2 : 1);
        if (is_digit(byte(digits))) end = after_digits(digits);
      }
    }
    push(Token::number, end - at_, end - at_, s_.substr(at_, end - at_));
  }

  void name() {
    std::size_t end = at_, characters = 0;
    while (end < s_.size()) {
      const std::string_view part(s_.data() + end, utf8_width(s_, end));
      if (!is_name_part(part)) break;
      end += part.size();
      ++characters;
    }
    push(Token::name, end - at_, characters, normal_name(s_.substr(at_, end - at_)));
  }

  // Reads a quoted text, "zxz": the axis letters of euler(…) may be quoted.
  void quoted() {
    const std::size_t close = s_.find('"', at_ + 1);
    if (close == std::string::npos)
      throw Failure(source_.span(offset_, 1), "this quote is not closed",
                    at_ > 0 && is_name_part(s_.substr(at_ - 1, 1))
                        ? "a second derivative is written with two primes, in a text in double quotes: \"x''\""
                        : "");
    const std::string text = s_.substr(at_ + 1, close - at_ - 1);
    push(Token::name, close + 1 - at_, utf8_length(text) + 2, text);
  }

  void sign(std::string_view c) {
    const std::string_view rest = std::string_view(s_).substr(at_);
    for (const Sign& sign : kSigns)
      if (rest.starts_with(sign.spelling)) {
        const std::string_view text = sign.text.empty() ? sign.spelling : sign.text;
        push(sign.token, sign.spelling.size(), utf8_length(sign.spelling), std::string(text));
        return;
      }
    const bool printable = c.size() > 1 || std::isprint(static_cast<unsigned char>(c[0]));
    throw Failure(source_.span(offset_, 1),
                  printable ? "'" + std::string(c) + "' means nothing in a formula"
                            : "a character that means nothing in a formula",
                  habit_of_sign(std::string(c)));
  }

  // True if a name ends here, in which case a '.' is followed by a member.
  bool after_name() const {
    return !lexemes_.empty() && lexemes_.back().token == Token::name &&
           lexemes_.back().offset + lexemes_.back().length == offset_;
  }

  const FormulaText& source_;
  const std::string& s_;
  std::size_t at_ = 0, offset_ = 0;  // in bytes and in characters
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

#include <array>
#include <cctype>

#include "base/utf8.h"
#include "expr/indices.h"

namespace anholon {

namespace {

// Nesting deeper than this is refused; it also bounds the recursion of parser and evaluator.
constexpr int kDeepest = 400;
// Longest formula read, in bytes.
constexpr std::size_t kLongestFormula = 1 << 20;

struct Greek {
  const char* letter;
  const char* name;
};
constexpr Greek kGreek[] = {
    {"α", "alpha"}, {"β", "beta"}, {"γ", "gamma"}, {"δ", "delta"}, {"ε", "epsilon"},
    {"ζ", "zeta"}, {"η", "eta"}, {"θ", "theta"}, {"ι", "iota"}, {"κ", "kappa"}, {"λ", "lambda"},
    {"μ", "mu"}, {"ν", "nu"}, {"ξ", "xi"}, {"ο", "omicron"}, {"π", "pi"}, {"ρ", "rho"},
    {"σ", "sigma"}, {"τ", "tau"}, {"υ", "upsilon"}, {"φ", "phi"}, {"χ", "chi"}, {"ψ", "psi"},
    {"ω", "omega"}, {"ϑ", "theta"}, {"ϕ", "phi"}, {"ϵ", "epsilon"}, {"ϱ", "rho"}, {"µ", "mu"},
    {"Γ", "Gamma"}, {"Δ", "Delta"}, {"Θ", "Theta"}, {"Λ", "Lambda"}, {"Ξ", "Xi"}, {"Π", "Pi"},
    {"Σ", "Sigma"}, {"Φ", "Phi"}, {"Ψ", "Psi"}, {"Ω", "Omega"}};

const char* greek_name(std::string_view letter) {
  for (const Greek& g : kGreek)
    if (letter == g.letter) return g.name;
  return nullptr;
}

enum class Token : std::uint8_t {
  number, name, plus, minus, times, over, caret, prime, superscript, open, close, left, right, comma,
  point, equals, middle_dot, cross_sign, compare, end,
};

struct Lexeme {
  Token token = Token::end;
  std::string text;
  std::size_t offset = 0, length = 1;  // in characters
};

bool is_name_start(std::string_view c) {
  return std::isalpha(static_cast<unsigned char>(c[0])) || c[0] == '_' || greek_name(c) != nullptr;
}
bool is_name_part(std::string_view c) {
  return is_name_start(c) || std::isdigit(static_cast<unsigned char>(c[0]));
}

class Parser {
 public:
  explicit Parser(const FormulaText& source) : source_(source) {
    if (source.text().size() > kLongestFormula)
      throw Failure(source.whole(), "a formula of more than " + std::to_string(kLongestFormula) + " bytes");
    lex();
  }

  // In the formula stand brackets after names: P[2].
  bool indexed() const { return indexed_; }

  Syntax formula() {
    Syntax s = expression(0);
    if (peek().token == Token::equals)
      fail(peek(), "a formula, not an equation, is expected here", "leave out the part from '=' on");
    finish();
    return s;
  }

  std::vector<Syntax> equation() {
    std::vector<Syntax> sides;
    sides.push_back(expression(0));
    if (peek().token == Token::equals) {
      next();
      sides.push_back(expression(0));
      if (peek().token == Token::equals) fail(peek(), "an equation has one '='", "write two constraints");
    }
    finish();
    return sides;
  }

 private:
  [[noreturn]] void fail(const Lexeme& at, std::string message, std::string hint = {}) const {
    throw Failure(source_.span(at.offset, at.length), std::move(message), std::move(hint));
  }

  void lex() {
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
                 (c == "." && i + 1 < s.size() && std::isdigit(static_cast<unsigned char>(s[i + 1])))) {
        std::size_t j = i;
        while (j < s.size() && std::isdigit(static_cast<unsigned char>(s[j]))) ++j;
        if (j < s.size() && s[j] == '.') for (++j; j < s.size() && std::isdigit(static_cast<unsigned char>(s[j]));) ++j;
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
        // "zxz": the axis letters of euler(…) may stand in quotes.
        const std::size_t close = s.find('"', i + 1);
        if (close == std::string::npos) throw Failure(source_.span(offset, 1), "this quote is not closed");
        const std::string text = s.substr(i + 1, close - i - 1);
        push(Token::name, close + 1 - i, utf8_length(text) + 2, text);
      } else {
        const auto sign = [&](Token t) { push(t, width, 1, std::string(c)); };
        if (c == "+") sign(Token::plus);
        else if (c == "-" || c == "−" || c == "–") sign(Token::minus);
        else if (c == "*" && i + 1 < s.size() && s[i + 1] == '*') push(Token::caret, 2, 2, "**");
        else if (c == "*") sign(Token::times);
        else if (c == "/") sign(Token::over);
        else if (c == "^") sign(Token::caret);
        else if (c == "'" || c == "′" || c == "’") sign(Token::prime);
        else if (c == "²") push(Token::superscript, width, 1, "2");
        else if (c == "³") push(Token::superscript, width, 1, "3");
        else if (c == "·" || c == "⋅") sign(Token::middle_dot);
        else if (c == "×") sign(Token::cross_sign);
        else if (c == "(") sign(Token::open);
        else if (c == ")") sign(Token::close);
        else if (c == "[") sign(Token::left);
        else if (c == "]") sign(Token::right);
        else if (c == ",") sign(Token::comma);
        else if (c == ".") sign(Token::point);
        else if ((c == ">" || c == "<") && i + 1 < s.size() && s[i + 1] == '=') push(Token::compare, 2, 2, std::string(c) + "=");
        else if (c == ">" || c == "<") sign(Token::compare);
        else if (c == "≥" || c == "≤") push(Token::compare, width, 1, c == "≥" ? ">=" : "<=");
        else if (c == "=" && i + 1 < s.size() && s[i + 1] == '=') push(Token::equals, 2, 2, "==");
        else if (c == "=") sign(Token::equals);
        else {
          const bool printable = width > 1 || std::isprint(static_cast<unsigned char>(c[0]));
          throw Failure(source_.span(offset, 1),
                        printable ? "'" + std::string(c) + "' means nothing in a formula"
                                  : "a character that means nothing in a formula");
        }
      }
    }
    lexemes_.push_back({Token::end, "", offset, 1});
  }

  const Lexeme& peek() const { return lexemes_[at_]; }
  Lexeme next() { return lexemes_[at_ < lexemes_.size() - 1 ? at_++ : at_]; }

  Syntax make(Syntax::Op op, const Lexeme& at, std::vector<Syntax> args = {}) const {
    Syntax s{op, at.text, std::move(args), source_.span(at.offset, at.length), at.offset,
             at.offset + at.length, {}};
    for (const Syntax& a : s.args) {
      s.offset = std::min(s.offset, a.offset);
      s.end = std::max(s.end, a.end);
    }
    return s;
  }

  Syntax expression(int strength) {
    if (++depth_ > kDeepest) fail(peek(), "nested deeper than " + std::to_string(kDeepest) + " levels",
                                  "give parts of the formula a name under [define]");
    Syntax left = prefix();
    for (;;) {
      const Lexeme at = peek();
      int power = 0;
      Syntax::Op op = Syntax::Op::add;
      switch (at.token) {
        case Token::plus: power = 1, op = Syntax::Op::add; break;
        case Token::minus: power = 1, op = Syntax::Op::subtract; break;
        case Token::times: power = 2, op = Syntax::Op::multiply; break;
        case Token::over: power = 2, op = Syntax::Op::divide; break;
        case Token::middle_dot: power = 2, op = Syntax::Op::dot; break;
        case Token::cross_sign: power = 2, op = Syntax::Op::cross; break;
        case Token::caret: power = 4, op = Syntax::Op::power; break;
        default: break;
      }
      if (power == 0 || power <= strength) break;
      next();
      Syntax right = expression(op == Syntax::Op::power ? power - 1 : power);
      if (op == Syntax::Op::power) {
        left = make(op, at, two(std::move(left), std::move(right)));
        continue;
      }
      // a + b - c + … and a * b / c … are one node each, however long: no depth to recurse into.
      const Syntax::Op chain = power == 1 ? Syntax::Op::add : Syntax::Op::multiply;
      if (left.op != chain) left = make(chain, at, one(std::move(left)));
      left.end = std::max(left.end, right.end);
      left.operators.push_back({op, source_.span(at.offset, at.length)});
      left.args.push_back(std::move(right));
    }
    --depth_;
    return left;
  }

  static std::vector<Syntax> two(Syntax a, Syntax b) {
    std::vector<Syntax> v;
    v.push_back(std::move(a));
    v.push_back(std::move(b));
    return v;
  }
  static std::vector<Syntax> one(Syntax a) {
    std::vector<Syntax> v;
    v.push_back(std::move(a));
    return v;
  }

  Syntax prefix() {
    const Lexeme at = peek();
    if (at.token == Token::minus) {
      next();
      return make(Syntax::Op::negate, at, one(expression(3)));
    }
    if (at.token == Token::plus) {
      next();
      return expression(3);
    }
    return postfix(primary());
  }

  Syntax primary() {
    const Lexeme at = next();
    switch (at.token) {
      case Token::number: return make(Syntax::Op::number, at);
      case Token::name: {
        if (peek().token == Token::open) {
          Syntax s = make(Syntax::Op::call, at, arguments(Token::close, ")"));
          s.end = lexemes_[at_ - 1].offset + 1;
          return s;
        }
        if (peek().token == Token::left) {
          Syntax s = make(Syntax::Op::index, at, arguments(Token::right, "]"));
          s.end = lexemes_[at_ - 1].offset + 1;
          if (peek().token == Token::open) {
            std::vector<Syntax> all = one(std::move(s));
            for (Syntax& a : arguments(Token::close, ")")) all.push_back(std::move(a));
            s = make(Syntax::Op::apply, at, std::move(all));
            s.end = lexemes_[at_ - 1].offset + 1;
          }
          indexed_ = true;
          return s;
        }
        return make(Syntax::Op::name, at);
      }
      case Token::open: {
        Syntax s = expression(0);
        if (peek().token != Token::close)
          fail(peek(), peek().token == Token::end ? "')' is missing at the end" : "')' is expected here");
        s.offset = at.offset;
        s.end = peek().offset + 1;
        next();
        return s;
      }
      case Token::left: {
        --at_;
        Syntax s = make(Syntax::Op::array, at, arguments(Token::right, "]"));
        s.end = lexemes_[at_ - 1].offset + 1;
        return s;
      }
      case Token::end:
        fail(at, lexemes_.size() == 1 ? "the formula is empty" : "the formula ends where a number, a name or '(' should follow");
      default:
        fail(at, "'" + at.text + "' stands where a number, a name or '(' should");
    }
  }

  std::vector<Syntax> arguments(Token close, const char* closer) {
    std::vector<Syntax> args;
    const Lexeme opened = next();
    if (peek().token == close) {
      next();
      return args;
    }
    for (;;) {
      args.push_back(expression(0));
      if (peek().token == Token::compare) {
        const Lexeme sign = next();
        args.back() = make(Syntax::Op::compare, sign, two(std::move(args.back()), expression(0)));
      }
      const Lexeme at = next();
      if (at.token == close) return args;
      if (at.token != Token::comma) {
        if (at.token == Token::end) fail(opened, std::string("this bracket is not closed: '") + closer + "' is missing");
        fail(at, std::string("',' or '") + closer + "' is expected here");
      }
    }
  }

  Syntax postfix(Syntax s) {
    for (int count = 0;; ++count) {
      const Lexeme at = peek();
      if (count > kDeepest) fail(at, "more than " + std::to_string(kDeepest) + " signs after one another");
      if (at.token == Token::prime) {
        next();
        s = make(Syntax::Op::prime, at, one(std::move(s)));
      } else if (at.token == Token::superscript) {
        next();
        Lexeme exponent = at;
        s = make(Syntax::Op::power, at, two(std::move(s), make(Syntax::Op::number, exponent)));
      } else if (at.token == Token::point) {
        next();
        const Lexeme member = next();
        if (member.token != Token::name) fail(member, "a member name (x, y, z or center) is expected after '.'");
        s = make(Syntax::Op::member, member, one(std::move(s)));
        if (peek().token == Token::left) {  // lambda.axle[2]
          for (Syntax& a : arguments(Token::right, "]")) s.args.push_back(std::move(a));
          indexed_ = true;
        }
      } else {
        return s;
      }
    }
  }

  void finish() {
    const Lexeme& at = peek();
    if (at.token == Token::end) return;
    if (at.token == Token::compare)
      fail(at, "'" + at.text + "' stands in a condition of piecewise only", "piecewise(x > 0, x, 0)");
    if (at.token == Token::close || at.token == Token::right) fail(at, "'" + at.text + "' closes nothing");
    const Lexeme& before = lexemes_[at_ - 1];
    if (at.token == Token::name || at.token == Token::number || at.token == Token::open) {
      if (before.token == Token::number && at.token == Token::name && at_ == 1 &&
          before.offset + before.length < at.offset)
        fail(at, "units ('" + at.text + "') are not read yet", "give the bare number in SI units");
      fail(at, "an operator is missing before '" + at.text + "'",
           before.token == Token::prime && at_ > 1
               ? "write " + lexemes_[at_ - 2].text + before.text + "*" + at.text + " for a product"
           : before.token == Token::name || before.token == Token::number
               ? "write " + before.text + "*" + at.text + (at.token == Token::open ? "…)" : "") + " for a product"
               : "a product is written with '*'");
    }
    fail(at, "'" + at.text + "' is not expected here");
  }

  const FormulaText& source_;
  std::vector<Lexeme> lexemes_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool indexed_ = false;
};

}  // namespace

FormulaText::FormulaText(std::string text, Span start) : text_(std::move(text)), start_(start) {}
FormulaText::FormulaText(std::string text, std::vector<Span> places)
    : text_(std::move(text)), places_(std::move(places)) {
  if (!places_.empty()) start_ = places_[0];
}

void FormulaText::set_file(std::uint32_t file) {
  start_.file = file;
  for (Span& s : places_) s.file = file;
}

Span FormulaText::span(std::size_t offset, std::size_t length) const {
  Span s = start_;
  if (places_.empty()) {
    if (s.line > 0) s.column += static_cast<std::uint32_t>(offset);
  } else if (offset < places_.size()) {
    s = places_[offset];
  } else {
    s = places_.back();
    ++s.column;
  }
  s.length = static_cast<std::uint32_t>(length);
  return s;
}

Span FormulaText::whole() const {
  const std::size_t n = utf8_length(text_);
  if (!places_.empty() && places_.front().line != places_.back().line) return span(0, 1);
  return span(0, n == 0 ? 1 : n);
}

Syntax parse_formula(const FormulaText& text) {
  Parser parser(text);
  Syntax s = parser.formula();
  return parser.indexed() || text.indices() ? with_indices(std::move(s), text.indices().get()) : s;
}

std::vector<Syntax> parse_equation(const FormulaText& text) {
  Parser parser(text);
  std::vector<Syntax> sides = parser.equation();
  if (parser.indexed() || text.indices())
    for (Syntax& s : sides) s = with_indices(std::move(s), text.indices().get());
  return sides;
}

std::vector<Syntax> parse_plain(const FormulaText& text) { return Parser(text).equation(); }

std::string normal_name(std::string_view name) {
  std::string out;
  for (std::size_t i = 0; i < name.size();) {
    const std::string_view c = name.substr(i, utf8_width(name, i));
    if (const char* g = greek_name(c)) out += g;
    else out += c;
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

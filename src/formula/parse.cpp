#include <algorithm>

#include "base/utf8.h"
#include "expr/table.h"
#include "formula/formula.h"
#include "formula/functions.h"
#include "formula/habits.h"
#include "formula/indices.h"
#include "formula/lexer.h"
#include "formula/units.h"

namespace anholon {

namespace {

// Nesting deeper than this is refused; it also bounds the recursion of parser and evaluator.
constexpr int kDeepest = 400;
// The longest formula that is read, in bytes.
constexpr std::size_t kLongestFormula = 1 << 20;

class Parser {
 public:
  explicit Parser(const FormulaText& source) : source_(source) {
    if (source.text().size() > kLongestFormula)
      throw Failure(source.whole(), "a formula of more than " + std::to_string(kLongestFormula) + " bytes");
    lexemes_ = lexemes(source);
  }

  // True if the formula contains brackets after names, P[2], or calls of pieces, f.c0(x).
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
      if (peek().token == Token::equals)
        fail(peek(), "an equation has one '='", "write two equations, each with one '='");
    }
    if (peek().token == Token::compare) inequality(sides[0]);
    finish();
    return sides;
  }

 private:
  [[noreturn]] void fail(const Lexeme& at, std::string message, std::string hint = {}) const {
    throw Failure(source_.span(at.offset, at.length), std::move(message), std::move(hint));
  }

  // Reports "x <= c" in the place of an equation.
  [[noreturn]] void inequality(const Syntax& left) {
    const Lexeme sign = next();
    const Syntax right = expression(0);
    const bool zero = right.op == Syntax::Op::number && parse_rational(right.text).value_or(1) == 0;
    const bool sum = right.op == Syntax::Op::add || right.op == Syntax::Op::negate;
    const std::string gap = print(left) + (zero ? "" : " - " + (sum ? "(" + print(right) + ")" : print(right)));
    fail(sign, "an equation is expected, '" + sign.text + "' makes an inequality",
         "an [[event]] finds where its two sides meet: when = \"" + gap + "\"");
  }

  const Lexeme& peek() const { return lexemes_[at_]; }
  Lexeme next() { return lexemes_[at_ < lexemes_.size() - 1 ? at_++ : at_]; }

  Syntax make(Syntax::Op op, const Lexeme& at, std::vector<Syntax> args = {}) const {
    Syntax s{op, at.text, std::move(args), source_.span(at.offset, at.length), at.offset, at.offset + at.length, {}};
    for (const Syntax& a : s.args) {
      s.offset = std::min(s.offset, a.offset);
      s.end = std::max(s.end, a.end);
    }
    return s;
  }

  Syntax expression(int strength) {
    if (++depth_ > kDeepest)
      fail(peek(), "nested deeper than " + std::to_string(kDeepest) + " levels",
           "give parts of the formula a name under [define]");
    Syntax left = prefix();
    for (;;) {
      const Lexeme at = peek();
      int power = 0;
      Syntax::Op op = Syntax::Op::add;
      switch (at.token) {
      case Token::plus:
        power = 1, op = Syntax::Op::add;
        break;
      case Token::minus:
        power = 1, op = Syntax::Op::subtract;
        break;
      case Token::times:
        power = 2, op = Syntax::Op::multiply;
        break;
      case Token::over:
        power = 2, op = Syntax::Op::divide;
        break;
      case Token::middle_dot:
        power = 2, op = Syntax::Op::dot;
        break;
      case Token::cross_sign:
        power = 2, op = Syntax::Op::cross;
        break;
      case Token::caret:
        power = 4, op = Syntax::Op::power;
        break;
      default:
        break;
      }
      if (power == 0 || power <= strength) break;
      next();
      Syntax right = expression(op == Syntax::Op::power ? power - 1 : power);
      if (op == Syntax::Op::power) {
        left = make(op, at, two(std::move(left), std::move(right)));
        continue;
      }
      // a + b - c + … and a * b / c … are one node each, however long, so the recursion is not deep.
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
    case Token::number: {
      Syntax s = make(Syntax::Op::number, at);
      return unit_follows(at) ? quantity(std::move(s)) : s;
    }
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
      if (peek().token == Token::compare) {
        const Lexeme sign = next();
        s = make(Syntax::Op::compare, sign, two(std::move(s), expression(0)));
      }
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
      fail(at, lexemes_.size() == 1 ? "the formula is empty"
                                    : "the formula ends where a number, a name or '(' should follow");
    default:
      fail(at, "'" + at.text + "' stands where a number, a name or '(' should");
    }
  }

  const Lexeme& ahead(std::size_t k) const { return lexemes_[std::min(at_ + k, lexemes_.size() - 1)]; }

  // True if a unit follows: a name after a number and a blank, or 1/ before the name of a unit. A call or a member of a
  // family is no unit.
  bool unit_follows(const Lexeme& number) const {
    const std::size_t k = reciprocal_unit() ? 2 : 0;
    const Lexeme &name = ahead(k), &after = ahead(k + 1);
    return name.token == Token::name && number.offset + number.length < peek().offset && after.token != Token::open &&
           after.token != Token::left;
  }

  // True for 1/s; in 1/t, t is the time.
  bool reciprocal_unit() const {
    return peek().token == Token::number && peek().text == "1" && ahead(1).token == Token::over && touches(at_ + 1) &&
           touches(at_ + 2) && ahead(2).text != "t" && find_unit(ahead(2).text);
  }

  // True if lexeme k follows without a blank. A unit contains no blanks: "2 m/s * t" is a product with t.
  bool touches(std::size_t k) const {
    return k > 0 && k < lexemes_.size() && lexemes_[k - 1].offset + lexemes_[k - 1].length == lexemes_[k].offset;
  }

  // Reads the unit after a number: names of units with whole powers, joined by * · and /, and perhaps 1/ before them.
  Syntax quantity(Syntax number) {
    const std::size_t first = at_;
    constexpr std::size_t kLongestUnit = 200;
    std::string text;
    if (reciprocal_unit()) text = "1/", at_ += 2;
    for (;;) {
      const Lexeme name = next();
      if (text.size() > kLongestUnit) fail(lexemes_[first], "this unit is out of all proportion");
      if (name.text == "and" || name.text == "or")
        fail(name, "conditions are not joined by '" + name.text + "'", habit_of_sign(name.text == "and" ? "&" : "∨"));
      if (!find_unit(name.text)) {
        if (const std::string unit = habit_of_unit(name.text); !unit.empty())
          fail(name, "'" + name.text + "' is no unit", "write " + number.text + " " + text + unit);
        const std::string near = did_you_mean(name.text, unit_names());
        fail(name, "'" + name.text + "' is no unit" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
             "a name after a number is a unit; write " + number.text + "*" + name.text + " for a product");
      }
      text += name.text;
      if (peek().token == Token::prime && touches(at_))
        fail(peek(), "a unit has no derivative", "write " + number.text + "*" + name.text + "' for a product");
      if (peek().token == Token::superscript && touches(at_)) {
        text += "^" + next().text;
      } else if (peek().token == Token::caret && touches(at_)) {
        next();
        text += "^";
        if (peek().token == Token::minus) text += "-", next();
        const Lexeme power = next();
        if (power.token != Token::number || power.text.size() > 2 ||
            power.text.find_first_not_of("0123456789") != std::string::npos || std::stoi(power.text) > 20)
          fail(power, "the power of a unit is a whole number between -20 and 20");
        text += power.text;
      }
      // t is the time except right after the number.
      const Token sign = peek().token;
      const bool joins = (sign == Token::times || sign == Token::middle_dot || sign == Token::over) && touches(at_) &&
                         touches(at_ + 1);
      if (!joins) break;
      const Lexeme &after = lexemes_[at_ + 1], &behind = lexemes_[std::min(at_ + 2, lexemes_.size() - 1)];
      if (after.token != Token::name || after.text == "t" || !find_unit(after.text) || behind.token == Token::open ||
          behind.token == Token::left)
        break;
      text += next().token == Token::over ? "/" : "*";
    }
    if (!read_unit(text)) fail(lexemes_[first], "this unit is out of all proportion");
    Syntax s{Syntax::Op::quantity, std::move(text), {}, number.span, number.offset, 0, {}};
    const Lexeme& last = lexemes_[at_ - 1];
    s.end = last.offset + last.length;
    s.span = source_.span(lexemes_[first].offset, s.end - lexemes_[first].offset);
    s.args.push_back(std::move(number));
    return s;
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
        if (at.token == Token::end)
          fail(opened, std::string("this bracket is not closed: '") + closer + "' is missing");
        if (at.token == Token::equals)
          fail(at, "a condition compares with <, <=, > or >=", "a mode is told by choose(mode, v1, v2)");
        if (at.token == Token::name && (at.text == "and" || at.text == "or"))
          fail(at, "conditions are not joined by '" + at.text + "'", habit_of_sign(at.text == "and" ? "&" : "∨"));
        fail(at, std::string("',' or '") + closer + "' is expected here");
      }
    }
  }

  Syntax postfix(Syntax s) {
    for (int count = 0;; ++count) {
      const Lexeme at = peek();
      if (count > kDeepest) fail(at, "more than " + std::to_string(kDeepest) + " signs after one another");
      if (at.token == Token::open && s.op == Syntax::Op::prime) argument_of_derivative(s);
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
        if (member.token != Token::name && member.token != Token::number)
          fail(member, "a member name (x, y, z or center) is expected after '.'");
        s = make(Syntax::Op::member, member, one(std::move(s)));
        if (peek().token == Token::left) {  // lambda.axle[2]
          for (Syntax& a : arguments(Token::right, "]")) s.args.push_back(std::move(a));
          indexed_ = true;
        }
        if (peek().token == Token::open && is_piece_of_table(member.text)) s = call_of_piece(std::move(s), at);
      } else {
        return s;
      }
    }
  }

  // Makes the call f.c0(x) or T[2].knot(x).
  Syntax call_of_piece(Syntax piece, const Lexeme& at) {
    std::vector<Syntax> all = one(std::move(piece));
    for (Syntax& a : arguments(Token::close, ")")) all.push_back(std::move(a));
    Syntax s = make(Syntax::Op::apply, at, std::move(all));
    s.end = lexemes_[at_ - 1].offset + 1;
    indexed_ = true;
    return s;
  }

  // Reports "x'(t)": coordinates and their derivatives are written without an argument.
  [[noreturn]] void argument_of_derivative(const Syntax& s) const {
    const auto token = [&](std::size_t k) { return lexemes_[std::min(at_ + k, lexemes_.size() - 1)]; };
    const bool of_time = token(1).token == Token::name && token(1).text == "t" && token(2).token == Token::close;
    if (of_time) fail(peek(), "a derivative has no argument: it is the value at t", "write " + print(s));
    fail(peek(), "an operator is missing before '('", "write " + print(s) + "*(…) for a product");
  }

  // Returns the hint for a missing operator.
  std::string hint_for_missing(const Lexeme& before, const Lexeme& at) const {
    if (before.token == Token::prime && at_ > 1)
      return "write " + lexemes_[at_ - 2].text + before.text + "*" + at.text + " for a product";
    if (at.text == "and" || at.text == "or") return habit_of_sign(at.text == "and" ? "&" : "∨");
    if (before.token != Token::name && before.token != Token::number) return "a product is written with '*'";
    const std::vector<std::string> functions = function_names();
    // sin^2(x)
    if (at_ > 2 && lexemes_[at_ - 2].token == Token::caret &&
        std::find(functions.begin(), functions.end(), lexemes_[at_ - 3].text) != functions.end())
      return "write " + lexemes_[at_ - 3].text + "(…)^" + before.text;
    if (before.token == Token::name && std::find(functions.begin(), functions.end(), before.text) != functions.end())
      return "write " + before.text + "(" + at.text + (at.token == Token::open ? "…" : "") + ")";
    return "write " + before.text + "*" + at.text + (at.token == Token::open ? "…)" : "") + " for a product" +
           (before.token == Token::number && at.token == Token::name && find_unit(at.text)
                ? ", " + before.text + " " + at.text + " for a unit"
                : "");
  }

  void finish() {
    const Lexeme& at = peek();
    if (at.token == Token::end) return;
    if (at.token == Token::compare)
      fail(at, "'" + at.text + "' stands in a condition of piecewise only", "piecewise(x > 0, x, 0)");
    if (at.token == Token::comma && at_ > 0 && lexemes_[at_ - 1].token == Token::number && touches(at_) &&
        touches(at_ + 1) && lexemes_[at_ + 1].token == Token::number)
      fail(at, "',' is not expected here",
           "a decimal has a point: " + lexemes_[at_ - 1].text + "." + lexemes_[at_ + 1].text);
    if (at.token == Token::close || at.token == Token::right) fail(at, "'" + at.text + "' closes nothing");
    const Lexeme& before = lexemes_[at_ - 1];
    if (at.token == Token::name || at.token == Token::number || at.token == Token::open) {
      fail(at, "an operator is missing before '" + at.text + "'", hint_for_missing(before, at));
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

}  // namespace anholon

// Prints syntax trees.
#include "formula/formula.h"

namespace anholon {

namespace {

enum Strength : int { kSum = 1, kProduct = 2, kMinus = 3, kPower = 4, kPostfix = 5 };

int strength(const Syntax& s) {
  switch (s.op) {
  case Syntax::Op::add:
    return kSum;
  case Syntax::Op::multiply:
    return kProduct;
  case Syntax::Op::negate:
    return kMinus;
  case Syntax::Op::power:
    return kPower;
  case Syntax::Op::compare:
    return 0;
  case Syntax::Op::quantity:
    return kMinus;  // 2 m^2 is not (2 m)^2
  default:
    return kPostfix;
  }
}

const char* sign(Syntax::Op op) {
  switch (op) {
  case Syntax::Op::add:
    return " + ";
  case Syntax::Op::subtract:
    return " - ";
  case Syntax::Op::divide:
    return "/";
  case Syntax::Op::dot:
    return "·";
  case Syntax::Op::cross:
    return "×";
  default:
    return "*";
  }
}

std::string bracketed(const Syntax& s, int least) {
  const std::string text = print(s);
  return strength(s) < least ? "(" + text + ")" : text;
}

std::string list(const std::vector<Syntax>& args, const char* open, const char* close) {
  std::string out = open;
  for (std::size_t i = 0; i < args.size(); ++i) out += (i > 0 ? ", " : "") + print(args[i]);
  return out + close;
}

}  // namespace

std::string print(const Syntax& s) {
  switch (s.op) {
  case Syntax::Op::number:
  case Syntax::Op::name:
    return s.text;
  case Syntax::Op::quantity:
    return print(s.args[0]) + " " + s.text;
  case Syntax::Op::call:
    return s.text + list(s.args, "(", ")");
  case Syntax::Op::compare:
    return print(s.args[0]) + " " + s.text + " " + print(s.args[1]);
  case Syntax::Op::index:
    return s.text + list(s.args, "[", "]");
  case Syntax::Op::apply:
    return print(s.args[0]) + list({s.args.begin() + 1, s.args.end()}, "(", ")");
  case Syntax::Op::array:
    return list(s.args, "[", "]");
  case Syntax::Op::member:
    return bracketed(s.args[0], kPostfix) + "." + s.text;
  case Syntax::Op::prime:
    return bracketed(s.args[0], kPostfix) + "'";
  case Syntax::Op::negate:
    return "-" + bracketed(s.args[0], kPower);
  case Syntax::Op::power:
    return bracketed(s.args[0], kPostfix) + "^" + bracketed(s.args[1], kMinus);
  case Syntax::Op::add:
  case Syntax::Op::multiply: {
    const int own = strength(s);
    // A minus sign has no brackets only at the beginning.
    std::string out = bracketed(s.args[0], own);
    for (std::size_t i = 1; i < s.args.size(); ++i) {
      const bool minus = s.args[i].op == Syntax::Op::negate;
      out += sign(s.operators[i - 1].op) + (minus ? "(" + print(s.args[i]) + ")" : bracketed(s.args[i], own + 1));
    }
    return out;
  }
  case Syntax::Op::subtract:
  case Syntax::Op::divide:
  case Syntax::Op::dot:
  case Syntax::Op::cross:
    break;
  }
  return {};
}

}  // namespace anholon

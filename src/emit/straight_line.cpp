#include "emit/straight_line.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <set>
#include <unordered_map>

#include "base/assert.h"
#include "emit/text.h"
#include "tape/operands.h"

namespace anholon::emit {

namespace {

constexpr int kLargestPower = 4;  // whole powers up to this exponent are products

Tape tape_of(const Column& es) {
  if (es.empty()) return {};
  return compile(es, std::vector<int>(es.size(), 0), true);
}

const std::string kZero = "0.0";

std::string element(const char* array, std::size_t i) { return std::string(array) + "[" + std::to_string(i) + "]"; }

// Returns the name of a value that begins at `at`, "s12"; empty if another word is there.
std::string value_name(const std::string& text, std::size_t at) {
  const auto in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  if (text[at] != 's' || (at > 0 && in_word(text[at - 1]))) return {};
  std::size_t end = at + 1;
  while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end]))) ++end;
  return end == at + 1 || (end < text.size() && in_word(text[end])) ? "" : text.substr(at, end - at);
}

// Returns the statements, one a line, without values that no later statement reads, which constant factors leave behind
// when they move outwards.
std::string without_unread(const std::string& statements) {
  std::vector<std::string> lines;
  for (std::size_t from = 0, to; from < statements.size(); from = to) {
    to = std::min(statements.find('\n', from), statements.size() - 1) + 1;
    lines.push_back(statements.substr(from, to - from));
  }
  std::set<std::string> read;
  for (std::size_t k = lines.size(); k-- > 0;) {
    std::string& line = lines[k];
    const std::size_t equals = line.find(" = ");
    const std::size_t word = equals == std::string::npos || equals == 0 ? 0 : line.rfind(' ', equals - 1) + 1;
    if (const std::string name = value_name(line, word); !name.empty() && word > 0 && !read.count(name)) {
      line.clear();
      continue;
    }
    for (std::size_t i = equals == std::string::npos ? 0 : equals; i < line.size(); ++i)
      if (const std::string name = value_name(line, i); !name.empty()) read.insert(name);
  }
  std::string out;
  for (const std::string& line : lines) out += line;
  return out;
}

}  // namespace

const StraightLine::Coefficient StraightLine::kOne{{{}, 1}};

std::string StraightLine::assigned(const std::string& name, const std::string& value, bool declare) const {
  if (language_ == Language::python) return "    " + name + " = " + value + "\n";
  return (declare ? "  const double " : "  ") + name + " = " + value + ";\n";
}

std::string StraightLine::function_name(Function f) const {
  return language_ == Language::python ? info(f).numpy : info(f).c;
}

StraightLine::StraightLine(const RateFormulas& f, const Column& es, Language language)
    : formulas_(f), language_(language), tape_(tape_of(es)) {
  std::unordered_map<std::uint32_t, std::string> parameters;
  for (std::size_t i = 0; i < f.p.size(); ++i)
    parameters[f.model->graph->node(f.p.symbols[i].id).index] = element("p", i);
  for (std::size_t i = 0; i < f.u.size(); ++i)
    parameters[f.model->graph->node(f.u.symbols[i].id).index] = element("u", i);
  find_uses(parameters);
  name_.resize(tape_.code.size());
  forms_.resize(tape_.code.size());
  for (std::uint32_t s = 0; s < tape_.code.size(); ++s)
    if (const Instruction& in = tape_.code[s]; in.op == Op::parameter) {
      if (const auto found = parameters.find(in.index); found != parameters.end()) name_[s] = found->second;
    }
  std::unordered_map<NodeId, std::string> arguments{{f.model->graph->time().id, "t"}};
  const auto add = [&](const RateFormulas::Symbols& list, const char* array) {
    for (std::size_t i = 0; i < list.size(); ++i) arguments[list.symbols[i].id] = element(array, i);
  };
  add(f.x, "x");
  add(f.lead, "lead");
  for (const Input& in : tape_.inputs) name_[in.slot] = arguments.at(in.symbol);
  for (std::uint32_t s = 0; s < tape_.code.size(); ++s)
    if (is_literal(s)) name_[s] = operation(tape_.code[s], {});
  write_rates();
  text_ = without_unread(text_);
  write_constants();
}

void StraightLine::find_uses(const std::unordered_map<std::uint32_t, std::string>& parameters) {
  const std::uint32_t size = static_cast<std::uint32_t>(tape_.code.size());
  uses_.resize(size);
  for (const std::uint32_t root : tape_.roots) uses_[root].needed = true, ++uses_[root].readers;
  for (std::uint32_t s = size; s-- > 0;)
    if (uses_[s].needed)
      for_each_operand(tape_, tape_.code[s], [&](std::uint32_t k) {
        uses_[k].needed = true;
        ++uses_[k].readers;
      });
  // A tape takes u for parameters, so a slot that depends on u is constant for the tape and varies here.
  for (std::uint32_t s = 0; s < size; ++s) {
    const Instruction& in = tape_.code[s];
    uses_[s].varies = in.op == Op::input || (in.op == Op::parameter && parameters.at(in.index)[0] == 'u');
    for_each_operand(tape_, tape_.code[s],
                     [&](std::uint32_t k) { uses_[s].varies = uses_[s].varies || uses_[k].varies; });
  }
}

// Writes the operands of the constants, and then the constants.
void StraightLine::write_constants() {
  std::vector<bool> read(tape_.code.size(), false);
  for (const Coefficient& c : constants_)
    for (const auto& term : c)
      for (const auto& factor : term.first) read[factor.first] = true;
  for (std::uint32_t s = static_cast<std::uint32_t>(tape_.code.size()); s-- > 0;)
    if (read[s]) for_each_operand(tape_, tape_.code[s], [&](std::uint32_t k) { read[k] = true; });
  std::unordered_map<std::string, std::string> computed;  // operation, name
  for (std::uint32_t s = 0; s < tape_.code.size(); ++s) {
    if (!read[s] || !name_[s].empty()) continue;
    const std::string text = operation(tape_.code[s], [&](std::uint32_t k) { return name_[k]; });
    // An operation that was computed before is not computed again.
    const auto [known, fresh] = computed.try_emplace(text, "k" + std::to_string(computed.size()));
    if (fresh) constants_text_ += assigned(known->second, text, true);
    name_[s] = known->second;
  }
  for (std::size_t i = 0; i < constants_.size(); ++i)
    constants_text_ += assigned(element("c", i), constant_text(constants_[i]), false);
}

void StraightLine::write_rates() {
  for (std::uint32_t s = 0; s < tape_.code.size(); ++s) {
    if (!uses_[s].needed || !uses_[s].varies) continue;
    const Instruction& in = tape_.code[s];
    switch (in.op) {
    case Op::input:
    case Op::parameter:
      time_ = time_ || name_[s] == "t";
      // In Python a subscript of an array of many states makes an array.
      forms_[s] = {{language_ == Language::python && name_[s] != "t" ? named(name_[s]) : name_[s], kOne}};
      break;
    case Op::linear:
      set(s, sum_of(in));
      break;
    case Op::multiply:
    case Op::scale:
      set(s, product_of(in.a, in.b));
      break;
    case Op::square:
      set(s, product_of(in.a, in.a));
      break;
    case Op::divide:
      set(s, quotient_of(in.a, in.b));
      break;
    case Op::function:
      if (const auto power = general_power(in)) {
        set(s, {{*power, kOne}});
        break;
      }
      [[fallthrough]];
    default:
      set(s, {{named(operation(in, [&](std::uint32_t k) { return operand(k); })), kOne}});
    }
  }
  for (std::size_t i = 0; i < tape_.roots.size(); ++i) {
    const std::uint32_t root = tape_.roots[i];
    const std::string value = uses_[root].varies ? sum_text(forms_[root]) : operand(root);
    if (value == kZero)
      zeros_.push_back(i);
    else
      text_ += assigned(element("out", i), value, false);
  }
}

// Returns a slot that does not vary, as a product of powers as far as possible.
StraightLine::Coefficient StraightLine::constant(std::uint32_t s) const {
  const Instruction& in = tape_.code[s];
  const Coefficient itself{{{{s, 1}}, 1}};
  switch (in.op) {
  case Op::constant: {
    const Rational& value = tape_.rationals[in.index];
    return value == 0 ? Coefficient{} : Coefficient{{{}, value}};
  }
  case Op::linear: {
    if (in.count == 0) return {};
    const LinearTerm& term = tape_.linear_terms[in.first];
    return in.count > 1 ? itself : product({{{}, tape_.rationals[term.coefficient]}}, constant(term.slot));
  }
  case Op::multiply:
  case Op::scale:
    return product(constant(in.a), constant(in.b));
  case Op::square:
    return constant_power(in.a, 2);
  case Op::divide:
    return product(constant(in.a), constant_power(in.b, -1));
  case Op::power: {
    const Rational& exponent = tape_.rationals[in.index];
    const bool whole = exponent.is_integer() && abs(exponent) <= kLargestPower;
    return whole ? constant_power(in.a, exponent.to_long()) : itself;
  }
  default:
    return itself;
  }
}

// Returns the power of a slot; the power of a sum has the slot as its base.
StraightLine::Coefficient StraightLine::constant_power(std::uint32_t s, long exponent) const {
  const Coefficient base = constant(s);
  if (base.size() != 1) return {{{{s, exponent}}, 1}};
  Coefficient out = kOne;
  for (long k = 0; k < std::abs(exponent); ++k) out = product(out, base);
  if (exponent > 0) return out;
  Powers inverse;
  for (const auto& [slot, power] : out.begin()->first) inverse[slot] = -power;
  return {{inverse, 1 / out.begin()->second}};
}

StraightLine::Coefficient StraightLine::product(const Coefficient& a, const Coefficient& b) {
  Coefficient out;
  for (const auto& [powers, r] : a)
    for (const auto& [others, q] : b) {
      Powers all(powers);
      for (const auto& [slot, power] : others) all[slot] += power;
      std::erase_if(all, [](const auto& factor) { return factor.second == 0; });
      out[all] += r * q;
    }
  std::erase_if(out, [](const auto& term) { return term.second == 0; });
  return out;
}

bool StraightLine::is_sign(const Coefficient& c) {
  return c.size() == 1 && c.begin()->first.empty() && abs(c.begin()->second) == 1;
}

// True if a form times a constant takes no more operations than its value times the constant.
bool StraightLine::scales_freely(const Form& f) {
  return std::count_if(f.begin(), f.end(), [](const Term& t) { return is_sign(t.coefficient); }) <= 1;
}

StraightLine::Form StraightLine::scaled(std::uint32_t s, const Coefficient& by) {
  Form out = is_sign(by) || scales_freely(forms_[s]) ? forms_[s] : Form{{operand(s), kOne}};
  for (Term& t : out) t.coefficient = product(t.coefficient, by);
  std::erase_if(out, [](const Term& t) { return t.coefficient.empty(); });
  return out;
}

StraightLine::Form StraightLine::sum_of(const Instruction& in) {
  Form out;
  const auto add = [&](const Term& more) {
    const auto same = std::find_if(out.begin(), out.end(), [&](const Term& t) { return t.text == more.text; });
    if (same == out.end()) return out.push_back(more);
    for (const auto& [powers, r] : more.coefficient) same->coefficient[powers] += r;
    std::erase_if(same->coefficient, [](const auto& term) { return term.second == 0; });
  };
  for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
    const LinearTerm& term = tape_.linear_terms[k];
    const Coefficient factor{{{}, tape_.rationals[term.coefficient]}};
    if (!uses_[term.slot].varies)
      add({"", product(factor, constant(term.slot))});
    else
      for (const Term& t : scaled(term.slot, factor)) add(t);
  }
  std::erase_if(out, [](const Term& t) { return t.coefficient.empty(); });
  return out;
}

// Returns the value of a slot as one term.
StraightLine::Term StraightLine::term_of(std::uint32_t s) {
  if (uses_[s].varies && forms_[s].size() == 1 && !forms_[s][0].text.empty()) return forms_[s][0];
  return {operand(s), kOne};
}

StraightLine::Form StraightLine::product_of(std::uint32_t a, std::uint32_t b) {
  if (!uses_[a].varies) std::swap(a, b);
  if (!uses_[b].varies) return scaled(a, constant(b));
  Term x = term_of(a), y = term_of(b);
  if (y.text < x.text) std::swap(x, y);
  return {{named(x.text + "*" + y.text), product(x.coefficient, y.coefficient)}};
}

StraightLine::Form StraightLine::quotient_of(std::uint32_t a, std::uint32_t b) {
  const Term x = term_of(a);
  // x^n/x is x^(n - 1), which has a value for x = 0.
  if (const auto power = powers_.find(x.text); power != powers_.end() && power->second.first == operand(b)) {
    Coefficient exponent = power->second.second;
    exponent[{}] -= 1;
    std::erase_if(exponent, [](const auto& term) { return term.second == 0; });
    return {{power_of(operand(b), exponent), x.coefficient}};
  }
  return {{named(x.text + "/" + operand(b)), x.coefficient}};
}

void StraightLine::set(std::uint32_t s, Form f) {
  const bool free = f.empty() || (f.size() == 1 && is_sign(f[0].coefficient));
  if (!free && uses_[s].readers > 1) f = {{named(sum_text(f)), kOne}};
  forms_[s] = std::move(f);
}

std::string StraightLine::named(const std::string& value) {
  const auto [known, fresh] = values_.try_emplace(value, "s" + std::to_string(values_.size()));
  if (fresh) text_ += assigned(known->second, value, true);
  return known->second;
}

std::string StraightLine::operand(std::uint32_t s) {
  if (!uses_[s].varies) {
    const Coefficient c = constant(s);
    return c.empty() ? kZero : is_literal(s) ? name_[s] : place_of(c);
  }
  const Form& f = forms_[s];
  if (f.empty()) return kZero;
  if (f.size() == 1 && f[0].coefficient == kOne && !f[0].text.empty()) return f[0].text;
  return named(sum_text(f));
}

std::string StraightLine::place_of(const Coefficient& c) {
  const auto [place, fresh] = places_.try_emplace(c, constants_.size());
  if (fresh) constants_.push_back(c);
  return element("c", place->second);
}

// Returns the text of a sum. A term that is subtracted is one operation; a leading minus is one more.
std::string StraightLine::sum_text(Form f) {
  if (f.empty()) return kZero;
  const auto rank = [](const Term& t) { return t.coefficient == kOne ? 0 : is_sign(t.coefficient) ? 2 : 1; };
  std::stable_sort(f.begin(), f.end(), [&](const Term& a, const Term& b) { return rank(a) < rank(b); });
  std::string out;
  for (const Term& t : f) {
    Coefficient size = t.coefficient;
    const bool literal = size.size() == 1 && size.begin()->first.empty();
    const bool minus = size.begin()->second < 0 && (literal || !out.empty());
    if (minus)
      for (auto& term : size) term.second = -term.second;
    out += out.empty() ? (minus ? "-" : "") : minus ? " - " : " + ";
    std::string factor = literal ? number(size.begin()->second) : place_of(size);
    if (factor.find('/') != std::string::npos) factor = "(" + factor + ")";
    if (t.text.empty())
      out += factor;
    else
      out += size == kOne ? t.text : factor + "*" + t.text;
  }
  return out;
}

std::string StraightLine::constant_text(const Coefficient& c) const {
  std::string out;
  for (const auto& [powers, r] : c) {
    const Rational size = abs(r);
    std::string above, below;
    for (const auto& [slot, exponent] : powers) {
      std::string& to = exponent > 0 ? above : below;
      to += (to.empty() ? "" : "*") + power(name_[slot], std::abs(exponent));
    }
    const std::string factor = size == 1 && !above.empty() ? "" : "(" + number(size) + ")";
    out += out.empty() ? (r < 0 ? "-" : "") : r < 0 ? " - " : " + ";
    out += factor + (factor.empty() || above.empty() ? "" : "*") + above + (below.empty() ? "" : "/(" + below + ")");
  }
  return out;
}

std::string StraightLine::statements(bool sparse) const {
  std::string out = text_;
  for (std::size_t i = 0; !sparse && i < zeros_.size(); ++i) out += assigned(element("out", zeros_[i]), "0", false);
  return out;
}

std::vector<double> StraightLine::default_constants() const {
  if (constants_.empty()) return {};
  std::size_t most = 0;
  for (const RateFormulas::Symbols* list : {&formulas_.p, &formulas_.u})
    for (Expr e : list->symbols) most = std::max<std::size_t>(most, formulas_.model->graph->node(e.id).index + 1);
  std::vector<double> parameters(most, 0);
  for (std::size_t i = 0; i < formulas_.p.size(); ++i)
    parameters[formulas_.model->graph->node(formulas_.p.symbols[i].id).index] = formulas_.parameters[i];
  Machine<double> machine(tape_, 0, parameters);
  machine.evaluate();
  std::vector<double> out;
  for (const Coefficient& c : constants_) {
    double value = 0;
    for (const auto& [powers, r] : c) {
      double product = r.get_d();
      for (const auto& [slot, exponent] : powers) product *= std::pow(machine.series(slot)[0], exponent);
      value += product;
    }
    out.push_back(value);
  }
  return out;
}

// True for a number that is written at its place of use.
bool StraightLine::is_literal(std::uint32_t s) const {
  const Instruction& in = tape_.code[s];
  return in.op == Op::constant || in.op == Op::pi || (in.op == Op::linear && in.count == 0);
}

std::string StraightLine::power(const std::string& x, const Rational& exponent) const {
  const Rational e = abs(exponent);
  const std::string root = language_ == Language::python ? "np.sqrt(" : "sqrt(";
  std::string out;
  if (e == Rational(1, 2)) {
    out = root + x + ")";
  } else if (e == Rational(3, 2)) {
    out = x + "*" + root + x + ")";
  } else if (e.is_integer() && e <= kLargestPower) {
    out = x;
    for (long k = e.to_long(); k > 1; --k) out += "*" + x;
  } else {
    return language_ == Language::python ? x + "**(" + number(exponent) + ")"
                                         : "pow(" + x + ", " + number(exponent) + ")";
  }
  return exponent < 0 ? "1/(" + out + ")" : out;
}

std::string StraightLine::operation(const Instruction& in, const std::function<std::string(std::uint32_t)>& text) {
  const std::string a = in.op == Op::constant || in.op == Op::pi || in.op == Op::linear ? "" : text(in.a);
  switch (in.op) {
  case Op::constant: {
    const std::string value = number(tape_.rationals[in.index]);
    return value[0] == '-' || value.find('/') != std::string::npos ? "(" + value + ")" : value;
  }
  case Op::pi:
    return "3.14159265358979323846";
  case Op::linear: {
    std::string out;
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const Rational& c = tape_.rationals[tape_.linear_terms[k].coefficient];
      const std::string x = text(tape_.linear_terms[k].slot);
      out += out.empty() ? (c < 0 ? "-" : "") : c < 0 ? " - " : " + ";
      const Rational size = abs(c);
      if (size == 1)
        out += x;
      else if (const std::string n = number(size); n.find('/') == std::string::npos)
        out += n + "*" + x;
      else
        out += "(" + n + ")*" + x;
    }
    return out.empty() ? kZero : out;
  }
  case Op::multiply:
  case Op::scale:
    return a + "*" + text(in.b);
  case Op::square:
    return a + "*" + a;
  case Op::divide:
    return a + "/" + text(in.b);
  case Op::power:
    return power(a, tape_.rationals[in.index]);
  case Op::function: {
    const Function f = static_cast<Function>(in.index);
    used_sign_ = used_sign_ || f == Function::sign;
    return function_name(f) + "(" + a + ")";
  }
  case Op::arctan2:
    return (language_ == Language::python ? "np.arctan2(" : "atan2(") + a + ", " + text(in.b) + ")";
  case Op::select:
    if (language_ == Language::python) return "np.where(" + text(in.first) + " >= 0, " + a + ", " + text(in.b) + ")";
    return "(" + text(in.first) + " >= 0 ? " + a + " : " + text(in.b) + ")";
  case Op::lookup:
    return language_ == Language::python ? python_lookup(tape_.step_functions[in.index], a)
                                         : c_lookup(tape_.step_functions[in.index], a);
  case Op::input:
  case Op::parameter:
  case Op::rate:
    break;
  }
  ANHOLON_ASSERT(!"an operation that a formula does not have");
  return {};
}

}  // namespace anholon::emit

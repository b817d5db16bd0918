#include "emit/straight_line.h"

#include <algorithm>
#include <unordered_map>

#include "base/assert.h"
#include "emit/text.h"

namespace anholon::emit {

namespace {

constexpr int kLargestPower = 4;  // whole powers up to this exponent are products

Tape tape_of(const Column& es) {
  if (es.empty()) return {};
  return compile(es, std::vector<int>(es.size(), 0), true);
}

std::string element(const char* array, std::size_t i) { return std::string(array) + "[" + std::to_string(i) + "]"; }

}  // namespace

// The operands of a slot, without slots of derivatives, which series need.
template <class F>
void StraightLine::for_each_operand(std::uint32_t s, const F& f) const {
  const Instruction& in = tape_.code[s];
  switch (in.op) {
  case Op::constant:
  case Op::pi:
  case Op::input:
  case Op::parameter:
    return;
  case Op::linear:
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) f(tape_.linear_terms[k].slot);
    return;
  case Op::select:
    f(in.first);
    [[fallthrough]];
  case Op::multiply:
  case Op::scale:
  case Op::divide:
  case Op::arctan2:
    f(in.b);
    [[fallthrough]];
  case Op::square:
  case Op::power:
  case Op::function:
  case Op::lookup:
  case Op::rate:
    f(in.a);
    return;
  }
}

std::string StraightLine::assigned(const std::string& name, const std::string& value, bool declare) const {
  if (language_ == Language::python) return "    " + name + " = " + value + "\n";
  return (declare ? "  const double " : "  ") + name + " = " + value + ";\n";
}

std::string StraightLine::function_name(Function f) const {
  return language_ == Language::python ? info(f).numpy : info(f).c;
}

StraightLine::StraightLine(const RateFormulas& f, const Column& es, Language language)
    : formulas_(f), language_(language), tape_(tape_of(es)) {
  std::unordered_map<NodeId, std::string> arguments{{f.model->graph->time().id, "t"}};
  const auto add = [&](const RateFormulas::Symbols& list, const char* array) {
    for (std::size_t i = 0; i < list.size(); ++i) arguments[list.symbols[i].id] = element(array, i);
  };
  add(f.x, "x");
  add(f.lead, "lead");
  std::unordered_map<std::uint32_t, std::string> parameters;
  for (std::size_t i = 0; i < f.p.size(); ++i)
    parameters[f.model->graph->node(f.p.symbols[i].id).index] = element("p", i);
  for (std::size_t i = 0; i < f.u.size(); ++i)
    parameters[f.model->graph->node(f.u.symbols[i].id).index] = element("u", i);

  const std::uint32_t size = static_cast<std::uint32_t>(tape_.code.size());
  std::vector<bool> needed(size, false);
  for (const std::uint32_t root : tape_.roots) needed[root] = true;
  for (std::uint32_t s = size; s-- > 0;)
    if (needed[s]) for_each_operand(s, [&](std::uint32_t k) { needed[k] = true; });
  // A tape takes u for parameters, so a slot that depends on u is constant for the tape and varies here.
  std::vector<bool> varies(size, false), kept(size, false);  // kept: constants that something varying, or a root, needs
  for (std::uint32_t s = 0; s < size; ++s) {
    const Instruction& in = tape_.code[s];
    varies[s] = in.op == Op::input || (in.op == Op::parameter && parameters.at(in.index)[0] == 'u');
    for_each_operand(s, [&](std::uint32_t k) { varies[s] = varies[s] || varies[k]; });
    if (needed[s] && varies[s])
      for_each_operand(s, [&](std::uint32_t k) { kept[k] = kept[k] || (!varies[k] && !inline_number(k)); });
  }
  for (const std::uint32_t root : tape_.roots) kept[root] = kept[root] || (!varies[root] && !inline_number(root));

  name_.resize(size);
  std::unordered_map<std::uint32_t, std::string> given;
  for (const Input& in : tape_.inputs) given[in.slot] = arguments.at(in.symbol);
  std::unordered_map<std::string, std::string> computed;  // operation, name
  const auto write = [&](std::uint32_t s, std::string& to) {
    const Instruction& in = tape_.code[s];
    if (in.op == Op::input || in.op == Op::parameter) {
      name_[s] = in.op == Op::input ? given.at(s) : parameters.at(in.index);
    } else if (!inline_number(s)) {
      // An operation that was computed before is not computed again.
      const auto [known, fresh] = computed.try_emplace(operation(s), "s" + std::to_string(s));
      if (fresh) to += assigned(known->second, known->first, true);
      name_[s] = known->second;
    } else {
      name_[s] = operation(s);
    }
  };
  std::vector<std::uint32_t> constants;
  for (std::uint32_t s = 0; s < size; ++s)
    if (needed[s] && !varies[s]) {
      write(s, constants_text_);
      if (kept[s]) constants.push_back(s);
    }
  std::unordered_map<std::string, std::string> places;  // of constants in c
  for (const std::uint32_t s : constants) {
    const auto [place, fresh] = places.try_emplace(name_[s], element("c", constants_.size()));
    if (fresh) {
      constants_text_ += assigned(place->second, name_[s], false);
      constants_.push_back(s);
    }
    name_[s] = place->second;
  }
  for (std::uint32_t s = 0; s < size; ++s)
    if (needed[s] && varies[s]) {
      write(s, text_);
      time_ = time_ || name_[s] == "t";
    }
  for (std::size_t i = 0; i < tape_.roots.size(); ++i)
    if (const std::string& value = name_[tape_.roots[i]]; value != "0.0")
      text_ += assigned(element("out", i), value, false);
}

std::string StraightLine::statements(bool sparse) const {
  std::string out = text_;
  for (std::size_t i = 0; !sparse && i < tape_.roots.size(); ++i)
    if (name_[tape_.roots[i]] == "0.0") out += assigned(element("out", i), "0", false);
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
  for (const std::uint32_t slot : constants_) out.push_back(machine.series(slot)[0]);
  return out;
}

// A number that is written where it is used.
bool StraightLine::inline_number(std::uint32_t s) const {
  const Instruction& in = tape_.code[s];
  if (in.op == Op::constant || in.op == Op::pi) return true;
  return in.op == Op::linear && in.count == 0;
}

std::string StraightLine::power(const std::string& x, const Rational& exponent) const {
  const Rational e = abs(exponent);
  const std::string root = language_ == Language::python ? "np.sqrt(" : "sqrt(";
  std::string out;
  if (e == Rational(1, 2)) {
    out = root + x + ")";
  } else if (e == Rational(3, 2)) {
    out = x + "*" + root + x + ")";
  } else if (e.get_den() == 1 && e <= kLargestPower) {
    out = x;
    for (long k = e.get_num().get_si(); k > 1; --k) out += "*" + x;
  } else {
    return language_ == Language::python ? x + "**(" + number(exponent) + ")"
                                         : "pow(" + x + ", " + number(exponent) + ")";
  }
  return exponent < 0 ? "1/(" + out + ")" : out;
}

std::string StraightLine::operation(std::uint32_t s) {
  const Instruction& in = tape_.code[s];
  const std::string& a = in.op == Op::constant || in.op == Op::pi || in.op == Op::linear ? "" : name_[in.a];
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
      const std::string& x = name_[tape_.linear_terms[k].slot];
      out += out.empty() ? (c < 0 ? "-" : "") : c < 0 ? " - " : " + ";
      const Rational size = abs(c);
      if (size == 1)
        out += x;
      else if (const std::string n = number(size); n.find('/') == std::string::npos)
        out += n + "*" + x;
      else
        out += "(" + n + ")*" + x;
    }
    return out.empty() ? "0.0" : out;
  }
  case Op::multiply:
  case Op::scale:
    return a + "*" + name_[in.b];
  case Op::square:
    return a + "*" + a;
  case Op::divide:
    return a + "/" + name_[in.b];
  case Op::power:
    return power(a, tape_.rationals[in.index]);
  case Op::function: {
    const Function f = static_cast<Function>(in.index);
    used_sign_ = used_sign_ || f == Function::sign;
    return function_name(f) + "(" + a + ")";
  }
  case Op::arctan2:
    return (language_ == Language::python ? "np.arctan2(" : "atan2(") + a + ", " + name_[in.b] + ")";
  case Op::select:
    if (language_ == Language::python) return "np.where(" + name_[in.first] + " >= 0, " + a + ", " + name_[in.b] + ")";
    return "(" + name_[in.first] + " >= 0 ? " + a + " : " + name_[in.b] + ")";
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

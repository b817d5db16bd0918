#include "model/formula_of_slot.h"

#include <algorithm>
#include <cmath>

#include "model/exponents.h"

namespace anholon {

namespace {

constexpr std::size_t kLongestFormula = 120;

// Returns the formula of a slot; long ones are cut to keep the message one sentence long.
std::string short_text(const Tape& tape, const Model& model, std::uint32_t slot) {
  const NodeId node = tape.nodes[slot];
  if (node == Tape::kNoNode) return {};
  const std::string text = print(Expr{model.graph.get(), node}, model.names, Format::text);
  return text.size() <= kLongestFormula ? text : text.substr(0, kLongestFormula) + "...";
}

std::string power_text(const std::string& base, const Rational& exponent) {
  if (exponent == Rational(1, 2)) return "sqrt(" + base + ")";
  if (exponent == Rational(-1, 2)) return "1/sqrt(" + base + ")";
  return "(" + base + ")^(" + exponent.get_str() + ")";
}

struct Described {
  std::string formula;
  std::uint32_t argument;  // the slot whose value explains the fault
};

// Returns the power whose logarithm the slot is, as the user wrote it; empty if the slot is not such a logarithm.
std::string power_of_log(const Tape& tape, const Model& model, std::uint32_t slot) {
  const Instruction& in = tape.code[slot];
  if (in.op != Op::function || in.index != static_cast<std::uint32_t>(Function::log)) return {};
  const Graph& g = *model.graph;
  for (std::uint32_t s = slot; s < tape.code.size(); ++s) {
    if (tape.nodes[s] == Tape::kNoNode) continue;
    const std::optional<PowerParts> power = parts_of_power(g, tape.nodes[s]);
    if (!power || power->base != tape.nodes[in.a]) continue;
    const bool plain = power->factor == 1 && power->exponent.size() == 1 && power->exponent[0].second == 1;
    const Expr exponent{model.graph.get(), plain ? power->exponent[0].first : 0};
    const std::string base = short_text(tape, model, in.a),
                      of = plain ? print(exponent, model.names, Format::text) : std::string("...");
    const auto atom = [](const std::string& text) {
      return text.find_first_of(" +-*/^") == std::string::npos ? text : "(" + text + ")";
    };
    return atom(base) + "^" + atom(of);
  }
  return {};
}

// Returns the formula of a slot, and the slot of its argument.
Described described(const Tape& tape, const Model& model, std::uint32_t slot) {
  const Instruction& in = tape.code[slot];
  const auto name = [&](std::uint32_t of) {
    const std::string text = short_text(tape, model, of);
    return text.empty() ? std::string("...") : text;
  };
  switch (in.op) {
  case Op::power:
    return {power_text(name(in.a), tape.rationals[in.index]), in.a};
  case Op::divide:
    return {"a division by " + name(in.b), in.b};
  case Op::arctan2:
    return {"atan2(" + name(in.a) + ", " + name(in.b) + ")", in.a};
  case Op::function:
    if (const std::string power = power_of_log(tape, model, slot); !power.empty()) return {power, in.a};
    return {short_text(tape, model, slot).empty() ? "a function of " + name(in.a) : short_text(tape, model, slot),
            in.a};
  case Op::constant:
  case Op::pi:
  case Op::input:
  case Op::parameter:
  case Op::linear:
  case Op::multiply:
  case Op::scale:
  case Op::square:
  case Op::select:
  case Op::lookup:
  case Op::rate:
    break;
  }
  return {short_text(tape, model, slot).empty() ? "a formula" : short_text(tape, model, slot), slot};
}

using Formulas = std::vector<Expr>;

void add(Formulas& list, Expr e) {
  if (e.graph) list.push_back(e);
}
void add(Formulas& list, const Vector& v) {
  for (int i = 0; i < 3; ++i) add(list, v[i]);
}

// Calls visit(title, formulas) for each element that contributes to the equations of motion.
template <class Visit>
void for_each_element(const Model& model, const Visit& visit) {
  const auto show = [&](const std::string& kind, const std::string& name, const Formulas& formulas) {
    visit(kind + " '" + name + "'", formulas);
  };
  for (const Force& f : model.forces) {
    Formulas formulas;
    add(formulas, f.vector);
    add(formulas, f.tension);
    for (const auto& [coordinate, component] : f.generalized) add(formulas, component);
    show("the force", f.name, formulas);
  }
  for (const Potential& p : model.potentials) show("the potential", p.name, {p.value});
  for (const Dissipation& d : model.dissipation) show("the dissipation", d.name, {d.value});
  for (const Constraint& c : model.constraints) show("the constraint", c.name, {c.phi});
  for (const VaryingMass& m : model.masses) show("the mass of", m.name, {m.value});
  for (const StateVariable& z : model.states) show("the rate of", z.name, {z.rate});
  for (const Body& b : model.bodies) {
    Formulas formulas;
    add(formulas, b.center);
    show("the position of", b.name, formulas);
  }
}

// Returns the element whose formulas hold the node, "the force 'spring'"; empty if there is none or several.
std::string element_with(const Model& model, NodeId node) {
  std::string found;
  int elements = 0;
  for_each_element(model, [&](const std::string& title, const Formulas& formulas) {
    const std::vector<NodeId> nodes = reachable(formulas);
    if (!std::binary_search(nodes.begin(), nodes.end(), node)) return;
    ++elements;
    found = title;
  });
  return elements == 1 ? found : std::string();
}

// Returns the element with the formula of the slot or, if derivation has changed the formula, with its argument: " in
// the force 'spring'".
std::string in_element(const Tape& tape, const Model& model, std::uint32_t slot, std::uint32_t argument) {
  for (const std::uint32_t s : {slot, argument}) {
    if (tape.nodes[s] == Tape::kNoNode || tape.code[s].op == Op::input) continue;
    if (const std::string element = element_with(model, tape.nodes[s]); !element.empty()) return " in " + element;
  }
  return {};
}

std::string message(const Tape& tape, const Model& model, std::uint32_t slot, const Described& d,
                    const std::string& place, const std::function<double(std::uint32_t)>& value) {
  std::string out = d.formula + place + (std::isfinite(value(slot)) ? " has no derivatives" : " has no value");
  if (d.argument == slot) return out;
  const std::string argument = short_text(tape, model, d.argument);
  return argument.empty() ? out : out + ", where " + argument + " = " + number_text(value(d.argument), 6);
}

}  // namespace

std::string message_without_value(const Tape& tape, const Model& model, std::uint32_t slot,
                                  const std::function<double(std::uint32_t)>& value) {
  return message(tape, model, slot, described(tape, model, slot), "", value);
}

Outcome without_value(const Tape& tape, const Model& model, std::uint32_t slot,
                      const std::function<double(std::uint32_t)>& value) {
  const Described d = described(tape, model, slot);
  std::string text = message(tape, model, slot, d, in_element(tape, model, slot, d.argument), value);
  if (!power_of_log(tape, model, slot).empty())
    return {OutcomeKind::not_a_number, std::move(text),
            "a power has a value at and below 0 only if its exponent is a fixed whole number: write abs(x)^n*sign(x) "
            "for an odd power of any sign of x, abs(x)^n for an even one"};
  return {OutcomeKind::not_a_number, std::move(text),
          "start or stop the motion away from this point, or change the formula so that it is smooth here"};
}

}  // namespace anholon

#include "program/program.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

// From this number of unknowns on, J may be sparse.
static constexpr std::size_t kMany = 64;

// True if nonlinear equations may have several solutions. If the mechanical equations contain no rate of a state,
// accelerations and multipliers follow from them alone; if these equations are linear in them, the rates follow,
// whatever their formulas.
static bool may_have_several_solutions(const Program& p, const std::vector<std::uint32_t>& nonlinear) {
  const std::size_t mechanical = p.system->mechanical();
  const auto roots = p.tape.roots.begin();
  const std::vector<std::uint32_t> needed =
      precedents(p.tape, {roots, roots + static_cast<std::ptrdiff_t>(mechanical)});
  const auto needs = [&](std::uint32_t slot) { return std::binary_search(needed.begin(), needed.end(), slot); };
  return std::any_of(nonlinear.begin(), nonlinear.end(), needs) ||
         std::any_of(p.inputs.begin(), p.inputs.end(),
                     [&](const ProgramInput& in) { return in.leading && in.variable >= mechanical && needs(in.slot); });
}

// Groups the unknowns by their scales. Multipliers that are no states have none.
static std::vector<std::vector<std::uint32_t>> scales(const System& system, const std::vector<int>& d) {
  std::vector<std::vector<std::uint32_t>> list;
  for (std::uint32_t j = 0; j < d.size(); ++j) {
    const std::size_t scale = system.scales.empty() ? 0 : system.scales[j];
    if (list.size() <= scale) list.resize(scale + 1);
    if (d[j] > 0) list[scale].push_back(j);
  }
  std::erase_if(list, [](const auto& members) { return members.empty(); });
  return list;
}

Program program(const System& system, const Structure& structure, std::span<const Expr> quadratures, bool shared) {
  Program p;
  p.system = &system;
  p.c = structure.c;
  p.d = structure.d;
  p.scales = scales(system, p.d);
  Column es = system.equations;
  es.insert(es.end(), quadratures.begin(), quadratures.end());
  p.quadratures = quadratures.size();
  p.tape = compile(es, structure.c, shared, system.rates, static_cast<std::uint32_t>(system.coordinates));

  const Graph& g = *system.model->graph;
  p.tangent_row.assign(p.tape.code.size(), Program::kUntainted);
  for (const Input& in : p.tape.inputs) {
    const Node& n = g.node(in.symbol);
    ProgramInput input;
    input.slot = in.slot;
    if (n.kind == Kind::time) {
      input.kind = ProgramInput::Kind::time;
    } else if (const auto j = system.variable(in.symbol)) {
      input.kind = ProgramInput::Kind::variable;
      input.variable = *j;
      input.order = n.order;
      const int lead = p.tape.code[in.slot].lead;
      input.leading = in.slot < p.tape.main_end && n.order + lead == p.d[*j];
      if (input.leading) p.tangent_row[in.slot] = static_cast<std::uint32_t>(p.tangent_rows++);
    }
    p.inputs.push_back(input);
  }

  const std::vector<Instruction>& code = p.tape.code;
  std::vector<std::uint32_t> nonlinear;
  const auto tainted = [&](std::uint32_t slot, std::uint8_t lead) {
    return p.tangent_row[slot] != Program::kUntainted && code[slot].lead == lead;
  };
  for (std::uint32_t s = 0; s < p.tape.main_end; ++s) {
    const Instruction& in = code[s];
    TaintedSlot t{s, 0, false, false};
    switch (in.op) {
    case Op::constant:
    case Op::pi:
    case Op::input:
    case Op::parameter:
    case Op::lookup:
      continue;
    case Op::linear:
      for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
        t.a = t.a || tainted(p.tape.linear_terms[k].slot, in.lead);
      break;
    case Op::multiply:
    case Op::scale:
    case Op::divide:
    case Op::arctan2:
    case Op::select:
      t.a = tainted(in.a, in.lead);
      t.b = tainted(in.b, in.lead);
      break;
    case Op::square:
    case Op::power:
    case Op::function:
      t.a = tainted(in.a, in.lead);
      break;
    case Op::rate:
      t.a = tainted(in.a, static_cast<std::uint8_t>(in.lead + in.index));
      break;
    }
    if (!t.a && !t.b) continue;
    // At higher orders of the series (leads above 0) they enter linearly for every operation.
    const bool product = in.op == Op::multiply || in.op == Op::scale;
    if (in.lead == 0 && in.op != Op::linear && in.op != Op::select && in.op != Op::rate &&
        (product ? t.a && t.b : in.op != Op::divide || t.b))
      nonlinear.push_back(s);
    t.row = static_cast<std::uint32_t>(p.tangent_rows++);
    p.tangent_row[s] = t.row;
    p.tainted.push_back(t);
  }
  p.nonlinear = !nonlinear.empty();
  p.several_solutions = p.nonlinear && may_have_several_solutions(p, nonlinear);
  if (p.unknowns() >= kMany) p.linearized = linearized(p);
  return p;
}

ProgramSize size(const Program& p) {
  ProgramSize r{p.tape.code.size(), 0, 0, 0, p.tainted.size()};
  for (const Instruction& in : p.tape.code) {
    if (in.constant) continue;
    switch (in.op) {
    case Op::constant:
    case Op::pi:
    case Op::input:
    case Op::parameter:
      break;
    case Op::linear:
    case Op::scale:
    case Op::select:
    case Op::lookup:
    case Op::rate:
      ++r.linear;
      break;
    case Op::multiply:
    case Op::square:
    case Op::divide:
      ++r.products;
      break;
    case Op::power:
    case Op::function:
    case Op::arctan2:
      ++r.functions;
      break;
    }
  }
  return r;
}

static std::string line(const Program& p, std::uint32_t s) {
  const Instruction& in = p.tape.code[s];
  const auto slot = [](std::uint32_t k) { return "s" + std::to_string(k); };
  switch (in.op) {
  case Op::constant:
    return p.tape.rationals[in.index].get_str();
  case Op::pi:
    return "pi";
  case Op::parameter:
    return p.system->model->names.parameters[in.index];
  case Op::input:
    return print(Expr{p.system->model->graph.get(), p.tape.inputs[in.index].symbol}, p.system->model->names,
                 Format::text);
  case Op::linear: {
    std::string out;
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const LinearTerm& t = p.tape.linear_terms[k];
      const std::string c = p.tape.rationals[t.coefficient].get_str();
      out += (out.empty() ? "" : " + ") + (c == "1" ? "" : c + " ") + slot(t.slot);
    }
    return out;
  }
  case Op::multiply:
  case Op::scale:
    return slot(in.a) + " * " + slot(in.b);
  case Op::square:
    return slot(in.a) + "^2";
  case Op::divide:
    return slot(in.a) + " / " + slot(in.b);
  case Op::power:
    return slot(in.a) + "^(" + p.tape.rationals[in.index].get_str() + ")";
  case Op::function:
    return std::string(info(static_cast<Function>(in.index)).name) + "(" + slot(in.a) + ")";
  case Op::arctan2:
    return "atan2(" + slot(in.a) + ", " + slot(in.b) + ")";
  case Op::select:
    return slot(in.first) + " >= 0 ? " + slot(in.a) + " : " + slot(in.b);
  case Op::lookup:
    return p.tape.step_functions[in.index].name + "(" + slot(in.a) + ")";
  case Op::rate:
    return "D^" + std::to_string(in.index) + " " + slot(in.a);
  }
  return {};
}

std::string print(const Program& p) {
  std::string out;
  for (std::uint32_t s = 0; s < p.tape.code.size(); ++s) {
    const Instruction& in = p.tape.code[s];
    out += "s" + std::to_string(s) + " = " + line(p, s);
    if (in.lead > 0) out += "    lead " + std::to_string(in.lead);
    if (s < p.tape.main_end && p.tangent_row[s] != Program::kUntainted) out += "    leading";
    out += "\n";
  }
  for (std::size_t i = 0; i < p.c.size(); ++i)
    out += "equation " + p.system->equation_names[i] + ": s" + std::to_string(p.tape.roots[i]) +
           " = 0, differentiated " + std::to_string(p.c[i]) + " times\n";
  const ProgramSize n = size(p);
  out += std::to_string(n.slots) + " slots: " + std::to_string(n.products) + " products, " + std::to_string(n.linear) +
         " linear, " + std::to_string(n.functions) + " functions; " + std::to_string(n.tainted) +
         " depend on the unknowns of a stage\n";
  return out;
}

}  // namespace anholon

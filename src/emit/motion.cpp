#include "emit/motion.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon::emit {

namespace {

std::string times_differentiated(int c) {
  return c == 0 ? "" : c == 1 ? ", differentiated once" : ", differentiated " + std::to_string(c) + " times";
}

void refuse_unknown_functions(const System& s) {
  const Model& model = *s.model;
  for (NodeId id : symbols(s.equations)) {
    const Node& node = model.graph->node(id);
    if (node.kind == Kind::given)
      throw Failure(Span{}, "the given function '" + model.unknown_functions[node.index] + "' has no formula",
                    "a program needs one: [functions] " + model.unknown_functions[node.index] + " = \"…\"");
    ANHOLON_ASSERT(node.kind != Kind::mass);
  }
}

// Adds the state: the derivatives of each variable below its leading one.
void add_state(const System& s, const Structure& structure, Motion& m) {
  const std::size_t n = s.size();
  int largest_d = 0;
  for (int d : structure.d) largest_d = std::max(largest_d, d);
  for (int k = 0; k < largest_d; ++k)
    for (std::size_t j = 0; j < n; ++j)
      if (k < structure.d[j]) m.state.push_back({j, static_cast<unsigned>(k)});
  for (const StateEntry& e : m.state)
    m.state_names.push_back(derivative_name(s.variable_names[e.variable], e.order, Format::text));
  for (std::size_t j = 0; j < n; ++j)
    m.leading_names.push_back(
        derivative_name(s.variable_names[j], static_cast<unsigned>(structure.d[j]), Format::text));
}

// Returns the leading derivatives that occur in equation i, which is differentiated c times; zero for each other
// variable.
Column leading_derivatives(const System& s, const Structure& structure, std::size_t i) {
  Column leading;
  for (std::size_t j = 0; j < s.size(); ++j) {
    const int order = structure.sigma[i][j];
    leading.push_back(order != kAbsent && order == structure.d[j] - structure.c[i]
                          ? s.symbol(j, static_cast<unsigned>(order))
                          : s.model->graph->zero());
  }
  return leading;
}

// Adds residual, Jacobian and hidden constraints of equation i.
void add_equation(const System& s, const Structure& structure, std::size_t i, Motion& m) {
  Graph& g = *s.model->graph;
  // Derivatives that do not truly occur are set to zero before further differentiation.
  const auto up_to = [&](const Column& es, int below) {
    return substitute(es, [&](NodeId id) {
      const auto j = s.variable(id);
      return j && static_cast<int>(g.node(id).order) > structure.d[*j] - below ? g.zero() : Expr{};
    });
  };
  const int c = structure.c[i];
  Column e = up_to({s.equations[i]}, c);
  const Column leading = leading_derivatives(s, structure, i);
  // A symbol that is not a leading derivative is 0 in `leading`, on which nothing depends.
  Column row = gradient(e[0], leading);
  for (std::size_t j = 0; j < s.size(); ++j)
    if (is_zero(leading[j])) row[j] = g.zero();
  m.jacobian.push_back(row);
  for (int k = 0; k < c; ++k) {
    m.hidden.push_back(e[0]);
    m.hidden_names.push_back(derivative_name(s.equation_names[i], static_cast<unsigned>(k), Format::text));
    e = up_to(total_derivative(e), c - k - 1);
  }
  m.residual.push_back(e[0]);
  m.equation_names.push_back(s.equation_names[i] + times_differentiated(c));
}

bool is_linear(const System& s, const Structure& structure, const std::vector<Column>& jacobian) {
  for (const Column& row : jacobian)
    for (NodeId id : symbols(row)) {
      const auto j = s.variable(id);
      if (j && static_cast<int>(s.model->graph->node(id).order) == structure.d[*j]) return false;
    }
  return true;
}

// Adds the values of the parameters. Parameters may refer to each other in any order: values are substituted until only
// free parameters are left.
void add_parameters(const Model& model, Motion& m) {
  for (const Parameter& p : model.parameters) m.parameters.push_back(p.value);
  if (m.parameters.empty()) return;
  std::vector<bool> free;
  for (std::size_t i = 0; i < m.parameters.size(); ++i) {
    free.push_back(symbols({&m.parameters[i], 1}).empty());
    if (!free.back()) m.derived.push_back(i);
  }
  for (std::size_t depth = 0; depth < m.parameters.size(); ++depth)
    m.parameters = substitute(m.parameters, [&](NodeId id) {
      const Node& node = model.graph->node(id);
      return node.kind == Kind::parameter && !free[node.index] ? model.parameters[node.index].value : Expr{};
    });
}

// The symbols that formulas of a program may contain: the time, state and lead, parameters and inputs.
class Known {
 public:
  Known(const System& s, const Motion& m) : s_(s), m_(m) {}

  // Returns e with the formulas of masses and inputs substituted; multipliers of redundant constraints are zero.
  Expr written(Expr e) const {
    Graph& g = *s_.model->graph;
    e = put_masses(*s_.model, put_state_rates(*s_.model, e, 2));
    return substitute({&e, 1}, [&](NodeId id) {
      const Node& n = g.node(id);
      if (n.kind == Kind::multiplier && !s_.variable(id)) return g.zero();
      return Expr{};
    })[0];
  }

  bool holds_all_of(Expr e) const {
    const Graph& g = *s_.model->graph;
    const std::vector<NodeId> list = symbols({&e, 1});
    return std::all_of(list.begin(), list.end(), [&](NodeId id) {
      const Node& n = g.node(id);
      if (n.kind == Kind::time || n.kind == Kind::parameter) return true;
      if (n.kind == Kind::control)
        return n.order == 0 && std::find(m_.inputs.begin(), m_.inputs.end(), n.index) != m_.inputs.end();
      const auto j = s_.variable(id);
      return j && static_cast<int>(n.order) <= m_.orders[*j];
    });
  }

  // Returns an event; nullopt if it contains symbols that a program does not know.
  std::optional<Motion::Event> event(std::size_t k) const {
    const Event& e = s_.model->events[k];
    const Graph& g = *s_.model->graph;
    Motion::Event out{k, written(e.when), {}, {}, false};
    bool known = holds_all_of(out.when);
    for (const Assignment& set : e.set) {
      const Node& n = g.node(set.symbol.id);
      const auto j = s_.variable(set.symbol.id);
      if (n.kind != Kind::parameter && (!j || static_cast<int>(n.order) >= m_.orders[*j])) return std::nullopt;
      out.targets.push_back(n.kind == Kind::parameter ? "p[" + std::to_string(n.index) + "]"
                                                      : "state[" + std::to_string(m_.place(*j, n.order)) + "]");
      out.values.push_back(written(set.value));
      out.moves = out.moves || n.kind == Kind::jet;
      known = known && holds_all_of(out.values.back());
    }
    return known ? std::optional(std::move(out)) : std::nullopt;
  }

 private:
  const System& s_;
  const Motion& m_;
};

}  // namespace

std::size_t Motion::place(std::size_t variable, unsigned order) const {
  for (std::size_t i = 0; i < state.size(); ++i)
    if (state[i].variable == variable && state[i].order == order) return i;
  ANHOLON_ASSERT(!"a derivative that is no part of the state");
  return 0;
}

Motion motion(const System& s, const Structure& structure, const EmitOptions& options) {
  Motion m = motion_between_events(s, structure, options.inputs);
  const Known known(s, m);
  for (const auto& [name, value] : options.outputs) {
    const Expr e = known.written(value);
    if (!known.holds_all_of(e)) {
      m.left_out.push_back("the output " + name);
      continue;
    }
    m.output_names.push_back(name);
    m.outputs.push_back(e);
  }
  for (std::size_t k = 0; k < s.model->events.size(); ++k) {
    if (auto event = known.event(k))
      m.events.push_back(*std::move(event));
    else
      m.left_out.push_back("the event " + s.model->events[k].name);
  }
  return m;
}

Motion motion_between_events(const System& s, const Structure& structure, std::span<const InputFormula> inputs) {
  refuse_unknown_functions(s);
  Motion m;
  m.orders = structure.d;
  for (const InputFormula& u : inputs) {
    m.inputs.push_back(u.control);
    m.input_values.push_back(u.value);
    m.input_names.push_back(s.model->controls[u.control].name);
  }
  add_state(s, structure, m);
  for (std::size_t i = 0; i < s.size(); ++i) add_equation(s, structure, i, m);
  m.linear = is_linear(s, structure, m.jacobian);
  add_parameters(*s.model, m);
  return m;
}

std::vector<double> start_state(const Motion& m, const EmitOptions::Start& start) {
  std::vector<double> out;
  for (const StateEntry& e : m.state) out.push_back(start.values.at(e.variable).at(e.order));
  return out;
}

}  // namespace anholon::emit

#include "emit/motion.h"

#include "base/assert.h"

namespace anholon::emit {

namespace {

std::string times_differentiated(int c) {
  return c == 0 ? "" : c == 1 ? ", differentiated once" : ", differentiated " + std::to_string(c) + " times";
}

void refuse_events(const Model& model) {
  for (const Event& e : model.events)
    if (!e.set.empty())
      throw Failure(e.span, "a program for a model whose events set something ('" + e.name + "') is not written yet",
                    "anholon simulate computes its motion");
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

// The state: the derivatives of each variable below its leading one.
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

// The leading derivatives that occur in equation i, which is differentiated c times; zero for each other variable.
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

// Residual, Jacobian and hidden constraints of equation i.
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

// The values of the parameters. Parameters may refer to each other in any order: values are substituted until only free
// parameters are left.
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

}  // namespace

std::size_t Motion::place(std::size_t variable, unsigned order) const {
  for (std::size_t i = 0; i < state.size(); ++i)
    if (state[i].variable == variable && state[i].order == order) return i;
  ANHOLON_ASSERT(!"a derivative that is no part of the state");
  return 0;
}

Motion motion(const System& s, const Structure& structure, const EmitOptions& options) {
  refuse_events(*s.model);
  return motion_between_events(s, structure, options.inputs);
}

Motion motion_between_events(const System& s, const Structure& structure, std::span<const InputFormula> inputs) {
  refuse_unknown_functions(s);
  Motion m;
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

std::vector<double> start_state(const System& s, const Motion& m, const EmitOptions::Start& start) {
  std::vector<double> out;
  for (const StateEntry& e : m.state)
    out.push_back(e.variable >= s.mechanical()                 ? start.states[e.variable - s.mechanical()]
                  : e.variable >= s.coordinates || e.order > 1 ? 0
                  : e.order == 0                               ? start.q[e.variable]
                                                               : start.qd[e.variable]);
  return out;
}

}  // namespace anholon::emit

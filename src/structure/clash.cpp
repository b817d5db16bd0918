// Why there are no consistent initial data, in words.
#include "expr/normal.h"
#include "structure/state_solver.h"

namespace anholon {

template <Number N>
std::string StateSolver<N>::entry_name(const Node& n) const {
  return derivative_name(n.kind == Kind::multiplier ? "lambda." + model_.constraints[n.index].name : model_.coordinates[n.index].name, n.order, Format::text);
}

// The derivatives and multipliers of the nonlinear constraints.
template <Number N>
std::string StateSolver<N>::solution_text(const std::vector<N>& x, const System& s, const Structure& t) const {
  std::string list;
  for (std::size_t j = 0; j < s.size(); ++j) {
    if (j >= s.mechanical()) continue;
    bool named = j >= s.coordinates && may_branch(m_, s, s.constraints[j - s.coordinates]);
    for (std::size_t r : s.constraints) named = named || (j < s.coordinates && may_branch(m_, s, r) && !is_zero(m_.Phi[r][j]));
    if (!named) continue;
    list += (list.empty() ? "" : ", ") + derivative_name(s.variable_names[j], static_cast<unsigned>(t.d[j]), Format::text) + " = " + number_text(to_double(x[j]), 6);
  }
  return list;
}

template <Number N>
Outcome StateSolver<N>::no_leading(const System& s, const LeadingSolutions<N>& solutions, const std::string& others) const {
  std::string which;
  for (std::size_t r : s.constraints)
    if (may_branch(m_, s, r)) which += (which.empty() ? "'" : ", '") + model_.constraints[r].name + "'";
  if (!others.empty())
    return {OutcomeKind::inconsistent, "no solution lies on the branch asked for; there is " + others, "another [initial] branch, or other initial data"};
  if (solutions.singular)
    return {OutcomeKind::singular,
            "singular configuration: the multiplier of the constraint " + which + " is 0 at the start, and the equations do not determine the motion there",
            "give initial data at which the constraint has a reaction: other accelerations, [initial] qddot = {…}"};
  return {OutcomeKind::no_convergence, "no derivatives were found at the start that satisfy the constraint " + which + " and the equations of motion",
          "there may be no real solution; a guess helps where there is one: [initial] guess = {…}"};
}

template <Number N>
std::string StateSolver<N>::kind(const Stage<N>& stage) const {
  const Node& n = stage.unknown(0);
  return n.kind != Kind::jet || n.order > 1 ? "higher derivatives" : n.order == 0 ? "positions" : "velocities";
}

template <Number N>
Outcome StateSolver<N>::no_value(const Stage<N>& stage) {
  return {OutcomeKind::inconsistent,
          "the " + kind(stage) + " cannot be found: " + stage.equation(0).what + " or its neighbours have no value at the initial data",
          "give a guess near the wanted configuration: [initial] guess = {…}"};
}

// What an equation asks of the unknowns that are free, the values of the others put in: "x'^2 + 1 = 0".
template <Number N>
std::string StateSolver<N>::asked(const Stage<N>& stage, std::size_t row) const {
  constexpr std::size_t kMostUnknowns = 2, kLongest = 60;
  constexpr long kMostWork = 2000;
  if (p_.plan && !p_.alone) return {};  // it would take an expression
  const Graph& g = m_.graph();
  const Expr residual = stage.equation(row).residual;
  std::size_t open = 0;
  bool valued = true;
  const auto number = [&](const N& value) {
    const std::optional<Rational> r = parse_rational(number_text(to_double(value), 6));
    valued = valued && r;
    return m_.graph().number(r ? *r : Rational(0));
  };
  const auto free = [&](NodeId id) {
    for (std::size_t j = 0; j < stage.unknowns(); ++j)
      if (&stage.unknown(j) == &g.node(id)) return *state_.origin(g.node(id)) != Origin::given;
    return false;
  };
  const Expr e = substitute({&residual, 1}, [&](NodeId id) {
    const Node& n = g.node(id);
    if (free(id)) return ++open, Expr{};
    if (n.kind == Kind::time) return number(state_.t);
    if (n.kind == Kind::parameter) return number(p_.parameters[n.index]);
    if (const N* value = state_.value(n)) return number(*value);
    return Expr{};
  })[0];
  if (open == 0 || open > kMostUnknowns || !valued || stage.equation(row).span.line == 0) return {};
  const std::optional<Expr> full = expanded(e, kMostWork);
  const std::string text = print(full ? *full : e, model_.names, Format::text);
  return text.size() > kLongest ? std::string() : "; it asks for " + text + " = 0 here";
}

template <Number N>
Outcome StateSolver<N>::clash(const Stage<N>& stage, std::size_t row) {
  const StageEquation& e = stage.equation(row);
  std::string fixed;
  for (std::size_t j = 0; j < stage.unknowns(); ++j) {
    const Node& n = stage.unknown(j);
    if (*state_.origin(n) == Origin::given && abs(stage.jacobian(row, j)) > N(0)) fixed += (fixed.empty() ? "" : ", ") + entry_name(n);
  }
  const std::string at = e.span.line ? " (line " + std::to_string(e.span.line) + ")" : "";
  return {OutcomeKind::inconsistent,
          e.what + at + " is missed by " + number_text(std::abs(to_double(stage.residual[row])), 3) + " with the initial data given" + asked(stage, row),
          fixed.empty() ? "it clashes with another constraint or condition, or has no real solution near the guess: [initial] guess = {…}"
                        : "leave out " + std::string(fixed.find(',') == std::string::npos ? "" : "one of ") + fixed +
                              " (what is missing is found from the constraints), if the equation can be satisfied at all"};
}

#define INSTANTIATE(N)                                                                                              \
  template std::string StateSolver<N>::entry_name(const Node&) const;                                               \
  template std::string StateSolver<N>::solution_text(const std::vector<N>&, const System&, const Structure&) const; \
  template Outcome StateSolver<N>::no_leading(const System&, const LeadingSolutions<N>&, const std::string&) const; \
  template Outcome StateSolver<N>::no_value(const Stage<N>&);                                                       \
  template Outcome StateSolver<N>::clash(const Stage<N>&, std::size_t);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

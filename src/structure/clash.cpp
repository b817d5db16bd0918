// Messages that explain why there are no consistent initial data.
#include <algorithm>
#include <utility>

#include "expr/normal.h"
#include "structure/state_solver.h"

namespace anholon {

static constexpr const char* kGiveGuess =
    "there may be no real solution; a guess helps where there is one: [initial] guess = {…}";

template <Number N>
std::string StateSolver<N>::entry_name(const Node& n) const {
  return derivative_name(n.kind == Kind::multiplier ? multiplier_name(model_, n.index)
                         : n.kind == Kind::state    ? model_.states[n.index].name
                                                    : model_.coordinates[n.index].name,
                         n.order, Format::text);
}

// Lists the derivatives and multipliers of the nonlinear constraints, and the derivatives in which forces are
// nonlinear.
template <Number N>
std::string StateSolver<N>::solution_text(const std::vector<N>& x, const System& s, const Structure& t) const {
  std::string list;
  const Column of_forces = nonlinear_in_forces(m_, t.d);
  for (std::size_t j = 0; j < s.size(); ++j) {
    if (j >= s.mechanical()) continue;
    const Expr leading = s.symbol(j, static_cast<unsigned>(t.d[j]));
    bool named = j >= s.coordinates && may_branch(m_, s, s.constraints[j - s.coordinates]);
    for (std::size_t r : s.constraints)
      named = named || (j < s.coordinates && may_branch(m_, s, r) && !is_zero(m_.Phi[r][j]));
    named = named || std::any_of(of_forces.begin(), of_forces.end(), [&](Expr of) { return of.id == leading.id; });
    if (!named) continue;
    list += (list.empty() ? "" : ", ") +
            derivative_name(s.variable_names[j], static_cast<unsigned>(t.d[j]), Format::text) + " = " +
            number_text(to_double(x[j]), 6);
  }
  return list;
}

template <Number N>
Outcome StateSolver<N>::no_leading(const System& s, const LeadingSolutions<N>& solutions,
                                   const std::string& others) const {
  std::string which;
  for (std::size_t r : s.constraints)
    if (may_branch(m_, s, r)) which += (which.empty() ? "'" : ", '") + model_.constraints[r].name + "'";
  if (!others.empty())
    return {OutcomeKind::inconsistent, "no solution lies on the branch asked for; there is " + others,
            "another [initial] branch, or other initial data"};
  if (which.empty()) return no_accelerations(solutions.singular);
  if (solutions.singular)
    return {OutcomeKind::singular,
            "singular configuration: the multiplier of the constraint " + which +
                " is 0 at the start, and the equations do not determine the motion there",
            "give initial data at which the constraint has a reaction: other accelerations, [initial] qddot = {…}"};
  return {OutcomeKind::no_convergence,
          "no derivatives were found at the start that satisfy the constraint " + which +
              " and the equations of motion",
          kGiveGuess};
}

// Returns the outcome for forces that are nonlinear in the accelerations if no regular solution is found.
template <Number N>
Outcome StateSolver<N>::no_accelerations(bool singular) const {
  if (singular)
    return {OutcomeKind::singular,
            "singular configuration: forces are nonlinear in accelerations, or in velocities of coordinates without "
            "inertia, and the equations of motion do not determine these at the start",
            "give other initial data"};
  return {
      OutcomeKind::no_convergence,
      "forces are nonlinear in accelerations, or in velocities of coordinates without inertia, and no values of these "
      "were found at the start that satisfy the equations of motion",
      kGiveGuess};
}

template <Number N>
std::string StateSolver<N>::kind(const Stage<N>& stage) const {
  const Node& n = stage.unknown(0);
  for (std::size_t j = 1; j < stage.unknowns(); ++j)
    if (is_higher(stage.unknown(j)) != is_higher(n)) return "initial data";
  return n.kind != Kind::jet || n.order > 1 ? "higher derivatives" : n.order == 0 ? "positions" : "velocities";
}

template <Number N>
Outcome StateSolver<N>::no_value(const Stage<N>& stage) {
  const std::string what =
      stage.undefined < stage.size() ? equation_text(stage.equation(stage.undefined)) : "the mass matrix";
  return {OutcomeKind::inconsistent,
          "the " + kind(stage) + " cannot be found: " + what + " has no value at the initial data",
          "give a guess near the wanted configuration: [initial] guess = {…}"};
}

// Describes an equation: "constraint 'edge' (line 10)".
template <Number N>
std::string StateSolver<N>::equation_text(const StageEquation& e) const {
  return e.what + (e.span.line ? " (" + line_of(e.span, model_.source_text) + ")" : "");
}

// Returns the equation with the known values substituted, as a condition on the free or released unknowns: "x'^2 + 1 =
// 0".
template <Number N>
std::string StateSolver<N>::asked(const Stage<N>& stage, std::size_t row,
                                  const std::vector<std::size_t>& released) const {
  constexpr std::size_t kMostUnknowns = 2, kLongest = 60;
  constexpr long kMostWork = 2000;
  const Graph& g = m_.graph();
  const std::unique_ptr<Graph> own = g.clone();  // other threads may be reading the graph
  const Expr residual = own->own(stage.equation(row).residual);
  std::size_t open = 0;
  bool valued = true;
  const auto number = [&](const N& value) {
    const std::optional<Rational> r = parse_rational(number_text(to_double(value), 6));
    valued = valued && r;
    return own->number(r ? *r : Rational(0));
  };
  const auto free = [&](NodeId id) {
    for (std::size_t j = 0; j < stage.unknowns(); ++j)
      if (&stage.unknown(j) == &g.node(id))
        return *state_.origin(g.node(id)) != Origin::given ||
               std::find(released.begin(), released.end(), j) != released.end();
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
  return text.size() > kLongest ? std::string() : "asks for " + text + " = 0 here";
}

// Joins parts as "x, y and z".
static std::string listed(const std::vector<std::string>& parts, const char* last = " and ") {
  std::string text;
  for (std::size_t k = 0; k < parts.size(); ++k) text += (k == 0 ? "" : k + 1 == parts.size() ? last : ", ") + parts[k];
  return text;
}

std::pair<std::string, std::string> told_apart(double a, double b) {
  for (int digits : {6, 9, 12, 17})
    if (std::pair text(number_text(a, digits), number_text(b, digits)); text.first != text.second || digits == 17)
      return text;
  return {};
}

namespace {

// A value or a condition that may be left out; `value` is a value that would fit instead, if it is known.
struct Given {
  std::string name, key, value;
  Span span;
};

// Returns the names as "x'", "qr' in wheel.toml".
std::vector<std::string> with_files(const std::vector<Given>& given, const SourceText& source) {
  std::vector<std::string> names;
  for (const Given& g : given) names.push_back(g.name + (g.span.file > 0 ? " in " + source.of(g.span).name : ""));
  return names;
}

// Tells what to write instead in a file over a base: entries of a base cannot be removed, but its values and its list
// of conditions can be replaced.
std::string over_base(const std::vector<Given>& given) {
  std::vector<std::string> replaced;
  bool conditions = false;
  for (const Given& g : given) {
    if (g.span.file == 0) continue;
    if (!g.key.empty())
      replaced.push_back("initial.\"" + g.key + "\" = " + (g.value.empty() ? "…" : g.value));
    else if (!std::exchange(conditions, true))
      replaced.emplace_back("initial.conditions = […]");
  }
  return replaced.empty() ? ""
                          : "; a file over this base can replace it, not leave it out: " + listed(replaced, " or ");
}

}  // namespace

// Returns a message with the given values and the equations that contradict each other.
template <Number N>
Outcome StateSolver<N>::clash_of(const Stage<N>& stage, const Contradiction<N>& c,
                                 const InitialState<N>& before) const {
  std::vector<std::string> values, equations;
  std::vector<Given> names, conditions;
  std::string wanted;
  for (std::size_t j : c.given) {
    const Node& n = stage.unknown(j);
    const double value = to_double(stage.x_of(before, j));
    const auto [is, other] =
        c.wanted ? told_apart(value, to_double(*c.wanted)) : std::pair(number_text(value, 6), std::string());
    const std::string name = entry_name(n);
    Span span;
    for (const GivenValue& v : model_.initial.given)
      if (&node(v.symbol) == &n && !overridden(n)) span = v.span;
    names.push_back({name, name, other, span});
    values.push_back(name + " = " + is + (span.line ? " (" + line_of(span, model_.source_text) + ")" : ""));
    if (c.wanted) wanted = name + " = " + other;
  }
  const bool alone = c.equations.size() == 1;
  bool clauses = false;
  for (std::size_t i : c.equations) {
    const StageEquation& e = stage.equation(i);
    if (e.condition) conditions.push_back({e.what, {}, {}, e.span});
    const std::string asks =
        wanted.empty() || !alone || !stage.linear() ? asked(stage, i, c.given) : "asks for " + wanted + " here";
    clauses = clauses || !asks.empty();
    equations.push_back(equation_text(e) + (asks.empty() ? "" : ", which " + asks));
  }
  const std::string guess = "where there is a solution, a guess near it helps: [initial] guess = {…}";
  if (values.empty() && alone)
    return {OutcomeKind::inconsistent, "no " + kind(stage) + " satisfy " + equations[0],
            stage.linear() ? "start elsewhere, or change the equation"
                           : "the equation may have no real solution; " + guess};
  if (values.empty())
    return {OutcomeKind::inconsistent,
            listed(equations, clauses ? ", and " : " and ") + ": no " + kind(stage) + " satisfy " +
                (equations.size() == 2 ? "both" : "all of them"),
            (conditions.empty() ? "one of them has to go, or the motion starts elsewhere"
                                : "leave out " + listed(with_files(conditions, model_.source_text), " or ")) +
                over_base(conditions) + (stage.linear() ? "" : "; " + guess)};
  std::string message = listed(values) + (values.size() == 1 ? " clashes with " : " clash with ") +
                        listed(equations, clauses ? ", and " : " and ");
  if (!wanted.empty() && !stage.linear())
    message += "; " + wanted + " would fit";
  else if (!wanted.empty() && !alone)
    message += "; together they ask for " + wanted + " here";
  names.insert(names.end(), conditions.begin(), conditions.end());
  return {OutcomeKind::inconsistent, message,
          "leave out " + std::string(names.size() == 1 ? "" : "one of ") +
              listed(with_files(names, model_.source_text), ", ") + " (what is missing is found from the constraints)" +
              over_base(names) + (stage.linear() || c.wanted ? "" : "; " + guess)};
}

template <Number N>
Outcome StateSolver<N>::clash(Stage<N>& stage, std::size_t worst, const InitialState<N>& before) {
  std::vector<bool> given;
  for (std::size_t j = 0; j < stage.unknowns(); ++j) given.push_back(*before.origin(stage.unknown(j)) == Origin::given);
  const double missed = std::abs(to_double(stage.residual[worst]));
  const std::string asks = asked(stage, worst, {});
  InitialState<N> start = before;
  const auto c = contradiction(stage, start, given, worst);
  clash_is_told_ = c.has_value();
  if (c) return clash_of(stage, *c, before);
  return {
      OutcomeKind::inconsistent,
      equation_text(stage.equation(worst)) + " is missed by " + number_text(missed, 3) +
          " with the initial data given" + (asks.empty() ? "" : "; it " + asks),
      "it clashes with another constraint or condition, or has no real solution near the guess: [initial] guess = {…}"};
}

#define INSTANTIATE(N)                                                                                                 \
  template std::string StateSolver<N>::entry_name(const Node&) const;                                                  \
  template std::string StateSolver<N>::solution_text(const std::vector<N>&, const System&, const Structure&) const;    \
  template Outcome StateSolver<N>::no_leading(const System&, const LeadingSolutions<N>&, const std::string&) const;    \
  template Outcome StateSolver<N>::no_value(const Stage<N>&);                                                          \
  template Outcome StateSolver<N>::clash_of(const Stage<N>&, const Contradiction<N>&, const InitialState<N>&) const;   \
  template Outcome StateSolver<N>::clash(Stage<N>&, std::size_t, const InitialState<N>&);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

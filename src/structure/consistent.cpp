#include "structure/consistent.h"

#include <algorithm>

#include "base/assert.h"

namespace anholon {

const char* name(Origin origin) {
  switch (origin) {
    case Origin::given: return "given";
    case Origin::derived: return "derived";
    case Origin::chosen: return "chosen";
    case Origin::guessed: return "guess";
    case Origin::corrected: return "corrected";
  }
  return "";
}

namespace {

constexpr int kMostIterations = 60;
// Given values may miss a constraint by this much of its scale: they are rounded numbers.
constexpr double kRounded = 1e-8;
// Rows of a constraint Jacobian count as dependent below this fraction of their size.
constexpr double kDependent = 1e-9;

struct Equation {
  Expr residual;
  std::string what;  // "constraint 'blade'"
  Span span;
  bool condition = false;  // of the file's initial data, not a law of the system
};

// Equations in the unknowns of one stage (positions or velocities) and their partial derivatives.
template <Number N>
class Stage {
 public:
  Stage(const Mechanics& m, const std::vector<Equation>& equations, unsigned order, const std::vector<N>& parameters)
      : m_(m), equations_(equations), unknowns_(order == 0 ? m.q : m.qd), order_(order),
        n_(m.q.size()), tape_(build()), machine_(tape_, 0, parameters) {}

  std::size_t size() const { return equations_.size(); }

  // Values, scales and partial derivatives at a state; false if a formula has no value there.
  bool evaluate(const N& t, const std::vector<N>& q, const std::vector<N>& qd) {
    const Graph& g = m_.graph();
    for (const Input& in : tape_.inputs) {
      const Node& n = g.node(in.symbol);
      N value(0);
      if (n.kind == Kind::time) value = t;
      else if (n.kind == Kind::jet && n.order == 0) value = q[n.index];
      else if (n.kind == Kind::jet && n.order == 1) value = qd[n.index];
      machine_.series(in.slot)[0] = value;
    }
    machine_.evaluate();
    residual.assign(size(), N(0));
    scale.assign(size(), N(0));
    jacobian = Matrix<N>(size(), n_);
    mass = Matrix<N>(n_, n_);
    const std::vector<N>& x = order_ == 0 ? q : qd;
    N largest_unknown(1);  // a residual below its round-off is none
    for (const N& v : x)
      if (abs(v) > largest_unknown) largest_unknown = abs(v);
    for (std::size_t i = 0; i < size(); ++i) {
      residual[i] = machine_.value(i);
      if (!is_finite(residual[i])) return false;
      scale[i] = term_scale(i);
      for (std::size_t a = 0; a < n_; ++a) {
        jacobian(i, a) = machine_.value(size() + i * n_ + a);
        if (!is_finite(jacobian(i, a))) return false;
        for (N part : {abs(N(jacobian(i, a) * x[a])), N(abs(jacobian(i, a)) * largest_unknown * unit_roundoff<N>())})
          if (part > scale[i]) scale[i] = part;
      }
      if (!(scale[i] > N(0))) scale[i] = N(1);
    }
    const std::size_t first = size() * (n_ + 1);
    N largest(0);
    for (std::size_t a = 0; a < n_; ++a)
      for (std::size_t b = 0; b < n_; ++b) {
        mass(a, b) = machine_.value(first + a * n_ + b);
        if (!is_finite(mass(a, b))) return false;
        if (a == b && abs(mass(a, b)) > largest) largest = abs(mass(a, b));
      }
    // A coordinate without inertia still has a least change.
    if (!(largest > N(0))) largest = N(1);
    for (std::size_t a = 0; a < n_; ++a) mass(a, a) += largest * N(1e-12);
    return true;
  }

  std::vector<N> residual, scale;
  Matrix<N> jacobian, mass;

 private:
  Tape build() {
    Column es;
    for (const Equation& e : equations_) es.push_back(e.residual);
    for (const Equation& e : equations_) {
      const Column d = gradient(e.residual, unknowns_);
      es.insert(es.end(), d.begin(), d.end());
    }
    for (const Column& row : mass_matrix(m_)) es.insert(es.end(), row.begin(), row.end());
    return compile(es);
  }

  // The sum of the absolute values of the terms of an equation.
  N term_scale(std::size_t i) const {
    const Instruction& alias = tape_.code[tape_.roots[i]];
    const std::uint32_t slot = tape_.linear_terms[alias.first].slot;
    const Instruction& in = tape_.code[slot];
    if (in.op != Op::linear) return abs(machine_.series(slot)[0]);
    N s(0);
    for (std::uint32_t k = in.first; k < in.first + in.count; ++k) {
      const LinearTerm& t = tape_.linear_terms[k];
      s += abs(N(machine_.rational(t.coefficient) * machine_.series(t.slot)[0]));
    }
    return s;
  }

  const Mechanics& m_;
  const std::vector<Equation>& equations_;
  Column unknowns_;
  unsigned order_;
  std::size_t n_;
  Tape tape_;
  Machine<N> machine_;
};

template <Number N>
N worst_relative(const Stage<N>& s, std::size_t* which = nullptr) {
  N worst(0);
  for (std::size_t i = 0; i < s.size(); ++i)
    if (N v = abs(s.residual[i]) / s.scale[i]; v > worst) {
      worst = v;
      if (which) *which = i;
    }
  return worst;
}

template <Number N>
class Solver {
 public:
  Solver(const InitialProblem<N>& p, InitialState<N>& state) : p_(p), m_(*p.mechanics), model_(*m_.model), state_(state) {}

  Outcome run() {
    const std::size_t n = m_.q.size();
    state_.q.assign(n, N(0));
    state_.qd.assign(n, N(0));
    state_.q_origin.assign(n, Origin::chosen);
    state_.qd_origin.assign(n, Origin::chosen);
    start_values();
    std::vector<Equation> positions, velocities;
    for (std::size_t r = 0; r < model_.constraints.size(); ++r) {
      const Constraint& c = model_.constraints[r];
      if (c.order > 1) continue;
      const Expr phi = put_masses(model_, c.phi);
      const std::string what = "constraint '" + c.name + "'";
      if (c.order == 0) {
        positions.push_back({phi, what, c.span});
        velocities.push_back({total_derivative(phi), "the derivative of " + what, c.span});
      } else {
        velocities.push_back({phi, what, c.span});
      }
    }
    for (const Condition& c : model_.initial.conditions) {
      const Expr residual = put_masses(model_, c.residual);
      const std::string what = "condition \"" + c.text + "\"";
      (jet_order(residual) == 0 ? positions : velocities).push_back({residual, what, c.span, true});
    }
    if (Outcome o = solve(positions, 0); !o.ok()) return o;
    return solve(velocities, 1);
  }

 private:
  std::vector<N> values(const std::vector<GivenValue>& list) {
    Column es;
    for (const GivenValue& v : list) es.push_back(v.value);
    if (es.empty()) return {};
    const Tape tape = compile(es);
    Machine<N> machine(tape, 0, p_.parameters);
    machine.evaluate();
    std::vector<N> out;
    for (std::size_t i = 0; i < es.size(); ++i) out.push_back(machine.value(i));
    return out;
  }

  void place(Expr symbol, const N& value, Origin origin) {
    const Node& n = m_.graph().node(symbol.id);
    if (n.kind != Kind::jet || n.order > 1) return;
    (n.order == 0 ? state_.q : state_.qd)[n.index] = value;
    (n.order == 0 ? state_.q_origin : state_.qd_origin)[n.index] = origin;
  }

  void start_values() {
    const InitialData& in = model_.initial;
    const std::vector<N> t = values({{in.t, in.t, {}}}), guess = values(in.guess), given = values(in.given);
    state_.t = p_.t ? from_rational<N>(*p_.t) : t[0];
    for (std::size_t i = 0; i < guess.size(); ++i) place(in.guess[i].symbol, guess[i], Origin::guessed);
    for (std::size_t i = 0; i < given.size(); ++i) place(in.given[i].symbol, given[i], Origin::given);
    for (const StateOverride& o : p_.overrides)
      place((o.order == 0 ? m_.q : m_.qd)[o.coordinate], from_rational<N>(o.value), Origin::given);
  }

  // As the data say; where overrides clash with values or conditions of the file, the overrides hold
  // and the file's values are only where the least change starts from.
  Outcome solve(const std::vector<Equation>& equations, unsigned order) {
    const InitialState<N> before = state_;
    const Outcome o = attempt(equations, order);
    if (o.ok() || p_.overrides.empty()) return o;
    const InitialState<N> failed = std::exchange(state_, before);
    const auto overridden = [&](std::size_t a) {
      return std::any_of(p_.overrides.begin(), p_.overrides.end(),
                         [&](const StateOverride& v) { return v.order == order && v.coordinate == a; });
    };
    std::vector<Origin>& origin = order == 0 ? state_.q_origin : state_.qd_origin;
    for (std::size_t a = 0; a < origin.size(); ++a)
      if (origin[a] == Origin::given && !overridden(a)) origin[a] = Origin::guessed;
    std::vector<Equation> kept;
    for (const Equation& e : equations) {
      bool open = !e.condition;  // a condition stays while it says something about what is still open
      for (NodeId id : symbols({&e.residual, 1})) {
        const Node& n = m_.graph().node(id);
        open = open || (n.kind == Kind::jet && n.order == order && !overridden(n.index));
      }
      if (open) kept.push_back(e);
    }
    if (attempt(kept, order).ok()) return {};
    state_ = failed;
    return o;
  }

  Outcome attempt(const std::vector<Equation>& equations, unsigned order) {
    if (equations.empty()) return {};
    std::vector<Origin>& origin = order == 0 ? state_.q_origin : state_.qd_origin;
    Stage<N> stage(m_, equations, order, p_.parameters);
    std::vector<std::size_t> free;
    for (std::size_t a = 0; a < origin.size(); ++a)
      if (origin[a] != Origin::given) free.push_back(a);
    const std::vector<N> before = order == 0 ? state_.q : state_.qd;
    std::size_t worst = 0;
    if (!newton(stage, order, free)) return no_value(equations, order);
    for (std::size_t a : free)
      if (moves(stage, a)) origin[a] = Origin::derived;
    N miss = worst_relative(stage, &worst);
    if (!(miss > rounding())) return {};
    if (to_double(miss) <= kRounded) {
      // Rounded numbers: all may move a little.
      std::vector<std::size_t> all;
      for (std::size_t a = 0; a < origin.size(); ++a) all.push_back(a);
      if (newton(stage, order, all) && !(worst_relative(stage, &worst) > rounding())) {
        const std::vector<N>& now = order == 0 ? state_.q : state_.qd;
        for (std::size_t a = 0; a < now.size(); ++a)
          if (origin[a] == Origin::given)
            if (N change = abs(N(now[a] - before[a])); change > N(0)) {
              origin[a] = Origin::corrected;
              if (change > state_.largest_correction) state_.largest_correction = change;
            }
        return {};
      }
      miss = worst_relative(stage, &worst);
    }
    return clash(equations[worst], stage, worst, order);
  }

  N rounding() const { return unit_roundoff<N>() * N(200); }

  // True if the equations say anything about unknown a.
  bool moves(const Stage<N>& s, std::size_t a) const {
    for (std::size_t i = 0; i < s.size(); ++i)
      if (abs(s.jacobian(i, a)) > N(0)) return true;
    return false;
  }

  bool evaluate(Stage<N>& s) { return s.evaluate(state_.t, state_.q, state_.qd); }

  // min |x - guess|_M over the free unknowns subject to the equations, by Newton's method with a
  // line search; ends at the least change reachable, the caller looks at what is left.
  bool newton(Stage<N>& s, unsigned order, const std::vector<std::size_t>& free) {
    std::vector<N>& x = order == 0 ? state_.q : state_.qd;
    const std::vector<N> guess = x;
    if (!evaluate(s)) return false;
    N last_step(-1);
    bool nudged = false;
    for (int k = 0; k < kMostIterations && !free.empty(); ++k) {
      Matrix<N> a(s.size(), free.size());
      for (std::size_t i = 0; i < s.size(); ++i)
        for (std::size_t j = 0; j < free.size(); ++j) a(i, j) = s.jacobian(i, free[j]);
      const RowChoice<N> rows = choose_rows(a, N(kDependent));
      if (rows.dependent.size() && !nudged && worst_relative(s) > rounding() && k == 0) {
        // The guess may be a place where a constraint is flat (the centre of a circle): leave it.
        nudged = true;
        bool flat = false;
        for (std::size_t i : rows.dependent)
          if (abs(s.residual[i]) > rounding() * s.scale[i]) flat = true;
        if (flat) {
          for (std::size_t j = 0; j < free.size(); ++j)
            x[free[j]] += N(0.1) + N(0.037) * N(static_cast<int>(j % 7));
          if (!evaluate(s)) return false;
          continue;
        }
      }
      const std::size_t r = rows.independent.size();
      if (r == 0) break;
      Matrix<N> ar(r, free.size()), mass(free.size(), free.size());
      std::vector<N> b(r, N(0)), y;
      for (std::size_t i = 0; i < r; ++i) {
        b[i] = -s.residual[rows.independent[i]];
        for (std::size_t j = 0; j < free.size(); ++j) {
          ar(i, j) = a(rows.independent[i], j);
          b[i] += ar(i, j) * (x[free[j]] - guess[free[j]]);
        }
      }
      for (std::size_t i = 0; i < free.size(); ++i)
        for (std::size_t j = 0; j < free.size(); ++j) mass(i, j) = s.mass(free[i], free[j]);
      if (!least_change(mass, ar, b, y)) return true;
      // Progress is measured against the scales where the step begins: those at its end grow with it.
      const std::vector<N> scale = s.scale;
      const auto merit = [&] {
        N worst(0);
        for (std::size_t i = 0; i < s.size(); ++i)
          if (N v = abs(s.residual[i]) / scale[i]; v > worst) worst = v;
        return worst;
      };
      const N now = merit();
      const std::vector<N> old = x;
      N fraction(1), step(0), size(0);
      bool better = false;
      for (int halvings = 0; halvings < 12; ++halvings, fraction = fraction * N(0.5)) {
        for (std::size_t j = 0; j < free.size(); ++j)
          x[free[j]] = old[free[j]] + fraction * (guess[free[j]] + y[j] - old[free[j]]);
        if (!evaluate(s)) continue;
        if (merit() <= now * N(0.9) + rounding() * N(4) || halvings == 11) {
          better = true;
          break;
        }
      }
      if (!better && !evaluate(s)) return false;
      for (std::size_t j = 0; j < free.size(); ++j) {
        if (N v = abs(N(x[free[j]] - old[free[j]])); v > step) step = v;
        if (N v = abs(x[free[j]]); v > size) size = v;
      }
      const N floor = unit_roundoff<N>() * N(8) * (size > N(1) ? size : N(1));
      const bool settled = !(step > floor) || (last_step >= N(0) && !(step < last_step) && step < floor * N(100));
      last_step = step;
      if (settled) break;
    }
    return true;
  }

  Outcome no_value(const std::vector<Equation>& equations, unsigned order) {
    return {OutcomeKind::inconsistent,
            std::string("the ") + (order == 0 ? "positions" : "velocities") + " cannot be found: " + equations[0].what +
                " or its neighbours have no value at the initial data",
            "give a guess near the wanted configuration: [initial] guess = {…}"};
  }

  Outcome clash(const Equation& e, const Stage<N>& stage, std::size_t row, unsigned order) {
    const N& residual = stage.residual[row];
    std::string fixed;
    const std::vector<Origin>& origin = order == 0 ? state_.q_origin : state_.qd_origin;
    for (std::size_t a = 0; a < origin.size(); ++a) {
      if (origin[a] == Origin::given && abs(stage.jacobian(row, a)) > N(0))
        fixed += (fixed.empty() ? "" : ", ") + derivative_name(model_.coordinates[a].name, order, Format::text);
    }
    const std::string at = e.span.line ? " (line " + std::to_string(e.span.line) + ")" : "";
    return {OutcomeKind::inconsistent,
            e.what + at + " is missed by " + number_text(std::abs(to_double(residual)), 3) + " with the initial data given",
            fixed.empty() ? "it clashes with another constraint or condition, or has no real solution near the guess: [initial] guess = {…}"
                          : "leave out " + std::string(fixed.find(',') == std::string::npos ? "" : "one of ") + fixed +
                                " (what is missing is found from the constraints), if the equation can be satisfied at all"};
  }

  const InitialProblem<N>& p_;
  const Mechanics& m_;
  const Model& model_;
  InitialState<N>& state_;
};

}  // namespace

template <Number N>
Outcome consistent_state(const InitialProblem<N>& problem, InitialState<N>& state) {
  return Solver<N>(problem, state).run();
}

template <Number N>
RowChoice<N> independent_constraints(const Mechanics& m, const std::vector<N>& parameters, const InitialState<N>& state) {
  const std::size_t s = m.phi.size(), n = m.q.size();
  RowChoice<N> choice;
  if (s == 0) return choice;
  Column es;
  for (const Column& row : m.Phi)
    for (Expr e : row) es.push_back(put_masses(*m.model, e));
  const Tape tape = compile(es);
  Machine<N> machine(tape, 0, parameters);
  const Graph& g = m.graph();
  for (const Input& in : tape.inputs) {
    const Node& node = g.node(in.symbol);
    N value(0);
    if (node.kind == Kind::time) value = state.t;
    else if (node.kind == Kind::jet && node.order == 0) value = state.q[node.index];
    else if (node.kind == Kind::jet && node.order == 1) value = state.qd[node.index];
    machine.series(in.slot)[0] = value;
  }
  machine.evaluate();
  Matrix<N> phi(s, n);
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t a = 0; a < n; ++a) phi(i, a) = machine.value(i * n + a);
  return choose_rows(phi, N(kDependent));
}

template Outcome consistent_state<double>(const InitialProblem<double>&, InitialState<double>&);
template Outcome consistent_state<long double>(const InitialProblem<long double>&, InitialState<long double>&);
template Outcome consistent_state<Multi>(const InitialProblem<Multi>&, InitialState<Multi>&);
template RowChoice<double> independent_constraints<double>(const Mechanics&, const std::vector<double>&, const InitialState<double>&);
template RowChoice<long double> independent_constraints<long double>(const Mechanics&, const std::vector<long double>&, const InitialState<long double>&);
template RowChoice<Multi> independent_constraints<Multi>(const Mechanics&, const std::vector<Multi>&, const InitialState<Multi>&);

}  // namespace anholon

#include "linear/linear_model.h"

#include <algorithm>

#include "base/assert.h"
#include "numeric/more_digits.h"
#include "tape/bind.h"

namespace anholon {

namespace {

constexpr int kMostNewton = 30;
// pivots at least this large, relative to the largest, are taken in the order of the coordinates
constexpr double kNearlyLargest = 0.5;
constexpr double kPreferred = 0.02;  // pivots of preferred or already taken coordinates: from this size on

// 10^-(fraction of the working digits): a smaller number, relative to its neighbours, is round-off.
Multi round_off(double part) {
  Multi u(1);
  mpfr_div_2ui(u.raw(), u.raw(), static_cast<unsigned long>(part * static_cast<double>(Multi::working_bits())),
               MPFR_RNDN);
  return u;
}
constexpr double kZeroPart = 0.7;    // for a matrix made by two solutions of linear equations
constexpr double kNewtonPart = 0.9;  // for a converged iteration
constexpr double kEntryPart = 0.85;  // for one entry among those of A

Multi largest(const std::vector<Multi>& v) {
  Multi m(0);
  for (const Multi& x : v)
    if (abs(x) > m) m = abs(x);
  return m;
}

}  // namespace

const char* name(LinearModel::Motion motion) {
  switch (motion) {
  case LinearModel::Motion::equilibrium:
    return "equilibrium";
  case LinearModel::Motion::steady:
    return "steady";
  case LinearModel::Motion::unsteady:
    return "unsteady";
  case LinearModel::Motion::unchecked:
    return "unchecked";
  }
  return "";
}

Linearizer::Linearizer(Workspace& scenario, const StateChoice& choice, Signals signals)
    : s_(scenario), choice_(choice), signals_(std::move(signals)), mass_(mass_matrix(*scenario.mechanics)) {
  const Graph& g = *s_.model->graph;
  notes_ = signals_.notes;
  Column columns, es;
  for (std::size_t j = 0; j < s_.system.size(); ++j) {
    first_.push_back(entries_.size());
    for (int k = 0; k <= s_.structure.d[j]; ++k) {
      entries_.push_back({j, k});
      columns.push_back(s_.system.symbol(j, static_cast<unsigned>(k)));
    }
  }
  for (std::size_t i = 0; i < s_.system.size(); ++i)
    for (int k = 0; k <= s_.structure.c[i]; ++k) {
      rows_.push_back({i, k});
      es.push_back(total_derivative(s_.system.equations[i], static_cast<unsigned>(k)));
    }
  // An input on which a hidden constraint depends would enter with its rate.
  for (std::size_t u = signals_.u.size(); u-- > 0;) {
    bool hidden = false;
    for (std::size_t r = 0; r < rows_.size(); ++r)
      hidden = hidden || (rows_[r].second < s_.structure.c[rows_[r].first] && !is_zero(partial(es[r], signals_.u[u])));
    if (!hidden) continue;
    notes_.push_back(
        "the input '" + signals_.inputs[u] +
        "' stands in a constraint that holds at every time: its rate would be an input, too; it is left out");
    signals_.u.erase(signals_.u.begin() + static_cast<std::ptrdiff_t>(u));
    signals_.inputs.erase(signals_.inputs.begin() + static_cast<std::ptrdiff_t>(u));
  }
  for (std::size_t y = signals_.y.size(); y-- > 0;) {
    bool beyond = false;
    for (NodeId id : symbols({&signals_.y[y], 1}))
      if (const auto j = s_.system.variable(id)) beyond = beyond || g.node(id).order > s_.structure.d[*j];
    if (!beyond) continue;
    notes_.push_back("the output '" + signals_.outputs[y] +
                     "' holds derivatives beyond those of the equations; it is left out");
    signals_.y.erase(signals_.y.begin() + static_cast<std::ptrdiff_t>(y));
    signals_.outputs.erase(signals_.outputs.begin() + static_cast<std::ptrdiff_t>(y));
  }
  columns.insert(columns.end(), signals_.u.begin(), signals_.u.end());
  const Column outputs = put_masses(*s_.model, signals_.y);
  es.insert(es.end(), outputs.begin(), outputs.end());
  const std::size_t rows = es.size();
  sides_ = {es, columns, s_.model->parameters.size()};
  for (std::size_t r = 0; r < rows; ++r) {
    const Column d = gradient(es[r], columns);
    for (std::size_t c = 0; c < d.size(); ++c) {
      if (is_zero(d[c])) continue;
      partials_.push_back({r, c});
      es.push_back(d[c]);
    }
  }
  tape_ = compile(es);
}

std::string Linearizer::entry_name(std::size_t e) const {
  return derivative_name(s_.system.variable_names[entries_[e].variable], static_cast<unsigned>(entries_[e].order),
                         Format::text);
}

// One point of a motion: its entries, and the relations between their variations.
class LinearPoint {
 public:
  LinearPoint(const Linearizer& l, const std::vector<Multi>& parameters)
      : l_(l), machine_(l.tape_, 0, parameters), x(l.entries_.size(), Multi(0)) {}

  // Loads the computed state, with the leading derivatives if they are known.
  void load(const InitialState<Multi>& state) {
    t = state.t;
    for (std::size_t e = 0; e < x.size(); ++e)
      if (const Multi* known = state.value(node(e))) x[e] = *known;
  }

  // Gives a machine of formulas its inputs.
  void set(Machine<Multi>& machine) const {
    bind(machine, *l_.s_.model->graph, [&](const Node& n, NodeId symbol) {
      if (n.kind == Kind::time) return t;
      const auto j = l_.s_.system.variable(symbol);
      const bool known = j && n.order <= l_.s_.structure.d[*j];  // others are multipliers of redundant constraints
      return known ? x[l_.entry(*j, n.order)] : Multi(0);
    });
  }

  // Values of all equations, and the partial derivatives; false if a formula has no value here.
  bool evaluate() {
    set(machine_);
    machine_.evaluate();
    residual.clear();
    const std::size_t all = l_.rows_.size() + l_.signals_.y.size();
    jacobian = Matrix<Multi>(all, x.size() + l_.signals_.u.size());
    for (std::size_t r = 0; r < l_.rows_.size(); ++r) residual.push_back(machine_.value(r));
    for (std::size_t p = 0; p < l_.partials_.size(); ++p)
      jacobian(l_.partials_[p].row, l_.partials_[p].column) = machine_.value(all + p);
    const auto good = [](const Multi& v) { return v.finite(); };
    return std::all_of(residual.begin(), residual.end(), good) &&
           std::all_of(jacobian.data.begin(), jacobian.data.end(), good);
  }

  // Chooses the entries of the state that follow from the others: level by level, from positions to velocities and on,
  // so that a velocity is dependent if its coordinate is. Returns false if the hidden constraints are not independent
  // here.
  bool choose() {
    const Structure& t_ = l_.s_.structure;
    follows.assign(x.size(), false);
    std::vector<bool> taken(t_.d.size(), false), wished(t_.d.size(), false);
    const std::vector<std::size_t>& asked =
        l_.choice_.eliminate.empty() ? l_.s_.model->dependent : l_.choice_.eliminate;
    for (std::size_t a : asked) wished[a] = true;
    for (int level = t_.largest_c(); level >= 1; --level) {
      std::vector<std::size_t> rows, columns;
      for (std::size_t r = 0; r < l_.rows_.size(); ++r)
        if (t_.c[l_.rows_[r].first] - l_.rows_[r].second == level) rows.push_back(r);
      for (std::size_t j = 0; j < t_.d.size(); ++j)
        if (t_.d[j] >= level) columns.push_back(j);
      if (!eliminate(rows, columns, level, taken, wished)) return false;
    }
    return true;
  }

  // Newton's method for all entries that depend on the independent ones.
  bool settle() {
    const Multi small = round_off(kNewtonPart);
    for (int k = 0; k < kMostNewton; ++k) {
      if (!solve_for_dependent()) return false;
      std::vector<Multi> step, minus;
      for (const Multi& r : residual) minus.push_back(-r);
      lu_.solve(minus, step);
      for (std::size_t i = 0; i < step.size(); ++i) x[dependent_[i]] += step[i];
      if (largest(step) <= small * (Multi(1) + largest(x))) return true;  // J is that of a practically equal point
      if (!evaluate()) return false;
    }
    return false;
  }

  // z' = A z, and z' on the motion.
  void linear(LinearModel& out) const {
    std::vector<std::size_t> where(x.size(), x.size()),
        independent;  // index of an entry among the dependent or independent ones
    for (std::size_t i = 0; i < dependent_.size(); ++i) where[dependent_[i]] = i;
    for (std::size_t e = 0; e < x.size(); ++e)
      if (where[e] == x.size()) independent.push_back(e);
    // Sorts positions before velocities, the usual order.
    std::stable_sort(independent.begin(), independent.end(),
                     [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    const std::size_t n = independent.size(), inputs = l_.signals_.u.size(), outputs = l_.signals_.y.size();
    // Dependent entries as functions of independent ones and of inputs.
    Matrix<Multi> follow(dependent_.size(), n + inputs);
    std::vector<Multi> column(l_.rows_.size(), Multi(0)), solution;
    for (std::size_t c = 0; c < n + inputs; ++c) {
      for (std::size_t r = 0; r < column.size(); ++r)
        column[r] = -jacobian(r, c < n ? independent[c] : x.size() + c - n);
      lu_.solve(column, solution);
      for (std::size_t i = 0; i < solution.size(); ++i) follow(i, c) = solution[i];
    }
    out.A = Matrix<Multi>(n, n), out.B = Matrix<Multi>(n, inputs), out.C = Matrix<Multi>(outputs, n),
    out.D = Matrix<Multi>(outputs, inputs);
    out.states.clear(), out.dependent.clear(), out.values.clear(), out.rates.clear();
    out.inputs = l_.signals_.inputs, out.outputs = l_.signals_.outputs, out.notes = l_.notes_;
    for (std::size_t r = 0; r < n; ++r) {
      const std::size_t next = independent[r] + 1;  // entries of a variable are adjacent
      const bool free = where[next] == x.size();
      for (std::size_t c = 0; c < n; ++c)
        out.A(r, c) = free ? Multi(independent[c] == next ? 1 : 0) : follow(where[next], c);
      for (std::size_t c = 0; c < inputs; ++c) out.B(r, c) = free ? Multi(0) : follow(where[next], n + c);
      out.states.push_back(l_.entry_name(independent[r]));
      out.values.push_back(x[independent[r]]);
      out.rates.push_back(x[next]);
    }
    for (std::size_t o = 0; o < outputs; ++o)
      for (std::size_t c = 0; c < n + inputs; ++c) {
        const std::size_t row = l_.rows_.size() + o;
        Multi& entry = c < n ? out.C(o, c) : out.D(o, c - n);
        entry = jacobian(row, c < n ? independent[c] : x.size() + c - n);
        for (std::size_t i = 0; i < dependent_.size(); ++i) addmul(entry, jacobian(row, dependent_[i]), follow(i, c));
      }
    for (Matrix<Multi>* m : {&out.A, &out.B, &out.C, &out.D}) {
      const Multi nothing = round_off(kEntryPart) * largest(m->data);
      for (Multi& a : m->data)
        if (!(abs(a) > nothing)) a = Multi(0);
    }
    const Multi still = round_off(kEntryPart) * (Multi(1) + largest(x));
    for (std::vector<Multi>* list : {&out.values, &out.rates})
      for (Multi& v : *list)
        if (!(abs(v) > still)) v = Multi(0);
    for (std::size_t e : dependent_)
      if (!l_.leading(e)) out.dependent.push_back(l_.entry_name(e));
    out.t = t;
    independent_ = std::move(independent);
  }

  std::size_t independent(std::size_t i) const { return independent_[i]; }
  bool coordinate(std::size_t i) const {
    const auto& e = l_.entries_[independent_[i]];
    return e.order == 0 && e.variable < l_.s_.system.coordinates;
  }

 private:
  const Linearizer& l_;
  Machine<Multi> machine_;

 public:
  Multi t{0};
  std::vector<Multi> x, residual;
  Matrix<Multi> jacobian;
  std::vector<bool> follows;

 private:
  Node node(std::size_t e) const {
    const auto& entry = l_.entries_[e];
    return l_.s_.system.symbol_node(entry.variable, static_cast<unsigned>(entry.order));
  }
  std::pair<int, std::size_t> rank(std::size_t e) const {
    const auto& entry = l_.entries_[e];
    const bool multiplier = entry.variable >= l_.s_.system.coordinates;
    return {multiplier ? 1000 + entry.order : entry.order, entry.variable};
  }

  bool eliminate(const std::vector<std::size_t>& rows, const std::vector<std::size_t>& columns, int level,
                 std::vector<bool>& taken, const std::vector<bool>& wished) {
    const std::vector<int>& d = l_.s_.structure.d;
    Matrix<Multi> a(rows.size(), columns.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      for (std::size_t j = 0; j < columns.size(); ++j)
        a(i, j) = jacobian(rows[i], l_.entry(columns[j], d[columns[j]] - level));
      Multi size(0);
      for (std::size_t j = 0; j < columns.size(); ++j)
        if (abs(a(i, j)) > size) size = abs(a(i, j));
      if (!(size > Multi(0))) return false;
      for (std::size_t j = 0; j < columns.size(); ++j) a(i, j) /= size;
    }
    std::vector<bool> row_used(rows.size(), false), used(columns.size(), false);
    for (std::size_t step = 0; step < rows.size(); ++step) {
      std::vector<Multi> best(columns.size(), Multi(0));
      std::vector<std::size_t> row(columns.size(), 0);
      Multi top(0);
      for (std::size_t j = 0; j < columns.size(); ++j)
        for (std::size_t i = 0; i < rows.size(); ++i)
          if (!used[j] && !row_used[i] && abs(a(i, j)) > best[j])
            best[j] = abs(a(i, j)), row[j] = i, top = std::max(top, best[j]);
      if (!(top > round_off(kZeroPart))) return false;
      const auto first = [&](const std::vector<bool>* among, double part) {
        for (std::size_t j = 0; j < columns.size(); ++j)
          if (!used[j] && (!among || (*among)[columns[j]]) && best[j] >= Multi(part) * top) return j;
        return columns.size();
      };
      std::size_t j = first(&taken, kPreferred);
      if (j == columns.size()) j = first(&wished, kPreferred);
      if (j == columns.size()) j = first(nullptr, kNearlyLargest);
      const std::size_t pivot = row[j];
      used[j] = row_used[pivot] = true;
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (row_used[i]) continue;
        const Multi factor = -(a(i, j) / a(pivot, j));
        for (std::size_t k = 0; k < columns.size(); ++k) addmul(a(i, k), factor, a(pivot, k));
      }
      follows[l_.entry(columns[j], d[columns[j]] - level)] = true;
    }
    for (std::size_t j = 0; j < columns.size(); ++j) taken[columns[j]] = used[j];
    return true;
  }

  // Factorizes the columns of the dependent entries.
  bool solve_for_dependent() {
    dependent_.clear();
    for (std::size_t e = 0; e < x.size(); ++e)
      if (follows[e] || l_.leading(e)) dependent_.push_back(e);
    ANHOLON_ASSERT(dependent_.size() == l_.rows_.size());
    Matrix<Multi> a(l_.rows_.size(), dependent_.size());
    for (std::size_t r = 0; r < a.rows; ++r)
      for (std::size_t c = 0; c < a.cols; ++c) a(r, c) = jacobian(r, dependent_[c]);
    if (!lu_.factor(a)) return false;
    std::vector<Multi> direction;
    return lu_.smallest_singular_value(direction) > round_off(kZeroPart);
  }

  std::vector<std::size_t> dependent_;
  mutable std::vector<std::size_t> independent_;
  Lu<Multi> lu_;
};

namespace {

bool no_influence(const LinearModel& m, std::size_t column, const std::vector<bool>& kept, const Multi& zero) {
  for (std::size_t r = 0; r < m.states.size(); ++r)
    if (kept[r] && abs(m.A(r, column)) > zero) return false;
  return true;
}

// Drops coordinates without influence on the remaining ones, until none is left.
std::vector<bool> without_cyclic(const LinearModel& m, const LinearPoint& p, std::vector<bool> may, const Multi& zero) {
  std::vector<bool> kept(m.states.size(), true);
  for (bool again = true; again;) {
    again = false;
    for (std::size_t i = 0; i < kept.size(); ++i)
      if (kept[i] && may[i] && p.coordinate(i) && no_influence(m, i, kept, zero)) kept[i] = false, again = true;
  }
  return kept;
}

// A rate below this, in relation to the state, may come from numbers that were copied with sixteen digits.
constexpr double kCopied = 1e-13;

void tell(LinearModel& m, LinearModel::Motion motion, std::string why) {
  m.motion = motion;
  m.why = std::move(why);
}

}  // namespace

// Finds the coordinates that have no influence, here and at another point, and whether all others rest. `moving`: the
// other point lies along the motion, else these coordinates have other values there also if they rest.
static void look_for_steadiness(const LinearPoint& point, bool check, bool moving, LinearModel& out) {
  const std::size_t n = out.states.size();
  const Multi zero = round_off(kZeroPart) * (Multi(1) + largest(out.A.data)),
              still = round_off(kZeroPart) * (Multi(1) + largest(point.x));
  std::vector<bool> kept(n, true), may(n, true);
  LinearModel other;
  bool moved = false;
  for (bool again = true; again;) {
    again = false;
    kept = without_cyclic(out, point, may, zero);
    if (!check) break;
    LinearPoint there = point;
    there.t += Multi(0.375);
    for (std::size_t i = 0, k = 0; i < n; ++i)
      if (!kept[i] && (!moving || abs(out.rates[i]) > still))
        there.x[point.independent(i)] +=
            Multi(0.3125) + Multi(static_cast<int>(++k)) / Multi(16) + Multi(0.375) * out.rates[i];
    moved = there.evaluate() && there.settle();
    if (!moved) break;
    there.linear(other);
    for (std::size_t i = 0; i < n; ++i)
      if (!kept[i] && !no_influence(other, i, kept, zero)) may[i] = false, again = true;
  }
  out.cyclic.clear(), out.core.clear();
  for (std::size_t i = 0; i < n; ++i) (kept[i] ? out.core : out.cyclic).push_back(i);

  if (!check) return tell(out, LinearModel::Motion::unchecked, "");
  tell(out, LinearModel::Motion::equilibrium, "");
  if (largest(out.rates) > still) out.motion = LinearModel::Motion::steady;
  if (!moved) tell(out, LinearModel::Motion::unchecked, "no other point of the motion was found");
  for (std::size_t i : out.core) {
    // The rate of a coordinate is a velocity, which is a state itself or follows from states.
    if (abs(out.rates[i]) > still) {
      const bool rounding = abs(out.rates[i]) < Multi(kCopied) * (Multi(1) + largest(point.x));
      tell(out, LinearModel::Motion::unsteady,
           "the rate of " + out.states[i] + " is " + number_text(to_double(out.rates[i]), 6) +
               (rounding ? ", as of a rounded number that stands for a formula" : ""));
      break;
    }
    if (!moved) continue;
    if (abs(other.rates[i]) > still) {
      tell(out, LinearModel::Motion::unsteady, "the rate of " + out.states[i] + " does not stay 0");
      break;
    }
    bool same = true;
    for (std::size_t k : out.core) same = same && !(abs(Multi(other.A(i, k) - out.A(i, k))) > zero);
    if (!same) {
      tell(out, LinearModel::Motion::unsteady,
           "the coefficients in the equation of " + out.states[i] + " vary along the motion");
      break;
    }
  }
}

// A heading that rests may have other values in the same motion only if no state is a velocity along fixed axes.
static void look_for_steadiness(const LinearPoint& point, bool check, LinearModel& out) {
  look_for_steadiness(point, check, false, out);
  if (out.motion != LinearModel::Motion::unsteady) return;
  LinearModel along = out;
  look_for_steadiness(point, check, true, along);
  if (along.motion != LinearModel::Motion::unsteady) out = std::move(along);
}

static std::string text_of(const Branch& b, const SymbolNames& names) {
  const std::string condition = print(b.condition, names, Format::text);
  return b.table.empty() ? "where " + condition + " passes 0"
                         : "where " + condition + " passes a knot of the table '" + b.table + "'";
}

Outcome Linearizer::look_for_kinks(const LinearPoint& point, const std::vector<Multi>& parameters,
                                   std::vector<std::string>& rough) const {
  const Multi part = round_off(kZeroPart), near = part * (Multi(1) + largest(point.x));
  const std::size_t rows = rows_.size() + signals_.y.size();
  for (const auto& side : sides_.sides(parameters, near, [&](Machine<Multi>& m) { point.set(m); })) {
    const std::string where = text_of(sides_.branches()[side.branch], s_.model->names);
    for (std::size_t k = 0; k < side.below.size(); ++k) {
      const Multi &a = side.below[k], &b = side.above[k];
      if (!a.finite() && !b.finite()) continue;
      if (a.finite() && b.finite() && !(abs(Multi(a - b)) > part * (Multi(1) + abs(a) + abs(b)))) continue;
      const std::size_t row = k < rows ? k : sides_.partials()[k - rows].row;
      if (row >= rows_.size()) {
        rough[row - rows_.size()] = where;
        continue;
      }
      return {OutcomeKind::not_a_number,
              "the equations have no derivative at this state: the equation of " +
                  s_.system.equation_names[rows_[row].first] + " has a kink or a jump " + where,
              "linearize at a state on one side of it, --about state with other initial values, or replace min, max, "
              "abs, sign, piecewise or the table there by a smooth formula"};
    }
  }
  return {};
}

// Outputs without a derivative at the point.
static void leave_out(const std::vector<std::string>& rough, LinearModel& m) {
  for (std::size_t o = rough.size(); o-- > 0;) {
    if (rough[o].empty()) continue;
    m.notes.push_back("the output '" + m.outputs[o] + "' has a kink or a jump at this state, " + rough[o] +
                      "; it is left out");
    m.outputs.erase(m.outputs.begin() + static_cast<std::ptrdiff_t>(o));
    for (Matrix<Multi>* of : {&m.C, &m.D}) {
      Matrix<Multi> fewer(of->rows - 1, of->cols);
      for (std::size_t r = 0; r < fewer.rows; ++r)
        for (std::size_t c = 0; c < fewer.cols; ++c) fewer(r, c) = (*of)(r < o ? r : r + 1, c);
      *of = std::move(fewer);
    }
  }
}

Outcome Linearizer::at(const std::vector<Multi>& parameters, bool check, LinearModel& out) const {
  const InitialProblem<Multi> problem{s_.mechanics.get(), parameters, choice_.overrides, choice_.t, &mass_, nullptr,
                                      &s_.state};
  InitialState<Multi> state;
  if (Outcome o = consistent_state(problem, state); !o.ok()) return o;
  if (s_.routh)
    if (Outcome o = complete_state(problem, *s_.routh, s_.routh_structure, state); !o.ok()) return o;
  const Outcome singular{OutcomeKind::singular,
                         "the equations do not determine the motion at this state: it has no linear model",
                         "choose another state"};
  LinearPoint point(*this, parameters);
  point.load(state);
  if (!point.evaluate())
    return {OutcomeKind::not_a_number, "a derivative of the equations has no value at this state",
            "choose another state"};
  if (!point.choose() || !point.settle()) return singular;
  std::vector<std::string> rough(signals_.y.size());
  if (Outcome o = look_for_kinks(point, parameters, rough); !o.ok()) return o;
  point.linear(out);
  leave_out(rough, out);

  look_for_steadiness(point, check, out);
  Matrix<Multi> core(out.core.size(), out.core.size());
  for (std::size_t i = 0; i < core.rows; ++i)
    for (std::size_t k = 0; k < core.cols; ++k) core(i, k) = out.A(out.core[i], out.core[k]);
  if (!eigenvalues(core, out.spectrum))
    return {OutcomeKind::no_convergence, "the eigenvalues of A were not found",
            "ask for more digits: --digits " + std::to_string(more_digits<Multi>())};
  return {};
}

}  // namespace anholon

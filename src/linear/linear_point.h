// A point of a motion at which it is linearized.
#pragma once
#include <algorithm>
#include <optional>
#include <utility>

#include "base/assert.h"
#include "linear/varied_equations.h"
#include "tape/bind.h"
#include "tape/operands.h"

namespace anholon {

// Returns 10^-(fraction of the working digits): a smaller number, relative to its neighbours, is round-off.
inline Multi round_off(double part) {
  Multi u(1);
  mpfr_div_2ui(u.raw(), u.raw(), static_cast<unsigned long>(part * static_cast<double>(Multi::working_bits())),
               MPFR_RNDN);
  return u;
}
inline constexpr double kZeroPart = 0.7;    // for a matrix made by two solutions of linear equations
inline constexpr double kNewtonPart = 0.9;  // for a converged iteration
inline constexpr double kEntryPart = 0.85;  // for one entry among those of A

inline Multi largest(const std::vector<Multi>& v) {
  Multi m(0);
  for (const Multi& x : v)
    if (abs(x) > m) m = abs(x);
  return m;
}

// One point of a motion: its entries, and the relations between their variations.
class LinearPoint {
  static constexpr int kMostNewton = 30;
  // Pivots that are at least this large, relative to the largest, are taken in the order of the coordinates.
  static constexpr double kNearlyLargest = 0.5;
  static constexpr double kPreferred = 0.02;  // least relative size of pivots of preferred or already taken coordinates

 public:
  // `eliminate`: the coordinates that shall follow from others, as far as possible.
  LinearPoint(const VariedEquations& l, std::vector<std::size_t> eliminate, const std::vector<Multi>& parameters)
      : l_(l), eliminate_(std::move(eliminate)), machine_(l.tape, 0, parameters), x(l.entries.size(), Multi(0)) {}

  // Loads the computed state, with the leading derivatives if they are known.
  void load(const InitialState<Multi>& state) {
    t = state.t;
    for (std::size_t e = 0; e < x.size(); ++e)
      if (const Multi* known = state.value(node(e))) x[e] = *known;
  }

  // Sets the inputs of a machine of formulas.
  void set(Machine<Multi>& machine) const {
    bind(machine, *l_.scenario.model->graph, [&](const Node& n, NodeId symbol) {
      if (n.kind == Kind::time) return t;
      const auto j = l_.scenario.system.variable(symbol);
      const bool known =
          j && n.order <= l_.scenario.structure.d[*j];  // others are multipliers of redundant constraints
      return known ? x[l_.entry(*j, n.order)] : Multi(0);
    });
  }

  // Computes the values of all equations and the partial derivatives. Returns false if an equation has no value or no
  // derivative here; outputs may have none.
  bool evaluate() {
    set(machine_);
    machine_.evaluate();
    residual.clear();
    const std::size_t all = l_.rows.size() + l_.signals.y.size();
    jacobian = Matrix<Multi>(all, x.size() + l_.signals.u.size());
    for (std::size_t r = 0; r < l_.rows.size(); ++r) residual.push_back(machine_.value(r));
    for (std::size_t p = 0; p < l_.partials.size(); ++p)
      jacobian(l_.partials[p].row, l_.partials[p].column) = machine_.value(all + p);
    const auto good = [](const Multi& v) { return v.finite(); };
    return std::all_of(residual.begin(), residual.end(), good) &&
           std::all_of(jacobian.data.begin(),
                       jacobian.data.begin() + static_cast<std::ptrdiff_t>(l_.rows.size() * jacobian.cols), good);
  }

  // A value or a derivative that is no number.
  struct Fault {
    std::size_t row;                    // of an equation, or, after these, of an output
    std::optional<std::size_t> column;  // of the derivative; nullopt: the value has none
    std::uint32_t slot;                 // the formula of the tape that has no value, from ones that have values
  };
  // Returns the first fault of these rows, values before derivatives. REQUIRES: evaluate() was called here.
  std::optional<Fault> fault(std::size_t from, std::size_t to) const {
    for (std::size_t r = from; r < to; ++r)
      if (!machine_.value(r).finite()) return Fault{r, std::nullopt, origin(l_.tape.roots[r])};
    const std::size_t all = l_.rows.size() + l_.signals.y.size();
    for (std::size_t p = 0; p < l_.partials.size(); ++p)
      if (const auto& [row, column] = l_.partials[p]; row >= from && row < to && !machine_.value(all + p).finite())
        return Fault{row, column, origin(l_.tape.roots[all + p])};
    return std::nullopt;
  }
  double value(std::uint32_t slot) const { return to_double(machine_.series(slot)[0]); }

  // Chooses the entries of the state that follow from the others: level by level, from positions to velocities and on,
  // so that a velocity is dependent if its coordinate is. Returns false if the hidden constraints are not independent
  // here.
  bool choose() {
    const Structure& t_ = l_.scenario.structure;
    follows.assign(x.size(), false);
    std::vector<bool> taken(t_.d.size(), false), wished(t_.d.size(), false);
    for (std::size_t a : eliminate_) wished[a] = true;
    for (int level = t_.largest_c(); level >= 1; --level) {
      std::vector<std::size_t> rows, columns;
      for (std::size_t r = 0; r < l_.rows.size(); ++r)
        if (t_.c[l_.rows[r].first] - l_.rows[r].second == level) rows.push_back(r);
      for (std::size_t j = 0; j < t_.d.size(); ++j)
        if (t_.d[j] >= level) columns.push_back(j);
      if (!eliminate(rows, columns, level, taken, wished)) return false;
    }
    return true;
  }

  // Solves by Newton's method for all entries that depend on the independent ones.
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

  // Computes A, B, C, D, and z' on the motion.
  void linear(LinearModel& out) const {
    std::vector<std::size_t> where(x.size(), x.size()),
        independent;  // index of an entry among the dependent or independent ones
    for (std::size_t i = 0; i < dependent_.size(); ++i) where[dependent_[i]] = i;
    for (std::size_t e = 0; e < x.size(); ++e)
      if (where[e] == x.size()) independent.push_back(e);
    // Sorts positions before velocities, the usual order.
    std::stable_sort(independent.begin(), independent.end(),
                     [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
    const std::size_t n = independent.size(), inputs = l_.signals.u.size(), outputs = l_.signals.y.size();
    // The dependent entries as functions of the independent ones and of inputs.
    Matrix<Multi> follow(dependent_.size(), n + inputs);
    std::vector<Multi> column(l_.rows.size(), Multi(0)), solution;
    for (std::size_t c = 0; c < n + inputs; ++c) {
      for (std::size_t r = 0; r < column.size(); ++r)
        column[r] = -jacobian(r, c < n ? independent[c] : x.size() + c - n);
      lu_.solve(column, solution);
      for (std::size_t i = 0; i < solution.size(); ++i) follow(i, c) = solution[i];
    }
    out.A = Matrix<Multi>(n, n), out.B = Matrix<Multi>(n, inputs), out.C = Matrix<Multi>(outputs, n),
    out.D = Matrix<Multi>(outputs, inputs);
    out.states.clear(), out.dependent.clear(), out.values.clear(), out.rates.clear();
    out.inputs = l_.signals.inputs, out.outputs = l_.signals.outputs, out.notes = l_.notes;
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
        const std::size_t row = l_.rows.size() + o;
        Multi& entry = c < n ? out.C(o, c) : out.D(o, c - n);
        entry = jacobian(row, c < n ? independent[c] : x.size() + c - n);
        Multi slope = abs(entry), most(1);
        for (std::size_t i = 0; i < dependent_.size(); ++i) {
          addmul(entry, jacobian(row, dependent_[i]), follow(i, c));
          slope = std::max(slope, abs(jacobian(row, dependent_[i]))), most = std::max(most, abs(follow(i, c)));
        }
        // An entry that vanishes is the round-off of what follows from this unknown.
        if (!(abs(entry) > round_off(kEntryPart) * slope * most)) entry = Multi(0);
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
  // True if entry i is a coordinate or a state of the model, and no velocity or multiplier.
  bool position(std::size_t i) const {
    const auto& e = l_.entries[independent_[i]];
    const System& s = l_.scenario.system;
    return e.order == 0 && (e.variable < s.coordinates || e.variable >= s.mechanical());
  }

 private:
  const VariedEquations& l_;
  std::vector<std::size_t> eliminate_;
  Machine<Multi> machine_;

 public:
  Multi t{0};
  std::vector<Multi> x, residual;
  Matrix<Multi> jacobian;
  std::vector<bool> follows;

 private:
  Node node(std::size_t e) const {
    const auto& entry = l_.entries[e];
    return l_.scenario.system.symbol_node(entry.variable, static_cast<unsigned>(entry.order));
  }
  // Returns the slot from which the value of this one is no number: its operands have values.
  std::uint32_t origin(std::uint32_t slot) const {
    for (std::optional<std::uint32_t> next = slot; next;) {
      slot = *std::exchange(next, std::nullopt);
      const Instruction& in = l_.tape.code[slot];
      const auto descend = [&](std::uint32_t operand) {
        if (!machine_.series(operand)[0].finite()) next = operand;
      };
      if (in.op == Op::select && machine_.series(in.first)[0].finite())
        descend(machine_.series(in.first)[0] < Multi(0) ? in.b : in.a);
      else
        for_each_operand(l_.tape, in, descend);
    }
    return slot;
  }
  std::pair<int, std::size_t> rank(std::size_t e) const {
    const auto& entry = l_.entries[e];
    const bool multiplier = entry.variable >= l_.scenario.system.coordinates;
    return {multiplier ? 1000 + entry.order : entry.order, entry.variable};
  }

  bool eliminate(const std::vector<std::size_t>& rows, const std::vector<std::size_t>& columns, int level,
                 std::vector<bool>& taken, const std::vector<bool>& wished) {
    const std::vector<int>& d = l_.scenario.structure.d;
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
    ANHOLON_ASSERT(dependent_.size() == l_.rows.size());
    Matrix<Multi> a(l_.rows.size(), dependent_.size());
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

}  // namespace anholon

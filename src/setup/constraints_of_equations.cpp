#include "setup/constraints_of_equations.h"

#include <algorithm>
#include <cmath>

#include "expr/generic_point.h"
#include "structure/redundancy.h"

namespace anholon {

namespace {

using Which = std::vector<std::size_t>;

constexpr int kNewtonSteps = 60;
// Newton's steps end below this part of the size of the values.
constexpr double kConverged = 1e-13;

double length(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

// States near a base that satisfy some constraints: positions first, then velocities, then higher derivatives.
class StatesNear {
 public:
  // `base`: values of all symbols. `highest`: the highest derivatives that are found.
  StatesNear(const Mechanics& m, const Which& constraints, unsigned highest, std::function<double(const Node&)> base)
      : m_(m), constraints_(constraints), base_(std::move(base)) {
    const Graph& g = m.graph();
    for (unsigned k = 0; k <= highest; ++k) {
      start_.emplace_back();
      for (Expr q : jets(*m.model, k)) start_.back().push_back(base_(g.node(q.id)));
    }
    values_ = start_;
    for (const Column& row : m.Phi) phi_.push_back(put_masses(*m.model, row));
  }

  // Returns the values of all symbols at the present state.
  PointValues values() const {
    return PointValues([this](const Node& n) {
      if (n.kind == Kind::jet && n.order < values_.size()) return values_[n.order][n.index];
      const bool moves = n.kind == Kind::time || (n.kind == Kind::state && n.order == 0);
      return moves ? base_(n) + beside_ * generic_value(n, 0) : base_(n);
    });
  }

  // Moves to the state that lies from the base by about `size` in a direction that depends on the number of the trial,
  // at another time. Returns false if no state of the constraints was found there.
  bool move(int trial, double size) {
    constexpr double kPartOfTime = 0.1;  // in this time the velocities at the base move positions by less than `size`
    values_ = start_;
    scale_.assign(values_.size(), size);
    for (std::size_t k = 1; k < scale_.size(); ++k) scale_[k] *= std::max(1.0, length(start_[k]));
    double speed = 0;
    for (Expr q : m_.qd) speed = std::max(speed, std::abs(base_(m_.graph().node(q.id))));
    beside_ = kPartOfTime * size / (1 + speed);
    for (unsigned k = 0; k < values_.size(); ++k) {
      const std::vector<double> step = tangent(k, direction(k, trial));
      for (std::size_t a = 0; a < step.size(); ++a) values_[k][a] += scale_[k] * step[a];
      const std::optional<double> corrected = satisfy(k);
      // Positions that are far from the tangent plane may belong to another branch.
      if (!corrected || (k == 0 && *corrected > size / 2)) return false;
    }
    return true;
  }
  // Satisfies the constraints from values that depend on the number of the trial.
  bool find(int trial) {
    for (unsigned k = 0; k < values_.size(); ++k) {
      values_[k] = direction(k, trial);
      for (double& x : values_[k]) x *= 2 * std::sqrt(static_cast<double>(values_[k].size()));
      if (!satisfy(k)) return false;
    }
    return true;
  }

  // True if the constraint holds at the present state, up to a small part of what a move of this size may change it by.
  bool holds(std::size_t r) const {
    constexpr double kPart = 1e-6;
    PointValues at = values();
    const double change = length(matrix({r}, at).data) * scale_[static_cast<std::size_t>(m_.order[r])];
    return std::abs(at(put_masses(*m_.model, m_.phi[r]))) <= kPart * change;
  }

 private:
  Which up_to(unsigned k) const {
    Which out;
    for (std::size_t r : constraints_)
      if (m_.order[r] <= static_cast<int>(k)) out.push_back(r);
    return out;
  }

  Matrix<double> matrix(const Which& constraints, PointValues& at) const {
    Matrix<double> phi(constraints.size(), m_.q.size());
    for (std::size_t i = 0; i < phi.rows; ++i)
      for (std::size_t a = 0; a < phi.cols; ++a) phi(i, a) = at(phi_[constraints[i]][a]);
    return phi;
  }

  std::vector<double> direction(unsigned k, int trial) const {
    std::vector<double> v;
    for (Expr q : jets(*m_.model, k))
      v.push_back(generic_value(m_.graph().node(q.id), static_cast<std::uint64_t>(trial) + 1) - 0.5);
    const double l = length(v);
    for (double& x : v) x /= l;
    return v;
  }

  // Returns the least x with Phi x = f, by the rows that are independent; nullopt if there is no number for it.
  static std::optional<std::vector<double>> least(const Matrix<double>& phi, const std::vector<double>& f) {
    constexpr double kSmallRow = 1e-9;
    const Which rows = choose_rows(phi, kSmallRow).independent;
    std::vector<double> x(phi.cols, 0.0), mu, right;
    if (rows.empty()) return x;
    Matrix<double> gram(rows.size(), rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      right.push_back(f[rows[i]]);
      for (std::size_t j = 0; j < rows.size(); ++j)
        for (std::size_t a = 0; a < phi.cols; ++a) gram(i, j) += phi(rows[i], a) * phi(rows[j], a);
    }
    Lu<double> lu;
    if (!lu.factor(gram)) return std::nullopt;
    lu.solve(right, mu);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t a = 0; a < phi.cols; ++a) x[a] += phi(rows[i], a) * mu[i];
    if (!std::isfinite(length(x))) return std::nullopt;
    return x;
  }

  std::vector<double> tangent(unsigned k, std::vector<double> v) const {
    PointValues at = values();
    const Which rows = up_to(k);
    const Matrix<double> phi = matrix(rows, at);
    std::vector<double> along(rows.size(), 0.0);
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t a = 0; a < v.size(); ++a) along[i] += phi(i, a) * v[a];
    const auto normal = least(phi, along);
    for (std::size_t a = 0; a < v.size(); ++a) v[a] = normal ? v[a] - (*normal)[a] : 0;
    return v;
  }

  // Solves the constraints, differentiated to order k, for the derivatives of order k. Returns the length of the
  // correction; nullopt if Newton's method does not converge.
  std::optional<double> satisfy(unsigned k) {
    const Which rows = up_to(k);
    Column lifted;
    for (std::size_t r : rows)
      lifted.push_back(total_derivative(put_masses(*m_.model, m_.phi[r]), k - static_cast<unsigned>(m_.order[r])));
    const std::vector<double> before = values_[k];
    std::vector<double> correction(before.size(), 0.0);
    for (int step = 0; step < kNewtonSteps; ++step) {
      PointValues at = values();
      std::vector<double> f;
      for (Expr e : lifted) f.push_back(at(e));
      const auto x = least(matrix(rows, at), f);
      if (!x) return std::nullopt;
      for (std::size_t a = 0; a < x->size(); ++a) values_[k][a] -= (*x)[a];
      if (length(*x) > kConverged * (1 + length(values_[k]))) continue;
      for (std::size_t a = 0; a < before.size(); ++a) correction[a] = values_[k][a] - before[a];
      return length(correction);
    }
    return std::nullopt;
  }

  const Mechanics& m_;
  Rows phi_;  // dphi/dq^(m) of all constraints of the model
  Which constraints_;
  std::function<double(const Node&)> base_;
  std::vector<std::vector<double>> start_, values_;  // q^(k) by k and coordinate
  std::vector<double> scale_;                        // by k: the size of the last move
  double beside_ = 0;                                // how far times and states have moved
};

// True if constraints hold at all states near the base that satisfy the others. A row that depends on those of others
// at a singular state only has a constraint that is violated beside this state.
bool follow_near(const Mechanics& m, const Which& others, const Which& constraints,
                 const std::function<double(const Node&)>& base) {
  constexpr int kTrials = 4;
  constexpr double kLargest = 0.1, kSmallest = 1e-9;  // sizes of steps; large ones show a violation best
  unsigned highest = 0;
  for (std::size_t r : constraints) highest = std::max(highest, static_cast<unsigned>(m.order[r]));
  StatesNear states(m, others, highest, base);
  for (int trial = 0; trial < kTrials; ++trial) {
    double size = kLargest;
    while (size > kSmallest && !states.move(trial, size)) size /= 10;
    if (!(size > kSmallest)) return false;
    if (!std::all_of(constraints.begin(), constraints.end(), [&](std::size_t r) { return states.holds(r); }))
      return false;
  }
  return true;
}

// True if the rows are independent, none of them nearly dependent, at a point of the manifold of the constraints.
bool independent_on_manifold(const Mechanics& m, const Which& constraints,
                             const std::function<double(const Node&)>& base) {
  constexpr int kTrials = 20;
  constexpr double kClear =
      1e-3;  // the sine of a row; points are found up to round-off, or its root if rows are dependent
  if (constraints.empty()) return true;
  unsigned highest = 0;
  std::vector<int> order;
  for (std::size_t r : constraints) {
    order.push_back(m.order[r]);
    highest = std::max(highest, static_cast<unsigned>(m.order[r]));
  }
  StatesNear states(m, constraints, highest, base);
  for (int trial = 0; trial < kTrials; ++trial) {
    if (!states.find(trial)) continue;
    PointValues at = states.values();
    const Matrix<double> phi = constraint_matrix(m, constraints, at);
    const IndependentConstraints choice = choose_independent(phi, order);
    if (choice.redundant.empty() && choice.weakest > kClear && choose_rows(phi, kDependent).vanishing.empty())
      return true;
  }
  return false;
}

Which picked(const Which& all, const Which& indices) {
  Which out;
  for (std::size_t i : indices) out.push_back(all[i]);
  return out;
}

}  // namespace

ConstraintsOfEquations constraints_of_equations(const Mechanics& m, const std::vector<std::size_t>& all,
                                                const std::vector<double>& parameters,
                                                const InitialState<double>& state) {
  const auto base = symbol_near(*m.model, parameters, state);
  PointValues at(base);
  ConstraintsOfEquations out{independent_rows(m, all, at), {}, FullRank::here};
  if (state.q.empty()) {
    if (!independent_on_manifold(m, out.taken, base)) out.full_rank = FullRank::assumed;
    return out;
  }
  const Matrix<double> phi = constraint_matrix(m, all, at);
  std::vector<int> order;
  for (std::size_t r : all) order.push_back(m.order[r]);
  const IndependentConstraints choice = choose_independent(phi, order);
  // A zero row counts as independent there.
  const Which zero = choose_rows(phi, kDependent).vanishing;
  Which kept, open = choice.redundant;
  for (std::size_t i : choice.independent)
    (std::find(zero.begin(), zero.end(), i) == zero.end() ? kept : open).push_back(i);
  std::sort(open.begin(), open.end());
  kept = picked(all, kept), open = picked(all, open);
  if (open.empty()) return out;
  if (out.taken.size() > kept.size()) {
    if (follow_near(m, kept, open, base)) return {kept, open, FullRank::here};
    out.full_rank = FullRank::beside;
    return out;
  }
  // The rows are dependent everywhere. Those that are independent at a generic point may be dependent at the state.
  if (choose_rows(constraint_matrix(m, out.taken, at), kDependent).independent.size() < out.taken.size())
    out.taken = kept;
  return out;
}

}  // namespace anholon

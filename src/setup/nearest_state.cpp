#include "setup/nearest_state.h"

#include <algorithm>

#include "numeric/linear.h"

namespace anholon {

namespace {

constexpr int kMostSteps = 200, kRoundoffs = 16;

// The entries of one level of the state, x_j^(d_j - level) of the coordinates, and the equations that hold for them alone.
template <Number W>
class StateLevel {
 public:
  StateLevel(const Program& p, const Expansion<W>& at, int level) : p_(p), level_(level), n_(p.system->coordinates) {
    for (std::size_t j = 0; j < n_; ++j)
      entries_.push_back(at.offset(j) + static_cast<std::size_t>(std::max(0, p.d[j] - level)));
    for (std::size_t i = n_; i < p.system->mechanical(); ++i)
      if (p.c[i] >= level) rows_.push_back(i);
  }

  // True if the loaded state satisfies the equations up to round-off, after measure().
  bool holds(const Expansion<W>& at) const {
    return std::all_of(rows_.begin(), rows_.end(), [&](std::size_t i) {
      return at.hidden_residual(i, p_.c[i] - level_) <= unit_roundoff<W>() * W(kRoundoffs);
    });
  }

  // Computes the state nearest to `from` that satisfies the equations linearized at the state `state` for which `at` is
  // prepared. Returns the largest relative change, or nullopt if the change is not determined.
  std::optional<W> step(const Expansion<W>& at, const std::vector<W>& from, std::vector<W>& state) const {
    const Matrix<W> J = at.system_jacobian().matrix();
    Matrix<W> M(n_, n_), A(rows_.size(), n_);
    std::vector<W> b, y;
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < n_; ++j) M(i, j) = J(i, j);
    for (std::size_t r = 0; r < rows_.size(); ++r) {
      const std::size_t i = rows_[r];
      const int order = p_.c[i] - level_;
      W sum = -at.machine().series(p_.tape.roots[i])[order];  // orders are 0 and 1, whose factorials are 1
      for (std::size_t j = 0; j < n_; ++j) {
        A(r, j) = J(i, j);
        sum += J(i, j) * (state[entries_[j]] - from[entries_[j]]);
      }
      b.push_back(sum);
    }
    if (!least_change(M, A, b, y)) return std::nullopt;
    W most(0);
    for (std::size_t j = 0; j < n_; ++j) {
      W& x = state[entries_[j]];
      const W to = from[entries_[j]] + y[j];
      if (!is_finite(to)) return std::nullopt;
      most = std::max(most, W(abs(to - x) / (W(1) + abs(to))));
      x = to;
    }
    return most;
  }

 private:
  const Program& p_;
  int level_;
  std::size_t n_;
  std::vector<std::size_t> entries_, rows_;
};

}  // namespace

static System routh_of(const Scenario& s) {
  const Workspace own(s);
  return implicit_system(own.model, *own.mechanics, *find_formulation("routh"), own.independent);
}

template <Number W>
NearestState<W>::NearestState(const Scenario& s, const std::vector<W>& parameters) : routh_(routh_of(s)) {
  std::vector<double> numbers;
  for (const W& x : parameters) numbers.push_back(to_double(x));
  Structure structure;
  if (!analyse(routh_, numbers, hints_at(s.state), structure).ok()) return;
  drop_absent(routh_, structure);
  const auto of_coordinates = structure.d.begin() + static_cast<std::ptrdiff_t>(routh_.coordinates);
  if (std::all_of(structure.d.begin(), of_coordinates, [](int d) { return d == 2; }) && structure.largest_c() <= 2)
    program_ = program(routh_, structure);
}

template <Number W>
Outcome NearestState<W>::put(const Program& of, const W& t, const std::vector<W>& parameters,
                             const std::vector<W>& leading, std::vector<W>& state) const {
  if (program_.d != of.d) return {};
  Expansion<W> at(program_, parameters, 1);
  for (int level = *std::max_element(program_.c.begin(), program_.c.end()); level >= 1; --level) {
    const StateLevel<W> of_level(program_, at, level);
    const std::vector<W> from = state;
    W last(0);
    for (int k = 0;; ++k) {
      at.load(t, state, leading);
      // If the state cannot be prepared here, the stepper cannot begin with it either, and reports the fault.
      if (!at.prepare().ok()) return {};
      at.measure();
      if (k == 0 && of_level.holds(at)) break;
      const std::optional<W> change = of_level.step(at, from, state);
      if (!change) return {};
      const bool quiet = *change <= unit_roundoff<W>() * W(kRoundoffs);
      if (quiet || (k > 2 && of_level.holds(at) && !(*change < last))) break;
      if (k == kMostSteps)
        return {OutcomeKind::no_convergence, "no state near what is set satisfies the constraints",
                "set positions and velocities nearer to those that the constraints allow"};
      last = *change;
    }
  }
  return {};
}

template class NearestState<long double>;
template class NearestState<Quad>;
template class NearestState<Multi>;

}  // namespace anholon

// The search for the solution of a stage by Newton's method: with line searches, along its flow, and from points around.
#include <algorithm>

#include "structure/stage.h"

namespace anholon {

namespace {

constexpr int kMostIterations = 60;
// The limit of steps along Newton's flow. The steps grow by a factor after a place at which the Jacobian is nearly
// singular, and a flow that ends at a solution needs fewer steps.
constexpr int kMostFlowSteps = 100;
// After this number of line searches in a row without improvement the iteration is given up.
constexpr int kMostInVain = 3;
// The limit of steps of the descent to the nearest solution by Barzilai and Borwein, which takes about ten steps, and
// more if the constraints are strongly curved.
constexpr int kMostDescentSteps = 300;
// The limit of iterations of Newton's method that bring the steps of one descent back onto the solutions; beside folds
// each step takes many.
constexpr int kMostDescentIterations = 500;
// The smallest part of a step of Newton's method along its flow, a power of 4.
constexpr double kLeastFlowPart = 0x1p-40;

// Newton's method on a stage, in the free unknowns.
template <Number N>
class Iteration {
 public:
  Iteration(Stage<N>& stage, InitialState<N>& state, const std::vector<std::size_t>& free)
      : s_(stage), state_(state), free_(free) {
    for (std::size_t j : free) x_.push_back(&s_.x(state, j)), guess_.push_back(*x_.back());
  }

  const std::vector<N>& guess() const { return guess_; }
  std::vector<N> point() const {
    std::vector<N> p;
    for (const N* v : x_) p.push_back(*v);
    return p;
  }
  // Returns false if the equations have no value there.
  bool go_to(const std::vector<N>& point) {
    for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = point[j];
    return s_.evaluate(state_);
  }
  bool solved() const { return !(s_.worst() > stage_rounding<N>()); }

  // Returns the square of the distance from the guess, in the metric at the point.
  N distance() const { return distance(s_.metric); }

  // Goes towards the solution nearest to the guess or, if `nearest` is false, to any solution: every step is then the
  // least one.
  bool run(bool nearest) {
    in_vain_ = 0;
    settled_ = free_.empty();
    direct_ = true;
    const N rounding = stage_rounding<N>();
    if (!s_.evaluate(state_)) return false;
    N last_step(-1);
    bool nudged = false;
    for (int k = 0; k < kMostIterations && !free_.empty(); ++k, ++iterations_) {
      typename Stage<N>::Elimination& elimination = s_.elimination(free_);
      const RowChoice<N>& rows = elimination.rows;
      if (rows.dependent.size() && !nudged && s_.worst() > rounding && k == 0) {
        nudged = true;
        direct_ = false;
        if (leave_stationary_point(rows)) {
          if (!s_.evaluate(state_)) return false;
          continue;
        }
      }
      settled_ = rows.independent.empty();
      if (settled_) break;
      if (!elimination.possible) return true;
      least_step(elimination, nearest);
      if (!search()) return false;
      if (in_vain_ > kMostInVain) return true;
      settled_ = step_vanishes(last_step);
      if (settled_) break;
    }
    if (nearest && settled_ && !solved()) polish();
    return true;
  }

  // True if run() has reached a solution and, if requested, the nearest of its neighbours.
  bool settled() const { return settled_ && solved(); }
  // True if run() made full steps only, from a point at which the equations are independent.
  bool direct() const { return direct_; }

  // Goes to the solution nearest to the guess; if the first solution is not the nearest, a descent follows. Returns
  // false if the equations have no value there.
  bool run_to_nearest() {
    if (!run(true)) return false;
    if (solved() && !settled_) descend();
    return true;
  }

  // Follows Newton's flow from the point, along which all residuals fall in proportion: the solution at its end belongs
  // to the point, even if a full step of Newton's method would land near another one. Returns false if the flow ends
  // before a solution.
  bool follow() {
    if (!s_.evaluate(state_)) return false;
    flow_part_ = kLeastFlowPart;
    for (int k = 0; k < kMostFlowSteps; ++k) {
      if (solved()) return true;
      typename Stage<N>::Elimination& elimination = s_.elimination(free_);
      if (elimination.rows.independent.empty() || !elimination.possible) return false;
      least_step(elimination, false);
      if (!flow()) return false;
    }
    return solved();
  }

  // Descends along the solutions to one whose neighbours are not nearer to the guess. The direction is the greatest
  // change towards the guess, in the metric at the point, that keeps the equations to first order; its length follows
  // from the two last steps (Barzilai and Borwein), and Newton's method brings each step back onto the solutions.
  // Returns true if the step vanishes; else the descent ends at the nearest solution it has reached.
  bool descend() {
    std::vector<N> at, direction, last_at, last_direction;
    N last_moved(-1);
    const int begun = iterations_;
    for (int k = 0; k < kMostDescentSteps && iterations_ - begun < kMostDescentIterations; ++k) {
      typename Stage<N>::Elimination& elimination = s_.elimination(free_);
      if (elimination.rows.independent.empty() || !elimination.possible) return false;
      least_step(elimination, true);
      at = point();
      direction = step_;
      if (step_vanishes(last_moved)) {
        clear_round_off();
        return true;
      }
      if (!slide(at, direction, part_of_descent(at, direction, last_at, last_direction))) return false;
      last_at.swap(at);
      last_direction.swap(direction);
    }
    return false;
  }

 private:
  // Moves unknowns away from a guess that is a stationary point of a constraint (the centre of a circle). Returns false
  // if no constraint is stationary.
  bool leave_stationary_point(const RowChoice<N>& rows) {
    if (s_.linear()) return false;
    bool moved = false;
    for (std::size_t j = 0; j < free_.size(); ++j) {
      if (std::none_of(rows.dependent.begin(), rows.dependent.end(), [&](std::size_t i) {
            return s_.holds(i, free_[j]) && abs(s_.residual[i]) > stage_rounding<N>() * s_.scale[i];
          }))
        continue;
      *x_[j] += N(0.1) + N(0.037) * N(static_cast<int>(j % 7));
      moved = true;
    }
    return moved;
  }

  // True if the step is round-off of the point, or is only a little above and no longer falls. `last`: the size of the
  // step before, negative if there is none; becomes the size of this step.
  bool step_vanishes(N& last) const {
    N moved(0), size(0);
    for (std::size_t j = 0; j < x_.size(); ++j) {
      if (N v = abs(step_[j]); v > moved) moved = v;
      if (N v = abs(*x_[j]); v > size) size = v;
    }
    const N floor = unit_roundoff<N>() * N(8) * (size > N(1) ? size : N(1));
    const bool vanishes = !(moved > floor) || (last >= N(0) && !(moved < last) && moved < floor * N(100));
    last = moved;
    return vanishes;
  }

  // Sets unknowns to the guess if they differ from it only by the round-off of the largest change.
  void clear_round_off() {
    const std::vector<N> at = point();
    N largest(0);
    for (std::size_t j = 0; j < at.size(); ++j)
      if (N v = abs(N(at[j] - guess_[j])); v > largest) largest = v;
    for (std::size_t j = 0; j < at.size(); ++j)
      if (abs(N(at[j] - guess_[j])) < unit_roundoff<N>() * N(16) * largest) *x_[j] = guess_[j];
    if (!s_.evaluate(state_) || !solved()) go_to(at);
  }

  N distance(const Matrix<N>& metric) const {
    N sum(0);
    for (std::size_t i = 0; i < x_.size(); ++i)
      for (std::size_t j = 0; j < x_.size(); ++j)
        sum += (*x_[i] - guess_[i]) * metric(free_[i], free_[j]) * (*x_[j] - guess_[j]);
    return sum;
  }

  // Returns the part of the direction that the next step of a descent makes, from the change of the direction in the
  // last step.
  N part_of_descent(const std::vector<N>& at, const std::vector<N>& direction, const std::vector<N>& last_at,
                    const std::vector<N>& last_direction) const {
    constexpr double kLeast = 0x1p-20, kMost = 16;
    if (last_at.empty()) return N(1);
    N way(0), bent(0);
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = 0; j < at.size(); ++j) {
        const N& g = s_.metric(free_[i], free_[j]);
        way += (at[i] - last_at[i]) * g * (at[j] - last_at[j]);
        bent += (at[i] - last_at[i]) * g * (last_direction[j] - direction[j]);
      }
    if (!(bent > N(kLeast) * way)) return N(kMost);
    const N part = N(way / bent);
    return part < N(kLeast) ? N(kLeast) : part > N(kMost) ? N(kMost) : part;
  }

  // Makes this part of a step of the descent, or a smaller one, so that the distance does not grow in the metric at its
  // start. Returns false, at the start of the step, if no part achieves this. Distances are known to the rounding of
  // the solutions.
  bool slide(const std::vector<N>& at, const std::vector<N>& direction, N part) {
    constexpr int kMostParts = 12;
    const Matrix<N> metric = s_.metric;
    const N before = distance(metric) * (N(1) + N(16) * stage_rounding<N>());
    for (int k = 0; k < kMostParts; ++k, part = part * N(0.25)) {
      for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = at[j] + part * direction[j];
      if (run(false) && solved() && !(distance(metric) > before)) return true;
    }
    go_to(at);
    return false;
  }

  // Computes the step that least changes the point or, if `nearest`, the step to the point least distant from the
  // guess.
  void least_step(typename Stage<N>::Elimination& e, bool nearest) {
    const std::vector<std::size_t>& rows = e.rows.independent;
    const std::size_t n = free_.size();
    right_.resize(rows.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      right_[i] = -s_.residual[rows[i]];
      if (nearest)
        for (std::size_t j = 0; j < n; ++j) right_[i] += e.a(rows[i], j) * (*x_[j] - guess_[j]);
    }
    e.change.solve(right_, step_);
    if (nearest)
      for (std::size_t j = 0; j < n; ++j) step_[j] = N(guess_[j] + step_[j] - *x_[j]);
    drop_round_off();
  }

  // Sets entries of the step to zero that are far below the round-off of the largest number: they stand for zero.
  void drop_round_off() {
    N largest(0);
    for (std::size_t j = 0; j < step_.size(); ++j) largest = std::max({largest, N(abs(step_[j])), N(abs(*x_[j]))});
    const N zero = largest * unit_roundoff<N>() * unit_roundoff<N>();
    for (N& change : step_)
      if (abs(change) <= zero) change = N(0);
  }

  // True if the residuals are those of Newton's flow at this part of the step: they fall by this part, with an error of
  // at most the fraction kBent of it.
  bool flows(double part) const {
    constexpr double kBent = 0.5;
    N most(0), missed(0);
    for (std::size_t i = 0; i < s_.size(); ++i) {
      if (const N v = abs(old_residual_[i]) / scale_[i]; v > most) most = v;
      if (const N v = abs(N(s_.residual[i] - N(1 - part) * old_residual_[i])) / scale_[i]; v > missed) missed = v;
    }
    return missed <= N(kBent * part) * most + stage_rounding<N>() * N(4);
  }

  // Goes along the step as far as it follows Newton's flow, trying smaller parts of the step before larger ones,
  // because a full step may end near a solution by chance. Returns false if no part of the step follows the flow.
  bool flow() {
    constexpr double kTimes = 4, kFewer = 64;
    scale_ = s_.scale;
    old_residual_ = s_.residual;
    old_.clear();
    for (const N* v : x_) old_.push_back(*v);
    const auto go = [&](double part) {
      for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = old_[j] + N(part) * step_[j];
      return s_.evaluate(state_);
    };
    double good = 0;
    for (double part = std::max(kLeastFlowPart, flow_part_ / kFewer); part <= 1; part *= kTimes) {
      if (!go(part) || !flows(part)) break;
      good = part;
    }
    if (!go(good) || !(good > 0)) return false;
    flow_part_ = good;
    return true;
  }

  // Removes the round-off of steps that are measured from the guess: it has the size of the guess, and the solution may be
  // much smaller.
  void polish() {
    typename Stage<N>::Elimination& elimination = s_.elimination(free_);
    if (elimination.rows.independent.empty() || !elimination.possible) return;
    const std::vector<N> before = point();
    const N missed = s_.worst();
    least_step(elimination, false);
    for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] += step_[j];
    if (!s_.evaluate(state_) || !(s_.worst() < missed)) go_to(before);
  }

  // Goes along the step as long as the residual decreases; `step_` is then the step made.
  bool search() {
    // Progress is measured relative to the scales at the start of the step: those at its end grow with it.
    scale_ = s_.scale;
    old_.clear();
    for (const N* v : x_) old_.push_back(*v);
    const N now = s_.worst(scale_);
    N fraction(1);
    bool better = false;
    for (int halvings = 0; halvings < 12 && !better; ++halvings) {
      if (halvings > 0) fraction = fraction * N(0.5);
      for (std::size_t j = 0; j < x_.size(); ++j) *x_[j] = old_[j] + fraction * step_[j];
      if (!s_.evaluate(state_)) continue;
      const bool less = s_.worst(scale_) <= now * N(0.9) + stage_rounding<N>() * N(4);
      in_vain_ = less ? 0 : in_vain_ + (halvings == 11);
      better = less || halvings == 11;
      direct_ = direct_ && halvings == 0;
    }
    for (std::size_t j = 0; j < x_.size(); ++j) step_[j] = *x_[j] - old_[j];
    return better || s_.evaluate(state_);
  }

  Stage<N>& s_;
  InitialState<N>& state_;
  const std::vector<std::size_t>& free_;
  std::vector<N*> x_;
  std::vector<N> guess_;
  std::vector<N> right_, step_;  // right side of a step, and the step itself
  std::vector<N> scale_, old_;   // scales and point at the start of a step
  std::vector<N> old_residual_;  // residuals at the start of a step along Newton's flow
  double flow_part_ = 1;         // the part of the last step that was made along the flow
  bool settled_ = false;         // true if the last step of run() vanished
  bool direct_ = false;
  int in_vain_ = 0;     // searches in a row that found no improvement along their step
  int iterations_ = 0;  // all iterations of run()
};

// The nearest of the solutions that searches have reached.
template <Number N>
struct Nearest {
  static constexpr double kNearer = 1e-6;  // a smaller relative difference of distances does not count
  std::vector<N> point;                    // empty if there is none
  N distance{0};

  void offer(const Iteration<N>& at) {
    const N d = at.distance();
    if (point.empty() || d < distance * N(1 - kNearer)) distance = d, point = at.point();
  }
};

// Tells for each of these unknowns whether an equation contains it.
template <Number N>
std::vector<bool> held(const Stage<N>& s, const std::vector<std::size_t>& free) {
  std::vector<bool> is(free.size(), false);
  for (std::size_t j = 0; j < free.size(); ++j)
    for (std::size_t i = 0; i < s.size() && !is[j]; ++i) is[j] = s.holds(i, free[j]);
  return is;
}

// Returns the k-th point around the guess, at increasing distance. `numbers`: the numbers of the unknowns, by which the
// point is drawn.
template <Number N>
std::vector<N> around(const std::vector<N>& guess, const std::vector<std::size_t>& numbers, int k) {
  std::vector<N> p = guess;
  for (std::size_t j = 0; j < p.size(); ++j) {
    const unsigned draw =
        (static_cast<unsigned>(k) * 2654435761U + static_cast<unsigned>(numbers[j] + 1) * 2246822519U) >> 16;
    const N size = abs(p[j]) > N(1) ? N(abs(p[j])) : N(1);
    p[j] += size * N(k) * N(static_cast<int>(draw % 2001U) - 1000) / N(4000);
  }
  return p;
}

}  // namespace

template <Number N>
bool find_by_least_change(Stage<N>& s, InitialState<N>& state, const std::vector<std::size_t>& may_move,
                          const InitialState<double>* near, bool by_flow) {
  // Only unknowns that an equation contains are free: in the mass norm, others coupled to them by inertia would move as
  // well.
  std::vector<std::size_t> free, numbers;
  const std::vector<bool> moves = held(s, may_move);
  for (std::size_t j = 0; j < may_move.size(); ++j)
    if (moves[j]) free.push_back(may_move[j]), numbers.push_back(j);
  constexpr int kStarts = 12, kStartsInMany = 3;
  constexpr std::size_t kMany = 60;  // unknowns
  Iteration<N> newton(s, state, free);
  if (near && !free.empty()) {
    std::vector<N> there = newton.guess();
    for (std::size_t j = 0; j < free.size(); ++j)
      if (const double* x = near->value(s.unknown(free[j]))) there[j] = N(*x);
    if (newton.go_to(there) && newton.run_to_nearest() && newton.solved()) return true;
    newton.go_to(newton.guess());
  }
  if (by_flow && !free.empty()) {
    if (newton.follow()) {
      // Newton's method continues to the nearest of a family of solutions, and to all digits. A result that is farther
      // by more than round-off is another solution.
      const std::vector<N> there = newton.point();
      const N farther = N(2) * newton.distance();
      if (!newton.run(true) || !newton.settled() || newton.distance() > farther) {
        newton.go_to(there);
        newton.descend();
      }
      return true;
    }
    newton.go_to(newton.guess());
  }
  const bool value = newton.run_to_nearest();
  const bool solved = value && newton.solved();
  if ((solved && (by_flow || newton.direct())) || free.empty() || s.linear()) return value;
  const InitialState<N> first = state;
  Nearest<N> nearest;
  if (solved) nearest.offer(newton);
  for (int k = 0; k <= kStarts && (nearest.point.empty() || k < kStartsInMany || free.size() <= kMany); ++k) {
    if (!newton.go_to(around(newton.guess(), numbers, k))) continue;
    if (!newton.follow() && !(newton.run(false) && newton.solved())) continue;
    newton.descend();
    nearest.offer(newton);
  }
  if (!nearest.point.empty()) return newton.go_to(nearest.point);
  state = first;
  return value && s.evaluate(state);
}

#define INSTANTIATE(N)                                                                                                 \
  template bool find_by_least_change<N>(Stage<N>&, InitialState<N>&, const std::vector<std::size_t>&,                  \
                                        const InitialState<double>*, bool);
INSTANTIATE(double)
INSTANTIATE(long double)
INSTANTIATE(Quad)
INSTANTIATE(Multi)
#undef INSTANTIATE

}  // namespace anholon

// The Taylor expansion of a motion in any number type: the reference for expansions by kernels.
//
// Taylor coefficients are computed in N; the state, the projection on the constraints and the leading derivatives in
// the wider type W, with the LU of N (mixed-precision refinement). If the state were rounded to N at every step, it
// would be projected on the constraints of another point, which limits the accuracy of the energy of a fast spinning
// body over many steps.
#pragma once
#include "integrate/motion_state.h"
#include "integrate/step_control.h"
#include "program/expansion.h"

namespace anholon {

// A distance from the hidden constraints relative to the size of the state, and the equation that misses by this
// distance.
template <Number N>
struct MissedConstraint {
  N by{0};
  std::size_t equation = 0;
};

// An expansion is made in three parts: prepare() -> solve() -> extend().
template <Number N>
class ReferenceExpansion {
 public:
  using W = Wider<N>;
  ReferenceExpansion(const Program& program, const std::vector<N>& parameters, int order);
  ReferenceExpansion(ReferenceExpansion&&) = default;  // a copy would point into the original

  // Computes values at the state, J and its LU.
  Outcome prepare(const MotionState<N>& m, const std::vector<W>& guess);
  // Projects the state on the constraints and solves for the leading derivatives. `point`: the solution in W.
  Outcome solve(MotionState<N>& m, const std::vector<W>& guess, Expansion<W>& point);
  // The distance of the state from the constraints before solve() projected it; solve() may have failed.
  const MissedConstraint<N>& missed() const { return missed_; }
  Outcome extend() { return expansion_.extend(); }
  // Replaces extend() if formulas have no derivatives: the polynomials end with these leading derivatives.
  void cut_to(const MotionState<N>& m, const std::vector<W>& leading, Expansion<W>& point);

  int order() const { return order_; }
  // The length of a step by the radius of convergence.
  N reach(double shrink) const { return step_size<N>(unknowns_, program_->scales, order_, shrink); }
  Expansion<N>& series() { return expansion_; }
  const Expansion<N>& series() const { return expansion_; }
  // Computes the changes of the state over h, and the leading derivatives there. `point`: the solution where the
  // expansion was made.
  void polynomial(const W& h, const Expansion<W>& point, std::vector<W>& increments, std::vector<W>& leading) const;
  // The integral of quadrature i over h.
  W integral(std::size_t i, const W& h) const;
  // Advances the motion by h. Returns false if it grows beyond kBlowUp; then the state is unchanged.
  bool advance(MotionState<N>& m, const W& h, const Expansion<W>& point);

 private:
  Outcome solve_wide(MotionState<N>& m, Expansion<W>& point);

  const Program* program_;
  int order_;
  Expansion<N> expansion_;
  MissedConstraint<N> missed_;
  std::vector<UnknownSeries<N>> unknowns_;
  std::vector<W> reciprocal_;  // the reciprocals of 1, 2, …, order
  std::vector<N> narrow_state_, narrow_leading_, narrow_r_, narrow_y_;
  std::vector<W> change_, next_;
};

extern template class ReferenceExpansion<double>;
extern template class ReferenceExpansion<long double>;
extern template class ReferenceExpansion<Quad>;
extern template class ReferenceExpansion<Multi>;

}  // namespace anholon

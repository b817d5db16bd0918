// Decides whether the system Jacobian J is regular at a point, and stays so between two points of a motion (theory:
// taylor).
//
// If leading derivatives enter nonlinearly, solutions of the equations may meet where J is singular, and the Taylor
// polynomial would go straight on from one to another: `near` says that J is regular on all of the way. The polynomial
// may also carry a motion across a singular point of any system: a linkage that folds flat, a multiplier that makes the
// inertia vanish. The motion beyond is one of several: `crossed` says that there was such a point.
#pragma once
#include "integrate/look_ahead.h"

namespace anholon {

inline Outcome becomes_singular() {
  return {OutcomeKind::singular, "the system Jacobian becomes singular", "end the motion before"};
}

// True if the spectral radius of A = J0^-1 (J1 - J0), estimated by the norm of the balanced A^8, is at most 1/2. If it
// is below 1, every J on the line from J0 to J1 is regular.
template <Number N>
bool near(const Expansion<N>& p0, const Expansion<N>& p1);

// The unit vector v that J maps to the shortest image, J v, the reactions of the multipliers in v, and the smallest
// scaled singular value.
template <Number N>
struct Mode {
  std::vector<N> v, image, reaction;
  N sigma{0};
};
// REQUIRES: at.smallest_singular_value() has been computed; it is `sigma`.
template <Number N>
Mode<N> weakest_mode(const Expansion<N>& at, const N& sigma);

// True if J v or the reactions change their direction while v keeps its own: then a singular value, or a combination of
// the rows of Phi, has passed zero in between.
template <Number N>
bool crossed(const Mode<N>& a, const Mode<N>& b, std::size_t coordinates);

// Watches J along a motion: its smallest singular value sigma, and where a step has to end because of J.
template <Number N>
class JacobianGuard {
 public:
  using W = Wider<N>;
  explicit JacobianGuard(const Program& program) : coordinates_(program.system->coordinates) {}

  // Begins another motion.
  void restart() {
    sigma_ = N(0);
    singular_ahead_ = false;
  }
  const N& sigma() const { return sigma_; }
  void set_sigma(const N& sigma) { sigma_ = sigma; }
  // Measures sigma after prepare(), and notes new extremes in the record. Fails if constraints have lost their hold.
  Outcome check(Expansion<N>& at, const W& t, StepRecord<N>& record);

  // Returns the longest of h, h/2, h/4, … over which J is regular on all of the way, and notes it in the record.
  W on_the_branch(PresentStep<N>& step, W h, StepRecord<N>& record) const;
  // True if the step is the first one, or so much longer than the one before that J may be singular within it without
  // any earlier sign.
  static bool longer_than(const W& h, const W& last_step) {
    constexpr double kLonger = 1.5;
    return last_step == W(0) || abs(h) > last_step * W(kLonger);
  }
  // Returns the distance of the first singular point within h; nullopt if there is none.
  std::optional<W> singular_within(PresentStep<N>& step, const W& h, const W& last_step) const;
  // True if J, at two points that the motion passed in this order, shows no singular point between them. False if J has
  // no values.
  bool regular_between(LookAhead<N>& look, const MotionState<N>& before, const MotionState<N>& after) const;

  // True if the present step ends shortly before a singular point.
  bool singular_ahead() const { return singular_ahead_; }
  void set_singular_ahead(bool ahead) { singular_ahead_ = ahead; }

 private:
  std::size_t coordinates_;
  N sigma_{0};  // at the last expansion of the reference
  bool singular_ahead_ = false;
};

extern template class JacobianGuard<double>;
extern template class JacobianGuard<long double>;
extern template class JacobianGuard<Quad>;
extern template class JacobianGuard<Multi>;

}  // namespace anholon

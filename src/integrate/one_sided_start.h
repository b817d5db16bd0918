// Goes on from where a formula has no derivatives along the motion, or no value: a root, norm or unit vector whose
// argument is zero there (theory: taylor, "One-sided starts").
//
// One step, so short that the leading derivatives a say all about it: x(h) = x + ... + a h^d/d!. They are those that
// the equations have at its end, a = G(a), found by iteration: so a formula is taken on the side that the motion
// enters. Where they are not determined that way (dry friction that holds, a thrust along a velocity that is zero), the
// outcome names the formula.
#pragma once
#include "integrate/look_ahead.h"

namespace anholon {

template <Number N>
class OneSidedStart {
 public:
  using W = Wider<N>;
  // After an expansion that has failed with `fault`.
  OneSidedStart(PresentStep<N>& step, Outcome fault);

  // The length of the step, positive. `point`: where it begins.
  static W length(const PresentStep<N>& step, const Expansion<W>& point, double log_tolerance);
  // Ends the expansion with the leading derivatives for a step h of either sign; nullopt if they are not determined, or
  // grow without bound as h shrinks.
  std::optional<std::vector<W>> take(PresentStep<N>& step, const W& h) const;
  // The fault, where there is no such step.
  Outcome fault(PresentStep<N>& step, const W& h) const;
  // As fault(), where the motion came to the point and cannot go on from it: the expansion ends with the leading
  // derivatives of the track again.
  Outcome stop(PresentStep<N>& step, const W& h);
  // Whether the motion stops at the point: nothing follows whose leading derivatives stand for those that the equations
  // do not have there.
  bool stopped() const { return stopped_; }

 private:
  std::optional<std::vector<W>> leading_after(PresentStep<N>& step, const W& h, std::vector<W> leading) const;
  std::optional<std::vector<W>> fixed_point(PresentStep<N>& step, const W& h, std::vector<W> a) const;
  std::optional<std::vector<W>> only_fixed_point(PresentStep<N>& step, const W& h) const;

  Outcome fault_;
  std::vector<W> at_point_;  // the leading derivatives at the point; empty if the equations have none
  bool stopped_ = false;
};

extern template class OneSidedStart<double>;
extern template class OneSidedStart<long double>;
extern template class OneSidedStart<Quad>;
extern template class OneSidedStart<Multi>;

}  // namespace anholon

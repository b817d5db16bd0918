// Makes the first step from a point where a formula has no derivatives along the motion, or no value: a root, norm or
// unit vector whose argument is zero there (theory: taylor, "One-sided starts").
//
// The step is so short that the leading derivatives a determine it: x(h) = x + ... + a h^d/d!. They are those that the
// equations have at its end, a = G(a), found by iteration; so a formula is taken on the side that the motion enters. If
// that does not determine them (dry friction that holds, a thrust along a velocity that is zero), the outcome names the
// formula.
#pragma once
#include "integrate/look_ahead.h"

namespace anholon {

template <Number N>
class OneSidedStart {
 public:
  using W = Wider<N>;
  // REQUIRES: an expansion has failed with `fault`.
  OneSidedStart(PresentStep<N>& step, Outcome fault);

  // Returns the length of the step, positive. `point`: where the step begins.
  static W length(const PresentStep<N>& step, const Expansion<W>& point, double log_tolerance);
  // Ends the expansion with the leading derivatives for a step h of either sign. Returns nullopt if they are not
  // determined, or grow without bound as h shrinks.
  std::optional<std::vector<W>> take(PresentStep<N>& step, const W& h) const;
  // Returns the fault if there is no such step.
  Outcome fault(PresentStep<N>& step, const W& h) const;
  // Like fault(), for a motion that came to the point and cannot go on from it; the expansion gets the leading
  // derivatives of the track again.
  Outcome stop(PresentStep<N>& step, const W& h);
  // True if the motion stops at the point, so that no later leading derivatives can replace those that the equations do
  // not have there.
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

// Checks whether a step may end where its series allow. Series tell by their highest coefficients how far they reach,
// but they do not show a function that is nearly constant where they were made: a tanh far from its ramp, a wall that
// begins further on. The equations show such a function: the leading derivatives that the series foretell are put into
// the equations at the end of the step and at suspicious points on the way, and the change that Newton's method makes
// to them is the defect of the motion.
//
// A defect of x^(d) over a step h moves x^(d-1) by about h times the defect; relative to the size of x^(d-1) this
// change has to stay near the tolerance. Where J is nearly singular, Newton's change is round-off, however short the
// step is. Therefore the defect near the start of the step is measured before a step is refused.
#pragma once
#include <vector>

#include "numeric/number.h"

namespace anholon {

template <Number N>
class EndCheck {
 public:
  explicit EndCheck(double log_tolerance);
  // True if a look at the end of a step over h that has found this rate is enough, no points on the way being
  // suspicious.
  bool passes_at_once(const N& rate, const N& h) const { return passes(rate, h) && !(rate > N(kMostChange)); }
  // True if derivatives whose defect has this rate may have jumped: then series that reach so far do not lead to the
  // end of the step, however short the step is.
  bool may_jump(const N& rate, const N& reach) const { return !(passes(rate, reach) && rate <= N(kMostChange)); }
  // Begins a step of this length, with looks at these points on the way.
  void begin(const N& length, const std::vector<N>& on_the_way);
  // Returns where the next look has to be, from the start of the step; the last look is at the end.
  N where() const {
    return near_ >= 0 ? length_ * N(kNear[near_]) : index_ < on_the_way_.size() ? on_the_way_[index_] : length_;
  }
  // True if the next look decides about the step; false if it measures the round-off near the start.
  bool decides() const { return near_ < 0; }
  enum class Next { good, look, shorten };
  // Takes the result of the look at where(). `rate`: the defect there, relative to the size of the derivatives that it
  // changes.
  Next seen(const N& rate);
  // Refuses the length for another reason.
  Next refuse();
  // True if a look was passed although the solutions for the leading derivatives have lost the digits that lead the
  // motion.
  bool loses_digits() const { return loses_digits_; }
  // Forgets what was seen: the next step is a new one.
  void forget();

 private:
  // The largest rate of change of leading derivatives, relative to the size of the derivatives below, in a step with
  // good series.
  static constexpr double kMostChange = 0x1p-10;
  bool passes(const N& rate, const N& h) const { return rate * abs(h) <= allowed_; }
  // The parts of a step within which a defect is nothing but round-off.
  static constexpr double kNear[] = {0x1p-12, 0x1p-24};
  Next go_on();
  bool is_noise();
  void note_loss();

  N allowed_, length_{0}, rate_{0}, noise_{-1};
  std::vector<N> on_the_way_;
  std::size_t index_ = 0;
  int near_ = -1, shortened_ = 0;
  bool settled_ = false, loses_digits_ = false;
};

extern template class EndCheck<double>;
extern template class EndCheck<long double>;
extern template class EndCheck<Quad>;
extern template class EndCheck<Multi>;

}  // namespace anholon

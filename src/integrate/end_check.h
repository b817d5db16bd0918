// Whether a step may end where its series say. Series tell how far they reach by their highest coefficients, but
// nothing of a function that is all but constant where they were made: a tanh far from its ramp, a wall that begins
// further on. There the equations tell: the leading derivatives that the series foretell at the end of the step, and at
// points of suspicion on the way, are put into them, and what Newton's method changes of them there is the defect of
// the motion.
//
// A defect of x^(d) over a step h moves x^(d-1) by some h times as much; in relation to the size of that it is to stay
// near the tolerance. Where J is nearly singular, Newton's change is round-off, however short the step: that is looked
// at near the start of the step before one is refused.
#pragma once
#include <vector>

#include "numeric/number.h"

namespace anholon {

template <Number N>
class EndCheck {
 public:
  explicit EndCheck(double log_tolerance);
  // Whether the first look at the end of a step over h, which finds that rate, is enough: nothing is on the way.
  bool passes_at_once(const N& rate, const N& h) const { return passes(rate, h) && !(rate > N(kMostChange)); }
  // Whether derivatives that change at such a rate may have jumped: series that reach so far do not lead there, however
  // short the step is.
  bool may_jump(const N& rate, const N& reach) const { return !(passes(rate, reach) && rate <= N(kMostChange)); }
  // A try of another length, with looks at these points on the way.
  void begin(const N& length, const std::vector<N>& on_the_way);
  // Where the next look is to be; the last one is at the end.
  N where() const {
    return near_ >= 0 ? length_ * N(kNear[near_]) : index_ < on_the_way_.size() ? on_the_way_[index_] : length_;
  }
  // Whether it is one of the looks that decide, not one for round-off.
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

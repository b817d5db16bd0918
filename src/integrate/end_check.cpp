#include "integrate/end_check.h"

#include <cmath>

namespace anholon {

namespace {

// A step may end with a defect of kTolerances times the tolerance or of kRoundoffs round-offs (the shipped models: up
// to 10 tolerances, mostly 0.5). A defect of at most kAboveNoise times the defect near the start of the step is
// round-off.
constexpr double kTolerances = 100, kRoundoffs = 4096, kAboveNoise = 64;
// A step may change its leading derivatives by this part although the change is round-off; if the part is larger, the
// solutions have lost too many digits to tell where the motion goes.
constexpr double kMostLost = 0x1p-30;
// A step is shortened at most so often.
constexpr int kMostShortened = 60;

}  // namespace

template <Number N>
EndCheck<N>::EndCheck(double log_tolerance) : allowed_(N(exp(N(log_tolerance))) * N(kTolerances)) {
  if (const N roundoffs = unit_roundoff<N>() * N(kRoundoffs); allowed_ < roundoffs) allowed_ = roundoffs;
}

template <Number N>
void EndCheck<N>::begin(const N& length, const std::vector<N>& on_the_way) {
  length_ = length;
  on_the_way_ = on_the_way;
  index_ = 0;
  near_ = -1;
  settled_ = loses_digits_ = false;
}

template <Number N>
typename EndCheck<N>::Next EndCheck<N>::seen(const N& rate) {
  if (settled_) return Next::good;
  if (near_ < 0) {
    rate_ = rate;
    if (passes(rate, length_)) return go_on();
    if (noise_ < N(0)) {
      near_ = 0;
      return Next::look;
    }
  } else {
    if (is_finite(rate) && (noise_ < N(0) || rate < noise_)) noise_ = rate;
    if (++near_ < static_cast<int>(std::size(kNear))) return Next::look;
    near_ = -1;
    if (noise_ < N(0)) noise_ = N(0);
    if (is_noise()) {
      // The last look has to be at the end of the step.
      if (index_ >= on_the_way_.size()) return settled_ = true, Next::look;
      return go_on();
    }
  }
  return is_noise() ? go_on() : refuse();
}

template <Number N>
bool EndCheck<N>::is_noise() {
  if (!is_finite(rate_) || !(rate_ <= noise_ * N(kAboveNoise))) return false;
  note_loss();
  return true;
}

template <Number N>
void EndCheck<N>::note_loss() {
  if (!(rate_ * abs(length_) <= N(kMostLost))) loses_digits_ = true;
}

template <Number N>
typename EndCheck<N>::Next EndCheck<N>::go_on() {
  if (index_++ < on_the_way_.size()) return Next::look;
  settled_ = true;
  return Next::good;
}

template <Number N>
typename EndCheck<N>::Next EndCheck<N>::refuse() {
  if (++shortened_ <= kMostShortened) return Next::shorten;
  note_loss();
  const bool there = index_ >= on_the_way_.size() && near_ < 0;
  index_ = on_the_way_.size();
  near_ = -1;
  settled_ = true;
  return there ? Next::good : Next::look;
}

template <Number N>
void EndCheck<N>::forget() {
  noise_ = N(-1);
  shortened_ = 0;
}

template class EndCheck<double>;
template class EndCheck<long double>;
template class EndCheck<Quad>;
template class EndCheck<Multi>;

}  // namespace anholon

#include "contact/law/accumulation.h"

#include <cmath>
#include <limits>

namespace anholon {

void Accumulation::impact(std::size_t contact, double t) {
  constexpr double kRatio = 1e-3, kNoise = 0.1, kDigits = 1e-5, kTime = 16 * std::numeric_limits<double>::epsilon();
  Impacts& i = impacts_[contact];
  const double interval = i.count > 0 ? t - i.last : 0, ratio = i.count > 1 ? interval / i.interval : 0;
  // Near the limit an interval has few digits, so the earlier ratio is kept. It may change where gravity changes.
  const bool known = i.alike >= kAlike, alike = std::abs(ratio - i.ratio) < (known ? kNoise : kRatio);
  i.alike = i.count > 2 && ratio < 1 && alike ? i.alike + 1 : 0;
  i.ratio = known && alike && !(kTime * std::abs(t) < kDigits * interval) ? i.ratio : ratio;
  if (i.count == 0) i.first = t;
  i.last = t, i.interval = interval, ++i.count;
}

std::optional<double> Accumulation::limit(std::size_t contact) const {
  const Impacts& i = impacts_[contact];
  if (i.alike < kAlike || !(i.ratio > 0 && i.ratio < 1)) return std::nullopt;
  return i.last + i.interval * i.ratio / (1 - i.ratio);
}

bool Accumulation::near_limit(std::size_t contact, double t) const {
  constexpr double kPart = 1e-7;  // of the time from the first impact to the limit
  const std::optional<double> end = limit(contact);
  return end && *end - t < kPart * (*end - impacts_[contact].first);
}

}  // namespace anholon

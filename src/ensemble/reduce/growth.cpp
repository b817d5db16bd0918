#include "ensemble/reduce/growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace anholon {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Approaches the place of the greatest value of sign * f.
class Climb {
 public:
  Climb(const std::function<double(double)>& f, double sign, double h, double x)
      : f_(f), sign_(sign), h_(h), place_(x), most_(-kInfinity) {
    see(x);
  }

  void go(double reach) {
    constexpr int kPoints = 4, kShortest = 52;
    const double shortest = std::ldexp(std::abs(h_), -kShortest);
    for (double s = reach; s > shortest; s /= 2) {
      const double centre = place_;
      for (int j = -kPoints; j <= kPoints; ++j)
        if (j != 0) see(centre + s * j / kPoints);
    }
  }

  double place() const { return place_; }
  double greatest() const { return most_; }

 private:
  bool is_within(double x) const { return h_ < 0 ? x <= 0 && x >= h_ : x >= 0 && x <= h_; }
  void see(double x) {
    if (!is_within(x)) return;
    if (const double v = sign_ * f_(x); v > most_) place_ = x, most_ = v;
  }

  const std::function<double(double)>& f_;
  double sign_, h_;
  double place_, most_;
};

// The values on one side of a place.
class Side {
 public:
  // The distances are |h| 2^-k for k = kFirst, kFirst + kApart, and so on. The round-off of the time is small against
  // them, and they are shorter than the width of a peak that is to be told from a pole. If an end of [0, h] is nearer
  // than the longest one, they are halves of each other.
  Side(const std::function<double(double)>& f, double place, double length, double h) {
    constexpr int kFirst = 30, kApart = 3;
    const double longest = std::ldexp(std::abs(h), -kFirst);
    octaves_ = std::abs(length) < longest ? 1 : kApart;
    distance_ = std::copysign(std::min(std::abs(length), longest), length);
    for (std::size_t k = 0; k < values_.size(); ++k) {
      if (k > 0) distance_ = std::ldexp(distance_, -octaves_);
      values_[k] = f(place + distance_);
    }
    distance_ = std::abs(distance_);
  }

  // True if the values of sign * f rise by increments that do not fall.
  bool rises(double sign, double noise) const {
    // Increments whose ratios are above kFalls count as constant: those of s^q with q < 0.025 do so. Increments below
    // kSmall of the values are round-off.
    constexpr double kFalls = 0.95, kSmall = 1e-9;
    double before = 0, size = 0;
    for (std::size_t k = 0; k < values_.size(); ++k) {
      size = std::max(size, std::abs(values_[k]));
      if (k == 0) continue;
      const double rise = sign * (values_[k] - values_[k - 1]);
      if (!(rise > 0) || !(rise >= kFalls * before)) return false;
      before = rise;
    }
    return before > std::max(kSmall * size, noise);
  }

  // The order of the singularity at which the values rise or fall, 0 for a logarithm.
  double order() const { return std::log2(last_change() / (values_[kCount - 2] - values_[kCount - 3])) / octaves_; }
  // The integral that is left, if the order is less than 1.
  double rest() const { return std::abs(last_change()) * distance_ / (1 - order()); }

 private:
  static constexpr std::size_t kCount = 5;
  double last_change() const { return values_[kCount - 1] - values_[kCount - 2]; }

  std::array<double, kCount> values_{};
  double distance_ = 0;  // the shortest one
  int octaves_ = 1;
};

// Returns the greatest value between two points, of a function that rises and then falls, by golden sections; `middle`
// is a point with a value above those at the ends.
double peak_between(const std::function<double(double)>& f, double from, double to, double middle) {
  constexpr double kSection = 0.3819660112501051;  // (3 - sqrt(5)) / 2
  const double shortest = std::numeric_limits<double>::epsilon() * std::abs(to);
  double best = f(middle);
  while (std::abs(to - from) > shortest) {
    const bool left = std::abs(middle - from) > std::abs(to - middle);
    const double x = middle + kSection * ((left ? from : to) - middle), v = f(x);
    if (x == middle) break;
    if (v > best) {
      (left ? to : from) = middle;
      middle = x, best = v;
    } else {
      (left ? from : to) = x;
    }
  }
  return best;
}

}  // namespace

Growth growth_at(const std::function<double(double)>& f, double sign, double h, double x, double reach, double noise) {
  constexpr double kDivergent = 0.95;  // the integral of order 1 diverges, and just below it converges too slowly
  Climb climb(f, sign, h, x);
  climb.go(reach);
  Growth growth;
  growth.extreme = sign * climb.greatest();
  // An infinite value is one beyond the greatest double.
  growth.no_upper = growth.extreme == kInfinity, growth.no_lower = growth.extreme == -kInfinity;
  for (const double length : {-climb.place(), h - climb.place()}) {
    if (length == 0) continue;
    const Side side(f, climb.place(), length, h);
    const bool up = side.rises(1, noise), down = side.rises(-1, noise);
    growth.no_upper = growth.no_upper || up, growth.no_lower = growth.no_lower || down;
    if (!up && !down) continue;
    growth.integrable = growth.integrable && side.order() < kDivergent;
    growth.rest = std::max(growth.rest, side.rest());
  }
  return growth;
}

double greatest_near(const std::function<double(double)>& f, double h, double x) {
  const double value = f(x);
  if (x != h || !std::isfinite(value)) return value;
  // One of these distances is less than twice that of the kink, where values are greater than at the end.
  constexpr int kLongest = 24, kShortest = 48, kNext = 4;
  for (int k = kLongest; k <= kShortest; k += kNext) {
    const double s = std::ldexp(h, -k);
    if (!(f(h - s) > value)) continue;
    return std::max(value, peak_between(f, h - std::ldexp(s, kNext), h, h - s));
  }
  return value;
}

}  // namespace anholon

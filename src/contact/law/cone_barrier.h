// Minimizes a linear function within second-order cones, by Newton's method with a barrier that becomes steeper.
#pragma once
#include <array>
#include <limits>
#include <vector>

#include "contact/law/positive_equations.h"

namespace anholon {

// The cone |q + q_z z| <= p + p_z z.
struct AffineCone {
  long double p = 0;
  ContactNumbers p_z;
  std::array<long double, 2> q{};
  std::array<ContactNumbers, 2> q_z;

  long double height(const ContactNumbers& z) const { return p + dot(p_z, z); }
  std::array<long double, 2> radius(const ContactNumbers& z) const {
    return {q[0] + dot(q_z[0], z), q[1] + dot(q_z[1], z)};
  }
};

// -log of the product of all p^2 - |q|^2, plus a linear function times a number.
class ConeBarrier {
 public:
  ConeBarrier(const std::vector<AffineCone>& cones, const ContactNumbers& slope, ContactNumbers& z)
      : cones_(cones), slope_(slope), z_(z) {}

  // Makes one step of Newton's method with halving; returns false at the end of the iteration.
  bool step(long double steep) {
    constexpr long double kEnough = 1e-10L;
    constexpr int kHalves = 60;
    const std::size_t n = z_.size();
    std::vector<ContactNumbers> H(n, ContactNumbers(n, 0));
    ContactNumbers g(n, 0);
    for (std::size_t i = 0; i < n; ++i) g[i] = steep * slope_[i];
    for (const AffineCone& c : cones_) {
      const long double p = c.height(z_);
      const auto [q0, q1] = c.radius(z_);
      const long double q = std::hypot(q0, q1), h = (p - q) * (p + q);
      ContactNumbers rate(n);
      for (std::size_t i = 0; i < n; ++i) rate[i] = 2 * (p * c.p_z[i] - q0 * c.q_z[0][i] - q1 * c.q_z[1][i]) / h;
      for (std::size_t i = 0; i < n; ++i) {
        g[i] -= rate[i];
        for (std::size_t j = 0; j < n; ++j)
          H[i][j] +=
              rate[i] * rate[j] - 2 * (c.p_z[i] * c.p_z[j] - c.q_z[0][i] * c.q_z[0][j] - c.q_z[1][i] * c.q_z[1][j]) / h;
      }
    }
    const ContactNumbers d = solve_positive(H, g);
    if (!(dot(g, d) > kEnough)) return false;
    const long double before = value(z_, steep);
    long double part = 1;
    for (int k = 0; k < kHalves; ++k, part /= 2) {
      ContactNumbers next = z_;
      for (std::size_t i = 0; i < n; ++i) next[i] -= part * d[i];
      if (value(next, steep) < before) {
        z_ = std::move(next);
        return true;
      }
    }
    return false;
  }

 private:
  // -log of the product of all p^2 - |q|^2, plus the linear function times `steep`; infinite outside of a cone.
  long double value(const ContactNumbers& z, long double steep) const {
    long double sum = steep * dot(slope_, z);
    for (const AffineCone& c : cones_) {
      const long double p = c.height(z);
      const auto [q0, q1] = c.radius(z);
      const long double q = std::hypot(q0, q1);
      if (!(p > q)) return std::numeric_limits<long double>::infinity();
      sum -= std::log(p - q) + std::log(p + q);
    }
    return sum;
  }

  const std::vector<AffineCone>& cones_;
  const ContactNumbers& slope_;
  ContactNumbers& z_;
};

// Moves z, which is inside of all cones, to where slope z is least within the cones. The distance from the least value
// is of the order of the number of cones divided by `steepest`.
inline void minimize_within(const std::vector<AffineCone>& cones, const ContactNumbers& slope, long double steepest,
                            ContactNumbers& z) {
  constexpr long double kSteeper = 10;
  constexpr int kMost = 30;
  ConeBarrier barrier(cones, slope, z);
  for (long double steep = 1; steep <= steepest; steep *= kSteeper)
    for (int k = 0; k < kMost && barrier.step(steep); ++k) continue;
}

}  // namespace anholon

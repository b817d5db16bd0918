#include "numeric/random/sobol.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "base/assert.h"

namespace anholon {

namespace {

constexpr std::size_t kBits = 52;

// A primitive polynomial x^degree + a_1 x^(degree-1) + ... + 1, whose inner coefficients are the bits of `inner`, and
// the first direction numbers m_1, m_2, ... of the dimension.
struct Direction {
  std::uint32_t degree, inner;
  std::array<std::uint32_t, 7> m;
};
constexpr Direction kDirections[] = {
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
};
static_assert(std::size(kDirections) + 1 == kSobolDimensions);

using Directions = std::array<std::array<std::uint64_t, kBits>, kSobolDimensions>;

// Returns v_k = m_k 2^-k as numbers of kBits bits; the first dimension is the sequence of van der Corput, m_k = 1.
Directions directions() {
  Directions v{};
  for (std::size_t k = 0; k < kBits; ++k) v[0][k] = std::uint64_t{1} << (kBits - 1 - k);
  for (std::size_t j = 1; j < kSobolDimensions; ++j) {
    const Direction& d = kDirections[j - 1];
    for (std::size_t k = 0; k < kBits; ++k) {
      if (k < d.degree) {
        v[j][k] = std::uint64_t{d.m[k]} << (kBits - 1 - k);
        continue;
      }
      v[j][k] = v[j][k - d.degree] ^ (v[j][k - d.degree] >> d.degree);
      for (std::size_t i = 1; i < d.degree; ++i)
        if ((d.inner >> (d.degree - 1 - i)) & 1) v[j][k] ^= v[j][k - i];
    }
  }
  return v;
}

double rational(const double* over, const double* under, double x) {
  double a = 0, b = 0;
  for (int k = 7; k >= 0; --k) a = a * x + over[k], b = b * x + under[k];
  return a / b;
}

}  // namespace

double sobol(std::uint64_t number, std::uint32_t dimension, std::uint64_t shift) {
  static const Directions v = directions();
  ANHOLON_ASSERT(dimension < kSobolDimensions);
  std::uint64_t bits = shift >> (64 - kBits);
  for (std::size_t k = 0; k < kBits && number >> k != 0; ++k)
    if ((number >> k) & 1) bits ^= v[dimension][k];
  return (static_cast<double>(bits) + 0.5) * 0x1p-52;
}

// Algorithm AS 241, PPND16: M. J. Wichura, The percentage points of the normal distribution, Appl. Statist. 37 (1988).
double normal_quantile(double p) {
  static constexpr double kA[] = {3.3871328727963666080e0,  1.3314166789178437745e+2, 1.9715909503065514427e+3,
                                  1.3731693765509461125e+4, 4.5921953931549871457e+4, 6.7265770927008700853e+4,
                                  3.3430575583588128105e+4, 2.5090809287301226727e+3};
  static constexpr double kB[] = {1.0,
                                  4.2313330701600911252e+1,
                                  6.8718700749205790830e+2,
                                  5.3941960214247511077e+3,
                                  2.1213794301586595867e+4,
                                  3.9307895800092710610e+4,
                                  2.8729085735721942674e+4,
                                  5.2264952788528545610e+3};
  static constexpr double kC[] = {1.42343711074968357734e0,  4.63033784615654529590e0, 5.76949722146069140550e0,
                                  3.64784832476320460504e0,  1.27045825245236838258e0, 2.41780725177450611770e-1,
                                  2.27238449892691845833e-2, 7.74545014278341407640e-4};
  static constexpr double kD[] = {1.0,
                                  2.05319162663775882187e0,
                                  1.67638483018380384940e0,
                                  6.89767334985100004550e-1,
                                  1.48103976427480074590e-1,
                                  1.51986665636164571966e-2,
                                  5.47593808499534494600e-4,
                                  1.05075007164441684324e-9};
  static constexpr double kE[] = {6.65790464350110377720e0,  5.46378491116411436990e0,  1.78482653991729133580e0,
                                  2.96560571828504891230e-1, 2.65321895265761230930e-2, 1.24266094738807843860e-3,
                                  2.71155556874348757815e-5, 2.01033439929228813265e-7};
  static constexpr double kF[] = {1.0,
                                  5.99832206555887937690e-1,
                                  1.36929880922735805310e-1,
                                  1.48753612908506148525e-2,
                                  7.86869131145613259100e-4,
                                  1.84631831751005468180e-5,
                                  1.42151175831644588870e-7,
                                  2.04426310338993978564e-15};
  constexpr double kMiddle = 0.425, kTail = 5;
  const double q = p - 0.5;
  if (std::abs(q) <= kMiddle) return q * rational(kA, kB, kMiddle * kMiddle - q * q);
  const double r = std::sqrt(-std::log(std::min(p, 1 - p)));
  const double x = r <= kTail ? rational(kC, kD, r - 1.6) : rational(kE, kF, r - kTail);
  return q < 0 ? -x : x;
}

}  // namespace anholon

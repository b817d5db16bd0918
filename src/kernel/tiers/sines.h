// Sine and cosine over a lane type, of an angle and the part of the angle beyond its double. Included by one file per
// instruction set, like lanes.h.
//
// With n the nearest integer to 2x/pi, the rest r = x - n pi/2 is known to twice the digits of a double (pi/2 as two
// doubles, the product n P_1 with its rounding error); sine and cosine of it are polynomials (minimax for r^2 up to
// (pi/4)^2, errors of 1e-18 at most), to which the lower half of r adds a term of first order. Measured
// (test/backends/sines_test.cpp): errors of at most 0.7 units of the last place. For angles from 2^27 on the C library
// is used.
#pragma once
#include "kernel/arithmetic.h"
#include "kernel/tiers/lanes.h"

namespace anholon {
namespace {

template <int L>
struct Sines {
  using T = Lanes<L>;
  using V = typename T::V;

  static void of(V x, V beyond, V& sine, V& cosine) {
#ifdef __FMA__
    near(x, beyond, sine, cosine);
    const auto far = !(absolute(x) < T::broadcast(kFar));
    if (!T::any(far)) return;
#endif
    for (int lane = 0; lane < L; ++lane) {
      const double angle = T::get(x, lane), more = T::get(beyond, lane);
#ifdef __FMA__
      if (std::abs(angle) < kFar) continue;
#endif
      double s, c;
      sine_and_cosine(angle, s, c);
      T::set(sine, lane, Lanes<1>::fma(more, c, s));
      T::set(cosine, lane, Lanes<1>::fma(-more, s, c));
    }
  }

  // For machine code: each argument is a vector of lanes; `beyond` may be null.
  static void at(const double* x, const double* beyond, double* sine, double* cosine) {
    V s, c;
    of(*reinterpret_cast<const V*>(x), beyond ? *reinterpret_cast<const V*>(beyond) : T::broadcast(0), s, c);
    *reinterpret_cast<V*>(sine) = s;
    *reinterpret_cast<V*>(cosine) = c;
  }

 private:
  static constexpr double kFar = 0x1p27;

  static V absolute(V v) { return T::of(T::bits(v) & 0x7fffffffffffffffULL); }

  template <int N>
  static V polynomial(const double (&c)[N], V z) {
    V s = T::broadcast(c[N - 1]);
    for (int i = N - 2; i >= 0; --i) s = T::fma(s, z, T::broadcast(c[i]));
    return s;
  }

  static void near(V x, V beyond, V& sine, V& cosine) {
    constexpr double kTwoByPi = 0x1.45f306dc9c883p-1, kHalfPi = 0x1.921fb54442d18p+0,
                     kHalfPiBeyond = 0x1.1a62633145c07p-54;
    constexpr double kSine[] = {-0.16666666666666666,  0.008333333333333331,    -0.00019841269841265044,
                                2.755731921932218e-06, -2.5052106226493684e-08, 1.6058530668495764e-10,
                                -7.586640760203067e-13};
    constexpr double kCosine[] = {0.041666666666666664,    -0.001388888888888739, 2.480158729875576e-05,
                                  -2.7557317266493425e-07, 2.087614516326637e-09, -1.1382552018362967e-11};
    const V shifted = T::fma(x, T::broadcast(kTwoByPi), T::broadcast(kInteger)), n = shifted - T::broadcast(kInteger);
    const V product = n * T::broadcast(kHalfPi), rounded_away = T::fma(n, T::broadcast(kHalfPi), -product);
    const V first = x - product, second = T::fma(n, T::broadcast(kHalfPiBeyond), rounded_away);
    const V r = first - second, low = ((first - r) - second) + beyond;
    const V z = r * r, half = T::broadcast(0.5) * z, one = T::broadcast(1), left = one - half;
    // Computed without `low`, which may be as large as half a unit of the last place of a large angle.
    const V of_s = r * z, s_so_far = polynomial(kSine, z), lost = T::fma(r, r, -z);
    const V c_so_far = T::fma(z * z, polynomial(kCosine, z), T::fma(T::broadcast(-0.5), lost, (one - left) - half));
    const V s = r + T::fma(of_s, s_so_far, low * (left + c_so_far)),
            c = left + T::fma(-low, T::fma(of_s, s_so_far, r), c_so_far);
    const auto quarter = T::bits(shifted);
    const auto odd = (quarter & 1) != 0;
    sine = with_sign(odd ? c : s, quarter << 62);
    cosine = with_sign(odd ? s : c, (quarter + 1) << 62);
  }

  // Negates v if the highest bit is set.
  static V with_sign(V v, typename T::B bits) { return T::of(T::bits(v) ^ (bits & 0x8000000000000000ULL)); }
};

}  // namespace
}  // namespace anholon

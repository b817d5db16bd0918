// The steps of kernel/pairs.h over a lane type. Included by one file per instruction set, like lanes.h.
//
// With a + b = s + e exactly (Knuth), a b = p + e exactly (by a fused product): pairs as in T. J. Dekker (1971).
//
// Sine and cosine: with n the nearest integer to 2x/pi, the rest r = x - n pi/2 is a pair, pi/2 being three doubles;
// the Taylor polynomials of r have their first terms in pairs and those that are small enough in doubles. Angles from
// 2^27 on are left to long double.
#pragma once
#include <cmath>

#include "kernel/arithmetic.h"
#include "kernel/pairs.h"
#include "kernel/tiers/lanes.h"

namespace anholon {
namespace {

template <int L>
class PairRun {
 public:
  static void run(const PairProgram& program, double* numbers, const std::function<void(std::uint32_t)>& other) {
    V* const w = reinterpret_cast<V*>(numbers);
    const auto get = [&](std::uint32_t place) { return Pair{w[2 * place], w[2 * place + 1]}; };
    const auto put = [&](std::uint32_t place, const Pair& p) { w[2 * place] = p.high, w[2 * place + 1] = p.low; };
    using Act = PairProgram::Act;
    for (const PairProgram::Step& s : program.steps) switch (s.act) {
      case Act::linear: {
        Pair sum{T::broadcast(0), T::broadcast(0)};
        for (std::uint32_t k = s.first; k < s.first + s.count; ++k) {
          const PairProgram::Term& t = program.terms[k];
          sum = add(sum, multiply({T::broadcast(t.high), T::broadcast(t.low)}, get(t.place)));
        }
        put(s.out, sum);
        break;
      }
      case Act::multiply:
        put(s.out, multiply(get(s.a), get(s.b)));
        break;
      case Act::divide:
        put(s.out, divide(get(s.a), get(s.b)));
        break;
      case Act::sine_cosine: {
        Pair sine, cosine;
        sine_cosine(get(s.a), sine, cosine);
        put(s.out, sine), put(s.b, cosine);
        break;
      }
      case Act::copy:
        put(s.out, get(s.a));
        break;
      case Act::other:
        other(s.out);
        break;
      }
  }

 private:
  using T = Lanes<L>;
  using V = typename T::V;
  struct Pair {
    V high, low;
  };

  // The product is fused on every machine: without an instruction the C library computes it.
  static V fused(V a, V b, V c) {
    if constexpr (L == 1)
      return __builtin_fma(a, b, c);
    else
      return T::fma(a, b, c);
  }

  static Pair sum_of(V a, V b) {
    const V s = a + b, part = s - a;
    return {s, (a - (s - part)) + (b - part)};
  }
  static Pair sum_of_ordered(V a, V b) {  // |a| >= |b|
    const V s = a + b;
    return {s, b - (s - a)};
  }
  static Pair product_of(V a, V b) {
    const V p = a * b;
    return {p, fused(a, b, -p)};
  }
  static Pair add(const Pair& a, const Pair& b) {
    const Pair high = sum_of(a.high, b.high), low = sum_of(a.low, b.low);
    const Pair first = sum_of_ordered(high.high, high.low + low.high);
    return sum_of_ordered(first.high, first.low + low.low);
  }
  static Pair multiply(const Pair& a, const Pair& b) {
    const Pair p = product_of(a.high, b.high);
    return sum_of_ordered(p.high, p.low + fused(a.high, b.low, a.low * b.high));
  }
  static Pair scaled(const Pair& a, V by) {
    const Pair p = product_of(a.high, by);
    return sum_of_ordered(p.high, fused(a.low, by, p.low));
  }
  static Pair negative(const Pair& a) { return {-a.high, -a.low}; }
  static Pair divide(const Pair& a, const Pair& b) {
    const V first = a.high / b.high;
    const Pair left = add(a, negative(scaled(b, first)));
    const V second = left.high / b.high;
    const Pair rest = add(left, negative(scaled(b, second)));
    const Pair so_far = sum_of_ordered(first, second);
    return add(so_far, {rest.high / b.high, T::broadcast(0)});
  }

  static V absolute(V v) { return T::of(T::bits(v) & 0x7fffffffffffffffULL); }
  static V with_sign(V v, typename T::B bits) { return T::of(T::bits(v) ^ (bits & 0x8000000000000000ULL)); }

  template <int N>
  static V polynomial(const double (&c)[N], V z) {
    V s = T::broadcast(c[N - 1]);
    for (int i = N - 2; i >= 0; --i) s = fused(s, z, T::broadcast(c[i]));
    return s;
  }
  // a + z (b + z tail)
  static Pair series(const double (&a)[2], const double (&b)[2], const Pair& z, V tail) {
    const Pair inner = sum_of_ordered(T::broadcast(b[0]), z.high * tail);
    const Pair second = sum_of_ordered(inner.high, inner.low + T::broadcast(b[1]));
    return add({T::broadcast(a[0]), T::broadcast(a[1])}, multiply(z, second));
  }

  static void sine_cosine(const Pair& x, Pair& sine, Pair& cosine) {
    constexpr double kFar = 0x1p27, kTwoByPi = 0x1.45f306dc9c883p-1;
    // pi/2
    constexpr double kFirst = 0x1.921fb54442d18p+0, kSecond = 0x1.1a62633145c07p-54, kThird = -0x1.f1976b7ed8fbcp-110;
    constexpr double kThree[] = {-0x1.5555555555555p-3, -0x1.5555555555555p-57},
                     kFive[] = {0x1.1111111111111p-7, 0x1.1111111111111p-63},
                     kFour[] = {0x1.5555555555555p-5, 0x1.5555555555555p-59},
                     kSix[] = {-0x1.6c16c16c16c17p-10, 0x1.f49f49f49f49fp-65};
    // -1/7!, 1/9!, … to 1/21!, and 1/8!, -1/10!, … to 1/20!
    constexpr double kSine[] = {-1.0 / 5040,
                                1.0 / 362'880,
                                -1.0 / 39'916'800,
                                1.0 / 6'227'020'800,
                                -1.0 / 1'307'674'368'000,
                                1.0 / 355'687'428'096'000,
                                -1.0 / 121'645'100'408'832'000,
                                1.0 / 51'090'942'171'709'440'000.0};
    constexpr double kCosine[] = {1.0 / 40'320,
                                  -1.0 / 3'628'800,
                                  1.0 / 479'001'600,
                                  -1.0 / 87'178'291'200,
                                  1.0 / 20'922'789'888'000,
                                  -1.0 / 6'402'373'705'728'000,
                                  1.0 / 2'432'902'008'176'640'000};
    const V shifted = fused(x.high, T::broadcast(kTwoByPi), T::broadcast(kInteger)),
            n = shifted - T::broadcast(kInteger);
    const Pair by_first = product_of(n, T::broadcast(kFirst)), by_second = product_of(n, T::broadcast(kSecond));
    const Pair one = sum_of(x.high - by_first.high, -by_first.low), two = sum_of(one.high, -by_second.high),
               three = sum_of(two.high, x.low);
    const V low = fused(-n, T::broadcast(kThird), ((one.low + two.low) + three.low) - by_second.low);
    const Pair r = sum_of(three.high, low), z = multiply(r, r);
    const Pair s = add(r, multiply(multiply(r, z), series(kThree, kFive, z, polynomial(kSine, z.high))));
    const V half = T::broadcast(-0.5);
    const Pair less = sum_of_ordered(T::broadcast(1), half * z.high);
    const Pair c = add(sum_of_ordered(less.high, fused(half, z.low, less.low)),
                       multiply(multiply(z, z), series(kFour, kSix, z, polynomial(kCosine, z.high))));
    const auto quarter = T::bits(shifted);
    const auto odd = (quarter & 1) != 0;
    const auto sign = quarter << 62, next = (quarter + 1) << 62;
    sine = {with_sign(odd ? c.high : s.high, sign), with_sign(odd ? c.low : s.low, sign)};
    cosine = {with_sign(odd ? s.high : c.high, next), with_sign(odd ? s.low : c.low, next)};
    const auto far = !(absolute(x.high) < T::broadcast(kFar));
    if (!T::any(far)) return;
    for (int lane = 0; lane < L; ++lane) {
      if (std::abs(T::get(x.high, lane)) < kFar) continue;
      const long double angle = static_cast<long double>(T::get(x.high, lane)) + T::get(x.low, lane);
      const auto set = [&](Pair& p, long double value) {
        const double high = static_cast<double>(value);
        T::set(p.high, lane, high), T::set(p.low, lane, static_cast<double>(value - high));
      };
      set(sine, std::sin(angle)), set(cosine, std::cos(angle));
    }
  }
};

}  // namespace
}  // namespace anholon

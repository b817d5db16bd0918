// Vectors of doubles, as long as the instruction set allows: the number type of kernel arithmetic.
//
// Everything is in an unnamed namespace: each tier (tier_*.cpp) has its own copy, compiled for its machine.
#pragma once
#ifdef __AVX2__
#include <immintrin.h>
#endif

#include <bit>
#include <cstdint>

namespace anholon {
namespace {

// Lanes of doubles; one lane is a double. fma is fused if the machine supports it, in every tier but the plainest.
template <int L>
struct Lanes;

template <>
struct Lanes<1> {
  using V = double;
  using B = std::uint64_t;
  static B bits(V v) { return std::bit_cast<B>(v); }
  static V of(B b) { return std::bit_cast<V>(b); }
  static B exponent(B b) { return static_cast<B>(static_cast<std::int64_t>(b) >> 52); }
  static bool any(bool b) { return b; }
  static V broadcast(double x) { return x; }
  static double get(V v, int) { return v; }
  static void set(V& v, int, double x) { v = x; }
#ifdef __FMA__
  static V fma(V a, V b, V c) { return __builtin_fma(a, b, c); }
#else
  static V fma(V a, V b, V c) { return a * b + c; }
#endif
};

#ifdef __AVX2__
template <int L>
struct SeveralLanes {
  typedef double V __attribute__((vector_size(8 * L), may_alias));
  typedef std::uint64_t B __attribute__((vector_size(8 * L)));
  typedef std::int64_t Signed __attribute__((vector_size(8 * L)));
  static double get(V v, int lane) { return reinterpret_cast<const double*>(&v)[lane]; }
  static void set(V& v, int lane, double x) { reinterpret_cast<double*>(&v)[lane] = x; }
  static B bits(V v) { return (B)v; }
  static V of(B b) { return (V)b; }
  static B exponent(B b) { return (B)((Signed)b >> 52); }
};

template <>
struct Lanes<4> : SeveralLanes<4> {
  static V broadcast(double x) { return (V)_mm256_set1_pd(x); }
  static V fma(V a, V b, V c) { return (V)_mm256_fmadd_pd((__m256d)a, (__m256d)b, (__m256d)c); }
  static bool any(Signed mask) { return _mm256_movemask_pd((__m256d)mask) != 0; }
};
#endif
#ifdef __AVX512F__
template <>
struct Lanes<8> : SeveralLanes<8> {
  static V broadcast(double x) { return (V)_mm512_set1_pd(x); }
  static V fma(V a, V b, V c) { return (V)_mm512_fmadd_pd((__m512d)a, (__m512d)b, (__m512d)c); }
  static bool any(Signed mask) { return _mm512_test_epi64_mask((__m512i)mask, (__m512i)mask) != 0; }
};
#endif

// x / n, rounded once: the exact quotient up to a relative error of 2^-106. 1 / n is `reciprocal` + `beyond`.
template <class T>
typename T::V quotient(typename T::V x, double n, double reciprocal, double beyond) {
#ifdef __FMA__
  (void)n;
  return T::fma(x, T::broadcast(reciprocal), x * T::broadcast(beyond));
#else
  (void)reciprocal, (void)beyond;
  return x / T::broadcast(n);
#endif
}

}  // namespace
}  // namespace anholon

#include <gtest/gtest.h>

#include "numeric/enclosure.h"

namespace anholon::enclosure_test {
namespace {

SquareSystem polynomial(std::vector<int> c) {
  SquareSystem f{1, {}, {}};
  f.value = [c](const Box& x) {
    Ball v(0);
    for (std::size_t i = c.size(); i-- > 0;) v = v * x[0] + Ball(c[i]);
    return std::vector<Ball>{v};
  };
  f.jacobian = [c](const Box& x) {
    Ball v(0);
    for (std::size_t i = c.size(); i-- > 1;) v = v * x[0] + Ball(c[i] * static_cast<int>(i));
    return std::vector<Ball>{v};
  };
  return f;
}

// A circle and a line through its center: x = y = ±1.
SquareSystem circle() {
  SquareSystem f{2, {}, {}};
  f.value = [](const Box& x) { return std::vector<Ball>{x[0] * x[0] + x[1] * x[1] - Ball(2), x[0] - x[1]}; };
  f.jacobian = [](const Box& x) { return std::vector<Ball>{Ball(2) * x[0], Ball(2) * x[1], Ball(1), Ball(-1)}; };
  return f;
}

// x_i + x_{i+1}^2/10 = 11/10: the root (1, …, 1).
SquareSystem ring(std::size_t n) {
  SquareSystem f{n, {}, {}};
  f.value = [n](const Box& x) {
    std::vector<Ball> v;
    for (std::size_t i = 0; i < n; ++i)
      v.push_back(x[i] + x[(i + 1) % n] * x[(i + 1) % n] * Ball(Rational(1, 10)) - Ball(Rational(11, 10)));
    return v;
  };
  f.jacobian = [n](const Box& x) {
    std::vector<Ball> j(n * n, Ball(0));
    for (std::size_t i = 0; i < n; ++i) {
      j[i * n + i] += Ball(1);
      j[i * n + (i + 1) % n] += x[(i + 1) % n] * Ball(Rational(1, 5));
    }
    return j;
  };
  return f;
}

TEST(Enclosure, FindsTheRootOfTwoToTheLastBit) {
  for (slong bits : {64, 128, 512, 1024}) {
    const BallScope scope(bits);
    const auto root = enclose_root(polynomial({-2, 0, 1}), std::vector<long double>{1.5L});
    ASSERT_TRUE(root) << bits;
    EXPECT_TRUE(((*root)[0] - sqrt(Ball(2))).contains_zero());
    EXPECT_LT(*(*root)[0].radius(), Rational(1, mpz_class(1) << static_cast<unsigned long>(bits - 10)));
  }
}

TEST(Enclosure, KnownRootsOfSeveralSizes) {
  const auto corner = enclose_root(circle(), std::vector<long double>{0.9L, 1.1L});
  ASSERT_TRUE(corner);
  EXPECT_TRUE((*corner)[0].contains(1) && (*corner)[1].contains(1));
  for (std::size_t n = 1; n <= 8; ++n) {
    const auto root = enclose_root(ring(n), std::vector<long double>(n, 0.8L));
    ASSERT_TRUE(root) << n;
    for (const Ball& x : *root) EXPECT_TRUE(x.contains(1)) << n;
  }
}

TEST(Enclosure, ADoubleRootIsNeverProved) {
  EXPECT_FALSE(enclose_root(polynomial({1, -2, 1}), std::vector<long double>{1.0L}));
  EXPECT_FALSE(enclose_root(polynomial({1, -2, 1}), std::vector<long double>{1.01L}));
  EXPECT_FALSE(prove_root(polynomial({1, -2, 1}), {Ball(Rational(1), Rational(1, 10))}));
}

TEST(Enclosure, NoRootIsNeverProved) {
  for (long double start : {0.0L, 0.3L, -2.0L})
    EXPECT_FALSE(enclose_root(polynomial({1, 0, 1}), std::vector<long double>{start}));
}

TEST(Enclosure, AGivenBoxMustHoldTheRoot) {
  const SquareSystem f = polynomial({-2, 0, 1});
  EXPECT_TRUE(prove_root(f, {Ball(Rational(7, 5), Rational(1, 10))}));
  EXPECT_FALSE(prove_root(f, {Ball(Rational(6, 5), Rational(1, 10))})) << "beside the root";
  EXPECT_FALSE(prove_root(f, {Ball(Rational(0), Rational(2))})) << "two roots";
  EXPECT_FALSE(prove_root(f, {Ball(Rational(7, 5))})) << "a single number";
  EXPECT_FALSE(prove_root(circle(), {Ball(Rational(1), Rational(1, 10)), Ball(Rational(3, 2), Rational(1, 10))}));
}

TEST(Enclosure, WhatIsNotDefinedIsNotProved) {
  SquareSystem f{1, {}, {}};
  f.value = [](const Box& x) { return std::vector<Ball>{log(x[0])}; };
  f.jacobian = [](const Box& x) { return std::vector<Ball>{Ball(1) / x[0]}; };
  EXPECT_TRUE(enclose_root(f, std::vector<long double>{1.2L}));
  EXPECT_FALSE(enclose_root(f, std::vector<long double>{-1.0L}));
  EXPECT_FALSE(prove_root(f, {Ball(Rational(1), Rational(2))}));
}

// The mutant: the Jacobian of another system must not prove a root that does not exist.
TEST(Enclosure, ARootNeedsItsOwnEquation) {
  SquareSystem f = polynomial({1, -2, 1});
  f.value = [](const Box& x) { return std::vector<Ball>{x[0] * x[0] + Ball(1)}; };
  f.jacobian = [](const Box& x) { return std::vector<Ball>{Ball(2) * x[0]}; };
  EXPECT_FALSE(prove_root(f, {Ball(Rational(1), Rational(1, 2))}));
}

}  // namespace
}  // namespace anholon::enclosure_test

// The remainder by the relations that may divide equals the remainder by all relations.
#include <gtest/gtest.h>

#include "expr/polynomial.h"

namespace anholon::polynomial_test {
namespace {

class Remainder : public testing::Test {
 protected:
  Poly g(long k) const { return Poly::generator(ring, k); }
  Poly n(long k) const { return Poly::constant(ring, k); }
  void SetUp() override {
    relations.add(s * s + c * c - n(1));
    relations.add_first(r * r - s * s - x);
    relations.add(u * y - n(1));
  }
  Ring ring{6};
  const Poly u = g(0), r = g(1), s = g(2), c = g(3), x = g(4), y = g(5);
  Relations relations{ring};
};

TEST_F(Remainder, WhatNoRelationDividesStays) {
  const Poly p = u * r * s * c * x + n(3);
  EXPECT_TRUE(relations.remainder(p).same(p));
  EXPECT_TRUE(relations.remainder(n(0)).zero());
  EXPECT_TRUE(Relations(ring).remainder(s * s).same(s * s));
}

// s^2 occurs only after r^2 is divided: the remainder by one relation lets another one divide.
TEST_F(Remainder, TailsOpenRelations) {
  const Poly one_minus_c2 = n(1) - c * c;
  EXPECT_TRUE(relations.remainder(r * r).same(one_minus_c2 + x));
  EXPECT_TRUE(relations.remainder(r * r * s).same(one_minus_c2 * s + x * s));
  EXPECT_FALSE(relations.remainder(r * r).same(s * s + x)) << "mutant: the second relation left out";
}

TEST_F(Remainder, ALeadingProductDividesOnlyItsMultiples) {
  EXPECT_TRUE(relations.remainder(u * x).same(u * x));
  EXPECT_TRUE(relations.remainder(u * x * y).same(x));
}

TEST_F(Remainder, IsPaidFor) {
  const Ring poor(6, 50);
  Relations few(poor);
  const auto generator = [&](long k) { return Poly::generator(poor, k); };
  few.add(generator(2) * generator(2) - generator(3) - generator(4) - generator(5));
  Poly p = Poly::constant(poor, 1);
  for (int k = 0; k < 20; ++k) p = p * generator(2);
  EXPECT_THROW(few.remainder(p), TooLarge);
}

}  // namespace
}  // namespace anholon::polynomial_test

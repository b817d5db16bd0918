// The digits that a hint suggests.
#include <gtest/gtest.h>

#include "numeric/more_digits.h"

namespace anholon {
namespace {

TEST(MoreDigits, AreThirtyBeyondTheNumbersOfTheMachine) {
  EXPECT_EQ(more_digits<double>(), 30);
  EXPECT_EQ(more_digits<long double>(), 30);
}

TEST(MoreDigits, AreTwiceThoseThatARunHas) {
  EXPECT_EQ(more_digits<Quad>(), 70);
  for (const int digits : {40, 60, 100}) {
    const PrecisionScope precision{digits};
    EXPECT_GE(more_digits<Multi>(), 2 * digits);
    EXPECT_LE(more_digits<Multi>(), 3 * digits);
    EXPECT_EQ(more_digits<Multi>() % 10, 0);
  }
}

}  // namespace
}  // namespace anholon

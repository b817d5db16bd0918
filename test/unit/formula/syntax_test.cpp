#include <gtest/gtest.h>

#include "formula/formula.h"

namespace anholon::syntax_test {
namespace {

std::string again(const std::string& text) { return print(parse_formula(FormulaText(text, Span{1, 1, 1}))); }

TEST(SyntaxPrint, KeepsWhatIsWritten) {
  for (const char* text : {"a + b - c", "a - (b - c)", "a*b/c", "a/(b*c)", "(a + b)*c", "-a^2", "(-a)^2", "a^(-1/2)",
                           "x''", "(x*y)'", "sin(2*x)", "atan2(y, x)", "[x, 0, 1]", "P.x'", "-(a + b)", "a*(-b)",
                           "(a^b)^c", "dot(a, b)*c", "2*r^2*psi'*lambda"})
    EXPECT_EQ(again(text), text);
}

TEST(SyntaxPrint, OneWayToWriteIt) {
  EXPECT_EQ(again("a*( b )"), "a*b");
  EXPECT_EQ(again("r²"), "r^2");
  EXPECT_EQ(again("θ′"), "theta'");
  EXPECT_EQ(again("a ** 2"), "a^2");
}

TEST(SyntaxPrint, MeansTheSame) {
  for (const char* text : {"-m'*u*cos(a + t)", "a^b^c", "-a^-b", "a - -b", "a/b/c", "a/(b/c)", "2*-x", "-(-x)"})
    EXPECT_EQ(again(again(text)), again(text)) << again(text);
}

}  // namespace
}  // namespace anholon::syntax_test

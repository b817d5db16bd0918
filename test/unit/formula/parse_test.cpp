#include <gtest/gtest.h>

#include "support/plain_names.h"
#include "support/value.h"

namespace anholon::parse_test {
namespace {

using test::PlainNames;

TEST(Precedence, PowersBindToTheRightAndBeforeALeadingMinus) {
  PlainNames n;
  const Expr x = n.number("x");
  EXPECT_EQ(n.number("-x^2"), -(x * x));
  EXPECT_EQ(n.number("(-x)^2"), x * x);
  EXPECT_EQ(n.number("2^-1"), n.g.number(Rational(1, 2)));
  EXPECT_EQ(n.number("2^3^2"), n.g.number(512));
  EXPECT_EQ(n.number("2**3"), n.g.number(8));
  EXPECT_EQ(n.number("-2^2"), n.g.number(-4));
  EXPECT_EQ(n.number("x^-2"), pow(x, -2));
  EXPECT_EQ(n.number("2*-x"), -2 * x);
}

TEST(Precedence, QuotientsAndDifferencesBindToTheLeft) {
  PlainNames n;
  EXPECT_EQ(n.number("a/b/x"), n.number("a/(b*x)"));
  EXPECT_EQ(n.number("a-b-x"), n.number("a-(b+x)"));
  EXPECT_EQ(n.number("a/b*x"), n.number("a*x/b"));
  EXPECT_EQ(n.number("a-b+x"), n.number("x+a-b"));
  EXPECT_EQ(n.number("a - (b - x)"), n.number("a - b + x"));
  EXPECT_EQ(n.number("a/(b/x)"), n.number("a*x/b"));
  EXPECT_EQ(n.number("a+b*x^2"), n.number("a+(b*(x^2))"));
}

TEST(Numbers, AreExactDecimals) {
  PlainNames n;
  EXPECT_EQ(n.number("0.1 + 0.2"), n.g.number(Rational(3, 10)));
  EXPECT_EQ(n.number("1e-3"), n.g.number(Rational(1, 1000)));
  EXPECT_EQ(n.number(".5"), n.g.number(Rational(1, 2)));
  EXPECT_EQ(n.number("9.81"), n.g.number(Rational(981, 100)));
}

TEST(Unicode, ReadsGreekSuperscriptsAndSigns) {
  PlainNames n;
  EXPECT_EQ(n.number("π"), n.g.pi());
  EXPECT_EQ(n.number("x²"), n.number("x^2"));
  EXPECT_EQ(n.number("x³ − y"), n.number("x^3 - y"));
  EXPECT_EQ(n.number("a·x"), n.number("a*x"));
  EXPECT_EQ(n.number("u·v"), n.number("dot(u, v)"));
  EXPECT_EQ(std::get<Vector>(n.value("u × v")).z, std::get<Vector>(n.value("cross(u, v)")).z);
  EXPECT_EQ(n.number("x′"), n.number("x'"));
  EXPECT_EQ(normal_name("φ̇"), "phi\u0307");
  EXPECT_EQ(normal_name("θ1"), "theta1");
}

TEST(Derivatives, PrimesAndD) {
  PlainNames n;
  EXPECT_EQ(n.number("x'"), n.g.jet(0, 1));
  EXPECT_EQ(n.number("x'''"), n.g.jet(0, 3));
  EXPECT_EQ(n.number("D(x, 4)"), n.g.jet(0, 4));
  EXPECT_EQ(n.number("(x*y)'"), n.number("x'*y + x*y'"));
  EXPECT_EQ(n.number("sin(x)'"), n.number("cos(x)*x'"));
  EXPECT_EQ(n.number("t'"), n.g.one());
  EXPECT_EQ(n.number("x'^2"), n.number("(x')^2"));
}

struct Mistake {
  const char* text;
  unsigned column;
  const char* message;
};

TEST(Mistakes, HaveTheirColumnAndSayWhatIsWrong) {
  PlainNames n;
  const Mistake mistakes[] = {
      {"x + ", 5, "the formula ends where a number, a name or '(' should follow"},
      {"", 1, "the formula is empty"},
      {"x ++", 5, "the formula ends where a number, a name or '(' should follow"},
      {"(x + y", 7, "')' is missing at the end"},
      {"x + y)", 6, "')' closes nothing"},
      {"2 x", 3, "'x' is no unit"},
      {"x y", 3, "an operator is missing before 'y'"},
      {"x(y) z", 6, "an operator is missing before 'z'"},
      {"x + $", 5, "'$' means nothing in a formula"},
      {"α*x + q", 1, "unknown name 'alpha'"},
      {"a*x + q", 7, "unknown name 'q'"},
      {"sin(x, y)", 1, "sin takes 1 argument, 2 are given"},
      {"sin(u)", 5, "argument 1 of sin is a vector, not a number"},
      {"sine(x)", 1, "unknown function 'sine'; did you mean 'sin'?"},
      {"max(x", 4, "this bracket is not closed: ')' is missing"},
      {"x = y", 3, "a formula, not an equation, is expected here"},
      {"x / (y - y)", 3, "division by zero"},
      {"sqrt(-2)", 1, "square root of a negative number"},
      {"log(0)", 1, "logarithm of a number that is not positive"},
      {"x^1001", 2, "a power above 1000"},
      {"1e9999", 1, "the number 1e9999 is out of all proportion"},
      {"[1, 2]", 1, "a vector has three components"},
      {"x²² + γ", 7, "unknown name 'gamma'"},
      {"D(x, 21)", 6, "argument 2 of D is not a whole number between 0 and 20"},
      {"q[]", 1, "the bracket after 'q' is empty"},
      {"q[1/2]", 4, "an index is a whole number: + - * only"},
      {"q[x]", 3, "'x' is no index"},
      {"sum(x)", 1, "sum runs over a range of [index]"},
  };
  for (const Mistake& m : mistakes) {
    const Failure f = n.failure(m.text);
    EXPECT_EQ(f.diagnostic.message, m.message) << "in '" << m.text << "'";
    EXPECT_EQ(f.diagnostic.span.column, m.column) << "in '" << m.text << "'";
  }
}

TEST(Types, VectorsNumbersAndRotationsDoNotMix) {
  PlainNames n;
  const Mistake mistakes[] = {
      {"u*v", 2, "product of two vectors"},
      {"u + 1", 3, "sum of a vector and a number"},
      {"1/u", 2, "division by a vector"},
      {"u^2", 2, "power of a vector"},
      {"x^u", 2, "the exponent is a vector, not a number"},
      {"R + R", 3, "sum of a rotation and a rotation"},
      {"u*R", 2, "product of a vector and a rotation"},
      {"R'", 2, "derivative of a rotation"},
      {"B + u", 3, "sum of a body and a vector"},
      {"-R", 1, "minus a rotation"},
      {"dot(u, 1)", 8, "argument 2 of dot is a number, not a vector"},
  };
  for (const Mistake& m : mistakes) {
    const Failure f = n.failure(m.text);
    EXPECT_EQ(f.diagnostic.message, m.message) << "in '" << m.text << "'";
    EXPECT_EQ(f.diagnostic.span.column, m.column) << "in '" << m.text << "'";
  }
}

TEST(Types, ZeroIsAlsoTheZeroVector) {
  PlainNames n;
  EXPECT_TRUE(is_zero(std::get<Vector>(n.value("u - u"))));
  EXPECT_EQ(std::get<Vector>(n.value("u + 0")).x, n.number("x"));
  EXPECT_EQ(n.number("dot(u, 0)"), n.g.zero());
}

TEST(Rotations, HaveOrthonormalAxesAndTheirAngularVelocity) {
  PlainNames n;
  const PrecisionScope precision(40);
  const test::Point at(3);
  for (const char* text : {"rotx(x)", "roty(2*y)*rotz(x)", "rotz(x)*rotx(y)*rotz(z)", "euler(zxz, x, y, z)",
                           "rot([3/5, 0, 4/5], x*y)", "euler(\"xyz\", x, y, z)"}) {
    const Rotation r = std::get<Rotation>(n.value(text));
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        EXPECT_LE(test::distance(test::value(dot(r[i], r[j]), at), Multi(i == j ? 1 : 0)), 1e-38) << text;
      // u' = w x u defines the angular velocity.
      const Vector rate = total_derivative(r[i]), turned = cross(r.rate, r[i]);
      for (int k = 0; k < 3; ++k)
        EXPECT_LE(test::distance(test::value(rate[k], at), test::value(turned[k], at)), 1e-38) << text;
      EXPECT_LE(test::distance(test::value(dot(r.rate, r[i]), at), test::value(r.own_rate[i], at)), 1e-38) << text;
    }
    const Vector z = cross(r[0], r[1]);
    for (int k = 0; k < 3; ++k)
      EXPECT_LE(test::distance(test::value(z[k], at), test::value(r[2][k], at)), 1e-38) << "right-handed";
  }
}

std::string repeated(const std::string& s, int times) {
  std::string out;
  for (int k = 0; k < times; ++k) out += s;
  return out;
}

TEST(Size, DeepNestingIsRefusedNotCrashed) {
  PlainNames n;
  for (const std::string& bomb :
       {repeated("(", 100000) + "x" + repeated(")", 100000), repeated("-", 100000) + "x", repeated("+", 100000) + "x",
        repeated("sin(", 100000) + "x" + repeated(")", 100000), "x" + repeated("^x", 100000), repeated("[", 100000),
        "x" + repeated("'", 100000), "u" + repeated(".x", 100000), repeated("2^-", 100000) + "x"}) {
    const Failure f = n.failure(bomb);
    EXPECT_NE(f.diagnostic.message, "no failure") << bomb.substr(0, 12);
    EXPECT_LE(f.diagnostic.message.size(), 200U);
  }
  EXPECT_EQ(n.number(repeated("(", 300) + "x" + repeated(")", 300)), n.number("x"));
}

TEST(Size, LongSumsAreFine) {
  PlainNames n;
  EXPECT_EQ(n.number("x" + repeated(" + x", 99999)), Rational(100000) * n.number("x"));
  EXPECT_EQ(n.number("x" + repeated(" - x", 99999)), Rational(-99998) * n.number("x"));
}

TEST(Size, AFormulaOfMoreThanAMegabyteIsRefused) {
  PlainNames n;
  EXPECT_EQ(n.failure("x" + repeated(" + x", 300000)).diagnostic.message, "a formula of more than 1048576 bytes");
}

TEST(FormulaText, PlacesOfCharactersCarryOverLines) {
  const FormulaText text("x + $", std::vector<Span>{{3, 5}, {3, 6}, {3, 7}, {4, 1}, {4, 2}});
  try {
    parse_formula(text);
    FAIL();
  } catch (const Failure& f) {
    EXPECT_EQ(f.diagnostic.span.line, 4U);
    EXPECT_EQ(f.diagnostic.span.column, 2U);
  }
}

TEST(Equation, HasOneSideOrTwo) {
  EXPECT_EQ(parse_equation(FormulaText("x", Span{})).size(), 1U);
  EXPECT_EQ(parse_equation(FormulaText("x = y", Span{})).size(), 2U);
  EXPECT_EQ(parse_equation(FormulaText("x == y", Span{})).size(), 2U);
  EXPECT_THROW(parse_equation(FormulaText("x = y = z", Span{})), Failure);
}

}  // namespace
}  // namespace anholon::parse_test

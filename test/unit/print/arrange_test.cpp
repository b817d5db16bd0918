#include <gtest/gtest.h>

#include "expr/normal.h"
#include "print/arrange.h"
#include "support/plain_names.h"
#include "support/random_expr.h"
#include "support/value.h"

namespace anholon::arrange_test {
namespace {

using test::PlainNames;

std::string paper(PlainNames& n, const std::string& text) {
  const SymbolNames names = test::plain_symbol_names();
  return print(arranged(n.number(text), names), names, Format::text);
}

TEST(Arranged, LooksAsInAPaper) {
  PlainNames n;
  const std::pair<const char*, const char*> samples[] = {
      // Equal coefficients are gathered; accelerations come first and occur once.
      {"m*x'' + a*x'' - b*m*y''*sin(z) - a*b*y''*sin(z)", "(m + a)*(x'' - b*y''*sin(z))"},
      {"m*a*(z''*sin(z) + z'^2*cos(z)) + b*m*(z''*sin(z) + z'^2*cos(z)) - (m + 2)*x''",
       "-(2 + m)*x'' + m*(a + b)*(z''*sin(z) + z'^2*cos(z))"},
      {"a*z'' - b*m*x''*sin(z) + b*m*y''*cos(z) + b^2*m*z''", "(a + b^2*m)*z'' - b*m*(x''*sin(z) - y''*cos(z))"},
      // Squares of sine and cosine have the shorter form.
      {"a^2*sin(x)^2 + a^2*cos(x)^2", "a^2"},
      {"a*x'' - a*x''*cos(x)^2", "a*x''*sin(x)^2"},
      {"a*(1 - sin(x)^2) + b*cos(x)^2 + b*sin(x)^2", "a*cos(x)^2 + b"},
      {"a*sin(x)^2 + b*cos(x)^2", "b*cos(x)^2 + a*sin(x)^2"},
      // Sums of angles.
      {"a*sin(x + b)", "a*sin(x + b)"},
      {"a*(sin(x)*cos(b) + cos(x)*sin(b))", "a*sin(x + b)"},
      {"cos(x)*cos(y) - sin(x)*sin(y)", "cos(x + y)"},
      {"a*sin(x)*cos(y) - a*cos(x)*sin(y)", "a*sin(x - y)"},
      {"cos(x)*sin(y) - sin(x)*cos(y)", "-sin(x - y)"},
      {"x''*cos(x)*cos(y) + x''*sin(x)*sin(y) + y'", "x''*cos(x - y) + y'"},
      {"a*tan(x)*(x' + y') - a*x'*tan(x)", "a*y'*tan(x)"},
      // Fractions and factors.
      {"x/(1 + y)^2 + a*x/(1 + y)^2", "(1 + a)*x/(y + 1)^2"},
      {"x^2/(x + y) + 2*x*y/(x + y) + y^2/(x + y)", "x + y"},
      {"2*a*(x - y)", "2*a*(x - y)"},
      {"x^2 + 2*x*y + y^2", "(x + y)^2"},
      {"a^2 - b^2", "a^2 - b^2"},
  };
  for (const auto& [text, expected] : samples) EXPECT_EQ(paper(n, text), expected) << text;
}

TEST(Arranged, KeepsTheNamesOfTheUser) {
  PlainNames n;
  SymbolNames names = test::plain_symbol_names();
  names.defined[n.number("a + b*cos(x)").id] = "d";
  names.defined[n.number("sqrt(x^2 + y^2)").id] = "r";
  const auto printed = [&](const char* text) { return print(arranged(n.number(text), names), names, Format::text); };
  EXPECT_EQ(printed("m*(a + b*cos(x))^2*x'' + m*(a + b*cos(x))^2*y''"), "m*d^2*(x'' + y'')");
  EXPECT_EQ(printed("a*x/sqrt(x^2 + y^2) + b*x/sqrt(x^2 + y^2)"), "(a + b)*x/r");
}

// Theorem. An arrangement is equal to the expression (by proof if one is found, else by its values), and it is no
// longer than the expression and its expansion.
TEST(Arranged, IsEqualAndNoLonger) {
  const PrecisionScope precision(60);
  const double tolerance = 1e-35;  // 60 digits, and cancellation between monomials of moderate size
  PlainNames n;
  const SymbolNames names = test::plain_symbol_names();
  const auto length = [&](Expr e) { return print(e, names, Format::text).size(); };
  const std::vector<Expr> atoms = {n.number("x"),
                                   n.number("y"),
                                   n.number("a"),
                                   n.number("b"),
                                   n.number("x''"),
                                   n.number("y'"),
                                   sin(n.number("x")),
                                   cos(n.number("x")),
                                   sin(n.number("y + b")),
                                   cos(n.number("y")),
                                   sin(n.number("y")),
                                   sqrt(n.number("1 + y^2")),
                                   pow(n.number("2 + a^2"), -1)};
  int proofs = 0, shorter = 0;
  for (std::uint32_t k = 1; k <= 200; ++k) {
    test::RandomExpr make(n.g, 7000 + k, atoms);
    Expr e = make.make(2);
    if (k % 2 == 0) e = make.atom() * e + make.atom() * e + make.make(2) * make.atom();
    const Expr a = arranged(e, names);
    ASSERT_LE(length(a), length(e));
    if (const auto full = expanded(e)) {
      ASSERT_LE(length(a), length(*full));
    }
    shorter += length(a) < length(e);
    if (proved_zero(a - e)) {
      ++proofs;
      continue;
    }
    ASSERT_LE(test::distance(test::value(a, test::Point(k)), test::value(e, test::Point(k))), tolerance)
        << print(e, names, Format::text) << "\n"
        << print(a, names, Format::text);
  }
  EXPECT_GT(proofs, 190);
  EXPECT_GT(shorter, 50);
}

}  // namespace
}  // namespace anholon::arrange_test

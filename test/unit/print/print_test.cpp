#include <gtest/gtest.h>

#include "print/print.h"
#include "support/plain_names.h"
#include "support/random_expr.h"

namespace anholon::print_test {
namespace {

using test::PlainNames;

// Theorem. The parser reads the printed text back as the same expression.
TEST(RoundTrip, PrintedTextParsesToTheSameExpression) {
  PlainNames n;
  const SymbolNames names = test::plain_symbol_names();
  const std::vector<Expr> atoms = {n.number("x"),
                                   n.number("y'"),
                                   n.number("z''"),
                                   n.number("D(x,5)"),
                                   n.number("a"),
                                   n.number("b"),
                                   n.number("m"),
                                   n.number("t"),
                                   n.number("pi"),
                                   n.number("f"),
                                   n.number("f'"),
                                   n.g.multiplier(0, 0),
                                   n.g.number(2),
                                   n.g.number(Rational(-3, 4)),
                                   sqrt(n.g.number(2)),
                                   pow(n.number("x"), {-3, 2}),
                                   pow(n.g.number(Rational(2, 3)), {1, 3}),
                                   pow(n.number("y"), -2),
                                   -n.number("x"),
                                   n.number("x - y")};
  for (std::uint32_t k = 1; k <= 2000; ++k) {
    const Expr e = test::RandomExpr(n.g, k, atoms).make(1 + static_cast<int>(k % 4));
    const std::string text = print(e, names, Format::text);
    if (text.size() > 20000) continue;
    Expr back = n.g.zero();
    try {
      back = n.number(text);
    } catch (const Failure& f) {
      FAIL() << f.diagnostic.message << "\n" << text;
    }
    ASSERT_EQ(back.id, e.id) << text << "\nread back as\n" << print(back, names, Format::text);
  }
}

TEST(RoundTrip, DefinedNamesStandForTheirExpressions) {
  PlainNames n;
  SymbolNames names = test::plain_symbol_names();
  const Expr inner = n.number("sin(x) + a"), e = n.number("2*(sin(x) + a)^2");
  names.defined[inner.id] = "h";
  EXPECT_EQ(print(e, names, Format::text), "2*h^2");
}

TEST(Text, LooksAsAPersonWouldWriteIt) {
  PlainNames n;
  const SymbolNames names = test::plain_symbol_names();
  const std::pair<const char*, const char*> samples[] = {{"a*x''", "a*x''"},
                                                         {"x*a/b", "a*x/b"},
                                                         {"-x", "-x"},
                                                         {"x^2/2", "x^2/2"},
                                                         {"1/x", "1/x"},
                                                         {"sqrt(x)", "sqrt(x)"},
                                                         {"(x+y)^3", "(x + y)^3"},
                                                         {"sin(x)*cos(x)", "sin(x)*cos(x)"},
                                                         {"1/(a*b)", "1/(a*b)"},
                                                         {"D(x,4)", "D(x,4)"},
                                                         {"x - 3/4", "x - 3/4"}};
  for (const auto& [text, expected] : samples) EXPECT_EQ(print(n.number(text), names, Format::text), expected);
}

TEST(Text, PowersWithFormulasAsExponents) {
  PlainNames n;
  const SymbolNames names = test::plain_symbol_names();
  const std::pair<const char*, const char*> samples[] = {{"x^a", "x^a"},
                                                         {"x*y*z^a", "x*y*z^a"},
                                                         {"x^(a + 1)/x", "x^(a + 1)/x"},
                                                         {"b*(x^2 + y^2)^(-a)", "b*(x^2 + y^2)^(-a)"},
                                                         {"x^(2*a)", "x^(2*a)"},
                                                         {"x^(a/2)", "x^(a/2)"},
                                                         {"x^(2*(a - b))", "x^(2*(a - b))"},
                                                         {"x^(a*b^2 - 3)", "x^(a*b^2 - 3)"},
                                                         {"(x^a)^2", "(x^a)^2"},
                                                         {"2^a", "2^a"},
                                                         {"x^sin(a)", "x^sin(a)"},
                                                         {"exp(2*log(x))", "exp(2*log(x))"},
                                                         {"exp(a*log(x) + y)", "exp(a*log(x) + y)"},
                                                         {"log(x)*exp(a)", "log(x)*exp(a)"},
                                                         {"-x^a", "-x^a"}};
  for (const auto& [text, expected] : samples) {
    const Expr e = n.number(text);
    const std::string printed = print(e, names, Format::text);
    EXPECT_EQ(printed, expected);
    EXPECT_EQ(n.number(printed).id, e.id) << text;
  }
  EXPECT_EQ(print(n.number("b*x^(a + 1)"), names, Format::latex), "b \\, {x}^{a + 1}");
  EXPECT_EQ(print(n.number("x^a"), names, Format::mathml),
            "<msup><mrow><mi>x</mi></mrow><mrow><mi>a</mi></mrow></msup>");
}

TEST(Text, BeyondTheLongestPrintIsCut) {
  PlainNames n;
  Expr e = n.number("x");
  for (int k = 0; k < 25; ++k) e = n.number("y") + e * sin(e);  // its text doubles at every step
  EXPECT_LE(print(e, test::plain_symbol_names(), Format::text).size(), 3 * kLongestPrint);
}

TEST(Latex, Samples) {
  EXPECT_EQ(latex_name("theta"), "\\theta");
  EXPECT_EQ(latex_name("x1"), "x_{1}");
  EXPECT_EQ(latex_name("theta12"), "\\theta_{12}");
  EXPECT_EQ(latex_name("mass"), "\\mathrm{mass}");
  EXPECT_EQ(latex_name("x_a"), "x_{a}");
  EXPECT_EQ(latex_name("theta[3]"), "\\theta_{3}");
  EXPECT_EQ(latex_name("x1[3]"), "x_{1,3}");
  EXPECT_EQ(latex_name("x_a[1,2]"), "x_{a,1,2}");
  EXPECT_EQ(latex_name("front_wheel[2]"), "\\mathrm{front}_{\\mathrm{wheel},2}");
  EXPECT_EQ(latex_name("x_left_wheel"), "x_{\\mathrm{left}\\,\\mathrm{wheel}}");
  EXPECT_EQ(latex_name("x__a"), "x_{\\mathrm{\\_a}}");
  EXPECT_EQ(derivative_name("x", 2, Format::latex), "\\ddot{x}");
  EXPECT_EQ(derivative_name("x", 4, Format::latex), "x^{(4)}");
  EXPECT_EQ(derivative_name("x", 3, Format::text), "x'''");
  EXPECT_EQ(derivative_name("x", 4, Format::text), "D(x,4)");
  PlainNames n;
  SymbolNames names = test::plain_symbol_names();
  names.coordinates = {"theta", "y", "z"};
  const auto latex = [&](const char* text) { return print(n.number(text), names, Format::latex); };
  EXPECT_EQ(latex("a*x'^2/2"), "\\frac{1}{2} \\, a \\, {\\dot{\\theta}}^{2}");
  EXPECT_EQ(latex("sqrt(x)/b"), "\\frac{\\sqrt{\\theta}}{b}");
  EXPECT_EQ(latex("sin(x'')"), "\\sin\\left(\\ddot{\\theta}\\right)");
  EXPECT_EQ(latex("pi"), "\\pi");
}

TEST(Text, GivesTheMinusOfBracketsToTheirProduct) {
  PlainNames n;
  const SymbolNames names = test::plain_symbol_names();
  const std::pair<const char*, const char*> samples[] = {
      {"a*(y'' - x'')", "a*(y'' - x'')"}, {"a - b*(-x''*y - z'')", "b*(y*x'' + z'') + a"},
      {"-a*(-x'' - y)", "a*(x'' + y)"},   {"a*(-x'' - y)^2", "a*(x'' + y)^2"},
      {"a/(-x'' - y)", "-a/(x'' + y)"},   {"-x + y", "y - x"},
      {"(a + m)*x''", "(a + m)*x''"},     {"1/(1 + a*t)", "1/(1 + a*t)"},
      {"a/(b*(1 + t))", "a/(b*(1 + t))"}, {"-x''*sin(y) + y''*cos(y)", "y''*cos(y) - x''*sin(y)"}};
  for (const auto& [text, expected] : samples) EXPECT_EQ(print(n.number(text), names, Format::text), expected) << text;
}

TEST(Mathml, Samples) {
  EXPECT_EQ(mathml_name("theta"), "<mi>θ</mi>");
  EXPECT_EQ(mathml_name("x1"), "<msub><mi>x</mi><mn>1</mn></msub>");
  EXPECT_EQ(mathml_name("phi_a"), "<msub><mi>φ</mi><mi>a</mi></msub>");
  EXPECT_EQ(mathml_name("theta[3]"), "<msub><mi>θ</mi><mn>3</mn></msub>");
  EXPECT_EQ(mathml_name("x1[3]"), "<msub><mi>x</mi><mrow><mn>1</mn><mo>,</mo><mn>3</mn></mrow></msub>");
  EXPECT_EQ(mathml_name("phi_a[1,2]"),
            "<msub><mi>φ</mi><mrow><mi>a</mi><mo>,</mo><mn>1</mn><mo>,</mo><mn>2</mn></mrow></msub>");
  EXPECT_EQ(mathml_name("mass"), "<mi mathvariant=\"normal\">mass</mi>");
  EXPECT_EQ(mathml_name("a<b&c"), "<mi mathvariant=\"normal\">a&lt;b&amp;c</mi>");
  const auto dotted = [](const std::string& letter, const std::string& dots) {
    return "<mover>" + letter + "<mo stretchy=\"false\" scriptlevel=\"+0\">" + dots + "</mo></mover>";
  };
  EXPECT_EQ(derivative_name("<mi>x</mi>", 2, Format::mathml), dotted("<mi>x</mi>", "¨"));
  // Dots stand over the letter and not over its index.
  EXPECT_EQ(derivative_name(mathml_name("theta_1"), 1, Format::mathml),
            "<msub>" + dotted("<mi>θ</mi>", "˙") + "<mn>1</mn></msub>");
  EXPECT_EQ(derivative_name(mathml_name("x[1,2]"), 3, Format::mathml),
            "<msub>" + dotted("<mi>x</mi>", "⃛") + "<mrow><mn>1</mn><mo>,</mo><mn>2</mn></mrow></msub>");
  EXPECT_EQ(derivative_name("<msup><mi>x</mi><mo>∗</mo></msup>", 1, Format::mathml),
            "<msup>" + dotted("<mi>x</mi>", "˙") + "<mo>∗</mo></msup>");
  // Dots over a name of several letters would stand over one of them.
  EXPECT_EQ(derivative_name(mathml_name("mass"), 1, Format::mathml), "<mi mathvariant=\"normal\">mass′</mi>");
  EXPECT_EQ(derivative_name(mathml_name("th_1"), 2, Format::mathml),
            "<msub><mi mathvariant=\"normal\">th″</mi><mn>1</mn></msub>");
  // Subscripts have one level.
  EXPECT_EQ(mathml_name("x_left_wheel"), "<msub><mi>x</mi><mrow><mi mathvariant=\"normal\">left</mi><mspace "
                                         "width=\"0.1667em\"/><mi mathvariant=\"normal\">wheel</mi></mrow></msub>");
  PlainNames n;
  SymbolNames names = test::plain_symbol_names();
  names.coordinates = {"theta", "y", "z"};
  const auto mathml = [&](const char* text) { return print(n.number(text), names, Format::mathml); };
  EXPECT_EQ(mathml("a*y"), "<mi>a</mi><mo>&#x2062;</mo><mi>y</mi>");
  EXPECT_EQ(mathml("y - 3/4"), "<mi>y</mi><mo>−</mo><mfrac><mrow><mn>3</mn></mrow><mrow><mn>4</mn></mrow></mfrac>");
  EXPECT_EQ(mathml("sqrt(x)/b"), "<mfrac><mrow><msqrt><mi>θ</mi></msqrt></mrow><mrow><mi>b</mi></mrow></mfrac>");
  EXPECT_EQ(mathml("sin(y)^2"), "<msup><mrow><mi>sin</mi><mo>&#x2061;</mo><mrow><mo>(</mo><mi>y</mi><mo>)</mo></mrow></"
                                "mrow><mrow><mn>2</mn></mrow></msup>");
  EXPECT_EQ(mathml("sign(y)").substr(0, 12), "<mi>sgn</mi>");
}

// Every opening brace has a closing one, and every \left a \right.
TEST(Latex, IsBalancedOnRandomExpressions) {
  PlainNames n;
  const auto occurrences = [](const std::string& text, const std::string& part) {
    int count = 0;
    for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
    return count;
  };
  const std::vector<Expr> atoms = {n.number("x"), n.number("y'"), n.number("a"), n.g.number(Rational(-3, 4)),
                                   n.g.multiplier(0, 0)};
  for (std::uint32_t k = 1; k <= 200; ++k) {
    const std::string text = print(test::RandomExpr(n.g, k, atoms).make(3), test::plain_symbol_names(), Format::latex);
    ASSERT_EQ(occurrences(text, "{"), occurrences(text, "}")) << text;
    ASSERT_EQ(occurrences(text, "\\left"), occurrences(text, "\\right")) << text;
    ASSERT_EQ(occurrences(text, "+ -"), 0) << text;
    ASSERT_EQ(occurrences(text, "*"), 0) << text;
  }
}

}  // namespace
}  // namespace anholon::print_test

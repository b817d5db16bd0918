// Formulas that wrap have the same signs as those that do not.
#include <gtest/gtest.h>

#include "mechanics/mechanics.h"
#include "report/markup.h"
#include "report/math_lines.h"
#include "support/models.h"

namespace anholon::math_lines_test {
namespace {

// The text without its tags.
std::string signs(const std::string& s) {
  std::string out;
  bool tag = false;
  for (char c : s) {
    if (c == '<') tag = true;
    if (!tag && c != ' ') out += c;
    if (c == '>') tag = false;
  }
  return out;
}

const std::string kTerm = "<mi>a</mi><mo>&#x2062;</mo><mi>b</mi>";

TEST(MathLines, ASumIsBrokenBeforeEachSignButNotBeforeALeadingOne) {
  const auto pieces = math_pieces("<mo>−</mo>" + kTerm + "<mo>+</mo><mi>c</mi><mo>−</mo><mi>d</mi>");
  ASSERT_EQ(pieces.size(), 3U);
  EXPECT_EQ(signs(pieces[0]), "−a&#x2062;b");
  EXPECT_EQ(signs(pieces[1]), "+c");
  EXPECT_EQ(signs(pieces[2]), "−d");
  EXPECT_NE(pieces[0].find("form=\"prefix\""), std::string::npos);
  EXPECT_NE(pieces[1].find("form=\"infix\""), std::string::npos);
}

TEST(MathLines, OnlyLongBracketsAreOpened) {
  const std::string inner = "<mi>x</mi><mo>+</mo><mi>y</mi>";
  EXPECT_EQ(math_pieces("<mi>a</mi><mrow><mo>(</mo>" + inner + "<mo>)</mo></mrow>").size(), 1U);
  std::string longer = inner;
  for (int k = 0; k < 12; ++k) longer += "<mo>+</mo><mi>z</mi>";
  EXPECT_EQ(math_pieces("<mi>a</mi><mrow><mo>(</mo>" + longer + "<mo>)</mo></mrow>").size(), 14U);
  // Roots stay whole, as do fractions with a short numerator.
  EXPECT_EQ(math_pieces("<msqrt>" + longer + "</msqrt>").size(), 1U);
  EXPECT_EQ(math_pieces("<mfrac><mrow>" + inner + "</mrow><mrow><mi>c</mi></mrow></mfrac>").size(), 1U);
}

TEST(MathLines, ALongNumeratorIsTakenOutOfItsFraction) {
  std::string sum = "<mi>x</mi>", product = "<mi>x</mi>";
  for (int k = 0; k < 14; ++k)
    sum += "<mo>+</mo><mi>z</mi>", product += "<mo>&#x2062;</mo><msup><mi>z</mi><mn>2</mn></msup>";
  const auto fraction = [](const std::string& top) {
    return "<mfrac><mrow>" + top + "</mrow><mrow><mi>c</mi></mrow></mfrac>";
  };
  std::string together;
  for (const std::string& p : math_pieces(fraction(sum))) together += p;
  EXPECT_EQ(signs(together), "1c(" + signs(sum) + ")");
  EXPECT_EQ(math_pieces(fraction(sum)).size(), 15U);
  together.clear();
  for (const std::string& p : math_pieces(fraction(product))) together += p;
  EXPECT_EQ(signs(together), "1c&#x2062;" + signs(product));
}

TEST(MathLines, NothingOfAnEquationIsLostOnAnyShippedModel) {
  int asked = 0;
  for (const char* name : {"zoo/disc", "zoo/rattleback", "papers/luo-zhao-example-2", "zoo/fourbar"}) {
    const auto model = test::shipped(name);
    const Mechanics m = mechanics(*model);
    for (const Column* column : {&m.Q, &m.Gamma, &m.phi})
      for (const Expr& e : put_masses(*model, *column)) {
        const std::string row = print(e, model->names, Format::mathml);
        if (row.find("<mfrac>") != std::string::npos) continue;  // tested above
        ++asked;
        std::string together;
        for (const std::string& p : math_pieces(row)) together += p;
        EXPECT_EQ(signs(together), signs(row));
        EXPECT_EQ(signs(wrapping_math(row)), signs(row));
      }
  }
  EXPECT_GT(asked, 8);
}

TEST(Page, TextIsNeverMarkup) {
  EXPECT_EQ(markup_escape("</script><b a='1' b=\"2\">&"),
            "&lt;/script&gt;&lt;b a=&#39;1&#39; b=&quot;2&quot;&gt;&amp;");
}

}  // namespace
}  // namespace anholon::math_lines_test

#include <gtest/gtest.h>

#include "plot/labels.h"

namespace anholon::plot::labels_test {
namespace {

std::string unicode(const std::string& column, const std::string& unit = "") {
  return text_label(column, unit, LabelStyle::unicode);
}

TEST(Labels, InUnicode) {
  EXPECT_EQ(unicode("x"), "x");
  EXPECT_EQ(unicode("theta'"), "θ\u0307");
  EXPECT_EQ(unicode("theta''"), "θ\u0308");
  EXPECT_EQ(unicode("x'''"), "x\u20DB");
  EXPECT_EQ(unicode("D(x,4)"), "x⁽⁴⁾");
  EXPECT_EQ(unicode("D(x,12)"), "x⁽¹²⁾");
  EXPECT_EQ(unicode("lambda.blade"), "λ_blade");
  EXPECT_EQ(unicode("lambda.blade'"), "λ\u0307_blade");
  EXPECT_EQ(unicode("N.theta"), "N_θ");
  EXPECT_EQ(unicode("x12'"), "x\u0307₁₂");
  EXPECT_EQ(unicode("P[1,2]"), "P₁,₂");
  EXPECT_EQ(unicode("phi_wheel"), "φ_wheel");
  EXPECT_EQ(unicode("speed'"), "speed′");
  EXPECT_EQ(unicode("x'", "m/s"), "x\u0307 (m/s)");
  EXPECT_EQ(unicode("theta", "1"), "θ");
  // Initial values and quantiles of a sweep.
  EXPECT_EQ(unicode("phi'(0)", "1/s"), "φ\u0307(0) (1/s)");
  EXPECT_EQ(unicode("theta 10 %", "rad"), "θ 10 % (rad)");
  EXPECT_EQ(unicode("N.theta 90 %"), "N_θ 90 %");
  EXPECT_EQ(unicode("(0)"), "(0)");
  EXPECT_EQ(unicode("a %"), "a %");
  // Names in the style of other programs stay unchanged.
  EXPECT_EQ(unicode("v [m/s]"), "v [m/s]");
  EXPECT_EQ(text_label("theta'", "", LabelStyle::plain), "theta'");
}

TEST(Labels, InLatex) {
  EXPECT_EQ(latex_label("theta'", ""), "$\\dot{\\theta}$");
  EXPECT_EQ(latex_label("lambda.blade", ""), "$\\lambda_{\\mathrm{blade}}$");
  EXPECT_EQ(latex_label("N.theta", ""), "$N_{\\theta}$");
  EXPECT_EQ(latex_label("D(x,4)", ""), "$x^{(4)}$");
  EXPECT_EQ(latex_label("x", "m/s^2"), "$x$ (m/s\\textasciicircum{}2)");
  EXPECT_EQ(latex_label("theta'(0)", "rad"), "$\\dot{\\theta}$(0) (rad)");
  EXPECT_EQ(latex_label("theta 50 %", ""), "$\\theta$ 50 \\%");
  EXPECT_EQ(latex_label("100% v_x", ""), "100\\% v\\_x");
}

TEST(Labels, AsPieces) {
  const RichText t = rich_label("theta''", "rad", LabelStyle::unicode);
  ASSERT_EQ(t.size(), 2u);
  EXPECT_EQ(t[0].text, "θ");
  EXPECT_EQ(t[0].dots, 2u);
  EXPECT_TRUE(t[0].italic);
  EXPECT_EQ(t[1].text, " (rad)");
  EXPECT_TRUE(rich_label("lambda.blade", "", LabelStyle::unicode)[1].sub);
}

TEST(Labels, MarksHaveNoWidth) {
  for (const char* column : {"theta'", "theta''", "x'''"}) EXPECT_EQ(shown_width(unicode(column)), 1u) << column;
  EXPECT_EQ(shown_width("λ_blade"), 7u);
}

}  // namespace
}  // namespace anholon::plot::labels_test

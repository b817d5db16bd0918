// Units: exact factors, prefixes, and the reading of a number with a unit.
#include <gtest/gtest.h>

#include "formula/formula.h"
#include "formula/units.h"
#include "support/plain_names.h"

namespace anholon::units_test {
namespace {

Rational factor(const std::string& unit) {
  const auto u = read_unit(unit);
  return u ? u->factor : Rational(0);
}

TEST(Units, AreExact) {
  EXPECT_EQ(factor("km"), 1000);
  EXPECT_EQ(factor("km/h"), Rational(5, 18));
  EXPECT_EQ(factor("g"), Rational(1, 1000));
  EXPECT_EQ(factor("kg"), 1);
  EXPECT_EQ(factor("t"), 1000);
  EXPECT_EQ(factor("m^3/s^2"), 1);
  EXPECT_EQ(factor("mm^2"), Rational(1, 1000000));
  EXPECT_EQ(factor("in"), Rational(127, 5000));
  EXPECT_EQ(factor("ft*lbf/s") * 550, factor("hp"));
  EXPECT_EQ(factor("lbf"), factor("lb") * Rational(980665, 100000));
  EXPECT_EQ(factor("PS"), 75 * factor("kp*m/s"));
  EXPECT_EQ(factor("mi"), 5280 * factor("ft"));
  EXPECT_EQ(factor("yd"), 3 * factor("ft"));
  EXPECT_EQ(factor("kn"), factor("nmi/h"));
  EXPECT_EQ(factor("kN*m"), 1000);
  EXPECT_EQ(factor("s^-2"), 1);
  EXPECT_EQ(factor("1/min"), Rational(1, 60));
  EXPECT_EQ(factor("1/km^2*g"), factor("km^-2*g"));
  EXPECT_EQ(factor("min"), 60);
  EXPECT_EQ(factor("MPa"), factor("N") / factor("mm^2"));
  EXPECT_EQ(factor("mum"), Rational(1, 1000000));
  EXPECT_EQ(read_unit("deg")->pi, 1);
  EXPECT_EQ(factor("deg"), Rational(1, 180));
  EXPECT_EQ(read_unit("rpm")->pi, 1);
  for (const char* none : {"", "kmin", "kkg", "m/", "m^", "m^x", "foo", "m^21", "ktt", "1/", "1", "2/s", "1/1/s"})
    EXPECT_FALSE(read_unit(none)) << none;
}

// Each row of the table is found by its name; no prefix with another unit hides it.
TEST(Units, OfTheTableAreFoundByTheirNames) {
  for (const UnitRow& r : unit_table()) {
    const auto u = find_unit(r.name);
    ASSERT_TRUE(u) << r.name;
    const Rational expected(r.factor);
    EXPECT_EQ(u->factor, expected) << r.name;
    EXPECT_GT(u->factor, 0);
  }
}

TEST(Units, DimensionsAreNamed) {
  const auto text = [](const char* unit) { return describe(read_unit(unit)->dimension); };
  EXPECT_EQ(text("km"), "a length (m)");
  EXPECT_EQ(text("lbf"), "a force (N)");
  EXPECT_EQ(text("km/h"), "a velocity (m/s)");
  EXPECT_EQ(text("deg"), "a pure number");
  EXPECT_EQ(text("rpm"), "an angular velocity or frequency (1/s)");
  EXPECT_EQ(text("kg*m"), "a quantity in kg*m");
  EXPECT_EQ(text("m^3/s^2"), "a quantity in m^3/s^2");
}

TEST(Units, FollowANumberAndABlank) {
  test::PlainNames names;
  Graph& g = names.g;
  const auto value = [&](const char* text) { return names.number(text); };
  EXPECT_EQ(value("2 km"), g.number(2000));
  EXPECT_EQ(value("30 deg"), Rational(1, 6) * g.pi());
  EXPECT_EQ(value("60 rpm"), 2 * g.pi());
  EXPECT_EQ(value("2 m + 3 cm"), g.number(Rational(203, 100)));
  EXPECT_EQ(value("-2 m^2"), g.number(-2));
  EXPECT_EQ(value("(2 km)^2"), g.number(4000000));
  EXPECT_EQ(value("2 km²"), g.number(2000000));
  EXPECT_EQ(value("9.81 m/s^2*x"), Rational(981, 100) * value("x")) << "x is no unit: a product";
  EXPECT_EQ(value("5 m/s*t"), 5 * g.time()) << "t is the time behind a unit";
  EXPECT_EQ(value("5 t"), g.number(5000)) << "and the tonne behind a number";
  EXPECT_EQ(value("6 N*m / 2"), g.number(3));
  EXPECT_EQ(value("3e3 mm"), g.number(3));
  EXPECT_EQ(value("10 1/min*x"), Rational(1, 6) * value("x")) << "x is no unit: a product";
  EXPECT_EQ(value("3 1/s^2 + 2 s^-2 - 1 1/cm²"), g.number(5 - 10000));
  EXPECT_EQ(value("-2 1/m"), g.number(-2));
  for (const char* wrong : {"2 1/x", "2 1 /s", "2 1/ s", "2 3/s", "2 1/t", "2 1/m'", "21/s", "2 1/min(x, x)"})
    EXPECT_THROW(value(wrong), Failure) << wrong;
  for (const char* wrong : {"2 foo", "2 m'", "2m", "2 m^x", "2 m^2.5", "2 3", "x m"})
    EXPECT_THROW(value(wrong), Failure) << wrong;
  EXPECT_EQ(print(parse_formula(FormulaText("(2 m)^2*3 km/h", Span{1, 1, 1}))), "(2 m)^2*3 km/h");
  EXPECT_EQ(print(parse_formula(FormulaText("2 1/s*x", Span{1, 1, 1}))), "2 1/s*x");
}

}  // namespace
}  // namespace anholon::units_test

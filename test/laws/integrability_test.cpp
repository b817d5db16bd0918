// Frobenius's theorem: the derived flag does not depend on how the constraints are mixed, an integral that it finds is
// constant along every admissible motion, and a set is not called integrable if one coefficient is changed.
#include <random>

#include <gtest/gtest.h>

#include "mechanics/elimination.h"
#include "mechanics/integrability.h"
#include "numeric/linear.h"
#include "support/models.h"
#include "support/value.h"

namespace anholon::integrability_test {
namespace {

std::shared_ptr<const Model> particle(const std::vector<std::string>& equations, const std::string& more = {}) {
  std::string text = "coordinates = [\"x\", \"y\", \"z\", \"u\", \"v\"]\n[parameters]\nr = 2\nk = 3\none = "
                     "1\n[[particle]]\nname = \"p\"\nmass = 2\nposition = [\"x\", \"y\", \"z\"]\n"
                     "[[particle]]\nname = \"q\"\nmass = 1\nposition = [\"u\", \"v\", \"0\"]\n" +
                     more;
  for (std::size_t i = 0; i < equations.size(); ++i)
    text += "[[constraint]]\nname = \"c" + std::to_string(i) + "\"\nequation = \"" + equations[i] + "\"\n";
  return test::model_of(text);
}

struct Found {
  std::shared_ptr<const Model> model;
  Mechanics m;
  Integrability i;
};

Found found(const std::shared_ptr<const Model>& model) {
  Found f{model, mechanics(*model), {}};
  std::vector<std::size_t> first_order;
  for (std::size_t r = 0; r < f.m.order.size(); ++r)
    if (f.m.order[r] == 1) first_order.push_back(r);
  PointValues near([](const Node& n) { return 0.3 + 0.1 * n.index; });
  f.i = integrability(f.m, first_order, near);
  EXPECT_EQ(f.i.undecided, "");
  return f;
}
Found found(const std::vector<std::string>& equations, const std::string& more = {}) {
  return found(particle(equations, more));
}

using Ints = std::vector<int>;

std::vector<std::string> integrals(const Found& f) {
  std::vector<std::string> out;
  for (const IntegrableCombination& c : f.i.combinations)
    out.push_back(c.integral ? print(*c.integral, f.model->names, Format::text) : "");
  return out;
}

// df/dt vanishes along a motion that obeys all constraints: (df/dz) lies in the span of their rows. The numbers here
// are computed without the code of the search.
void expect_constant(const Found& f) {
  const PrecisionScope precision(50);
  Graph& g = f.m.graph();
  Column z = f.m.q;
  z.push_back(g.time());
  for (const IntegrableCombination& c : f.i.combinations) {
    if (!c.integral) continue;
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      test::Point at(seed);
      for (Expr v : f.m.qd) at.set(v, Multi(0));
      Rows rows;
      for (std::size_t r = 0; r < f.m.phi.size(); ++r) {
        if (f.m.order[r] == 0)
          rows.push_back(gradient(f.m.phi[r], z));
        else if (f.m.order[r] == 1) {
          rows.push_back(f.m.Phi[r]);
          rows.back().push_back(f.m.phi[r]);
        }
      }
      rows.push_back(gradient(*c.integral, z));
      const auto ranked = [&](std::size_t count) {
        Matrix<Multi> a(count, z.size());
        for (std::size_t i = 0; i < count; ++i) {
          const std::vector<Multi> v = test::values(rows[i], at);
          for (std::size_t b = 0; b < z.size(); ++b) a(i, b) = v[b];
        }
        return choose_rows(a, Multi(1e-30)).independent.size();
      };
      EXPECT_EQ(ranked(rows.size()), ranked(rows.size() - 1)) << print(*c.integral, f.model->names, Format::text);
    }
  }
}

TEST(Integrability, OfOneForm) {
  EXPECT_EQ(integrals(found({"x' = r*y'"})), std::vector<std::string>{"x - r*y"});
  EXPECT_EQ(integrals(found({"y*x' - x*y' = 0"})).size(), 1U);
  EXPECT_EQ(found({"x' = z*y'"}).i.flag, (Ints{1, 0}));
  // Velocities cancel.
  EXPECT_EQ(integrals(found({"(x'^2 - y'^2)/(x' - y') = 0"})), std::vector<std::string>{"x + y"});
  // Affine and rheonomic constraints: t counts as a coordinate.
  EXPECT_EQ(found({"y' = x"}).i.flag, (Ints{1, 0}));
  EXPECT_EQ(integrals(found({"y' = 3*t^2"})).size(), 1U);
  EXPECT_EQ(found({"x'*sin(t) + x*cos(t) = 0"}).i.flag, (Ints{1}));
  EXPECT_EQ(integrals(found({"x'*sin(t) + x*cos(t) = 0"})), std::vector<std::string>{"x*sin(t)"});
}

TEST(Integrability, TwoTogetherAndNeitherAlone) {
  const std::vector<std::string> both = {"x' + z*y' = 0", "z' - x*y' = 0"};
  EXPECT_EQ(found({both[0]}).i.flag, (Ints{1, 0}));
  EXPECT_EQ(found({both[1]}).i.flag, (Ints{1, 0}));
  const Found f = found(both);
  EXPECT_EQ(f.i.flag, (Ints{2}));
  EXPECT_TRUE(f.i.proved);
  EXPECT_EQ(f.i.combinations.size(), 2U);
  // A rotated pair has the span of dx and dy.
  const Found rotated = found({"x'*cos(u) + y'*sin(u) = 0", "y'*cos(u) - x'*sin(u) = 0"});
  EXPECT_EQ(integrals(rotated), (std::vector<std::string>{"x", "y"}));
  expect_constant(rotated);
}

TEST(Integrability, OneCombinationOfThree) {
  // A cart on two wheels: one integral combines the angles of the wheels and the heading; no other exists.
  const Found f = found(
      {"x'*sin(z) - y'*cos(z) = 0", "x'*cos(z) + y'*sin(z) + k*z' = r*u'", "x'*cos(z) + y'*sin(z) - k*z' = r*v'"});
  EXPECT_EQ(f.i.flag, (Ints{3, 2, 1}));
  ASSERT_EQ(f.i.combinations.size(), 1U);
  ASSERT_TRUE(f.i.combinations[0].integral);
  EXPECT_TRUE(is_zero(f.i.combinations[0].coefficients[0]));
  EXPECT_FALSE(is_zero(f.i.combinations[0].coefficients[1]));
  expect_constant(f);
}

TEST(Integrability, AfterAnotherIntegralIsPutIn) {
  // The heading is constant, so the knife runs straight.
  const Found f = found({"z' = 0", "x' = r*cos(z)*u'", "y' = r*sin(z)*u'"});
  EXPECT_EQ(f.i.flag, (Ints{3}));
  EXPECT_EQ(integrals(f).size(), 3U);
  for (const IntegrableCombination& c : f.i.combinations) EXPECT_TRUE(c.integral);
  expect_constant(f);
}

TEST(Integrability, OnTheSurfaceOfAHolonomicConstraint) {
  // The form is exact on x = y and not elsewhere.
  const Found f = found({"x - y = 0", "z' = x*u' + u*y'"});
  EXPECT_EQ(f.i.flag, (Ints{1}));
  expect_constant(f);
  EXPECT_EQ(found({"z' = x*u' + u*y'"}).i.flag, (Ints{1, 0}));
}

TEST(Integrability, ForSpecialValuesOfParameters) {
  const Found f = found({"x' = y*z' + one*z*y'"});
  EXPECT_EQ(f.i.flag, (Ints{1}));
  EXPECT_TRUE(f.i.these_values);
  EXPECT_FALSE(found({"x' = k*(y*z' + z*y')"}).i.these_values);
}

TEST(Integrability, OfClassicalSystems) {
  const auto flag = [](const char* model) { return found(test::shipped(model)).i.flag; };
  EXPECT_EQ(flag("zoo/chaplygin-sleigh"), (Ints{1, 0}));
  EXPECT_EQ(flag("zoo/disc"), (Ints{2, 1, 0}));
  EXPECT_EQ(flag("zoo/rattleback"), (Ints{2, 0}));
  EXPECT_EQ(flag("zoo/vertical-disc"), (Ints{2, 1, 0}));
  // Each further trailer is reached by one more bracket.
  EXPECT_EQ(flag("zoo/car-three-trailers"), (Ints{5, 4, 3, 2, 1, 0}));
}

// `rows` is a random mixture of the differentials of functions f_1, f_2 with random coefficients; in `mutant` one
// coefficient is changed.
struct Mixture {
  std::vector<std::string> rows, mutant;
};

Mixture mixture(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto number = [&] { return std::to_string(1 + random() % 5); };
  const std::string a = number(), b = number(), c = number(), d = number();
  const std::string df1 = "(x' + " + a + "*(z*u' + u*z'))", df2 = "(y' + " + b + "*(cos(u)*z*u' + sin(u)*z'))";
  const std::string m1 = "(1 + z^2)", m2 = "(" + c + "*u)", m3 = "x", m4 = "(" + d + " + u)";
  const std::string broken = "(y' + " + b + "*(cos(u)*z*u' + 2*sin(u)*z'))";
  const auto mixed = [&](const std::string& second) {
    return std::vector<std::string>{m1 + "*" + df1 + " + " + m2 + "*" + second + " = 0",
                                    m3 + "*" + df1 + " + " + m4 + "*" + second + " = 0"};
  };
  return {mixed(df2), mixed(broken)};
}

class Mixed : public testing::TestWithParam<std::uint64_t> {};

TEST_P(Mixed, FlagSeesThroughTheMixture) {
  const Mixture mix = mixture(GetParam());
  const Found f = found(mix.rows);
  EXPECT_EQ(f.i.flag, (Ints{2}));
  EXPECT_TRUE(f.i.proved);
  for (const IntegrableCombination& c : f.i.combinations) EXPECT_TRUE(c.integral);
  expect_constant(f);
  // The mutant: f_1 is still an integral, and the only one.
  const Found mutant = found(mix.mutant);
  EXPECT_EQ(mutant.i.flag, (Ints{2, 1}));
  ASSERT_EQ(mutant.i.combinations.size(), 1U);
  expect_constant(mutant);
}

INSTANTIATE_TEST_SUITE_P(Seed, Mixed, testing::Range<std::uint64_t>(1, 7));

}  // namespace
}  // namespace anholon::integrability_test

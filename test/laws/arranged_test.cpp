// The printed equations are the derived ones: for every shipped model, arranged - original is zero.
#include <gtest/gtest.h>

#include "expr/normal.h"
#include "formulation/formulation.h"
#include "print/arrange.h"
#include "support/model_point.h"
#include "support/models.h"

namespace anholon::arranged_test {
namespace {

// 40 digits, terms up to 1e3 and some hundred operations.
constexpr double kExact = 1e-30;

enum class Verdict { proved, same_values, different };

Verdict compare(const Model& model, Expr a, Expr b) {
  if (proved_zero(a - b)) return Verdict::proved;
  const PrecisionScope precision(40);
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const test::Point at = test::random_point(model, seed);
    const double scale = 1 + to_double(abs(test::value(b, at)));
    if (!(to_double(abs(test::value(a - b, at))) / scale <= kExact)) return Verdict::different;
  }
  return Verdict::same_values;
}

Column routh(const Model& model) {
  const Mechanics m = mechanics(model);
  const Equations e = find_formulation("routh")->equations(m, {});
  Column all = e.left;
  all.insert(all.end(), e.right.begin(), e.right.end());
  all.insert(all.end(), m.phi.begin(), m.phi.end());
  return all;
}

class Arranged : public testing::TestWithParam<std::string> {};

TEST_P(Arranged, EquationsAreProvedEqualOrHaveTheSameValues) {
  const std::shared_ptr<const Model> model = test::shipped(GetParam());
  const Column equations = routh(*model);
  std::size_t proofs = 0;
  for (Expr e : equations) {
    const Verdict verdict = compare(*model, arranged(e, model->names), e);
    EXPECT_NE(verdict, Verdict::different) << print(e, model->names, Format::text);
    proofs += verdict == Verdict::proved;
  }
  EXPECT_GE(2 * proofs, equations.size());
}

// A sign that an arrangement loses is noticed.
TEST_P(Arranged, AMutantIsRefuted) {
  const std::shared_ptr<const Model> model = test::shipped(GetParam());
  for (Expr e : routh(*model))
    if (!proved_zero(e)) {
      EXPECT_EQ(compare(*model, arranged(-e, model->names), e), Verdict::different)
          << print(e, model->names, Format::text);
    }
}

INSTANTIATE_TEST_SUITE_P(Model, Arranged, testing::ValuesIn(test::shipped_models()),
                         [](const auto& p) { return test::test_name(p.param); });

}  // namespace
}  // namespace anholon::arranged_test

#include <gtest/gtest.h>

#include "proof/witness.h"
#include "support/models.h"

namespace anholon::witness_test {
namespace {

// exp x - cosh x - sinh x is zero, which only algebra proves. A term of 1e-400 beside it needs more than 400 digits.
TEST(Witness, TellsFromZeroWhatTheDigitsResolve) {
  const auto model =
      test::model_of("coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n");
  Graph& g = *model->graph;
  const Expr x = g.jet(0, 0), zero = exp(x) - cosh(x) - sinh(x);
  Difference d;
  d.left = zero + g.number(parse_rational("1e-400").value());
  const WitnessSearch usual = find_witness(d, Elimination(), *model);
  EXPECT_FALSE(usual.witness.has_value());
  EXPECT_NE(usual.detail.find("zero to "), std::string::npos) << usual.detail;
  const WitnessSearch fine = find_witness(d, Elimination(), *model, 2000);
  ASSERT_TRUE(fine.witness.has_value());
  EXPECT_EQ(fine.detail, "1.00000e-400");
  d.left = zero;
  EXPECT_FALSE(find_witness(d, Elimination(), *model, 2000).witness.has_value());
}

}  // namespace
}  // namespace anholon::witness_test

// The reactions as formulas (theory: elimination). At points of a motion, which are found numerically, they equal the
// multipliers and reactions of that motion, also if a form without multipliers has put in the dependent accelerations.
#include <gtest/gtest.h>

#include "formulation/reactions.h"
#include "setup/eliminate.h"
#include "support/least_norm.h"
#include "support/models.h"
#include "support/motion_point.h"
#include "support/particle_system.h"

namespace anholon::reaction_formulas_test {
namespace {

constexpr double kExact = 1e-26;
constexpr double kRefuted = 1e-6;

class ReactionFormulas : public testing::TestWithParam<unsigned> {
 protected:
  PrecisionScope precision{40};
  std::shared_ptr<const Model> model =
      test::model_of(test::ParticleSystem({4, 2, GetParam(), 2, true}, 40 + GetParam()).text());
  Mechanics m = mechanics(*model);
  std::vector<test::Point> points;

  void SetUp() override {
    const Elimination e = elimination_of_reactions(m, {}, {});
    for (std::uint64_t seed = 1; seed <= 2; ++seed)
      if (auto at = test::motion_point(m, e.dependent, GetParam(), seed)) points.push_back(*at);
    ASSERT_EQ(points.size(), 2U);
  }
  // The relative difference of the values of formulas from those of others.
  double apart(const Column& formulas, const Column& others, const test::Point& at) const {
    const std::vector<Multi> want = test::values(put_masses(*model, others), at);
    return test::largest(test::plus(test::values(put_masses(*model, formulas), at), want, -1)) /
           (1 + test::largest(want));
  }
  static Column flat(const std::vector<Load>& loads) {
    Column out;
    for (const Load& l : loads)
      for (int i = 0; i < 3; ++i) out.push_back(l.force[i]);
    return out;
  }
};

TEST_P(ReactionFormulas, AreTheReactionsOfTheMotion) {
  for (const Formulation* form : formulations()) {
    if (form->unknowns == Unknowns::variational || !obstacle(*form, m).empty()) continue;
    const Elimination e =
        form->eliminates() ? elimination_for(m, form->unknowns, {}, {}) : elimination_of_reactions(m, {}, {});
    const anholon::ReactionFormulas r = reaction_formulas(m, *form, e);
    ASSERT_EQ(r.multipliers.size(), 2U);
    for (const test::Point& at : points) {
      EXPECT_LE(apart(e.in_coordinates(r.multipliers), m.lambda, at), kExact) << form->name;
      EXPECT_LE(apart(e.in_coordinates(r.by_multipliers), m.N, at), kExact) << form->name;
      EXPECT_LE(apart(e.in_coordinates(r.by_motion), m.N, at), kExact) << form->name;
      EXPECT_LE(apart(e.in_coordinates(flat(r.loads)), flat(reactions(*model)), at), kExact) << form->name;
    }
  }
}

// The rows D of the formulas in lambda are those of E - G in all jets; the other rows are so on a motion only.
TEST_P(ReactionFormulas, SolveTheEquationsOfTheDependentCoordinates) {
  const Elimination e = elimination_of_reactions(m, {}, {});
  const anholon::ReactionFormulas r = reaction_formulas(m, *find_formulation("routh"), e);
  const Column N = substitute(r.by_multipliers, [&](NodeId id) {
    for (std::size_t k = 0; k < 2; ++k)
      if (m.lambda[k].id == id) return r.multipliers[k];
    return Expr{};
  });
  const test::Point anywhere = test::random_point(*model, 3);
  EXPECT_LE(apart(e.D(N), e.D(r.by_motion), anywhere), kExact);
  EXPECT_GT(apart(e.I(N), e.I(r.by_motion), anywhere), kRefuted);
  EXPECT_LE(apart(e.I(N), e.I(r.by_motion), points[0]), kExact);
  // A mutant: the inverse is not transposed.
  const Column a_D = e.D(lagrange_operator(m) - forces(m));
  Column wrong;
  for (std::size_t k = 0; k < 2; ++k) wrong.push_back(e.Phi_D_inverse[k][0] * a_D[0] + e.Phi_D_inverse[k][1] * a_D[1]);
  EXPECT_GT(apart(wrong, m.lambda, points[0]), kRefuted);
}

INSTANTIATE_TEST_SUITE_P(Order, ReactionFormulas, testing::Values(0U, 1U, 2U, 3U),
                         [](const auto& p) { return "m" + std::to_string(p.param); });

// Equivalent constraints share one multiplier, and a reaction that an input keeps has none.
TEST(ReactionFormulasOf, RedundantAndServoConstraints) {
  const std::string head =
      "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 2\nposition = [\"x\", \"y\", 0]\n";
  const auto twice = test::model_of(
      head +
      "[[constraint]]\nname = \"c\"\nequation = \"y' = x\"\n[[constraint]]\nname = \"d\"\nequation = \"2*y' = 2*x\"\n");
  const Mechanics m = mechanics(*twice);
  const anholon::ReactionFormulas r =
      reaction_formulas(m, *find_formulation("routh"), elimination_of_reactions(m, {}, {}));
  EXPECT_EQ(is_zero(r.multipliers[0]) + is_zero(r.multipliers[1]), 1);
  const auto servo = test::model_of(head + "[input]\nf = {}\n[[force]]\non = \"p\"\nvector = [\"f\", \"0\", \"0\"]\n"
                                           "[[constraint]]\nname = \"c\"\nequation = \"y' = x\"\n[[constraint]]\nname "
                                           "= \"kept\"\nequation = \"x' = 1\"\nby = \"f\"\n");
  const Mechanics k = mechanics(*servo);
  const anholon::ReactionFormulas s =
      reaction_formulas(k, *find_formulation("routh"), elimination_of_reactions(k, {}, {}));
  EXPECT_TRUE(s.multipliers[0].graph);
  EXPECT_FALSE(s.multipliers[1].graph);
  EXPECT_TRUE(is_zero(s.by_motion[0])) << "no ideal reaction along x";
}

}  // namespace
}  // namespace anholon::reaction_formulas_test

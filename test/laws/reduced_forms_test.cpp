// Every form without multipliers is B^T (E - G) = 0 on the manifold of the constraints, B the tangents found there by numbers;
// at random free higher derivatives, so that those that must cancel do. For every shipped model.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "run/eliminate.h"
#include "support/manifold.h"
#include "support/models.h"

namespace anholon {
namespace {

constexpr double kExact = 1e-26;   // 40 digits, less what a nearly singular point of the manifold takes
constexpr int kPoints = 2;

struct System {
  std::shared_ptr<const Model> model;
  Mechanics m;
  explicit System(std::shared_ptr<const Model> from) : model(std::move(from)), m(mechanics(*model)) {}
  Column put(const Column& c) const { return put_masses(*model, c); }
};

// |residual - B^T (E - G)| in units of the terms, the largest of some points; for n equations without multipliers
// |B^T residual - …|.
double miss(const System& s, const Elimination& e, const Column& residual) {
  const PrecisionScope precision(40);
  const Column a = newton_left_side(s.m) - s.put(forces(s.m)), r = s.put(e.in_coordinates(residual));
  double worst = 0;
  int points = 0;
  for (std::uint64_t seed = 1; seed <= kPoints; ++seed) {
    const std::optional<test::Point> at = test::manifold_point(*s.model, e, seed);
    if (!at) continue;
    ++points;
    const Matrix<Multi> B = test::tangents(*s.model, e, *at);
    const std::vector<Multi> av = test::values(a, *at), rv = test::values(r, *at);
    const auto contracted = [&](const std::vector<Multi>& x, std::size_t k, double& scale) {
      Multi sum(0);
      for (std::size_t i = 0; i < x.size(); ++i) {
        sum += B(i, k) * x[i];
        scale = std::max(scale, std::abs(to_double(B(i, k) * x[i])));
      }
      return sum;
    };
    for (std::size_t k = 0; k < B.cols; ++k) {
      double scale = 1;
      const Multi want = contracted(av, k, scale);
      const Multi have = rv.size() == B.cols ? rv[k] : contracted(rv, k, scale);
      const double off = std::abs(to_double(Multi(have - want))) / scale;
      if (!(off <= worst)) worst = off == off ? off : 1e300;
    }
  }
  EXPECT_GT(points, 0) << "no point of the manifold was found";
  return worst;
}

class ReducedForms : public testing::TestWithParam<std::string> {};

TEST_P(ReducedForms, AreTheContractionOfNewtonsLaw) {
  // All forms of the bicycle take a while: these alone, without ANHOLON_LONG=1.
  const std::set<std::string> quick{"kane", "maggi"};
  const bool quick_only = GetParam() == "zoo/whipple" && !std::getenv("ANHOLON_LONG");
  const System s(test::shipped(GetParam()));
  for (const Formulation* form : formulations()) {
    if (!form->eliminates() || !obstacle(*form, s.m).empty() || (quick_only && !quick.count(form->name))) continue;
    const Elimination e = elimination_for(s.m, form->unknowns, {}, {});
    const Equations q = form->equations(s.m, e);
    EXPECT_LE(miss(s, e, q.left - q.right), kExact) << form->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Model, ReducedForms, testing::ValuesIn(test::shipped_models()),
                         [](const auto& p) { return test::test_name(p.param); });

// As many constraints as coordinates: nothing is left to be said, by no equations. Ends in a crash as long as the product of a
// column and a matrix without columns reads an entry of it (Boltzmann-Hamel's: in an internal fault).
TEST(FullyConstrained, LeavesNoEquations) {
  const System s(test::model_of("coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = \"2\"\nposition = [\"x\", \"y\", \"0\"]\n"
                                "[[constraint]]\nname = \"drive\"\nequation = \"x' = 1\"\n"
                                "[[constraint]]\nname = \"follow\"\nequation = \"y' = x\"\n"));
  for (const Formulation* form : formulations()) {
    if (!form->eliminates() || std::string(form->name) == "udwadia-kalaba") continue;
    for (const bool solve : {true, false}) {
      const Equations q = form->equations(s.m, elimination_for(s.m, form->unknowns, {}, {}, solve));
      EXPECT_TRUE(q.left.empty() && q.right.empty()) << form->name;
    }
  }
}

}  // namespace
}  // namespace anholon

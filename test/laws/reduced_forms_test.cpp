// For every shipped model, every form without multipliers is B^T (E - G) = 0 on the manifold of the constraints, where
// B are tangents that are found numerically. Free higher derivatives are random, so derivatives that must cancel do.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <set>

#include <gtest/gtest.h>

#include "proof/equations_of_motion.h"
#include "setup/eliminate.h"
#include "support/contraction.h"
#include "support/models.h"

namespace anholon::reduced_forms_test {
namespace {

constexpr double kExact = 1e-26;  // 40 digits, less what a nearly singular point of the manifold takes
constexpr int kPoints = 2;

struct System {
  std::shared_ptr<const Model> model;
  Mechanics m;
  explicit System(std::shared_ptr<const Model> from) : model(std::move(from)), m(mechanics(*model)) {}
};

class ReducedForms : public testing::TestWithParam<std::string> {};

TEST_P(ReducedForms, AreTheContractionOfNewtonsLaw) {
  // All forms of the bicycle take long: without ANHOLON_LONG=1 only these are tested.
  const std::set<std::string> quick{"kane", "maggi"};
  const bool quick_only = GetParam() == "zoo/whipple" && !std::getenv("ANHOLON_LONG");
  const System s(test::shipped(GetParam()));
  for (const Formulation* form : formulations()) {
    if (!form->eliminates() || !obstacle(*form, s.m).empty() || (quick_only && !quick.count(form->name))) continue;
    const Elimination e = elimination_for(s.m, form->unknowns, {}, {});
    const Equations q = form->equations(s.m, e);
    EXPECT_LE(test::miss_along_constraints(s.m, e, q.left - q.right, kPoints), kExact) << form->name;
  }
}

INSTANTIATE_TEST_SUITE_P(Model, ReducedForms, testing::ValuesIn(test::shipped_models()),
                         [](const auto& p) { return test::test_name(p.param); });

// The error of equations on motions of the system, relative to their sides. Returns nullopt if no point of a motion is
// found.
std::optional<double> miss_on_motion(EquationsOfMotion& motion, const Column& left, const Column& right) {
  if (motion.on_motion().empty()) return std::nullopt;
  double most = 0;
  for (PointValues& at : motion.on_motion()) {
    double size = 1e-3, miss = 0;
    for (std::size_t a = 0; a < left.size(); ++a) {
      size = std::max({size, std::abs(at(left[a])), std::abs(at(right[a]))});
      miss = std::max(miss, std::abs(at(left[a]) - at(right[a])));
    }
    most = std::max(most, miss / size);
  }
  return most;
}

// The n equations of Udwadia and Kalaba hold the reactions as functions of the state, which no contraction shows. All n
// hold on every motion of Routh's equations; with twice the reactions, whose contraction is the same, they do not hold.
TEST(UdwadiaKalaba, HoldsAcrossTheConstraints) {
  constexpr double kHolds = 1e-7;  // doubles, less the digits that a nearly singular point loses
  const Formulation& form = *find_formulation("udwadia-kalaba");
  int judged = 0;
  for (const std::string& name : test::shipped_models()) {
    const System s(test::shipped(name));
    if (s.m.phi.empty() || !obstacle(form, s.m).empty()) continue;
    EquationsOfMotion motion(s.m, 2, {});
    if (!motion.regular) continue;
    const auto written_out = [&](Column es) {
      for (Expr& e : es) e = put_rates(*s.model, put_masses(*s.model, e));
      return es;
    };
    const Equations q = form.equations(s.m, elimination_for(s.m, form.unknowns, {}, {}));
    const Column left = written_out(q.left), right = written_out(q.right), given = written_out(forces(s.m)),
                 reactions = right - given;
    const std::optional<double> miss = miss_on_motion(motion, left, right);
    if (!miss) continue;
    ++judged;
    EXPECT_LE(*miss, kHolds) << name;
    EXPECT_GT(*miss_on_motion(motion, left, given + reactions + reactions), 100 * kHolds) << name;
  }
  EXPECT_GE(judged, 20);
}

// With as many constraints as coordinates, the forms without multipliers have no equations.
TEST(FullyConstrained, LeavesNoEquations) {
  const System s(test::model_of(
      "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = \"2\"\nposition = [\"x\", \"y\", \"0\"]\n"
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
}  // namespace anholon::reduced_forms_test

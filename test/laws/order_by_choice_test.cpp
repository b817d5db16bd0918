// The order m of a form can be chosen: constraints of lower order are lifted to m, and the equations of order m are
// equivalent to the original ones, also without constraints. Forms with multipliers are E - G - N in all jets for every
// m; the others are B^T (E - G) on the manifold of the lifted constraints, where B are tangents that are found
// numerically.
#include <gtest/gtest.h>

#include "setup/eliminate.h"
#include "support/contraction.h"
#include "support/identity.h"
#include "support/particle_system.h"

namespace anholon::order_by_choice_test {
namespace {

constexpr double kExact = 1e-26;
constexpr double kRefuted = 1e-6;
constexpr unsigned kHighest = 4;

struct Case {
  const char* name;
  std::shared_ptr<const test::System> system;
};

std::vector<Case> cases() {
  static const auto random = [](unsigned order, std::size_t constraints) {
    return std::make_shared<const test::System>(
        test::model_of(test::ParticleSystem({3, 1, order, constraints, order != 2}, 5 + order).text()));
  };
  static const std::vector<Case> list{{"Free", random(0, 0)},
                                      {"Holonomic", random(0, 1)},
                                      {"FirstOrder", random(1, 2)},
                                      {"SecondOrderNonlinear", random(2, 1)},
                                      {"ThirdOrder", random(3, 1)}};
  return list;
}

class OrderByChoice : public testing::TestWithParam<std::size_t> {
 protected:
  const test::System& s = *cases()[GetParam()].system;
  unsigned lowest = highest_order(s.m);
  // E - G - N  at random points, without constraints or with them.
  double miss_in_all_jets(const Equations& q) const {
    return test::miss(s, {q.left, -q.right, -newton_left_side(s.m), forces(s.m), s.m.N});
  }
};

TEST_P(OrderByChoice, FormsWithMultipliersHoldForEveryOrder) {
  int forms = 0;
  for (const Formulation* form : formulations()) {
    if (form->unknowns != Unknowns::multipliers || form->highest_m == 0) continue;
    ++forms;
    for (unsigned m = 1; m <= kHighest; ++m) {
      ASSERT_EQ(order_obstacle(*form, s.m, m), "") << form->name;
      const Elimination asked = Elimination::of_order(m);
      EXPECT_EQ(order_of(s.m, asked), m);
      EXPECT_LE(miss_in_all_jets(form->equations(s.m, asked)), kExact) << form->name << ", m = " << m;
    }
  }
  EXPECT_EQ(forms, 4);
  EXPECT_EQ(order_of(s.m, {}), lowest);
  // A mutant has the factor of another order.
  const Column wrong = Rational(1, 3) * (gradient(T(s.m, 3), jets(*s.model, 3)) - Rational(3) * gradient(s.m.T, s.m.q));
  EXPECT_GT(miss_in_all_jets({wrong, right_side(s.m)}), kRefuted);
}

TEST_P(OrderByChoice, FormsWithoutMultipliersAreTheSameContraction) {
  int forms = 0;
  for (const Formulation* form : formulations()) {
    if (!form->eliminates() || form->highest_m == 0 || !obstacle(*form, s.m).empty()) continue;
    for (unsigned m = 1; m <= kHighest; ++m) {
      if (m < lowest) {
        EXPECT_NE(order_obstacle(*form, s.m, m), "") << form->name << ", m = " << m;
      }
      if (m > form->highest_m) {
        EXPECT_NE(order_obstacle(*form, s.m, m), "") << form->name << ", m = " << m;
      }
      if (m < lowest || m > form->highest_m) continue;
      ASSERT_EQ(order_obstacle(*form, s.m, m), "") << form->name;
      ++forms;
      for (const bool solve : {true, false}) {
        const Elimination e = elimination_for(s.m, form->unknowns, {}, {}, solve, m);
        EXPECT_EQ(e.m, m);
        EXPECT_TRUE(m == lowest || e.solved == solve) << "what is lifted is affine in its highest derivatives";
        const Equations q = form->equations(s.m, e);
        EXPECT_LE(test::miss_along_constraints(s.m, e, q.left - q.right, 1), kExact)
            << form->name << ", m = " << m << (solve ? ", solved" : "");
      }
    }
  }
  EXPECT_GE(forms, 12);
}

// Energies of one order with an elimination of another order give no equations of motion.
class LiftedConstraints : public OrderByChoice {};
TEST_P(LiftedConstraints, EnergiesOfAnotherOrderAreRefuted) {
  const unsigned m = lowest + 1;
  const Elimination e = elimination_for(s.m, Unknowns::coordinates, {}, {}, false, m);
  const Expr before = T(s.m, m - 2), T_before = T(s.m, m - 1);  // of order m - 1
  const Column p = e.D(s.by(m, T_before)), r = e.D(s.by(m - 1, T_before));
  const Rational factor(m), next(m + 1);
  const auto turned = factor * e.f_rate_by_u(), f_by = next * e.f_by(m - 1), f_by_u = e.f_by_u();
  const auto nielsen = [&](Expr below, Expr T_m) {
    const Column first = factor * e.by_u(T_m), second = next * e.I(e.by(m - 1, below)), third = next * (r * f_by_u),
                 fourth = p * (turned - f_by);
    return first - second - third - fourth - e.contract(forces(s.m));
  };
  EXPECT_LE(test::miss_along_constraints(s.m, e, nielsen(T_before, T(s.m, m)), 1), kExact);
  EXPECT_GT(test::miss_along_constraints(s.m, e, nielsen(before, T_before), 1), kRefuted);
}

std::string case_name(const testing::TestParamInfo<std::size_t>& p) { return cases()[p.param].name; }
INSTANTIATE_TEST_SUITE_P(System, OrderByChoice, testing::Range<std::size_t>(0, 5), case_name);
INSTANTIATE_TEST_SUITE_P(System, LiftedConstraints, testing::Range<std::size_t>(1, 5),
                         case_name);  // the systems that have constraints

// Quasi-velocities are lifted with the constraints and keep their own names.
TEST(OrderOfQuasiVelocities, TheirDerivativesStayFree) {
  const auto model = test::model_of(
      "coordinates = [\"x\", \"y\", \"z\"]\n[[particle]]\nname = \"p\"\nmass = 2\nposition = [\"x\", \"y\", \"z\"]\n"
      "[[constraint]]\nname = \"c\"\nequation = \"z'' = y*x'' + x'*y''\"\n[quasi]\nu1 = \"x'\"\n");
  const Mechanics M = mechanics(*model);
  for (const unsigned asked : {0U, 3U}) {
    const Elimination e = elimination_for(M, Unknowns::quasi_velocities, {}, {}, true, asked);
    EXPECT_EQ(e.free.names, (std::vector<std::string>{"u1", "u_y"}));
    EXPECT_EQ(e.free.orders, (std::vector<unsigned>(2, e.m - 1)));
    Labels free = free_labels(M, e);
    EXPECT_EQ(free[0].text, asked ? "u1''" : "u1'");
    EXPECT_EQ(free[1].text, asked ? "u_y''" : "u_y'");
    for (std::size_t a = 0; a < 2; ++a)
      EXPECT_EQ(e.quasi->w[a].id, model->graph->jet(static_cast<std::uint32_t>(a), e.m).id) << "u' = x''";
  }
}

}  // namespace
}  // namespace anholon::order_by_choice_test

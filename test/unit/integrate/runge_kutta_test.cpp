// The coefficients satisfy the order conditions sum_i b_i Phi_i(t) = 1 / gamma(t) for every rooted tree t with up to 8
// nodes (Butcher; Hairer, Nørsett & Wanner 1993, II.2).
#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "integrate/states/dormand_prince.h"

namespace anholon::runge_kutta_test {
namespace {

namespace method = dormand_prince;
using Weights = std::array<long double, method::kStages>;
using Stages = std::array<std::array<long double, method::kStages>, method::kStages>;

// A rooted tree, given by the indices of its subtrees in a list in which smaller trees come first.
struct Tree {
  std::vector<std::size_t> subtrees;
  int nodes = 1;
  long double density = 1;  // gamma
};

std::vector<Tree> trees(int most_nodes) {
  std::vector<Tree> all{{}};
  for (int nodes = 2; nodes <= most_nodes; ++nodes) {
    const std::size_t known = all.size();
    // Subtrees are in falling order, so that each set of them occurs once.
    const std::function<void(Tree, std::size_t, int)> grow = [&](Tree t, std::size_t largest, int left) {
      if (left == 0) {
        for (std::size_t s : t.subtrees) t.nodes += all[s].nodes, t.density *= all[s].density;
        t.density *= t.nodes;
        all.push_back(t);
        return;
      }
      for (std::size_t s = 0; s <= largest; ++s)
        if (all[s].nodes <= left) {
          Tree more = t;
          more.subtrees.push_back(s);
          grow(more, s, left - all[s].nodes);
        }
    };
    grow({}, known - 1, nodes - 1);
  }
  return all;
}

// The order up to which all conditions hold to round-off.
int order(const Stages& a, const Weights& b, int most = 9) {
  // The coefficients are given to about 30 digits and held in 19; the largest are 43.
  constexpr long double kRoundoff = 1e-16L;
  const std::vector<Tree> all = trees(most);
  std::vector<Weights> phi;
  int holds = most;
  for (const Tree& t : all) {
    Weights here;
    here.fill(1);
    for (std::size_t s : t.subtrees)
      for (std::size_t i = 0; i < method::kStages; ++i) {
        long double sum = 0;
        for (std::size_t j = 0; j < method::kStages; ++j) sum += a[i][j] * phi[s][j];
        here[i] *= sum;
      }
    phi.push_back(here);
    long double sum = 0;
    for (std::size_t i = 0; i < method::kStages; ++i) sum += b[i] * here[i];
    if (std::abs(sum - 1 / t.density) > kRoundoff) holds = std::min(holds, t.nodes - 1);
  }
  return holds;
}

Weights fifth() {
  Weights w;
  for (std::size_t i = 0; i < w.size(); ++i) w[i] = method::b[i] - method::e5[i];
  return w;
}

TEST(DormandPrince, TreesAreAllThereAre) {
  std::vector<int> count(10);
  for (const Tree& t : trees(9)) ++count[static_cast<std::size_t>(t.nodes)];
  EXPECT_EQ(count, (std::vector<int>{0, 1, 1, 2, 4, 9, 20, 48, 115, 286}));
}

TEST(DormandPrince, IsOfOrderEight) {
  EXPECT_EQ(order(method::a, method::b), method::kOrder);
  EXPECT_EQ(order(method::a, fifth()), 5);
  EXPECT_EQ(order(method::a, method::b3), 3);
  for (std::size_t i = 0; i < method::kStages; ++i) {
    long double sum = 0;
    for (long double a : method::a[i]) sum += a;
    EXPECT_NEAR(static_cast<double>(sum), static_cast<double>(method::c[i]), 1e-16) << i;
  }
}

// Mutants: a change of any coefficient in its 10th digit must be noticed.
TEST(DormandPrince, EveryCoefficientCounts) {
  for (std::size_t i = 0; i < method::kStages; ++i) {
    if (method::b[i] != 0) {
      Weights b = method::b;
      b[i] *= 1 + 1e-10L;
      EXPECT_LT(order(method::a, b), method::kOrder) << "b " << i;
    }
    for (std::size_t j = 0; j < i; ++j)
      if (method::a[i][j] != 0) {
        Stages a = method::a;
        a[i][j] *= 1 + 1e-10L;
        EXPECT_LT(order(a, method::b), method::kOrder) << "a " << i << " " << j;
      }
  }
}

}  // namespace
}  // namespace anholon::runge_kutta_test

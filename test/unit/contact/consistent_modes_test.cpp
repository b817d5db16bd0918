#include <array>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "contact/law/consistent_modes.h"

namespace anholon {

// A block of mass 1 on a floor under gravity g = 10, pushed along the floor by `push`.
static ContactProblem block(long double push, long double friction) {
  ContactProblem p;
  p.A = {{1, 0}, {0, 1}};
  p.b = {-push, 10};
  ContactRows rows;
  rows.normal = {0, 1};
  rows.tangential = {{1, 0}};
  rows.friction = rows.static_friction = friction;
  rows.rough = true;
  p.contacts = {rows};
  return p;
}

TEST(ContactLaw, BlockSticksOrSlipsByTheConeOfFriction) {
  const auto sticks = consistent_modes(block(2, 0.25L));
  ASSERT_EQ(sticks.size(), 1U);
  EXPECT_EQ(sticks[0].modes[0].touch, Touch::sticks);
  EXPECT_EQ(sticks[0].x[0], 0);
  const auto slips = consistent_modes(block(3, 0.25L));
  ASSERT_EQ(slips.size(), 1U);
  EXPECT_EQ(slips[0].modes[0].touch, Touch::slips);
  EXPECT_NEAR(static_cast<double>(slips[0].x[0]), 0.5, 1e-15);
  // The mutant: with another coefficient the same push does not slip.
  EXPECT_EQ(consistent_modes(block(3, 0.35L))[0].modes[0].touch, Touch::sticks);
}

TEST(ContactLaw, LargeFrictionIsNotSingular) {
  ContactProblem p = block(2e10L, 1e9L);
  const auto list = consistent_modes(p);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].modes[0].touch, Touch::slips);
}

// At the limit of friction the acceleration is zero up to the round-off of the forces, of either sign.
TEST(ContactLaw, BlockAtTheLimitOfFrictionSlips) {
  for (const long double off : {-1e-17L, 0.0L, 1e-17L}) {
    ContactProblem p = block(2.5L + off, 0.25L);
    p.contacts[0].may_stick = false;
    const auto list = consistent_modes(p);
    ASSERT_EQ(list.size(), 1U);
    EXPECT_EQ(list[0].modes[0].direction[0], 1);
  }
}

TEST(ContactLaw, BlockThatIsLiftedOpens) {
  ContactProblem p = block(0, 0.25L);
  p.b[1] = -1;
  const auto list = consistent_modes(p);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].modes[0].touch, Touch::open);
}

// Contacts at rest in space, in coordinates whose mass matrix is 1; `rates` are the accelerations of the rows without
// forces.
static ContactProblem at_rest_in_space(const std::vector<std::vector<long double>>& rows,
                                       const std::vector<long double>& rates, long double friction) {
  ContactProblem p;
  const std::size_t n = rows[0].size();
  p.A.assign(n, std::vector<long double>(n, 0));
  for (std::size_t i = 0; i < n; ++i) p.A[i][i] = 1;
  p.b.assign(n, 0);
  for (std::size_t k = 0; k < rows.size(); k += 3) {
    ContactRows c;
    c.normal = rows[k];
    c.tangential = {rows[k + 1], rows[k + 2]};
    c.normal_rate = rates[k];
    c.tangential_rate = {rates[k + 1], rates[k + 2]};
    c.friction = c.static_friction = friction;
    c.rough = true;
    c.direction = {1, 0};
    p.contacts.push_back(std::move(c));
  }
  return p;
}

// The corner of a box hardly slips: its acceleration has the direction of the slip only at angles very near to it. An
// iteration that projects the forces on the cone of friction gives the reference.
TEST(ContactLaw, SlipThatHardlyBeginsIsFound) {
  const auto list = consistent_modes(at_rest_in_space({{-2.401L, 0, 0}, {0.346L, 1.964L, 0}, {0.624L, -0.735L, 1.151L}},
                                                      {-10, 0.875L, 0.26L}, 0.892L));
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].modes[0].touch, Touch::slips);
  EXPECT_NEAR(static_cast<double>(list[0].normal[0]), 2.3573894314911823, 1e-14);
  EXPECT_NEAR(static_cast<double>(list[0].modes[0].direction[0]), -0.004068133078026337 / 0.00990943, 1e-5);
}

// A rigid body that rests on one corner is struck at another one. Contacts at rest have a solution for every
// coefficient of friction.
TEST(ContactLaw, BodyThatRestsOnOneCornerIsStruckAtAnother) {
  std::mt19937 random(5);
  const auto number = [&](long double from, long double to) {
    return from + (to - from) * static_cast<long double>(random()) / 4294967296.0L;
  };
  for (int k = 0; k < 200; ++k) {
    std::array<long double, 3> root;
    for (long double& r : root) r = number(1, 8);
    const long double height = number(0.05L, 0.5L);
    std::vector<std::vector<long double>> rows;
    for (int c = 0; c < 2; ++c) {
      const long double x = number(-0.5L, 0.5L), y = number(-0.5L, 0.5L), z = -height;
      rows.push_back({0, 0, 1, y * root[0], -x * root[1], 0});
      rows.push_back({1, 0, 0, 0, z * root[1], -y * root[2]});
      rows.push_back({0, 1, 0, -z * root[0], 0, x * root[2]});
    }
    const auto list = consistent_modes(
        at_rest_in_space(rows, {-1, number(-0.02L, 0.02L), number(-0.02L, 0.02L), 0, 0, 0}, k % 2 == 0 ? 0.9L : 0.6L));
    EXPECT_EQ(list.size(), 1U) << k;
  }
}

// A box of mass 1 that slides on one of its faces and turns. One part of its loads exerts nothing along the gaps;
// friction makes the motion depend on this part, and the least one is taken.
static ContactProblem sliding_box(const std::array<long double, 3>& half, const std::array<long double, 3>& v,
                                  long double friction) {
  ContactProblem p;
  p.A.assign(6, std::vector<long double>(6, 0));
  for (std::size_t i = 0; i < 3; ++i) {
    p.A[i][i] = 1;
    p.A[3 + i][3 + i] = (half[0] * half[0] + half[1] * half[1] + half[2] * half[2] - half[i] * half[i]) / 3;
  }
  p.b = {0, 0, 10, 0, 0, 0};
  for (int corner = 0; corner < 4; ++corner) {
    const long double x = corner < 2 ? -half[0] : half[0], y = corner % 2 == 0 ? -half[1] : half[1], z = -half[2];
    ContactRows c;
    c.normal = {0, 0, 1, y, -x, 0};
    c.tangential = {{1, 0, 0, 0, z, -y}, {0, 1, 0, -z, 0, x}};
    const long double u[] = {v[0] - v[2] * y, v[1] + v[2] * x}, size = std::hypot(u[0], u[1]);
    c.direction = {u[0] / size, u[1] / size};
    c.friction = c.static_friction = friction;
    c.rough = c.moves = true;
    p.contacts.push_back(std::move(c));
  }
  return p;
}

TEST(ContactLaw, BoxThatSlidesOnItsFaceHasOneMotion) {
  std::mt19937 random(3);
  const auto number = [&](long double from, long double to) {
    return from + (to - from) * static_cast<long double>(random()) / 4294967296.0L;
  };
  std::size_t on_three = 0;
  for (int k = 0; k < 400; ++k) {
    const std::array<long double, 3> half{number(0.1L, 0.5L), number(0.1L, 0.5L), number(0.1L, 0.3L)};
    const std::array<long double, 3> v{number(-1, 1), number(-1, 1), number(-5, 5)};
    const auto list = consistent_modes(sliding_box(half, v, number(0.1L, 0.9L)));
    ASSERT_EQ(list.size(), 1U) << k;
    const auto& N = list[0].normal;
    // The part without effect is the sum of the loads of two opposite corners minus that of the others.
    const long double part = std::abs(N[0] - N[1] - N[2] + N[3]);
    if (part < 1e-12L) continue;
    ++on_three;
    EXPECT_TRUE(N[0] == 0 || N[1] == 0 || N[2] == 0 || N[3] == 0) << k;
  }
  EXPECT_GT(on_three, 5U);
}

// An impact in space on one contact has a solution for every friction, since the rows are independent: a direction of
// slip is found for any mass matrix.
TEST(ContactLaw, ImpactInSpaceHasADirectionOfSlip) {
  std::mt19937 random(7);
  const auto number = [&] { return static_cast<long double>(random()) / 2147483648.0L - 1; };
  std::size_t slips = 0;
  constexpr long double kFrictions[] = {0.2L, 0.5L, 1, 1.5L};
  for (int k = 0; k < 2000; ++k) {
    ContactProblem p;
    std::vector<std::vector<long double>> root(6, std::vector<long double>(6));
    for (auto& row : root)
      for (long double& x : row) x = number();
    p.A.assign(6, std::vector<long double>(6, 0));
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t l = 0; l < 6; ++l) p.A[i][j] += root[i][l] * root[j][l] + (i == j ? 0.2L : 0);
    p.b.assign(6, 0);
    ContactRows rows;
    rows.tangential.resize(2);
    for (auto* row : {&rows.normal, &rows.tangential[0], &rows.tangential[1]})
      for (int i = 0; i < 6; ++i) row->push_back(number());
    rows.normal_rate = -1;
    rows.tangential_rate = {3 * number(), 3 * number()};
    rows.friction = rows.static_friction = kFrictions[k % 4];
    rows.rough = true;
    rows.direction = {1, 0};
    p.contacts = {rows};
    const auto list = consistent_modes(p);
    ASSERT_GE(list.size(), 1U) << k;
    for (const ContactSolution& s : list) {
      if (s.modes[0].touch != Touch::slips) continue;
      ++slips;
      long double v[2];
      for (std::size_t a = 0; a < 2; ++a) {
        v[a] = rows.tangential_rate[a];
        for (std::size_t i = 0; i < 6; ++i) v[a] += rows.tangential[a][i] * s.x[i];
      }
      const auto& d = s.modes[0].direction;
      EXPECT_GT(v[0] * d[0] + v[1] * d[1], 0);
      EXPECT_NEAR(static_cast<double>((v[0] * d[1] - v[1] * d[0]) / std::hypot(v[0], v[1])), 0, 1e-8);
    }
  }
  EXPECT_GT(slips, 100U);
}

// Painlevé's rod of mass 1 and length 2 that slides at the angle theta: beyond the critical friction the effective mass
// is negative, and no mode, or several, are consistent.
static std::size_t rod_modes(long double friction, long double spin) {
  const long double c = 0.6L, s = 0.8L;  // cos and sin of theta
  ContactProblem p;
  p.A = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1.0L / 3}};
  p.b = {0, 10, 0};
  ContactRows rows;
  rows.normal = {0, 1, -c};
  rows.tangential = {{1, 0, s}};
  rows.normal_rate = s * spin * spin;
  rows.friction = rows.static_friction = friction;
  rows.rough = rows.moves = true;
  rows.direction = {-1, 0};  // the sense in which friction presses the rod into the floor
  p.contacts = {rows};
  return consistent_modes(p).size();
}

TEST(ContactLaw, PainleveRodHasOneMotionBelowTheCriticalFriction) {
  // 1 + 3 c^2 - 3 mu c s = 0
  const long double critical = (1 + 3 * 0.36L) / (3 * 0.48L);
  EXPECT_EQ(rod_modes(critical - 1e-3L, 0), 1U);
  EXPECT_EQ(rod_modes(critical + 1e-3L, 0), 0U);
  EXPECT_EQ(rod_modes(critical + 1e-3L, 5), 2U);
  EXPECT_EQ(rod_modes(critical - 1e-3L, 5), 1U);
}

}  // namespace anholon

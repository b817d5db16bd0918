// Straight-line code in pairs of doubles agrees with Quad and long double in every tier and has the same bits in all
// lanes; the map of quasi-velocities in pairs agrees with the one in long double.
#include <cmath>
#include <cstring>
#include <random>

#include <gtest/gtest.h>

#include "kernel/arithmetic.h"
#include "kernel/pairs.h"
#include "kernel/state_map.h"
#include "motion/motion.h"
#include "numeric/quad.h"
#include "support/models.h"

namespace anholon::pairs_test {
namespace {

// Makes one step of the kind `act` in all lanes of a tier; sine and cosine go to places 1 and 2.
std::vector<double> run(const Tier& tier, PairProgram::Act act, const std::vector<std::array<double, 2>>& a,
                        const std::array<double, 2>& b) {
  const auto lanes = static_cast<std::size_t>(tier.lanes);
  PairProgram program;
  program.places = 3;
  program.steps = act == PairProgram::Act::sine_cosine ? std::vector<PairProgram::Step>{{act, 1, 0, 2}}
                                                       : std::vector<PairProgram::Step>{{act, 2, 0, 1}};
  if (act == PairProgram::Act::linear) {
    program.terms = {{1, 0, 0}, {1, 0, 1}};
    program.steps = {{act, 2, 0, 0, 0, 2}};
  }
  alignas(64) double numbers[3 * 2 * 8] = {};
  for (std::size_t lane = 0; lane < lanes; ++lane)
    for (std::size_t k = 0; k < 2; ++k) {
      numbers[k * lanes + lane] = a[lane % a.size()][k];
      numbers[(2 + k) * lanes + lane] = b[k];
    }
  (tier.lanes == 1   ? run_pairs_plain
   : tier.lanes == 4 ? run_pairs_avx2
                     : run_pairs_avx512)(program, numbers, [](std::uint32_t) {});
  return {numbers, numbers + 6 * lanes};
}

Quad sum(const std::vector<double>& numbers, const Tier& tier, std::size_t place, std::size_t lane = 0) {
  const auto lanes = static_cast<std::size_t>(tier.lanes);
  return static_cast<Quad>(numbers[2 * place * lanes + lane]) + numbers[(2 * place + 1) * lanes + lane];
}

double relative(Quad have, Quad want) { return static_cast<double>(abs((have - want) / want)); }

std::array<double, 2> random_pair(std::mt19937_64& random, int most_exponent) {
  const double high = std::ldexp(static_cast<double>(random() >> 11) - 0x1p52,
                                 -52 + static_cast<int>(random() % 8) + most_exponent - 8);
  const double low = high * 0x1p-54 * (static_cast<double>(random() >> 11) * 0x1p-52 - 1);
  return {high + low, low - ((high + low) - high)};
}

TEST(Pairs, AreKnownToTwiceTheDigits) {
  using Act = PairProgram::Act;
  std::mt19937_64 random(1);
  for (const Tier& tier : tiers())
    for (int i = 0; i < 20'000; ++i) {
      const auto a = random_pair(random, 10), b = random_pair(random, 10);
      const Quad x = static_cast<Quad>(a[0]) + a[1], y = static_cast<Quad>(b[0]) + b[1];
      ASSERT_LT(relative(sum(run(tier, Act::multiply, {a}, b), tier, 2), x * y), 0x1p-100) << tier.name;
      ASSERT_LT(relative(sum(run(tier, Act::divide, {a}, b), tier, 2), x / y), 0x1p-98) << tier.name;
      const Quad left = sum(run(tier, Act::linear, {a}, b), tier, 2) - (x + y);
      ASSERT_LT(static_cast<double>(abs(left) / (abs(x) + abs(y))), 0x1p-100) << tier.name;
    }
}

// The error is measured by the size of the pair or, near a zero of the function, by that of the angle.
TEST(Pairs, HaveSinesOfLongDoubles) {
  using Act = PairProgram::Act;
  std::mt19937_64 random(2);
  for (const Tier& tier : tiers())
    for (int i = 0; i < 20'000; ++i) {
      auto a = random_pair(random, i % 26);
      if (i % 3 == 0) a[0] = std::round(a[0] / M_PI_2) * M_PI_2, a[1] = 0;
      const Quad x = static_cast<Quad>(a[0]) + a[1];
      const std::vector<double> found = run(tier, Act::sine_cosine, {a}, {});
      ASSERT_LE(static_cast<double>(abs(sum(found, tier, 1) - sin(x))), 0x1p-65 * std::min(1.0, std::abs(a[0])))
          << tier.name << ' ' << a[0];
      ASSERT_LT(static_cast<double>(abs(sum(found, tier, 2) - cos(x))), 0x1p-65) << tier.name << ' ' << a[0];
    }
}

TEST(Pairs, HaveTheSameBitsInAllLanesAndTiers) {
  using Act = PairProgram::Act;
  std::mt19937_64 random(3);
  for (int i = 0; i < 2'000; ++i) {
    std::vector<std::array<double, 2>> many;
    for (int k = 0; k < 8; ++k) many.push_back(random_pair(random, k == 5 ? 40 : 3 * k));
    const auto b = random_pair(random, 3);
    for (const Act act : {Act::linear, Act::multiply, Act::divide, Act::sine_cosine})
      for (const Tier& tier : tiers()) {
        const std::vector<double> together = run(tier, act, many, b);
        for (std::size_t lane = 0; lane < static_cast<std::size_t>(tier.lanes); ++lane) {
          const std::vector<double> alone = run(tiers().front(), act, {many[lane]}, b);
          for (std::size_t k = 2; k < 6; ++k)
            ASSERT_EQ(together[k * static_cast<std::size_t>(tier.lanes) + lane], alone[k]) << tier.name;
        }
      }
  }
}

// Velocities from quasi-velocities along a motion agree with those of the reader in long double to its round-off, alone
// and beside other lanes. The models hold sines, quotients, roots and powers.
class MapsOf : public testing::TestWithParam<const char*> {};

TEST_P(MapsOf, AreThoseOfTheReaderInLongDouble) {
  Scenario prepared;
  ASSERT_TRUE(
      make_scenario(test::model_of(test::shipped_text(GetParam())), *find_formulation("routh"), {}, prepared).ok());
  Workspace s(prepared);
  Motion<double> motion(s, StepSettings{natural_logarithm(Rational(1, 1'000'000'000)), 0, 1000, {}, true}, {}, 0);
  ASSERT_TRUE(motion.start({}).ok());
  ASSERT_TRUE(motion.plan() && motion.plan()->map()) << "the kernel has no unknowns of its own";
  const auto parameters = parameter_values<long double>(*s.model);
  const int lanes = tiers().back().lanes;
  StateReader reader(*motion.plan()->map(), parameters);
  StateReaders readers(*motion.plan()->map(), parameters, lanes);
  std::vector<long double> state, own, leading, expected, found;
  int compared = 0;
  for (int step = 0; step < 40; ++step) {
    ASSERT_TRUE(motion.step(100).ok());
    const auto& stepper = motion.stepper();
    const auto t_of = [&](int lane) {
      return stepper.before() + (stepper.time() - stepper.before()) * static_cast<long double>(lane) / lanes;
    };
    std::vector<std::vector<long double>> owns;
    for (int lane = 0; lane < lanes; ++lane) {
      stepper.foretell(t_of(lane), state, own, leading);
      ASSERT_NE(state.empty(), own.empty());
      if (!own.empty()) readers.load(lane, t_of(lane), own), owns.push_back(own);
    }
    if (owns.empty()) continue;  // the reference made this step
    ++compared;
    readers.convert();
    for (int lane = 0; lane < lanes; ++lane) {
      const auto& from = owns[static_cast<std::size_t>(lane)];
      reader.motion(t_of(lane), from, expected);
      readers.motion(lane, from, found);
      ASSERT_EQ(found.size(), expected.size());
      long double size = 1;
      for (const long double x : expected) size = std::max(size, std::abs(x));
      for (std::size_t i = 0; i < found.size(); ++i) ASSERT_NEAR(found[i], expected[i], 0x1p-58L * size) << i;
    }
  }
  EXPECT_GT(compared, 20);
}

INSTANTIATE_TEST_SUITE_P(Zoo, MapsOf, testing::Values("zoo/disc", "zoo/snakeboard", "zoo/chaplygin-sleigh"));

}  // namespace
}  // namespace anholon::pairs_test

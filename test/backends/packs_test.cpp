// Isomorphic steps of one motion in lanes: which series share a vector, and that the bits are those of steps one by
// one.
#include <cmath>
#include <cstdlib>
#include <set>

#include <gtest/gtest.h>

#include "jit/packed_memory.h"
#include "jit/packs.h"
#include "kernel/kernel.h"
#include "motion/representation.h"
#include "simulation/simulate.h"
#include "support/compiler.h"
#include "support/models.h"
#include "support/random_system.h"

namespace anholon::packs_test {
namespace {

constexpr unsigned kWidth = 4;

struct Motion {
  explicit Motion(const std::shared_ptr<const Model>& model, int stages = 12) {
    Outcome o = make_scenario(model, *find_formulation("routh"), {}, prepared);
    scenario.emplace(prepared);
    if (o.ok()) o = initial_state(*scenario, {}, start);
    if (!o.ok()) return;
    parameters = parameter_values<long double>(*scenario->model);
    plan = KernelPlan::make(std::make_shared<const Program>(program(scenario->system, scenario->structure)), stages,
                            parameters, static_cast<double>(start.t), {start.state.begin(), start.state.end()});
  }
  void begin(Kernel& k) const {
    k.set_parameters(0, parameters);
    k.place(0, start.state, start.leading);
    k.set_time(0, static_cast<double>(start.t));
    k.begin();
  }
  Scenario prepared;
  std::optional<Workspace> scenario;
  std::vector<long double> parameters;
  Start<long double> start;
  std::shared_ptr<const KernelPlan> plan;
};

std::shared_ptr<const Model> chain(int links) {
  return test::model_of(test::replaced(test::shipped_text("zoo/chain"), "n = 4", "n = " + std::to_string(links)));
}

// In the packs of every shipped model, the series that lie side by side are those that the lanes need.
TEST(Packs, HoldEachSumOnceInTheLanesOfItsSeries) {
  std::size_t packed = 0;
  for (const std::string& name : test::moving_models()) {
    const auto model = test::shipped(name);
    if (not_integrated(*model)) continue;
    const Motion m(model);
    if (!m.plan) continue;
    const jit::Packs packs = jit::choose_packs(m.plan->plan(), kWidth);
    std::set<jit::Convolution> all, seen;
    for (const Step& s : m.plan->plan().stage)
      for (const jit::Convolution& c : jit::convolutions(s)) all.insert(c);
    for (const jit::Packs::Pack& pack : packs.packs) {
      ASSERT_EQ(pack.lanes.size(), kWidth) << name;
      unsigned count = 0;
      std::set<int> leads;
      for (unsigned l = 0; l < kWidth; ++l) {
        if (!pack.lanes[l]) continue;
        ++count;
        leads.insert(pack.lanes[l]->lead);
        EXPECT_EQ(packs.bundles[pack.a].at[l], pack.lanes[l]->a) << name;
        EXPECT_EQ(packs.bundles[pack.b].at[l], pack.lanes[l]->b) << name;
        EXPECT_TRUE(all.count(*pack.lanes[l])) << name;
        EXPECT_TRUE(seen.insert(*pack.lanes[l]).second) << name;
      }
      EXPECT_GE(count, jit::fewest_lanes(kWidth)) << name;
      EXPECT_EQ(leads.size(), 1U) << name;
      packed += count;
    }
    // A series is known up to the same order in all lanes.
    std::map<std::uint32_t, std::set<int>> newest;
    for (const jit::Packs::Bundle& b : packs.bundles)
      for (const std::uint32_t at : b.at)
        if (at != jit::Packs::kNobody) newest[at].insert(b.newest);
    for (const auto& [at, orders] : newest) EXPECT_EQ(orders.size(), 1U) << name;
    const jit::PackedMemory memory(m.plan->plan(), packs, kWidth, {all.begin(), all.end()});
    EXPECT_EQ(memory.alone().size() + seen.size(), all.size()) << name;
    std::set<std::uint32_t> taken;
    for (const jit::Convolution& c : all) {
      const jit::PackedMemory::Sums& s = memory.sums(c);
      for (std::uint32_t i = 0; i < 2 * kBlock; ++i)
        EXPECT_TRUE(taken.insert(s.at + s.step * i).second && s.at + s.step * i < memory.size()) << name;
    }
  }
  EXPECT_GT(packed, 500U);
}

// Eight links have two packs of sines and two of cosines, and as many of their products with the tensions. The sines
// and cosines of four links share their angles; the products share the sines and cosines.
TEST(Packs, FollowTheLinksOfAChain) {
  Motion m(chain(8));
  ASSERT_TRUE(m.plan);
  const std::vector<double> state(m.start.state.begin(), m.start.state.end());
  m.plan =
      cheapest(representations({m.plan, m.scenario->structure, {}, m.parameters, 0, state, m.scenario->mechanics.get()},
                               WritingEffort::very_long_motion))
          .plan;
  const jit::Packs packs = jit::choose_packs(m.plan->plan(), kWidth);
  std::size_t sums = 0;
  for (const Step& s : m.plan->plan().stage) sums += jit::convolutions(s).size();
  std::size_t full = 0, shared = 0;
  for (const jit::Packs::Pack& p : packs.packs)
    full += std::count_if(p.lanes.begin(), p.lanes.end(), [](const auto& c) { return c.has_value(); }) == kWidth;
  EXPECT_EQ(packs.packs.size(), sums / kWidth);
  EXPECT_EQ(full, packs.packs.size());
  for (std::size_t i = 0; i < packs.packs.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      shared += packs.packs[i].a == packs.packs[j].a || packs.packs[i].a == packs.packs[j].b;
  EXPECT_EQ(shared, 6U);
}

void expect_same_bits(const Motion& m, const std::string& what) {
  Kernel tables(m.plan);
  m.begin(tables);
  if (test::compiler_expected()) {
    ASSERT_EQ(m.plan->compile({}), "") << what;
  }
  Kernel compiled(m.plan);
  m.begin(compiled);
  const Plan& plan = m.plan->plan();
  for (std::size_t j = 0; j < plan.x.size(); ++j)
    for (int order = 0; order <= plan.stages + plan.d[j]; ++order) {
      const double x = tables.coefficient(j, order), y = compiled.coefficient(j, order);
      EXPECT_TRUE(x == y || (std::isnan(x) && std::isnan(y)))
          << what << " " << j << " " << order << ": " << x << " " << y;
    }
}

// The packs change the time only, also for numbers of links that fill no vector, orders that fill no block and chains
// of unequal links.
TEST(Packs, ChangeNoBit) {
  const std::string text = test::shipped_text("zoo/chain");
  std::string uneven = test::replaced(text, "l = 0.2", "\"l[i]\" = 0.2");
  uneven = test::replaced(uneven, "P[i-1] + l*(", "P[i-1] + l[i]*(");
  uneven = test::replaced(uneven, "m = 0.1", "\"m[i]\" = 0.1");
  uneven = test::replaced(uneven, "mass = \"m\"", "mass = \"m[i]\"");
  for (const std::string& one : {text, uneven})
    for (const auto& [links, stages] : {std::pair(2, 11), {3, 9}, {5, 12}, {7, 18}, {9, 10}, {13, 23}}) {
      const Motion m(test::model_of(test::replaced(one, "n = 4", "n = " + std::to_string(links))), stages);
      ASSERT_TRUE(m.plan) << links;
      expect_same_bits(m, std::to_string(links) + " links");
    }
}

// Plans whose code is in pieces, with orders that fill no block, one block or several, with refined solutions and
// without.
TEST(Pieces, ChangeNoBit) {
  const std::string text = test::shipped_text("zoo/chain");
  int all = 0, refined = 0;
  for (const auto& [links, stages] : {std::pair(90, 3), {90, 4}, {90, 7}, {100, 12}, {130, 19}, {450, 6}}) {
    const Motion m(test::model_of(test::replaced(text, "n = 4", "n = " + std::to_string(links))), stages);
    ASSERT_TRUE(m.plan) << links;
    EXPECT_NE(m.plan->tables().sums, 0U) << links;
    refined += m.plan->tables().refine;
    ++all;
    expect_same_bits(m, std::to_string(links) + " links");
    if (test::compiler_expected()) {
      EXPECT_TRUE(!m.plan->code() && m.plan->code_of_stages()) << links;
    }
  }
  EXPECT_GT(refined, 0);
  EXPECT_LT(refined, all);
}

TEST(Packs, ChangeNoBitOfRandomSystems) {
  const std::uint64_t wanted = std::getenv("ANHOLON_LONG") ? 60 : 6;
  std::uint64_t compared = 0;
  for (std::uint64_t seed = 1; compared < wanted && seed < 4 * wanted; ++seed) {
    const test::RandomSystem system(seed);
    const Motion m(test::model_of(system.text()), 9 + static_cast<int>(seed % 7));
    if (!m.plan) continue;  // its start has no solution, or its leading derivatives enter nonlinearly
    expect_same_bits(m, "seed " + std::to_string(seed));
    ++compared;
  }
  EXPECT_EQ(compared, wanted);
}

}  // namespace
}  // namespace anholon::packs_test

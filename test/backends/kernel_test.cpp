// The Taylor coefficients of every shipped model, at its start and along its motion, agree in all backends: the
// interpreted tape (the reference), the kernel in every tier of this machine, in lanes, and machine code.
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "kernel/kernel.h"
#include "motion/representation.h"
#include "simulation/simulate.h"
#include "support/chain.h"
#include "support/compiler.h"
#include "support/models.h"

namespace anholon::kernel_test {
namespace {

constexpr int kStages = 12;

// The shipped models without a kernel, and those without machine code, each with the reason.
using Reasons = std::map<std::string, std::string>;
constexpr const char *kNonlinear = "the leading derivatives enter nonlinearly",
                     *kLarge = "it is too large to be compiled in a short time";
const Reasons kWithoutKernel{{"zoo/constant-acceleration", kNonlinear},
                             {"zoo/constant-jerk", kNonlinear},
                             {"zoo/constant-jerk-central", kNonlinear},
                             {"zoo/rheonomic-order-2", kNonlinear},
                             {"zoo/rheonomic-order-3", kNonlinear}};
const Reasons kNotCompiled{{"zoo/whipple", kLarge}, {"asked/uneven-street", kLarge}};

// Models whose code takes seconds to compile: in lanes, their motions are compared under ANHOLON_LONG=1 only.
const std::set<std::string> kLongest{"zoo/rattleback", "zoo/spherical-robot", "papers/luo-zhao-example-1"};

// Models that have a kernel in quasi-velocities, which is compared in its own unknowns.
const std::string kInQuasi = "in quasi-velocities: ";
const std::vector<std::string> kQuasi{
    kInQuasi + "zoo/disc",       kInQuasi + "zoo/chaplygin-sleigh",  kInQuasi + "zoo/trailers",
    kInQuasi + "zoo/snakeboard", kInQuasi + "zoo/ball-on-turntable", kInQuasi + "zoo/vertical-disc"};

std::vector<std::string> shipped_except(const std::vector<Reasons>& lists) {
  std::vector<std::string> names;
  for (const std::string& name : test::moving_models())
    if (std::none_of(lists.begin(), lists.end(), [&](const Reasons& list) { return list.count(name) > 0; }))
      names.push_back(name);
  return names;
}

struct Reference {
  explicit Reference(const std::shared_ptr<const Model>& model) : quasi(false), why(set_up(model)) {}
  explicit Reference(const std::string& name)
      : quasi(name.starts_with(kInQuasi)), why(set_up(test::shipped(quasi ? name.substr(kInQuasi.size()) : name))) {}
  std::string set_up(const std::shared_ptr<const Model>& model) {
    if (const auto diagnostic = not_integrated(*model)) return diagnostic->message;
    Outcome o = make_scenario(model, *find_formulation("routh"), {}, prepared);
    scenario.emplace(prepared);
    if (o.ok()) o = initial_state(*scenario, {}, start);
    if (!o.ok()) return o.message;
    stepping = std::make_shared<const Program>(program(scenario->system, scenario->structure));
    parameters = parameter_values<long double>(*scenario->model);
    if (quasi) {
      motion_start = start;
      derived = std::exchange(stepping, nullptr);
      const auto own = plan();
      if (!own) return "it has none";
      stepping = {own, &own->program()};
      StateReader(*own->map(), parameters).own(start.t, motion_start.state, start.state);
      start.leading.assign(stepping->unknowns(), 0);
    }
    return no_plan(*stepping);
  }
  // Returns a new plan at each call.
  std::shared_ptr<const KernelPlan> plan() const {
    const double t = static_cast<double>(start.t);
    if (!quasi) return KernelPlan::make(stepping, kStages, parameters, t, narrow(start.state));
    for (const Representation& r : representations(
             KernelPlan::make(derived, kStages, parameters, t, narrow(motion_start.state)), WritingEffort::at_once))
      if (r.writing == Writing::quasi) return r.plan;
    return nullptr;
  }
  std::vector<Representation> representations(const std::shared_ptr<const KernelPlan>& of, WritingEffort effort) const {
    const std::vector<double> state = narrow(quasi ? motion_start.state : start.state);
    return anholon::representations(
        {of, scenario->structure, {}, parameters, static_cast<double>(start.t), state, scenario->mechanics.get()},
        effort);
  }
  static std::vector<double> narrow(const std::vector<long double>& v) { return {v.begin(), v.end()}; }

  bool quasi;
  Scenario prepared;
  std::optional<Workspace> scenario;
  std::shared_ptr<const Program> stepping, derived;
  std::vector<long double> parameters;
  Start<long double> start, motion_start;
  std::string why;  // the reason why there is no kernel, or empty
};

// The largest difference of the coefficients, in units of the largest coefficient of the same order.
template <class Coefficient>
double difference(const KernelPlan& plan, const Expansion<long double>& reference, const Coefficient& coefficient) {
  const Plan& p = plan.plan();
  double worst = 0;
  for (int k = 0; k <= p.stages; ++k) {
    double size = 1e-300, off = 0;
    for (std::size_t j = 0; j < p.x.size(); ++j) {
      const int order = k + p.d[j];
      const double want = static_cast<double>(reference.coefficient(j, order)), have = coefficient(j, order);
      size = std::max(size, std::abs(want) * plan.tables().factorial[static_cast<std::size_t>(order)] /
                                plan.tables().factorial[static_cast<std::size_t>(k)]);
      off = std::max(off, std::abs(have - want) * plan.tables().factorial[static_cast<std::size_t>(order)] /
                              plan.tables().factorial[static_cast<std::size_t>(k)]);
      if (!(off == off)) return 1e300;
    }
    if (size > 1e-9) worst = std::max(worst, off / size);
  }
  return worst;
}

bool same(double a, double b) { return a == b || (a != a && b != b); }

// Compares the motions in a lane of each kernel. Returns the name of the first difference, or an empty text.
std::string difference_of_motions(const Kernel& a, int lane_a, const Kernel& b, int lane_b) {
  if (!same(a.pivots(lane_a).health, b.pivots(lane_b).health)) return "health";
  if (!same(a.pivots(lane_a).determinant, b.pivots(lane_b).determinant)) return "determinant";
  if (!same(a.drift(lane_a), b.drift(lane_b))) return "drift";
  if (a.moved(lane_a) != b.moved(lane_b)) return "moved";
  if (a.reaches(lane_a) != b.reaches(lane_b)) return "reaches";
  if (a.reaches(lane_a) && a.reach(lane_a) != b.reach(lane_b)) return "reach";
  if (!same(a.largest(lane_a), b.largest(lane_b))) return "largest";
  const auto equal = [](const std::vector<long double>& x, const std::vector<long double>& y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(),
                      [](long double p, long double q) { return p == q || (p != p && q != q); });
  };
  std::vector<long double> x, y, lead_x, lead_y;
  for (const Kernel::Moment m : {Kernel::Moment::now, Kernel::Moment::begun, Kernel::Moment::before}) {
    a.fetch(lane_a, m, x, lead_x);
    b.fetch(lane_b, m, y, lead_y);
    if (!equal(x, y) || !equal(lead_x, lead_y)) return "state " + std::to_string(static_cast<int>(m));
  }
  a.fetch_base(lane_a, x);
  b.fetch_base(lane_b, y);
  return equal(x, y) ? "" : "base";
}

// The initial state of a lane: the start in lane 0, one without a value in lane 1, one far from the constraints in lane
// 2, one a little off in the others.
std::vector<long double> start_of_lane(const Reference& r, int lane) {
  std::vector<long double> state = r.start.state;
  if (lane == 1)
    state[0] = std::numeric_limits<long double>::quiet_NaN();
  else if (lane == 2)
    state.back() += 0.1L;
  else
    state[0] += 1e-18L * lane;
  return state;
}

constexpr int kSteps = 3;
// Makes kSteps steps with all kernels; calls `compare` after every expansion and after every step.
template <class Compare>
void walk(const Reference& r, std::initializer_list<Kernel*> kernels, const Compare& compare) {
  std::vector<double> t;
  for (Kernel* k : kernels)
    for (int lane = 0; lane < k->lanes(); ++lane) {
      k->set_parameters(lane, r.parameters);
      k->place(lane, start_of_lane(r, lane), r.start.leading);
    }
  const int lanes = (*kernels.begin())->lanes();
  t.assign(static_cast<std::size_t>(lanes), static_cast<double>(r.start.t));
  for (int step = 0; step < kSteps; ++step) {
    for (Kernel* k : kernels) {
      for (int lane = 0; lane < lanes; ++lane) k->set_time(lane, t[static_cast<std::size_t>(lane)]);
      k->begin();
    }
    compare();
    for (int lane = 0; lane < lanes; ++lane) {
      const Kernel& first = **kernels.begin();
      const double h = first.reaches(lane) ? std::min(first.reach(lane), 0.25) : 0.01;
      for (Kernel* k : kernels) k->set_step(lane, h);
      t[static_cast<std::size_t>(lane)] += h;
    }
    for (Kernel* k : kernels) k->advance();
    compare();
  }
}

class KernelOf : public testing::TestWithParam<std::string> {};
class WritingsOf : public testing::TestWithParam<std::string> {};
class CompiledKernelOf : public testing::TestWithParam<std::string> {};

TEST_P(KernelOf, EqualsTheInterpretedTape) {
  const Reference r(GetParam());
  ASSERT_EQ(r.why, "");
  const auto plan = r.plan();
  ASSERT_TRUE(plan);
  Expansion<long double> reference(*r.stepping, r.parameters, kStages);
  // Both expand at the same numbers.
  const std::vector<double> state = Reference::narrow(r.start.state);
  reference.load(static_cast<double>(r.start.t), {state.begin(), state.end()}, r.start.leading);
  ASSERT_TRUE(reference.prepare().ok());
  ASSERT_TRUE(reference.solve().ok());
  ASSERT_TRUE(reference.extend().ok());
  // The error of the interpreter itself in double.
  Expansion<double> plain(*r.stepping, Reference::narrow(r.parameters), kStages);
  plain.load(static_cast<double>(r.start.t), state, Reference::narrow(r.start.leading));
  ASSERT_TRUE(plain.prepare().ok());
  ASSERT_TRUE(plain.solve().ok());
  ASSERT_TRUE(plain.extend().ok());
  const double unavoidable =
      difference(*plan, reference, [&](std::size_t j, int order) { return plain.coefficient(j, order); });
  for (const Tier& tier : tiers()) {
    Kernel kernel(plan, 1, &tier);
    kernel.set_parameters(0, r.parameters);
    kernel.load(0, static_cast<double>(r.start.t), Reference::narrow(r.start.state),
                Reference::narrow(r.start.leading));
    kernel.expand();
    const double off =
        difference(*plan, reference, [&](std::size_t j, int order) { return kernel.coefficient(j, order); });
    EXPECT_LT(off, 1e-13 + 10 * unavoidable) << tier.name;
  }
}

// The kernel of every writing of the equations has the coefficients of the interpreted tape.
TEST_P(WritingsOf, EqualTheInterpretedTape) {
  const Reference r(GetParam());
  ASSERT_EQ(r.why, "");
  const auto plan = r.plan();
  ASSERT_TRUE(plan);
  const std::vector<double> state = Reference::narrow(r.start.state), leading = Reference::narrow(r.start.leading);
  const double t = static_cast<double>(r.start.t);
  Expansion<long double> reference(*r.stepping, r.parameters, kStages);
  reference.load(t, {state.begin(), state.end()}, r.start.leading);
  ASSERT_TRUE(reference.prepare().ok());
  ASSERT_TRUE(reference.solve().ok());
  ASSERT_TRUE(reference.extend().ok());
  const auto off_by = [&](const std::shared_ptr<const KernelPlan>& p) {
    Kernel kernel(p);
    kernel.set_parameters(0, r.parameters);
    if (!p->map()) {
      kernel.load(0, t, state, leading);
      kernel.expand();
      return difference(*p, reference, [&](std::size_t j, int order) { return kernel.coefficient(j, order); });
    }
    // A kernel in quasi-velocities is compared in its coordinates, up to the order that it knows.
    std::vector<long double> own;
    kernel.reader(0).own(t, {state.begin(), state.end()}, own);
    kernel.load<long double>(0, t, own, {});
    kernel.expand();
    const int known = p->plan().stages + 1;
    return difference(*plan, reference, [&](std::size_t j, int order) {
      const auto k = p->map()->own(j, plan->plan().x.size());
      return k && order <= known ? kernel.coefficient(*k, order) : static_cast<double>(reference.coefficient(j, order));
    });
  };
  const double derived = off_by(plan);
  for (const Representation& w : r.representations(plan, WritingEffort::long_motion))
    EXPECT_LT(off_by(w.plan), 1e-12 + 10 * derived) << name(w.writing);
}

// Every lane has the bits of a kernel of one lane, whatever the states of its neighbours are: one of them has no value,
// one is far from the constraints.
TEST_P(KernelOf, LanesHaveTheSameBits) {
  const Reference r(GetParam());
  ASSERT_EQ(r.why, "");
  const auto plan = r.plan();
  ASSERT_TRUE(plan);
  const Plan& p = plan->plan();
  for (const Tier& tier : tiers()) {
    if (tier.lanes == 1) continue;
    Kernel lanes(plan, tier.lanes, &tier), one(plan, 1, &tier);
    one.set_parameters(0, r.parameters);
    const auto state_of = [&](int lane) {
      std::vector<double> state = Reference::narrow(r.start.state);
      if (lane == 1)
        state[0] = std::numeric_limits<double>::quiet_NaN();
      else if (lane == 2)
        state[0] += 0.1;
      else
        state[0] += 1e-16 * lane;
      return state;
    };
    for (int lane = 0; lane < tier.lanes; ++lane) {
      lanes.set_parameters(lane, r.parameters);
      lanes.load(lane, static_cast<double>(r.start.t) + 0.01 * lane, state_of(lane),
                 Reference::narrow(r.start.leading));
    }
    lanes.expand();
    for (int lane = 0; lane < tier.lanes; ++lane) {
      if (lane == 1) continue;
      one.load(0, static_cast<double>(r.start.t) + 0.01 * lane, state_of(lane), Reference::narrow(r.start.leading));
      one.expand();
      for (std::size_t j = 0; j < p.x.size(); ++j)
        for (int k = 0; k <= p.stages + p.d[j]; ++k) {
          const double want = one.coefficient(j, k);
          if (want != want) continue;
          EXPECT_EQ(lanes.coefficient(j, k, lane), want) << tier.name << " lane " << lane << " order " << k;
        }
    }
  }
}

// Machine code and the table-driven arithmetic have the same bits at the same numbers, even if the arena holds the
// numbers of another expansion.
TEST_P(CompiledKernelOf, HasTheSameBits) {
  const Reference r(GetParam());
  ASSERT_EQ(r.why, "");
  const auto plain = r.plan(), compiled = r.plan();
  ASSERT_TRUE(plain && compiled);
  Kernel a(plain), b(compiled);
  for (Kernel* k : {&a, &b}) k->set_parameters(0, r.parameters);
  std::vector<double> state = Reference::narrow(r.start.state);
  // Code made with effort replaces code made quickly, not the other way round.
  for (const auto& [effort, shift] :
       {std::pair(CodeEffort::quick, 0.0), std::pair(CodeEffort::full, 1e-3), std::pair(CodeEffort::quick, 1e-3)}) {
    const std::string why = compiled->compile({}, 1, effort);
    ASSERT_EQ(why, compiler() ? "" : "there is no compiler beside the program");
    ASSERT_EQ(compiled->code() != nullptr, compiler() != nullptr);
    if (compiler()) {
      EXPECT_EQ(compiled->code()->effort, shift == 0 ? CodeEffort::quick : CodeEffort::full);
      EXPECT_EQ(compiled->code()->translated, shift == 0);
    }
    for (double& x : state) x += shift;
    for (Kernel* k : {&a, &b}) {
      k->load(0, static_cast<double>(r.start.t) + shift, state, Reference::narrow(r.start.leading));
      k->expand();
    }
    EXPECT_EQ(a.pivots(0).health, b.pivots(0).health);
    EXPECT_EQ(a.pivots(0).determinant, b.pivots(0).determinant);
    const Plan& p = plain->plan();
    for (std::size_t j = 0; j < p.x.size(); ++j)
      for (int k = 0; k <= p.stages + p.d[j]; ++k)
        EXPECT_EQ(a.coefficient(j, k), b.coefficient(j, k)) << r.scenario->system.variable_names[j] << " order " << k;
  }
}

// Machine code and tables agree in motions: in pivots, projection, reach and the next state, alone and in lanes.
TEST_P(CompiledKernelOf, MovesWithTheSameBits) {
  const Reference r(GetParam());
  ASSERT_EQ(r.why, "");
  const int most = tiers().back().lanes;
  for (const auto& [lanes, effort] : {std::pair(1, CodeEffort::quick), std::pair(1, CodeEffort::full),
                                      std::pair(most, CodeEffort::quick), std::pair(most, CodeEffort::full)}) {
    if (lanes > 1 && kLongest.contains(GetParam()) && !std::getenv("ANHOLON_LONG")) continue;
    const auto plain = r.plan(), compiled = r.plan();
    ASSERT_TRUE(plain && compiled);
    ASSERT_EQ(compiled->compile({}, lanes, effort), compiler() ? "" : "there is no compiler beside the program");
    if (compiler()) {
      EXPECT_EQ(compiled->code(lanes)->translated, effort == CodeEffort::quick && translated_at_first(lanes));
    }
    Kernel a(plain, lanes), b(compiled, lanes);
    int comparison = 0;
    walk(r, {&a, &b}, [&] {
      ++comparison;
      for (int lane = 0; lane < lanes; ++lane)
        EXPECT_EQ(difference_of_motions(a, lane, b, lane), "")
            << "lane " << lane << " of " << lanes << ", " << comparison;
    });
  }
}

// A lane's motion has the bits of a motion alone.
TEST_P(KernelOf, LanesMoveWithTheSameBits) {
  const Reference r(GetParam());
  ASSERT_EQ(r.why, "");
  const auto plan = r.plan();
  ASSERT_TRUE(plan);
  for (const Tier& tier : tiers()) {
    if (tier.lanes == 1) continue;
    Kernel lanes(plan, tier.lanes, &tier);
    std::vector<Kernel> alone;
    for (int lane = 0; lane < tier.lanes; ++lane) {
      Kernel& one = alone.emplace_back(plan, 1, &tier);
      one.set_parameters(0, r.parameters);
      one.place(0, start_of_lane(r, lane), r.start.leading);
    }
    std::vector<double> t(alone.size(), static_cast<double>(r.start.t));
    bool begun = false;
    walk(r, {&lanes}, [&] {
      begun = !begun;
      for (int lane = 0; lane < tier.lanes; ++lane) {
        const auto at = static_cast<std::size_t>(lane);
        Kernel& one = alone[at];
        if (begun) {
          one.set_time(0, t[at]);
          one.begin();
        } else {
          const double h = one.reaches(0) ? std::min(one.reach(0), 0.25) : 0.01;
          one.set_step(0, h);
          t[at] += h;
          one.advance();
        }
        // Lanes are projected together; a motion without a value may leave other traces in its lane.
        if (lane == 1) continue;
        EXPECT_EQ(difference_of_motions(lanes, lane, one, 0), "") << tier.name << " lane " << lane;
      }
    });
  }
}

INSTANTIATE_TEST_SUITE_P(Model, KernelOf, testing::ValuesIn(shipped_except({kWithoutKernel})),
                         [](const auto& p) { return test::test_name(p.param); });
INSTANTIATE_TEST_SUITE_P(Model, WritingsOf, testing::ValuesIn(shipped_except({kWithoutKernel})),
                         [](const auto& p) { return test::test_name(p.param); });
INSTANTIATE_TEST_SUITE_P(Quasi, KernelOf, testing::ValuesIn(kQuasi),
                         [](const auto& p) { return test::test_name(p.param.substr(kInQuasi.size())); });
INSTANTIATE_TEST_SUITE_P(Quasi, CompiledKernelOf, testing::ValuesIn(kQuasi),
                         [](const auto& p) { return test::test_name(p.param.substr(kInQuasi.size())); });
INSTANTIATE_TEST_SUITE_P(Model, CompiledKernelOf, testing::ValuesIn(shipped_except({kWithoutKernel, kNotCompiled})),
                         [](const auto& p) { return test::test_name(p.param); });

// The kernel keeps the start of the present expansion and that of the one before, whether it continues from its own
// step or is placed at a given state.
TEST(Kernels, KeepTheirLastTwoStarts) {
  const Reference r("zoo/chaplygin-sleigh");
  ASSERT_EQ(r.why, "");
  Kernel k(r.plan());
  k.set_parameters(0, r.parameters);
  std::vector<long double> leading;
  const auto fetched = [&](Kernel::Moment m) {
    std::vector<long double> state;
    k.fetch(0, m, state, leading);
    return state;
  };
  using enum Kernel::Moment;
  std::vector<long double> last;
  for (int step = 0; step < 5; ++step) {
    if (step % 2 == 0) {
      std::vector<long double> state = r.start.state;
      for (long double& x : state) x += 0.125L * step;
      k.place(0, state, r.start.leading);
      EXPECT_EQ(fetched(now), state);
    }
    const std::vector<long double> start = fetched(now), guess = leading;
    k.set_time(0, 0);
    k.begin();
    EXPECT_EQ(fetched(begun), start);
    EXPECT_EQ(leading, guess);
    if (!k.moved(0)) {
      EXPECT_EQ(fetched(now), start);
    }
    if (step > 0) {
      EXPECT_EQ(fetched(before), last);
    }
    last = start;
    if (step % 4 == 3) continue;  // the expansion failed
    k.set_step(0, 0.01);
    const std::vector<long double> base = fetched(now);
    k.advance();
    EXPECT_NE(fetched(now), base);
    EXPECT_EQ(fetched(begun), start);
    std::vector<long double> made;
    k.fetch_base(0, made);
    EXPECT_EQ(made, base);
  }
}

// Angles have turned 1000 times and are known to the digits of long double: a coordinate, and the sum of two of them.
// If a pivot is small, refinement restores the digits that the elimination loses.
TEST(Kernels, KeepTheirDigitsWithSmallPivotsIfTheyRefine) {
  constexpr int kLinks = 300, kStates = 12;
  const Reference r(test::model_of(test::chain_text(kLinks)));
  const auto plan = r.plan();
  ASSERT_TRUE(plan && plan->tables().refine);
  EXPECT_EQ(plan->least_health(), kHealthyIfRefined);
  Kernel kernel(plan);
  kernel.set_parameters(0, r.parameters);
  const double t = static_cast<double>(r.start.t);
  int compared = 0;
  for (int k = 0; k < kStates; ++k) {
    std::vector<double> state = Reference::narrow(r.start.state);
    for (std::size_t i = 0; i < state.size(); ++i)
      state[i] += std::remainder(0.618 * static_cast<double>(i + 3) * (k + 7), 4);
    kernel.load(0, t, state, {});
    kernel.expand();
    if (const double health = kernel.pivots(0).health; !(health > kHealthyIfRefined) || health > kHealthy) continue;
    Expansion<long double> reference(*r.stepping, r.parameters, kStages);
    reference.load(t, {state.begin(), state.end()}, {});
    Expansion<double> plain(*r.stepping, Reference::narrow(r.parameters), kStages);
    plain.load(t, state, {});
    ASSERT_TRUE(reference.prepare().ok() && reference.solve().ok() && reference.extend().ok());
    ASSERT_TRUE(plain.prepare().ok() && plain.solve().ok() && plain.extend().ok());
    const auto off = [&](const auto& series) {
      return difference(*plan, reference, [&](std::size_t j, int order) { return series.coefficient(j, order); });
    };
    EXPECT_LT(off(kernel), 1e-13 + 10 * off(plain)) << k;
    ++compared;
  }
  EXPECT_GE(compared, 3);
}

TEST(Kernels, KeepTheSinesOfAnglesThatHaveTurnedOften) {
  const Reference r(test::model_of(R"toml(
title = "Pendulum of two links, its joint by the angle between them"
coordinates = ["a", "b"]
[parameters]
m = 1
l = 1
g = 9.81
[point]
P = "l*(sin(a)*ex - cos(a)*ey)"
Q = "P + l*(sin(a + 2*b)*ex - cos(a + 2*b)*ey)"
[[particle]]
name = "p"
mass = "m"
position = "P"
[[particle]]
name = "q"
mass = "m"
position = "Q"
[gravity]
field = "-g*ey"
[initial]
a = 1
b = 0.5
)toml"));
  ;
  ASSERT_EQ(r.why, "");
  const auto plan = r.plan();
  ASSERT_TRUE(plan);
  const std::vector<long double> state{6543.211234567890123L, 0.25L, 2345.678901234567890L, -0.5L};
  Expansion<long double> reference(*r.stepping, r.parameters, kStages);
  reference.load(0, state, r.start.leading);
  ASSERT_TRUE(reference.prepare().ok() && reference.solve().ok() && reference.extend().ok());
  for (const Tier& tier : tiers()) {
    Kernel kernel(plan, 1, &tier);
    kernel.set_parameters(0, r.parameters);
    kernel.place(0, state, r.start.leading);
    kernel.set_time(0, 0);
    kernel.begin();
    // In doubles the angles would be off by 5e-13.
    EXPECT_LT(difference(*plan, reference, [&](std::size_t j, int order) { return kernel.coefficient(j, order); }),
              2e-14)
        << tier.name;
  }
}

// Plans of chains hold the inverse for the unknowns alone, and solve all columns that depend on these by their own
// rows, up to a number of links that differs between motions alone and in lanes. Tables and machine code have the same
// bits.
TEST(Kernels, InvertForManyUnknowns) {
  const std::string chain = test::shipped_text("zoo/chain");
  for (const auto& [links, company, inverted] : {std::tuple(6, Company::alone, true),
                                                 {6, Company::in_lanes, true},
                                                 {9, Company::alone, true},
                                                 {10, Company::in_lanes, true},
                                                 {11, Company::in_lanes, false},
                                                 {18, Company::alone, true},
                                                 {24, Company::alone, true}}) {
    const Reference r(test::model_of(test::replaced(chain, "n = 4", "n = " + std::to_string(links))));
    ASSERT_EQ(r.why, "");
    const auto plan = KernelPlan::make(r.stepping, kStages, r.parameters, 0, Reference::narrow(r.start.state), company);
    ASSERT_TRUE(plan && !plan->tables().refine) << links;
    const SparseLu& e = plan->elimination();
    EXPECT_EQ(e.influences.size(), inverted ? static_cast<std::size_t>(links) * links : 0U) << links;
    EXPECT_EQ(e.own.empty(), !inverted) << links;
    Expansion<long double> reference(*r.stepping, r.parameters, kStages);
    reference.load(0, r.start.state, r.start.leading);
    ASSERT_TRUE(reference.prepare().ok() && reference.solve().ok() && reference.extend().ok());
    Kernel tables(plan), compiled(plan);
    for (Kernel* k : {&tables, &compiled}) {
      k->set_parameters(0, r.parameters);
      k->place(0, r.start.state, r.start.leading);
      k->set_time(0, 0);
      if (k == &compiled && test::compiler_expected()) {
        ASSERT_EQ(plan->compile({}), "");
      }
      k->begin();
      EXPECT_LT(difference(*plan, reference, [&](std::size_t j, int order) { return k->coefficient(j, order); }), 1e-12)
          << links;
    }
    EXPECT_EQ(difference_of_motions(tables, 0, compiled, 0), "") << links;
    for (std::size_t j = 0; j < r.stepping->unknowns(); ++j)
      for (int order = 0; order <= kStages + 2; ++order)
        EXPECT_EQ(tables.coefficient(j, order), compiled.coefficient(j, order)) << links;
  }
}

// The entries of the elimination grow linearly with the links, as in the recursion of articulated bodies.
TEST(Kernels, EliminateChainsLinkByLink) {
  const std::string chain = test::shipped_text("zoo/chain");
  for (const std::size_t links : {8, 16, 32, 64, 150, 300}) {
    const Reference r(test::model_of(test::replaced(chain, "n = 4", "n = " + std::to_string(links))));
    ASSERT_EQ(r.why, "");
    const auto plan = cheapest(r.representations(r.plan(), WritingEffort::very_long_motion)).plan;
    ASSERT_TRUE(plan);
    const bool is_long = links > 64;
    EXPECT_LT(plan->elimination().update_list.size(), (is_long ? 200 : 50) * links);
    EXPECT_LT(plan->elimination().forward.size() + plan->elimination().terms.size(), (is_long ? 50 : 30) * links);
  }
}

// Plans of one stage that are too large for the compiler are translated; their code has the bits of the tables.
TEST(Kernels, OfLargePlansAreTranslated) {
  if (!compiler()) GTEST_SKIP() << "no compiler beside the program";
  for (const auto& [name, why] : kNotCompiled) {
    const Reference r(name);
    ASSERT_EQ(r.why, "");
    const auto of_points = [&] {
      return KernelPlan::make(r.stepping, 1, r.parameters, static_cast<double>(r.start.t),
                              Reference::narrow(r.start.state));
    };
    const auto plain = of_points(), code = of_points();
    ASSERT_TRUE(plain && code);
    EXPECT_EQ(code->compile({}), why) << name;
    EXPECT_EQ(r.plan()->compile({}, 1, CodeEffort::quick), why) << name << ": a motion";
    for (const int lanes : {1, lanes_at_first()}) {
      if (!translated_at_first(lanes)) continue;
      ASSERT_EQ(code->compile({}, lanes, CodeEffort::quick), "") << name;
      ASSERT_TRUE(code->code(lanes)->translated);
      Kernel a(plain, lanes), b(code, lanes);
      for (Kernel* k : {&a, &b}) {
        for (int lane = 0; lane < lanes; ++lane) {
          k->set_parameters(lane, r.parameters);
          std::vector<double> state = Reference::narrow(r.start.state);
          for (double& x : state) x += 1e-3 * (lane + 1);
          k->load(lane, static_cast<double>(r.start.t), state, Reference::narrow(r.start.leading));
        }
        k->expand();
      }
      const Plan& p = plain->plan();
      for (int lane = 0; lane < lanes; ++lane)
        for (std::size_t j = 0; j < p.x.size(); ++j)
          for (int k = 0; k <= p.stages + p.d[j]; ++k)
            EXPECT_EQ(a.coefficient(j, k, lane), b.coefficient(j, k, lane)) << name << " order " << k;
    }
  }
}

// The converse: every model on a list belongs there, for the given reason.
TEST(Kernels, AreMissingForTheseReasonsOnly) {
  for (const auto& [name, why] : kWithoutKernel) EXPECT_EQ(Reference(name).why, why) << name;
}

TEST(Kernels, AreNotCompiledForTheseReasonsOnly) {
  for (const auto& [name, why] : kNotCompiled) {
    const Reference r(name);
    ASSERT_EQ(r.why, "") << name;
    EXPECT_EQ(r.plan()->compile({}), compiler() ? why : "there is no compiler beside the program") << name;
  }
}

// A build without a compiler may find the compiler of another build beside it.
TEST(Kernels, HaveACompilerWhereOneWasBuilt) { EXPECT_TRUE(compiler() || !test::compiler_expected()); }

}  // namespace
}  // namespace anholon::kernel_test

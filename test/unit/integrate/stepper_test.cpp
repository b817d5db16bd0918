#include <numbers>

#include <gtest/gtest.h>

#include "integrate/lanes/ordinary_steps.h"
#include "integrate/stepper.h"
#include "kernel/kernel.h"
#include "structure/consistent.h"
#include "support/models.h"

namespace anholon::stepper_test {
namespace {

// The stages of one model from its text to the stepper; each refers to the one before.
struct Motion {
  std::shared_ptr<const Model> model;
  Mechanics m;
  System system;
  Structure structure;
  Program stepping;

  explicit Motion(const std::string& text) : model(test::model_of(text)), m(mechanics(*model)) {
    std::vector<std::size_t> all;
    for (std::size_t r = 0; r < model->constraints.size(); ++r) all.push_back(r);
    system = implicit_system(model, m, *find_formulation("routh"), all);
    const Outcome o = analyse(system, parameters_in<double>(), {}, structure);
    if (!o.ok()) throw std::runtime_error(o.message);
    stepping = program(system, structure);
  }
  template <class N>
  std::vector<N> parameters_in() const {
    Column values;
    for (const Parameter& p : model->parameters) values.push_back(p.value);
    return evaluate_parameters<N>(*model->graph, values);
  }
  // x_1, x_1', x_2, … from the model's initial data.
  template <class N>
  std::vector<N> start() const {
    InitialState<N> named;
    const Outcome o = consistent_state(InitialProblem<N>{&m, parameters_in<N>(), {}, std::nullopt}, named);
    if (!o.ok()) throw std::runtime_error(o.message);
    std::vector<N> state;
    for (std::size_t a = 0; a < named.q.size(); ++a) state.push_back(named.q[a]), state.push_back(named.qd[a]);
    return state;
  }
};

std::string line(const std::string& force, const std::string& initial) {
  return "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n[[force]]\nname = "
         "\"f\"\non = \"p\"\nvector = \"(" +
         force + ")*ex\"\n[initial]\n" + initial;
}

template <class N>
Stepper<N> stepper(const Motion& motion, double tolerance, int order = 0) {
  StepSettings settings;
  settings.log_tolerance = std::log(tolerance);
  settings.order = order;
  return Stepper<N>(motion.stepping, motion.parameters_in<N>(), motion.parameters_in<Wider<N>>(), settings);
}

template <class N>
void go(Stepper<N>& s, const Wider<N>& end) {
  while (!(s.time() == end)) {
    const Outcome o = s.step(end);
    if (!o.ok()) throw std::runtime_error(o.message);
  }
}

template <class N>
std::vector<Wider<N>> state_at(const Motion& motion, const Stepper<N>& s, const Wider<N>& t) {
  Expansion<Wider<N>> point(motion.stepping, motion.parameters_in<Wider<N>>(), 1);
  const Outcome o = s.at(t, point);
  if (!o.ok()) throw std::runtime_error(o.message);
  std::vector<Wider<N>> state;
  point.state(state);
  return state;
}

// The state at `end` of the motion whose state at `begin` is given.
using State = std::vector<long double>;
State moved(const Motion& motion, long double begin, const State& state, long double end, double tolerance = 1e-15) {
  Stepper<double> s = stepper<double>(motion, tolerance);
  const Outcome o = s.start(begin, state);
  if (!o.ok()) throw std::runtime_error(o.message);
  go(s, end);
  return state_at(motion, s, end);
}

// |x - cos t| at t = 1 after 1/h steps of equal size h.
double oscillator_error(const Motion& motion, int order, int steps) {
  Stepper<Multi> s = stepper<Multi>(motion, 0.5, order);  // its own step size is larger than all of these
  if (!s.start(Multi(0), {Multi(1), Multi(0)}).ok()) throw std::runtime_error("start");
  for (int k = 1; k <= steps; ++k) {
    const std::size_t before = s.steps();
    go(s, Multi(Multi(k) / Multi(steps)));
    EXPECT_EQ(s.steps(), before + 1) << "the step must be the one given";
  }
  return to_double(abs(Multi(state_at(motion, s, Multi(1))[0] - cos(Multi(1)))));
}

TEST(Stepper, MeasuredOrderIsTheStatedOne) {
  const PrecisionScope precision(50);
  const Motion motion(line("-x", "x = 1\n\"x'\" = 0\n"));
  for (int order : {4, 5, 8, 12}) {
    const double coarse = oscillator_error(motion, order, 16), fine = oscillator_error(motion, order, 32);
    const double measured = std::log2(coarse / fine);
    // Positions may gain one more power of h, but never lose one.
    EXPECT_GT(measured, order - 0.2);
    EXPECT_LT(measured, order + 1.2);
  }
}

TEST(Stepper, KeepsItsToleranceOnAPendulumOfKnownEnergy) {
  const Motion motion(line("-sin(x)", "x = 2\n\"x'\" = 0\n"));
  for (double tolerance : {1e-6, 1e-9, 1e-12}) {
    const State end = moved(motion, 0, motion.start<long double>(), 20, tolerance);
    const long double energy = end[1] * end[1] / 2 - std::cos(end[0]);
    EXPECT_LE(std::abs(energy + std::cos(2.0L)), 100 * tolerance);
  }
}

// x'' = 0, x' = 1/3: after 10^5 steps the position is exact to a round-off, while plain summation would be off by many.
// The test uses long double, in which the state has the type of the coefficients.
TEST(Stepper, CompensatedSumsDoNotGatherRoundOffs) {
  const int steps = 100000;
  const Motion motion(line("0", "x = 0\n\"x'\" = \"1/3\"\n"));
  Stepper<long double> s = stepper<long double>(motion, 1e-12, 4);
  ASSERT_TRUE(s.start(0, motion.start<long double>()).ok());
  long double plain = 0, before = 0;
  for (int k = 1; k <= steps; ++k) {
    const long double t = k * 0.1L;
    go(s, t);
    plain += (t - before) * (1.0L / 3);
    before = t;
  }
  const PrecisionScope precision(40);
  const long double exact = (Multi(before) * Multi(1.0L / 3)).to_long_double(),
                    ulp = std::nextafter(exact, 1e9L) - exact;
  EXPECT_LE(std::abs(state_at(motion, s, before)[0] - exact), 2 * ulp);
  EXPECT_GT(std::abs(plain - exact), 10 * ulp) << "the mutant";
}

const char* const kModels[] = {"zoo/chaplygin-sleigh", "zoo/fourbar", "zoo/rolling-coin",
                               "papers/luo-zhao-example-2-plane-frame"};

// In these models d = 2 for coordinates and 0 for multipliers, so the state of the expansion is the sequence of (q,
// q').
TEST(Stepper, DenseOutputIsTheMotionThere) {
  for (const char* name : kModels) {
    const Motion motion(test::shipped_text(name));
    const State start = motion.start<long double>();
    Stepper<double> s = stepper<double>(motion, 1e-15);
    ASSERT_TRUE(s.start(0, start).ok());
    ASSERT_TRUE(s.step(1).ok());
    ASSERT_TRUE(s.step(1).ok());
    const long double t = s.before() + 0.37L * (s.time() - s.before());
    const State inside = state_at(motion, s, t), there = moved(motion, 0, start, t);
    long double gap = 0, way = 0;
    for (std::size_t i = 0; i < start.size(); ++i)
      gap = std::max(gap, std::abs(inside[i] - there[i])), way = std::max(way, std::abs(inside[i] - start[i]));
    EXPECT_LE(gap, 2e-14) << name;  // states of size ten, tolerance 1e-15
    EXPECT_GT(way, 1e-3) << name;
  }
}

TEST(Stepper, BackwardsItReturnsToTheStart) {
  for (const char* name : kModels) {
    const Motion motion(test::shipped_text(name));
    const State start = motion.start<long double>(), back = moved(motion, 0.5, moved(motion, 0, start, 0.5), 0);
    for (std::size_t i = 0; i < start.size(); ++i) EXPECT_NEAR(back[i], start[i], 1e-13) << name;
  }
}

// A scleronomic system under forces of position returns along its path if its velocities are reversed.
TEST(Stepper, TimeReversal) {
  for (const char* name : {"zoo/chaplygin-sleigh", "zoo/rolling-coin"}) {
    const Motion motion(test::shipped_text(name));
    const State start = motion.start<long double>();
    State turned = moved(motion, 0, start, 0.5);
    for (std::size_t i = 1; i < turned.size(); i += 2) turned[i] = -turned[i];
    const State back = moved(motion, 0, turned, 0.5);
    long double without = 0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      EXPECT_NEAR(back[i], i % 2 ? -start[i] : start[i], 1e-13) << name;
      without = std::max(without, std::abs(back[i] - start[i]));
    }
    EXPECT_GT(without, 0.1L) << "the mutant: the velocities are turned at the end as well";
  }
}

TEST(Stepper, ConstraintsHoldToRoundOffAlongTheWay) {
  const Motion motion(test::shipped_text("zoo/fourbar"));
  Stepper<double> s = stepper<double>(motion, 1e-12);
  ASSERT_TRUE(s.start(0, motion.start<long double>()).ok());
  go(s, 0.8L);
  EXPECT_LE(s.worst_constraint(), 1e-11L) << "before projection: the tolerance of a step";
  EXPECT_LE(s.point().constraint_residual(), 1e-17L) << "a few round-offs of the wider numbers";
}

// ---- by a kernel
// ------------------------------------------------------------------------------------------------------------

// A stepper with a kernel that makes all expansions that it can.
struct Accelerated {
  explicit Accelerated(const Motion& motion, int order = 0, bool ordinary = true)
      : start(motion.start<long double>()), steps(motion.stepping, motion.parameters_in<double>(),
                                                  motion.parameters_in<long double>(), settings(order, ordinary)) {
    steps.accelerate(KernelPlan::make(std::make_shared<const Program>(motion.stepping), steps.order() - 1,
                                      motion.parameters_in<long double>(), 0, {start.begin(), start.end()}));
  }
  static StepSettings settings(int order, bool ordinary) {
    StepSettings s;
    s.order = order;
    s.measure = false;
    s.ordinary_steps = ordinary;
    return s;
  }
  Outcome go(long double end) {
    Outcome o = steps.start(0, start);
    while (o.ok() && steps.time() < end) o = steps.step(end);
    return o;
  }
  State start;
  Stepper<double> steps;
};

// x = -cos t; (x + away) y' = 0 does not determine y' at x + away = 0, where no multiplier has a pole.
std::string loses_hold(const std::string& away) {
  return "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex + "
         "y*ey\"\n[[force]]\nname = \"f\"\non = \"p\"\nvector = \"-x*ex\"\n"
         "[[constraint]]\nname = \"hold\"\nequation = \"(x + " +
         away + ")*y' = 0\"\n[initial]\nx = -1\ny = 0\n\"x'\" = 0\n\"y'\" = 0\n";
}

TEST(ByKernel, ASingularPointWithinAStepIsSeen) {
  const Motion motion(loses_hold("0"));
  // With order 19 two steps make the half period, and the reference expansion comes with the second.
  for (const int order : {15, 17, 19}) {
    Accelerated a(motion, order);
    ASSERT_TRUE(a.steps.accelerated());
    const Outcome o = a.go(4);
    EXPECT_EQ(o.kind, OutcomeKind::singular) << o.message << ", order " << order;
    EXPECT_NEAR(static_cast<double>(a.steps.time()), std::numbers::pi / 2, 1e-6) << o.message << ", order " << order;
    EXPECT_GT(a.steps.expansions_by_kernel(), order == 15 ? 1U : 0U);
  }
}

// x = -cos t meets -0.3 t, where the constraint does not determine y'. The time enters J itself, also when the stepper
// looks back.
TEST(ByKernel, ASingularPointThatDependsOnTimeIsSeen) {
  const double met = 1.2019131636661846;  // cos t = 0.3 t
  const Motion motion(loses_hold("0.3*t"));
  for (const int order : {12, 13, 15, 17, 19}) {  // of order 19 the point is found by looking back
    Accelerated a(motion, order);
    ASSERT_TRUE(a.steps.accelerated());
    const Outcome o = a.go(4);
    EXPECT_EQ(o.kind, OutcomeKind::singular) << o.message << ", order " << order;
    const std::string at = "at t = ";
    const double when = o.message.find(at) != std::string::npos
                            ? std::stod(o.message.substr(o.message.find(at) + at.size()))
                            : static_cast<double>(a.steps.time());
    EXPECT_NEAR(when, met, 1e-6) << o.message << ", order " << order;
  }
}

TEST(ByKernel, RegularMotionsAreNotStopped) {
  const Motion motion(loses_hold("3"));
  Accelerated a(motion);
  ASSERT_TRUE(a.go(4).ok());
  EXPECT_NEAR(static_cast<double>(state_at(motion, a.steps, 4.0L)[0]), -std::cos(4.0), 1e-12);
  EXPECT_EQ(a.steps.expansions_by_kernel(), a.steps.expansions());
}

// Pivots pass zero here, but J stays regular: the kernel continues.
TEST(ByKernel, PivotsMayChangeTheirSigns) {
  const Motion motion(test::replaced(test::shipped_text("zoo/trailers"), "n = 3", "n = 10"));
  Accelerated a(motion);
  ASSERT_TRUE(a.steps.accelerated());
  ASSERT_TRUE(a.go(6).ok());
  EXPECT_GE(a.steps.expansions_by_kernel() + 1, a.steps.expansions());
  const State by_reference = moved(motion, 0, a.start, 6), by_kernel = state_at(motion, a.steps, 6.0L);
  for (std::size_t i = 0; i < by_kernel.size(); ++i)
    EXPECT_NEAR(static_cast<double>(by_kernel[i]), static_cast<double>(by_reference[i]), 1e-10) << i;
}

TEST(ByKernel, AStepperStartsAnewWithoutATrace) {
  for (const char* name : kModels) {
    const Motion motion(test::shipped_text(name));
    Accelerated once(motion), again(motion);
    ASSERT_TRUE(once.go(0.5L).ok());
    ASSERT_TRUE(again.go(0.25L).ok());
    ASSERT_TRUE(again.go(0.5L).ok());
    EXPECT_EQ(once.steps.state(), again.steps.state()) << name;
    EXPECT_EQ(once.steps.steps(), again.steps.steps()) << name;
    EXPECT_EQ(once.steps.begun().motion.state, again.steps.begun().motion.state) << name;
  }
}

void expect_equal(const Stepper<double>& a, const Stepper<double>& b, const std::string& where) {
  EXPECT_EQ(a.time(), b.time()) << where;
  EXPECT_EQ(a.before(), b.before()) << where;
  EXPECT_EQ(a.state(), b.state()) << where;
  EXPECT_EQ(a.leading(), b.leading()) << where;
  EXPECT_EQ(a.integrals(), b.integrals()) << where;
  EXPECT_EQ(a.steps(), b.steps()) << where;
  EXPECT_EQ(a.expansions(), b.expansions()) << where;
  EXPECT_EQ(a.expansions_by_kernel(), b.expansions_by_kernel()) << where;
  EXPECT_EQ(a.worst_constraint(), b.worst_constraint()) << where;
  const StepperState<double> x = a.begun(), y = b.begun();
  EXPECT_EQ(x.motion.t, y.motion.t) << where;
  EXPECT_EQ(x.motion.state, y.motion.state) << where;
  EXPECT_EQ(x.motion.carry, y.motion.carry) << where;
  EXPECT_EQ(x.motion.leading, y.motion.leading) << where;
  EXPECT_EQ(x.motion.record.steps, y.motion.record.steps) << where;
  EXPECT_EQ(x.motion.record.last_step, y.motion.record.last_step) << where;
  EXPECT_EQ(x.motion.record.worst_constraint, y.motion.record.worst_constraint) << where;
}

// A wall that the series do not show from afar, so that ends of steps are refused. The other motions of the test have
// none.
const char* const kWall =
    "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n[[force]]\nname = "
    "\"f\"\non = \"p\"\nvector = \"(-x - 20*tanh(30*(x - 2)))*ex\"\n[initial]\nx = -3\n\"x'\" = 0\n";

TEST(ByKernel, OrdinaryStepsHaveTheBitsOfThoseLookedAtClosely) {
  std::vector<std::string> texts = {kWall};
  for (const char* name : kModels) texts.push_back(test::shipped_text(name));
  for (const std::string& text : texts)
    for (const long double end : {40.0L, -40.0L}) {
      const Motion motion(text);
      Accelerated ordinary(motion), closely(motion, 0, false);
      ASSERT_TRUE(ordinary.steps.accelerated());
      Outcome a = ordinary.steps.start(0, ordinary.start), b = closely.steps.start(0, closely.start);
      for (int k = 0; k < 600 && a.ok() && ordinary.steps.time() != end; ++k) {
        a = ordinary.steps.step(end), b = closely.steps.step(end);
        ordinary.steps.round_state(), closely.steps.round_state();
        EXPECT_EQ(a.kind, b.kind) << text << " step " << k;
        if (k % 37 == 0 || !a.ok()) expect_equal(ordinary.steps, closely.steps, text + " step " + std::to_string(k));
      }
      expect_equal(ordinary.steps, closely.steps, text);
    }
}

TEST(ByKernel, AStretchHasTheBitsOfItsSteps) {
  for (const char* name : kModels) {
    const Motion motion(test::shipped_text(name));
    Accelerated single(motion), together(motion);
    ASSERT_TRUE(single.steps.start(0, single.start).ok());
    ASSERT_TRUE(together.steps.start(0, together.start).ok());
    const long double end = 10, until = 4.5L;
    std::vector<long double> times;
    std::size_t longest = 0;
    Stretch<long double> stretch;
    for (int k = 0; single.steps.time() != end; ++k) {
      stretch.restart();
      stretch.most = static_cast<std::size_t>(1 + k % 13);
      stretch.until = together.steps.time() < until ? &until : nullptr;
      ASSERT_TRUE(together.steps.steps(end, stretch).ok());
      together.steps.round_state();
      ASSERT_FALSE(stretch.times.empty());
      EXPECT_LE(stretch.times.size(), stretch.most);
      longest = std::max(longest, stretch.times.size());
      for (std::size_t i = 0; i < stretch.times.size(); ++i) {
        ASSERT_TRUE(single.steps.step(end).ok());
        single.steps.round_state();
        EXPECT_EQ(single.steps.time(), stretch.times[i]) << name;
        if (i + 1 < stretch.times.size() && stretch.until) {
          EXPECT_LT(stretch.times[i], until) << name;
        }
      }
      expect_equal(single.steps, together.steps, name);
    }
    EXPECT_GT(longest, 1U) << name;
  }
}

// A motion that grows without bound, which no earlier step shows.
const char* const kGrows =
    "coordinates = [\"x\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"x*ex\"\n[[force]]\nname = "
    "\"f\"\non = \"p\"\nvector = \"100*x*ex\"\n[initial]\nx = 1\n\"x'\" = 0\n";

// The same motion in all lanes of a kernel, to a different end in each.
struct InLanes {
  InLanes(const Motion& motion, int lanes) {
    const State start = motion.start<long double>();
    const StepSettings settings = Accelerated::settings(0, true);
    const std::vector<long double> parameters = motion.parameters_in<long double>();
    kernel = std::make_shared<Kernel>(KernelPlan::make(std::make_shared<const Program>(motion.stepping),
                                                       taylor_order(settings.log_tolerance) - 1, parameters, 0,
                                                       {start.begin(), start.end()}, Company::in_lanes),
                                      lanes);
    ordinary.emplace(kernel, settings);
    for (int lane = 0; lane < kernel->lanes(); ++lane) {
      kernel->set_parameters(lane, parameters);
      ends.push_back(30 + 3 * lane);
      failed.push_back(false);
      steppers.push_back(
          std::make_unique<Stepper<double>>(motion.stepping, motion.parameters_in<double>(), parameters, settings));
      steppers.back()->accelerate(kernel, lane);
      steppers.back()->place(0, start);
    }
  }
  bool walking(std::size_t i) const { return steppers[i]->time() != ends[i] && !failed[i]; }
  // Makes at least one step in each lane; if `together`, all ordinary steps of the lanes at once.
  void go(bool together) {
    const auto each = [&](const auto& act) {
      for (std::size_t i = 0; i < steppers.size(); ++i)
        if (walking(i)) failed[i] = !act(*steppers[i], ends[i]);
    };
    each([](Stepper<double>& s, long double) { return s.begin_step(); });
    kernel->begin();
    std::vector<OrdinarySteps::Motion> motions;
    for (std::size_t i = 0; i < steppers.size(); ++i)
      motions.push_back({walking(i) ? steppers[i].get() : nullptr, ends[i], ends[i]});
    bool aimed = together && ordinary->run(motions);
    aimed_together += aimed;
    if (!aimed) each([](Stepper<double>& s, long double end) { return s.aim(end); });
    for (bool again = true; again; aimed = false) {
      if (!aimed) kernel->advance(), kernel->start_next();
      again = false;
      each([&](Stepper<double>& s, long double end) {
        const EndOfStep there = s.look_at_end(end);
        again = again || there == EndOfStep::elsewhere;
        return there != EndOfStep::failed;
      });
    }
    each([](Stepper<double>& s, long double) {
      const bool made = s.finish_step();
      if (made && s.arrived()) s.leave_kernel();
      return made;
    });
  }
  std::shared_ptr<Kernel> kernel;
  std::optional<OrdinarySteps> ordinary;
  std::vector<std::unique_ptr<Stepper<double>>> steppers;
  std::vector<long double> ends;
  std::vector<bool> failed;
  int aimed_together = 0;
};

void expect_the_bits_of_their_steppers(int lanes) {
  std::vector<std::string> texts = {kWall, kGrows};
  for (const char* name : kModels) texts.push_back(test::shipped_text(name));
  int aimed_together = 0;
  for (const std::string& text : texts) {
    const Motion motion(text);
    InLanes together(motion, lanes), apart(motion, lanes);
    std::size_t rounds = 0;
    for (; together.walking(together.steppers.size() - 1); ++rounds) {
      together.go(true);
      for (std::size_t i = 0; i < together.steppers.size(); ++i) {
        while (apart.steppers[i]->steps() < together.steppers[i]->steps()) apart.go(false);
        if (apart.steppers[i]->steps() == together.steppers[i]->steps() && !together.failed[i])
          expect_equal(*together.steppers[i], *apart.steppers[i], text);
      }
    }
    while (apart.walking(apart.steppers.size() - 1)) apart.go(false);
    for (std::size_t i = 0; i < together.steppers.size(); ++i) {
      expect_equal(*together.steppers[i], *apart.steppers[i], text);
      EXPECT_EQ(together.steppers[i]->trouble().message, apart.steppers[i]->trouble().message);
    }
    EXPECT_LT(rounds, together.steppers.back()->steps()) << text << ": steps are made together";
    aimed_together += together.aimed_together;
  }
  EXPECT_GT(aimed_together, 0) << "one has grown beyond all bounds after steps together";
}

// One lane, which every machine has, and the largest number of lanes of this machine.
TEST(ByKernel, StepsOfLanesTogetherHaveTheBitsOfTheirSteppers) {
  expect_the_bits_of_their_steppers(1);
  expect_the_bits_of_their_steppers(tiers().back().lanes);
}

// x = -cos t: a stretch ends with the first step at whose begin x has left its kept value.
TEST(ByKernel, AStretchEndsWhereAnUnknownLeavesItsValue) {
  const Motion motion(line("-x", "x = -1"));
  Accelerated a(motion, 12);
  ASSERT_TRUE(a.steps.start(0, a.start).ok());
  const std::array<Kept, 1> kept = {{{0, -1}}};
  Stretch<long double> stretch;
  stretch.most = 1000, stretch.kept = kept, stretch.margin = 1.5;
  ASSERT_TRUE(a.steps.steps(100, stretch).ok());
  const auto at = [](long double t) { return -std::cos(static_cast<double>(t)); };
  ASSERT_GE(stretch.times.size(), 2U);
  for (std::size_t i = 0; i + 2 < stretch.times.size(); ++i) EXPECT_LT(at(stretch.times[i]) + 1, 1.5);
  EXPECT_GE(at(a.steps.before()) + 1, 1.5);
}

// ---- what cannot be integrated has a name
// -----------------------------------------------------------------------------------

Outcome fate(const Motion& motion, double end, double& reached, std::size_t most_steps = 20000,
             bool cancelled = false) {
  StepSettings settings;
  settings.most_steps = most_steps;
  settings.cancelled = [=] { return cancelled; };
  Stepper<double> s(motion.stepping, motion.parameters_in<double>(), motion.parameters_in<long double>(), settings);
  Outcome o = s.start(0, motion.start<long double>());
  while (o.ok() && s.time() < end) o = s.step(end);
  reached = static_cast<double>(s.time());
  return o;
}

// The state (x, x') of a motion on a line at the time t.
std::vector<long double> line_at(const std::string& force, const std::string& initial, double t) {
  const Motion motion(line(force, initial));
  auto s = stepper<double>(motion, 1e-13);
  const Outcome o = s.start(0, motion.start<long double>());
  if (!o.ok()) throw std::runtime_error(o.message);
  go<double>(s, t);
  return state_at<double>(motion, s, t);
}

TEST(Kink, OfAbsIsPassed) {
  // x = cos t down to 0 at pi/2, then -sinh(t - pi/2).
  const auto x = line_at("-abs(x)", "x = 1\n", 4);
  EXPECT_NEAR(static_cast<double>(x[0]), -std::sinh(4 - std::numbers::pi / 2), 1e-11);
  EXPECT_NEAR(static_cast<double>(x[1]), -std::cosh(4 - std::numbers::pi / 2), 1e-11);
}

TEST(Kink, OfANormIsPassed) {
  // A constant pull towards 0: parabolas of half period 2 sqrt(2).
  const auto x = line_at("-x/norm(x*ex)", "x = 1\n", 4);
  const double since = 4 - 2 * std::numbers::sqrt2;
  EXPECT_NEAR(static_cast<double>(x[0]), -1 + since * since / 2, 1e-11);
}

TEST(Kink, WhereTheMotionStartsIsTakenOnItsSide) {
  // Drag from rest: x' = tanh t; abs(x') has its kink at the start.
  const auto x = line_at("1 - abs(x')*x'", "", 2);
  EXPECT_NEAR(static_cast<double>(x[1]), std::tanh(2), 1e-12);
  EXPECT_NEAR(static_cast<double>(x[0]), std::log(std::cosh(2)), 1e-12);
}

TEST(Kink, BackwardsToo) {
  const auto x = line_at("-abs(x)", "x = 1\n", -4);
  EXPECT_NEAR(static_cast<double>(x[0]), -std::sinh(4 - std::numbers::pi / 2), 1e-11);
}

TEST(Kink, ThatHoldsTheMotionIsAnOutcome) {
  const Motion motion(line("-sign(x')", "\"x'\" = 1\n"));
  auto s = stepper<double>(motion, 1e-12);
  ASSERT_TRUE(s.start(0, motion.start<long double>()).ok());
  Outcome o;
  for (int k = 0; k < 100 && o.ok(); ++k) o = s.step(2);
  EXPECT_EQ(o.kind, OutcomeKind::step_collapse);
  EXPECT_NE(o.message.find("kink"), std::string::npos) << o.message;
  EXPECT_NEAR(static_cast<double>(s.time()), 1, 1e-9);
}

TEST(Outcome, AnEndOutOfReachIsNoticedEarly) {
  const Motion motion(line("-x", "x = 1\n"));
  auto s = stepper<double>(motion, 1e-12);
  ASSERT_TRUE(s.start(0, motion.start<long double>()).ok());
  Outcome o;
  for (int k = 0; k < 2000 && o.ok(); ++k) o = s.step(1e15L);
  EXPECT_EQ(o.kind, OutcomeKind::interrupted);
  EXPECT_LT(s.steps(), 1500U);
  // If the end is within reach the motion does not stop.
  ASSERT_TRUE(s.start(0, motion.start<long double>()).ok());
  o = {};
  for (int k = 0; k < 2000 && o.ok(); ++k) o = s.step(1e6L);
  EXPECT_TRUE(o.ok()) << o.message;
}

// x'' = 2 x^3 with x = 1, x' = 1 at the start is x = 1/(1 - t).
TEST(Outcome, AMotionThatGrowsWithoutBoundBeforeItsPole) {
  double reached = 0;
  const Outcome o = fate(Motion(line("2*x^3", "x = 1\n\"x'\" = 1\n")), 2, reached);
  EXPECT_TRUE(o.kind == OutcomeKind::step_collapse || o.kind == OutcomeKind::blow_up) << name(o.kind);
  EXPECT_NEAR(reached, 1, 1e-10);
  EXPECT_FALSE(o.message.empty());
  EXPECT_FALSE(o.hint.empty());
}

TEST(Outcome, ExponentialGrowthIsABlowUp) {
  double reached = 0;
  const Outcome o = fate(Motion(line("x", "x = 1\n\"x'\" = 1\n")), 1000, reached);
  EXPECT_EQ(o.kind, OutcomeKind::blow_up);
  EXPECT_NEAR(reached, 230.26, 3);  // exp(t) = 1e100
}

// A weight that is thrown upwards reaches its highest point z' = 0, where the constraint determines nothing, at t =
// z'(0)(1 + k^2)/g = 0.2469.
TEST(Outcome, TheApexOfTheAppellHamelMachine) {
  std::string text = test::replaced(test::shipped_text("zoo/appell-hamel"), "\"-sqrt(5)/3\"", "\"sqrt(5)/3\"");
  double reached = 0;
  const Outcome o = fate(Motion(text), 2, reached);
  EXPECT_TRUE(o.kind == OutcomeKind::singular || o.kind == OutcomeKind::step_collapse)
      << name(o.kind) << ": " << o.message << " at " << reached;
  EXPECT_NEAR(reached, std::sqrt(5.0) / 3 * 3.25 / 9.81, 1e-6);
}

TEST(Outcome, AFormulaThatLeavesItsDomain) {
  double reached = 0;
  const Outcome o = fate(Motion(line("-sqrt(x)", "x = 1\n\"x'\" = -1\n")), 5, reached);
  EXPECT_FALSE(o.ok());
  EXPECT_TRUE(o.kind == OutcomeKind::not_a_number || o.kind == OutcomeKind::step_collapse) << name(o.kind);
}

TEST(Outcome, StepsCanBeLimitedAndCancelled) {
  double reached = 0;
  const Motion motion(line("-x", "x = 1\n\"x'\" = 0\n"));
  EXPECT_EQ(fate(motion, 1000, reached, 10).kind, OutcomeKind::interrupted);
  EXPECT_EQ(fate(motion, 1000, reached, 10, true).kind, OutcomeKind::interrupted);
  EXPECT_EQ(reached, 0);
}

TEST(Outcome, EveryKindHasANameOfItsOwn) {
  std::vector<std::string> names;
  for (OutcomeKind k : {OutcomeKind::finished, OutcomeKind::singular, OutcomeKind::step_collapse, OutcomeKind::blow_up,
                        OutcomeKind::not_a_number, OutcomeKind::no_convergence, OutcomeKind::inconsistent,
                        OutcomeKind::interrupted, OutcomeKind::negative_mass, OutcomeKind::too_large})
    names.push_back(name(k));
  std::sort(names.begin(), names.end());
  EXPECT_EQ(std::unique(names.begin(), names.end()), names.end());
}

}  // namespace
}  // namespace anholon::stepper_test

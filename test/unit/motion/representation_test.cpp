#include <gtest/gtest.h>

#include "motion/form_choice.h"
#include "motion/representation.h"
#include "support/models.h"

namespace anholon::representation_test {
namespace {

struct Written {
  explicit Written(const std::string& name, const Overrides& overrides = {})
      : Written(test::model_of(test::shipped_text(name), overrides)) {}
  explicit Written(std::shared_ptr<const Model> model) {
    if (!make_scenario(std::move(model), *find_formulation("routh"), {}, prepared).ok())
      throw std::runtime_error("no start");
    scenario.emplace(prepared);
    parameters = parameter_values<long double>(*scenario->model);
    Start<long double> start;
    if (!initial_state(*scenario, {}, start).ok()) throw std::runtime_error("no start");
    state.assign(start.state.begin(), start.state.end());
    t = static_cast<double>(start.t);
    derived = KernelPlan::make(std::make_shared<const Program>(program(scenario->system, scenario->structure)), 14,
                               parameters, static_cast<double>(start.t), state);
    if (!derived) throw std::runtime_error("no kernel");
    const std::size_t before = scenario->model->graph->size();
    list = representations(
        {derived, scenario->structure, {}, parameters, static_cast<double>(start.t), state, scenario->mechanics.get()},
        WritingEffort::long_motion);
    grown = scenario->model->graph->size() != before;
  }
  Scenario prepared;
  std::optional<Workspace> scenario;
  std::vector<long double> parameters;
  const Representation* by(Writing writing) const {
    for (const Representation& r : list)
      if (r.writing == writing) return &r;
    return nullptr;
  }
  std::vector<double> state;
  double t = 0;
  std::shared_ptr<const KernelPlan> derived;
  std::vector<Representation> list;
  bool grown = false;
};

TEST(Representation, TheDiscIsWrittenOut) {
  const Written disc("zoo/disc");
  EXPECT_EQ(cheapest(disc.list).writing, Writing::quasi);
  const Representation& best = cheapest_unmapped(disc.list);
  EXPECT_EQ(best.writing, Writing::expanded);
  EXPECT_LE(best.plan->work(), 0.35 * disc.derived->work());
  EXPECT_FALSE(disc.grown) << "the graph of the model";
}

TEST(Representation, WhereSolutionsAreRefinedEquationsStay) {
  const Written rattleback("zoo/rattleback");
  EXPECT_TRUE(rattleback.derived->tables().refine);
  EXPECT_EQ(cheapest(rattleback.list).writing, Writing::derived);
}

std::string links(int n) { return std::to_string(n); }

// Three products per link of a chain: its sine and cosine in one step, and the products of both with the forces at its
// end. The derived equations have ten.
TEST(Representation, TotalDerivativesAreLeftToTheSeries) {
  std::size_t before = 0;
  for (const int n : {4, 8, 12}) {
    const Written chain("zoo/chain", {{{"n", links(n)}}});
    const Representation* rates = chain.by(Writing::rates);
    ASSERT_TRUE(rates) << n;
    const ExpansionWork work = work_of(*rates->plan);
    EXPECT_EQ(work.products, 3U * static_cast<std::size_t>(n)) << "sine and cosine are one step";
    EXPECT_LE(work.operations, 0.55 * chain.derived->work());
    if (before > 0) {
      EXPECT_LE(work.sums, before + 4U * 16) << "in proportion to the links";
    }
    before = work.sums;
    EXPECT_EQ(cheapest(chain.list).writing, Writing::rates) << n;
    EXPECT_FALSE(chain.grown) << "the graph of the model";
  }
}

// The largest difference of two expansions from a state beside the start, in units of the coefficients of the same
// order.
double apart(const Written& w, const std::shared_ptr<const KernelPlan>& a, const std::shared_ptr<const KernelPlan>& b,
             const std::vector<long double>& parameters) {
  Kernel one(a), other(b);
  std::vector<double> state = w.state;
  for (std::size_t i = 0; i < state.size(); ++i) state[i] += 1e-3 * static_cast<double>(1 + i % 3);
  one.set_parameters(0, w.parameters);
  other.set_parameters(0, parameters);
  // Each expansion projects the state on the hidden constraints by one step of Newton's method.
  for (int pass = 0; pass < 4; ++pass) {
    one.load<double>(0, w.t, state, {});
    one.expand();
    for (std::size_t j = 0, i = 0; j < a->plan().d.size(); ++j)
      for (int k = 0; k < a->plan().d[j]; ++k) state[i++] = one.derivative(j, k);
  }
  std::vector<long double> motion(state.begin(), state.end()), own = motion;
  if (b->map()) other.reader(0).own(w.t, motion, own);
  other.load<long double>(0, w.t, own, {});
  other.expand();
  double worst = 0;
  const std::size_t unknowns = a->plan().d.size();
  for (int k = 0; k <= a->plan().stages; ++k) {
    double size = 1e-9, off = 0;
    for (std::size_t j = 0; j < unknowns; ++j) {
      const auto of_other = b->map() ? b->map()->own(j, unknowns) : std::optional<std::size_t>(j);
      if (!of_other) continue;
      const int order = k + b->plan().d[*of_other];
      size = std::max(size, std::abs(one.coefficient(j, order)));
      off = std::max(off, std::abs(one.coefficient(j, order) - other.coefficient(*of_other, order)));
    }
    worst = std::max(worst, off / size);
  }
  return worst;
}

// Compares every shipped model that has this writing with its derived equations, beside its start. Returns the number
// of these models.
std::size_t compare_with_derived(Writing writing) {
  std::size_t models = 0;
  for (const std::string& name : test::moving_models()) {
    Scenario probe;
    if (!make_scenario(test::shipped(name), *find_formulation("routh"), {}, probe).ok() ||
        !no_plan(program(probe.system, probe.structure)).empty())
      continue;
    const Written w(name);
    const Representation* r = w.derived ? w.by(writing) : nullptr;
    if (!r) continue;
    ++models;
    EXPECT_LE(apart(w, w.derived, r->plan, w.parameters), 1e-9) << name;
    EXPECT_FALSE(w.grown) << "the graph of the model";
  }
  const Written disc("zoo/disc");
  std::vector<long double> heavier = disc.parameters;
  for (long double& p : heavier) p *= 1 + 1e-6L;
  EXPECT_GT(apart(disc, disc.derived, disc.by(writing)->plan, heavier), 1e-8) << "the mutant";
  return models;
}

TEST(Representation, RatesAreTheSameEquations) { EXPECT_GE(compare_with_derived(Writing::rates), 20U); }
TEST(Representation, QuasiVelocitiesAreTheSameEquations) { EXPECT_GE(compare_with_derived(Writing::quasi), 10U); }

// The interpreter reads programs of this writing as well.
TEST(Representation, RatesByTheReference) {
  for (const char* name : {"zoo/chain", "zoo/trailers", "zoo/disc"}) {
    const Written w(name);
    const Program& rates = w.by(Writing::rates)->plan->program();
    const std::vector<double> parameters(w.parameters.begin(), w.parameters.end());
    Expansion<double> a(w.derived->program(), parameters, 8), b(rates, parameters, 8);
    for (Expansion<double>* e : {&a, &b}) {
      e->load(w.t, w.state, {});
      ASSERT_TRUE(e->prepare().ok() && e->project().ok() && e->solve().ok() && e->extend().ok()) << name;
    }
    for (std::size_t j = 0; j < rates.unknowns(); ++j)
      for (int k = 0; k <= 8; ++k)
        EXPECT_NEAR(a.coefficient(j, rates.d[j] + k), b.coefficient(j, rates.d[j] + k),
                    1e-9 * (1 + std::abs(a.coefficient(j, rates.d[j] + k))))
            << name << " " << j << " " << k;
  }
}

// A bead on a curve, an arm and a skate, moved by inputs.
TEST(Representation, InputsInPositions) {
  const std::string carried = "input.u = 't^2'\n",
                    with_a_state = "state.z = {rate = '-z', initial = 1}\ninput.u = 'z*t'\n";
  const std::string bead =
      "particle = [{name = 'b', mass = '1', position = 'u*ex + sin(q)*ey'}]\ncoordinates = ['q']\n";
  const std::string arm = "frame.A = 'rotz(u)'\nparticle = [{name = 'b', mass = '1', position = 'q*A.x'}]\n"
                          "coordinates = ['q']\ninitial = {q = 1}\n";
  const std::string skate = R"toml(coordinates = ["x", "y", "q"]
particle = [
  {name = "b", mass = "1", position = "x*ex + y*ey + u*(cos(q)*ex + sin(q)*ey)"},
  {name = "c", mass = "2", position = "x*ex + y*ey + 0.3*(cos(q)*ex + sin(q)*ey)"},
]
constraint = [{name = "blade", equation = "y'*cos(q) - x'*sin(q) = 0"}]
initial = {q = 0.4, "x'" = 1, "q'" = 0.5}
)toml";
  for (const auto& [text, writing] :
       {std::pair(carried + bead, Writing::rates), std::pair(with_a_state + bead, Writing::rates),
        std::pair(carried + arm, Writing::rates), std::pair(carried + skate, Writing::quasi)}) {
    const Written w(test::model_of(text));
    EXPECT_NE(w.by(writing), nullptr) << text;  // its expansion agrees with that of the derived equations
  }
}

TEST(Representation, IsTheSameTwice) {
  const Written a("zoo/disc"), b("zoo/disc");
  ASSERT_EQ(a.list.size(), b.list.size());
  for (std::size_t i = 0; i < a.list.size(); ++i) {
    EXPECT_EQ(a.list[i].writing, b.list[i].writing);
    EXPECT_EQ(a.list[i].plan->work(), b.list[i].plan->work());
  }
}

TEST(Representation, ComesWithTheStepsMade) {
  EXPECT_EQ(effort_after(0), WritingEffort::at_once);
  for (const WritingEffort e : kWritingEfforts) EXPECT_EQ(effort_after(steps_before(e)), e);
  EXPECT_EQ(effort_after(steps_before(WritingEffort::long_motion) - 1), WritingEffort::at_once);
}

TEST(FormChoice, QuasiVelocitiesDecide) {
  const auto disc = test::shipped("zoo/disc");
  const FormChoice c = choose_form(disc, {}), all = choose_form(disc, {}, Costs::all);
  EXPECT_EQ(c.costs.size(), 1U);
  EXPECT_EQ(all.costs.size(), 2U);
  EXPECT_STREQ(c.form->name, "routh");
  EXPECT_STREQ(all.form->name, "routh");
}

TEST(FormChoice, CountsBothForms) {
  const FormChoice c = choose_form(test::shipped("zoo/isokinetic"), {});
  ASSERT_EQ(c.costs.size(), 2U);
  EXPECT_STREQ(c.costs[0].form->name, "routh");
  EXPECT_GT(c.costs[0].total, 0);
  EXPECT_GT(c.costs[1].total, 0);
  // Maggi's equations divide by pivots, so total derivatives are not left to the series, and the form is chosen only if
  // it is cheaper by a quarter.
  EXPECT_STREQ(c.form->name, c.costs[0].total >= 1.25 * c.costs[1].total ? "maggi" : "routh");
}

}  // namespace
}  // namespace anholon::representation_test

// Rows by a kernel, side by side: their numbers are those of the reference to round-off, with the same bits in any
// company.
#include <cmath>

#include <gtest/gtest.h>

#include "observe/rows/row_kernel.h"
#include "observe/rows/row_values.h"
#include "setup/outputs/output_tape.h"
#include "support/models.h"
#include "support/motion.h"

namespace anholon::row_kernel_test {
namespace {

struct Rows {
  explicit Rows(const std::string& name) {
    if (!make_scenario(test::model_of(test::shipped_text(name)), *find_formulation("routh"), {}, prepared).ok())
      throw std::runtime_error("no start");
    s.emplace(prepared);
    parameters = parameter_values<long double>(*s->model);
    if (!initial_state(*s, {}, start).ok()) throw std::runtime_error("no start");
    outputs.emplace(*s, Column{});
    kernel = RowKernel::make(*s, outputs->all, 0, parameters, start, 1);
  }
  void expect_many() { kernel = RowKernel::make(*s, outputs->all, 0, parameters, start, 1, 100'000); }
  // A place near the start that misses the constraints by little more than round-off, as the ends of steps do.
  RowPlace near(int k) const {
    constexpr long double kNear = 1e-3L, kMissed = 1e-13L;
    RowPlace p = start;
    p.leading.clear();
    const auto change = [&](long double by, int other) {
      for (std::size_t i = 0; i < p.state.size(); ++i)
        p.state[i] += by * static_cast<long double>((static_cast<int>(i) * 7 + k * 5 + other) % 11 - 5);
    };
    const Program program = anholon::program(s->system, s->structure);
    Expansion<long double> point(program, parameters, 1);
    change(kNear, 0);
    point.load(p.t, p.state, p.leading);
    EXPECT_TRUE(point.prepare().ok());
    for (int i = 0; i < 5; ++i) EXPECT_TRUE(point.project().ok());
    point.state(p.state);
    change(kMissed, 3);
    return p;
  }
  // Computes the rows of the places; the remaining lanes hold the last place.
  void compute(const std::vector<RowPlace>& places) const {
    for (std::size_t lane = 0; lane < kernel->lanes(); ++lane)
      kernel->place(lane, places[std::min(lane, places.size() - 1)]);
    kernel->compute();
  }
  // All numbers of a lane.
  std::vector<double> numbers(std::size_t lane) const {
    std::vector<double> list;
    for (std::size_t j = 0; j < s->system.size(); ++j)
      for (int k = 0; k <= s->structure.d[j]; ++k) list.push_back(kernel->derivative(j, k, lane));
    for (std::size_t i = 0; i < outputs->all.size(); ++i) list.push_back(kernel->output(i, lane));
    return list;
  }
  // The same numbers by the reference, in long double.
  std::vector<double> reference(const RowPlace& p) {
    const Program program = anholon::program(s->system, s->structure);
    Expansion<long double> point(program, parameters, 1);
    point.load(p.t, p.state, p.leading);
    EXPECT_TRUE(point.prepare().ok());
    EXPECT_TRUE(point.project().ok());
    EXPECT_TRUE(point.solve().ok());
    OutputTape<long double> tape(*s, outputs->all, parameters);
    tape.evaluate(point);
    std::vector<double> list;
    for (std::size_t j = 0; j < s->system.size(); ++j)
      for (int k = 0; k <= s->structure.d[j]; ++k) list.push_back(static_cast<double>(point.derivative(j, k)));
    for (std::size_t i = 0; i < outputs->all.size(); ++i) list.push_back(static_cast<double>(tape[i]));
    return list;
  }

  Scenario prepared;
  std::optional<Workspace> s;
  std::vector<long double> parameters;
  RowPlace start;
  std::optional<RowExpressions> outputs;
  std::unique_ptr<RowKernel> kernel;
};

class RowsOf : public testing::TestWithParam<const char*> {};

TEST_P(RowsOf, AreThoseOfTheReference) {
  Rows rows(GetParam());
  ASSERT_TRUE(rows.kernel);
  std::vector<RowPlace> places;
  for (std::size_t k = 0; k < rows.kernel->lanes(); ++k) places.push_back(rows.near(static_cast<int>(k)));
  rows.compute(places);
  for (std::size_t lane = 0; lane < places.size(); ++lane) {
    EXPECT_TRUE(rows.kernel->good(lane));
    const std::vector<double> here = rows.numbers(lane), exact = rows.reference(places[lane]);
    ASSERT_EQ(here.size(), exact.size());
    double largest = 1;
    for (const double x : exact) largest = std::max(largest, std::abs(x));
    for (std::size_t i = 0; i < here.size(); ++i) EXPECT_NEAR(here[i], exact[i], 2e-11 * largest) << i;
  }
}

TEST_P(RowsOf, HaveTheSameBitsInAnyCompany) {
  Rows rows(GetParam());
  ASSERT_TRUE(rows.kernel);
  std::vector<RowPlace> places;
  for (std::size_t k = 0; k < rows.kernel->lanes(); ++k) places.push_back(rows.near(static_cast<int>(k)));
  rows.compute(places);
  std::vector<std::vector<double>> together;
  for (std::size_t lane = 0; lane < places.size(); ++lane) together.push_back(rows.numbers(lane));
  for (std::size_t k = 0; k < places.size(); ++k) {
    rows.compute({places[k]});
    EXPECT_EQ(rows.numbers(0), together[k]);
  }
}

// Many rows are computed in as many lanes as soon have machine code.
TEST_P(RowsOf, HaveTheSameBitsWhereManyAreExpected) {
  Rows rows(GetParam());
  ASSERT_TRUE(rows.kernel);
  const RowPlace place = rows.near(1);
  rows.compute({place});
  const std::vector<double> of_few = rows.numbers(0);
  rows.expect_many();
  ASSERT_TRUE(rows.kernel);
  EXPECT_EQ(rows.kernel->lanes(), static_cast<std::size_t>(lanes_at_first()));
  rows.compute({place});
  EXPECT_EQ(rows.numbers(0), of_few);
}

INSTANTIATE_TEST_SUITE_P(Zoo, RowsOf,
                         testing::Values("zoo/disc", "zoo/chain", "zoo/snakeboard", "zoo/rattleback", "zoo/fourbar"));

// Pivots are good at the state at which they are chosen. A row with a singular J is not trusted: a disc that lies flat.
TEST(RowKernel, SaysWhereItIsNotToBeTrusted) {
  Rows rows("zoo/disc");
  ASSERT_TRUE(rows.kernel);
  RowPlace flat = rows.start;
  std::size_t theta = 0;
  for (std::size_t a = 0; a < rows.s->model->coordinates.size(); ++a)
    if (rows.s->model->coordinates[a].name == "theta") theta = a;
  flat.state[2 * theta] = 1e-9L;
  flat.leading.clear();
  rows.compute({flat});
  EXPECT_FALSE(rows.kernel->good(0));
}

// Events change modes, which are parameters.
TEST(RowKernel, HasTheParametersThatItIsGiven) {
  const char* const text = R"(coordinates = ["x"]
mode.push = 1
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "2*push*ex"}]
event = [{name = "turn", when = "x - 1", set = {push = "-push"}}]
)";
  Scenario prepared;
  ASSERT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, prepared).ok());
  Workspace s(prepared);
  RowPlace start;
  ASSERT_TRUE(initial_state(s, {}, start).ok());
  std::vector<long double> parameters = parameter_values<long double>(*s.model);
  const auto kernel = RowKernel::make(s, RowExpressions(s, {}).all, 0, parameters, start, 1);
  ASSERT_TRUE(kernel);
  for (const long double push : {1.0L, -1.0L}) {
    parameters.at(0) = push;
    kernel->set_parameters(parameters);
    for (std::size_t lane = 0; lane < kernel->lanes(); ++lane) kernel->place(lane, start);
    kernel->compute();
    for (std::size_t lane = 0; lane < kernel->lanes(); ++lane)
      EXPECT_EQ(kernel->derivative(0, 2, lane), 2 * static_cast<double>(push));
  }
}

// The report compares all of the first 128 rows, 64 of the next 128 and of the next 256, then every eighth: 512, 520,
// …, 1000.
TEST(RowKernel, TheReportLooksAtEverFewerRows) {
  Scenario s;
  SimulationOptions o;
  o.to = 10;
  o.every = Rational(1, 100);
  ASSERT_TRUE(
      make_scenario(test::model_of(test::shipped_text("zoo/disc")), *find_formulation("routh"), o.state, s).ok());
  test::Motion motion;
  const SimulationReport r = simulate(s, o, motion.rows);
  EXPECT_EQ(r.rows, 1001U);
  EXPECT_EQ(r.rows_looked_at, 128U + 64U + 64U + 62U);
}

// A coefficient that a double holds stays; any other one lies between its two roundings, which are neighbours.
TEST(Rounding, TheOtherOneIsOnTheOtherSide) {
  Rows rows("zoo/disc");
  const auto program = std::make_shared<const Program>(anholon::program(rows.s->system, rows.s->structure));
  const auto plan =
      KernelPlan::make(program, 8, rows.parameters, 0, {rows.start.state.begin(), rows.start.state.end()});
  ASSERT_TRUE(plan);
  const CoefficientValues values(plan->plan(), *program, rows.parameters);
  const std::vector<double> nearest = values.rounded(), other = values.rounded(Rounding::other);
  ASSERT_EQ(nearest.size(), other.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (nearest[i] == other[i]) continue;
    ++differ;
    EXPECT_EQ(std::nextafter(nearest[i], other[i]), other[i]);
  }
  EXPECT_GT(differ, 0U);              // g = 9.81
  EXPECT_LT(differ, nearest.size());  // 1, 2, 1/2
}

}  // namespace
}  // namespace anholon::row_kernel_test

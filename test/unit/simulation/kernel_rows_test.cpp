// Rows of a kernel have the numbers of row_values(), and numbers that differ from the reference are found.
#include <gtest/gtest.h>

#include "simulation/kernel_rows.h"
#include "support/models.h"
#include "support/rows.h"

namespace anholon::kernel_rows_test {
namespace {

// A motion of a shipped model with all receivers of its rows. If `wrong`, the kernel of the rows has another value of
// g.
struct Rows {
  explicit Rows(const std::string& model, bool wrong = false) {
    EXPECT_TRUE(
        make_scenario(test::model_of(test::shipped_text(model)), *find_formulation("routh"), {}, prepared).ok());
    s.emplace(prepared);
    other.emplace(prepared);
    power = anholon::power(*s->mechanics);
    StepSettings settings;
    settings.integrals = 1;
    motion.emplace(*s, settings, watched_quadratures(*s, power), 0);
    EXPECT_TRUE(motion->start({}).ok());
    if (wrong) {
      std::size_t g = 0;
      while (other->model->parameters[g].name != "g") ++g;
      other->set_parameter(g, Rational(981'000'981, 100'000'000));  // by one part in a million
    }
    waiting = WaitingRows::make(*other, {}, 0, parameter_values<long double>(*other->model), motion->start_state(), 1);
    watch.emplace(*s, power, std::vector<Conserved>{}, motion->parameters());
    judge.emplace(*s, options);
    floors.emplace(*s, true);
    writer.emplace(sink, 16);
    report.constraints_each = constraint_reports(*s);
  }

  Scenario prepared;
  std::optional<Workspace> s, other;
  Power power;
  SimulationOptions options;
  std::optional<Motion<double>> motion;
  std::unique_ptr<WaitingRows> waiting;
  std::optional<Watch<long double>> watch;
  std::optional<Judge<double>> judge;
  std::optional<FloorWatch> floors;
  test::TextRows sink;
  std::optional<RowWriter<double>> writer;
  SimulationReport report;
};

TEST(KernelRows, FindNumbersThatAreNotThoseOfTheReference) {
  for (const bool wrong : {false, true}) {
    Rows r("zoo/disc", wrong);
    ASSERT_TRUE(r.waiting);
    KernelRows rows(*r.s, r.options, *r.motion, 0, std::move(r.waiting),
                    {*r.watch, *r.judge, r.floors, *r.writer, r.report});
    for (int k = 0; k < 20; ++k) {
      ASSERT_TRUE(r.motion->step(100).ok());
      rows.add(*r.motion, r.motion->stepper().time(), "", true);
      rows.step(1);
    }
    ASSERT_TRUE(rows.settle().ok());
    EXPECT_EQ(r.report.rows, 20U);
    EXPECT_EQ(r.report.rows_looked_at, 20U);
    const auto warning = rows.warning();
    ASSERT_EQ(warning.has_value(), wrong) << warning->message;
    if (wrong) {
      EXPECT_NE(warning->message.find("differ from the state solved for again"), std::string::npos);
    }
  }
}

TEST(KernelRows, HaveTheNumbersOfRowValues) {
  for (const char* model : {"zoo/disc", "zoo/chain", "zoo/fourbar", "zoo/snakeboard"}) {
    Rows r(model);
    ASSERT_TRUE(r.waiting) << model;
    WaitingBlock block(20);
    while (!block.full()) {
      ASSERT_TRUE(r.motion->step(100).ok());
      block.add(*r.motion, r.motion->stepper().time(), "");
    }
    std::size_t seen = 0;
    std::vector<double> fast, slow;
    r.waiting->compute(block, [&](const WaitingRows::Computed& row) {
      row.numbers(fast);
      row_values(*r.s, largest_order(*r.s, r.s->structure.d), row, row, slow);
      EXPECT_EQ(fast, slow) << model;
      ++seen;
      return true;
    });
    EXPECT_EQ(seen, 20U);
  }
}

// Every column is compared: a change of each number by a part in a million is found, one of a few round-offs is not.
TEST(RowCheck, FindsEveryWrongNumber) {
  Rows r("zoo/disc");
  const auto columns = columns_after_time(*r.s, 2);
  std::vector<double> numbers(columns.size());
  for (std::size_t j = 0; j < numbers.size(); ++j) numbers[j] = 1 + 0.1 * static_cast<double>(j);
  RowTwice row{0.5, numbers, {numbers.begin(), numbers.end()}, 1, std::vector<double>(columns.size(), 0.0)};
  for (std::size_t j = 0; j < numbers.size(); ++j)
    for (const double change : {1e-15, 1e-6}) {
      RowCheck check(columns);
      row.written = numbers;
      row.written[j] += change * 4;
      ASSERT_EQ(check.doubts(row), change > 1e-9);
      check.count(row, {});
      const auto found = check.found();
      ASSERT_EQ(found.has_value(), change > 1e-9);
      if (found) {
        EXPECT_EQ(found->column, columns[j].name);
      }
      // A change within the effect of the state's round-off is accepted.
      RowCheck uncertain(columns);
      std::vector<double> of_state(columns.size(), 0.0);
      of_state[j] = 1e-7;
      uncertain.doubts(row);
      uncertain.count(row, of_state);
      EXPECT_FALSE(uncertain.found());
      of_state[j] = 1e-9;
      uncertain.count(row, of_state);
      EXPECT_EQ(uncertain.found().has_value(), change > 1e-9);
    }
  // Digits that the reference itself loses by cancellation are no difference.
  RowCheck check(columns);
  row.written = numbers;
  row.written.back() += 1e-6;
  row.cancellation = 1e4;
  EXPECT_FALSE(check.doubts(row));
  check.count(row, {});
  EXPECT_FALSE(check.found());
  row.written.back() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(check.doubts(row));
  // The round-off of the state decides whether a root whose argument is about 0 has a value.
  std::vector<double> of_state(columns.size(), 0.0);
  of_state.back() = std::numeric_limits<double>::infinity();
  check.count(row, of_state);
  EXPECT_FALSE(check.found());
  check.count(row, {});
  EXPECT_TRUE(check.found());
}

}  // namespace
}  // namespace anholon::kernel_rows_test

// 200 random systems, each over a second of motion: Newton's law holds on dense output, a second form of the equations
// gives the same motion, and a motion that does not reach its end has a named outcome that the second form or 30 digits
// confirm.
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/random_system.h"
#include "support/rows.h"

namespace anholon::random_systems_test {
namespace {

constexpr double kNewton = 1e-11;     // C1, C2, C3 in relation to the terms
constexpr double kSameMotion = 1e-9;  // of two forms, in relation to the size of a column, where tolerances are 1e-13
constexpr double kSameEnd = 1e-6;     // times at which two runs stop
constexpr int kShards = 8, kEach = 25, kFinish = 20;

struct Motion {
  SimulationReport report;
  test::TextRows rows;
  double end = 0;
};

Motion run(const std::shared_ptr<const Model>& model, const Formulation& form, int digits) {
  Motion m;
  Scenario s;
  m.report.outcome = make_scenario(model, form, {}, s);
  if (!m.report.outcome.ok()) return m;
  SimulationOptions o;
  o.to = Rational(1);
  o.every = Rational(1, 20);
  o.most_steps = 20'000;
  o.tolerance = Rational(1, mpz_class(digits > 16 ? "1000000000000000000000000" : "10000000000000"));
  if (digits > 16) o.precision = Precision::multi, o.digits = digits;
  m.report = simulate(s, o, m.rows);
  m.end = m.report.t;
  return m;
}

// The form without multipliers that the seed selects.
const Formulation* second_form(const Model& model, std::uint64_t seed) {
  const Mechanics m = mechanics(model);
  std::vector<const Formulation*> list;
  for (const Formulation* f : formulations())
    if (f->eliminates() && f->obstacle(m).empty()) list.push_back(f);
  return list.empty() ? nullptr : list[seed % list.size()];
}

// The largest difference of two motions, each column in relation to its size. The last row of a motion that stops is
// left out.
double difference(const Motion& a, const Motion& b) {
  double worst = 0;
  const std::size_t rows = std::min(a.rows.rows().size(), b.rows.rows().size()) - (a.report.outcome.ok() ? 0 : 1);
  for (std::size_t k = 0; k < a.rows.names().size(); ++k) {
    if (a.rows.names()[k].rfind("lambda", 0) == 0) continue;  // if constraints are redundant, one choice of many
    double size = 1, miss = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      const double x = std::stod(a.rows.rows()[i][k]), y = std::stod(b.rows.rows()[i][k]);
      size = std::max(size, std::abs(x));
      miss = std::max(miss, std::abs(x - y));
    }
    worst = std::max(worst, miss / size);
  }
  return worst;
}

bool same_end(const Motion& a, const Motion& b) {
  return a.report.outcome.kind == b.report.outcome.kind && std::abs(a.end - b.end) <= kSameEnd;
}

class RandomSystems : public testing::TestWithParam<int> {};

TEST_P(RandomSystems, AreSolvedOrStopForAReason) {
  int finished = 0;
  for (int k = 0; k < kEach; ++k) {
    const std::uint64_t seed = static_cast<std::uint64_t>(GetParam() * kEach + k + 1);
    const test::RandomSystem system(seed);
    SCOPED_TRACE("seed " + std::to_string(seed) + ": " + system.what() + "\n" + system.text());
    const auto model = test::model_of(system.text());
    const Motion first = run(model, *find_formulation("routh"), 16);
    const Formulation* form = second_form(*model, seed);
    ASSERT_TRUE(form);
    const Motion second = run(model, *form, 16);
    if (first.report.outcome.ok()) {
      ++finished;
      EXPECT_LT(first.report.newton, kNewton);
      EXPECT_LT(first.report.projected, kNewton);
      EXPECT_LT(first.report.constraints_kept, kNewton);
      ASSERT_TRUE(second.report.outcome.ok()) << form->name << ": " << second.report.outcome.message;
      EXPECT_EQ(first.rows.rows().size(), 21U);
    } else {
      EXPECT_FALSE(first.report.outcome.message.empty());
      EXPECT_NE(first.report.outcome.kind, OutcomeKind::interrupted) << first.report.outcome.message;
      if (!same_end(first, second)) {
        const Motion precise = run(model, *find_formulation("routh"), 30);
        EXPECT_TRUE(same_end(first, precise))
            << first.report.outcome.message << "\n"
            << form->name << ": " << second.report.outcome.message << "\n30 digits: " << precise.report.outcome.message;
      }
    }
    if (first.rows.rows().size() > 1) {
      EXPECT_LT(difference(first, second), kSameMotion) << form->name;
    }
  }
  EXPECT_GE(finished, kFinish);
  RecordProperty("finished", finished);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomSystems, testing::Range(0, kShards));

// A force that is wrong by one part in a million is noticed.
TEST(RandomSystemsMutant, AnotherForceIsAnotherMotion) {
  int seen = 0;
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    const std::string text = test::RandomSystem(seed).text();
    const auto model = test::model_of(text),
               mutant =
                   test::model_of(test::replaced(text, "[gravity]\nfield = \"-", "[gravity]\nfield = \"-1.000001*"));
    const Motion a = run(model, *find_formulation("routh"), 16), b = run(mutant, *second_form(*mutant, seed), 16);
    if (!a.report.outcome.ok() || !b.report.outcome.ok()) continue;
    ++seen;
    EXPECT_GT(difference(a, b), kSameMotion) << "seed " << seed;
  }
  EXPECT_GE(seen, 3);
}

}  // namespace
}  // namespace anholon::random_systems_test

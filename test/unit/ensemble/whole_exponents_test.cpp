// Exponents that are parameters and whole: x^n is x*x*x for n = 3, whatever the sign of x.
#include <cmath>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "model/exponents.h"
#include "support/models.h"
#include "support/motion.h"

namespace anholon::whole_exponents_test {
namespace {

std::string bead(const std::string& spring, const std::string& parameters = "n = 3") {
  return "coordinates = [\"x\"]\nparameters = {m = 2, k = 3, " + parameters +
         "}\n[[particle]]\nname = \"p\"\nmass = \"m\"\nposition = \"x*ex\"\n" + spring + "\n[initial]\nx = -0.5\n";
}
std::string force(const std::string& f) { return "[[force]]\non = \"p\"\nvector = \"" + f + "*ex\""; }
std::string potential(const std::string& u) { return "[potential]\nU = \"" + u + "\""; }

test::Motion run(const std::string& text,
                 const std::optional<std::vector<std::size_t>>& open = std::vector<std::size_t>{}) {
  test::Motion r;
  Scenario s;
  SimulationOptions o;
  o.to = 4;
  o.state.open_parameters = open;
  r.report.outcome = make_scenario(test::model_of(text), *find_formulation("routh"), o.state, s);
  if (r.report.outcome.ok()) r.report = simulate(s, o, r.rows);
  return r;
}

TEST(WholeExponents, HaveValuesForEverySign) {
  const test::Motion with_number = run(bead(force("-k*x^3")));
  ASSERT_TRUE(with_number.report.outcome.ok());
  for (const std::string& text :
       {bead(force("-k*x^n")), bead(force("-k*x^(2*n - 3)")), bead(force("-k*x^q"), "n = 1, q = \"2*n + 1\""),
        bead(force("-k*(x^n)^(n - 2)")), bead(potential("k*x^(n + 1)/(n + 1)"))}) {
    const test::Motion r = run(text);
    ASSERT_TRUE(r.report.outcome.ok()) << text << r.report.outcome.message;
    EXPECT_NEAR(r.last("x"), with_number.last("x"), 1e-13) << text;
    EXPECT_NEAR(r.last("x''"), with_number.last("x''"), 1e-13) << text;
  }
  // The motion passes zero, from below and from zero itself.
  EXPECT_GT(with_number.last("x"), 0);
  EXPECT_TRUE(run(test::replaced(bead(force("(-k*x^n - 1)")), "x = -0.5", "x = 0")).report.outcome.ok());
}

TEST(WholeExponents, StayOpenWhereTheyMayChange) {
  EXPECT_FALSE(run(bead(force("-k*x^n")), std::vector<std::size_t>{2}).report.outcome.ok()) << "n may change";
  EXPECT_FALSE(run(bead(force("-k*x^q"), "n = 1, q = \"2*n + 1\""), std::vector<std::size_t>{2}).report.outcome.ok());
  EXPECT_TRUE(run(bead(force("-k*x^n")), std::vector<std::size_t>{0, 1}).report.outcome.ok());
  EXPECT_FALSE(run(bead(force("-k*x^n")), std::nullopt).report.outcome.ok());
  EXPECT_FALSE(run(bead(force("-k*x^n"), "n = 2.5")).report.outcome.ok()) << "no number for x < 0";
  const std::string mode = test::replaced(bead(force("-k*x^s")), "[[particle]]", "mode.s = 3\n[[particle]]");
  const Outcome o = run(mode).report.outcome;
  EXPECT_FALSE(o.ok()) << "events may set it";
  EXPECT_NE(o.hint.find("abs(x)^n*sign(x)"), std::string::npos) << o.hint;
}

TEST(WholeExponents, APowerThatLosesItsValueIsNamed) {
  const std::string text = test::replaced(bead(force("-k*x^n*x"), "n = 2.5"), "x = -0.5", "x = 0.5");
  const Outcome o = run(text).report.outcome;
  EXPECT_EQ(o.kind, OutcomeKind::not_a_number);
  EXPECT_EQ(o.message.rfind("x^n in the force 'force1' has no ", 0), 0U) << o.message;
  EXPECT_NE(o.hint.find("abs(x)^n*sign(x)"), std::string::npos) << o.hint;
}

class Results final : public CaseSink {
 public:
  void result(const CaseResult& r) override { list.push_back(r); }
  std::vector<CaseResult> list;
};

// Each case of a sweep has its own exponent.
TEST(WholeExponents, OfTheCasesOfASweep) {
  EnsembleOptions o;
  o.to = 4;
  o.varied = {{Varied::Kind::parameter, 2, 0, "n"}};
  const Rational values[] = {3, 1, 5, Rational(5, 2)};
  o.cases = std::size(values);
  o.numbers = [&](std::size_t k) { return EnsembleCase{{values[k]}, {}}; };
  o.state.open_parameters = std::vector<std::size_t>{2};
  o.estimate = ErrorEstimate::short_runs;
  const std::string text = test::replaced(bead(force("-k*x^n")), "x = -0.5", "x = 0.5");
  Scenario s;
  ASSERT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), o.state, s).ok());
  Results results;
  const EnsembleReport report = ensemble(s, o, results);
  ASSERT_EQ(results.list.size(), o.cases);
  for (const CaseResult& r : results.list) {
    const Rational& n = values[r.number];
    EXPECT_EQ(r.outcome.ok(), n.is_integer()) << n << r.outcome.message;
    if (!r.outcome.ok()) continue;
    const test::Motion one = run(test::replaced(text, "n = 3", "n = " + n.get_str()));
    EXPECT_NEAR(r.last[0], one.last("x"), 1e-12) << n;
  }
  ASSERT_TRUE(report.error.error) << report.error.none;
  EXPECT_GT(report.error.error->worst().digits, 9);
}

}  // namespace
}  // namespace anholon::whole_exponents_test

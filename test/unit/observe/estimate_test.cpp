// The digits to trust: how the estimate is made, and that each kind of columns has its own. test/estimate compares many
// motions with 30 digits.
#include <cmath>

#include <gtest/gtest.h>

#include "observe/estimate.h"
#include "support/motion.h"
#include "support/oracle.h"
#include "support/rows.h"

namespace anholon::estimate_test {
namespace {

struct Result : test::Motion {
  // The error of a kind of columns, or not a number if there is none.
  double error(ColumnKind kind) const {
    if (report.error)
      for (const KindError& e : report.error->kinds)
        if (e.kind == kind) return e.error;
    return std::nan("");
  }
  bool warned(const std::string& of) const {
    return std::any_of(report.warnings.begin(), report.warnings.end(),
                       [&](const Warning& w) { return w.message.find(of) != std::string::npos; });
  }
};

void run(const std::string& text, SimulationOptions o, Result& r) {
  o.estimate = ErrorEstimate::always;
  Scenario s;
  ASSERT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), o.state, s).ok());
  r.report = simulate(s, o, r.rows);
}

Result until(const std::string& text, Rational to, SimulationOptions o = {}) {
  Result r;
  o.to = to;
  run(text, o, r);
  EXPECT_TRUE(r.report.error) << r.report.no_error << r.report.outcome.message;
  return r;
}

const std::string kPoint = "coordinates = [\"x\"]\n[[particle]]\nname = \"P\"\nmass = 1\nposition = \"x*ex\"\n";
const std::string kKepler = R"toml(coordinates = ["x", "y"]
[parameters]
e = 0.95
[[particle]]
name = "P"
mass = 1
position = "x*ex + y*ey"
[gravity]
field = "-here/norm(here)^3"
[initial]
x = "1 - e"
"y'" = "sqrt((1 + e)/(1 - e))"
)toml";

// Compared with the reference trajectories, no estimate is smaller than a tenth of the true error, nor larger than a
// thousand times it (or the round-off of printing).
class Estimate : public testing::TestWithParam<test::OraclePair> {};

TEST_P(Estimate, OfTheErrorIsHonest) {
  const nlohmann::json data = test::oracle_data(GetParam().oracle), &path = data["trajectory"];
  const auto text = [](const nlohmann::json& j) { return j.get<std::string>(); };
  SimulationOptions o;
  for (const auto& t : path["times"]) o.at.push_back(parse_rational(text(t)).value());
  o.tolerance = Rational(1, 10'000'000);
  Result r;
  ASSERT_NO_FATAL_FAILURE(run(test::shipped_text(GetParam().model), o, r));
  ASSERT_TRUE(r.report.error) << r.report.no_error;
  const std::vector<std::string> coordinates = data["coords"].get<std::vector<std::string>>();
  std::map<std::string, std::pair<double, double>> columns;  // largest difference, largest value
  std::map<std::string, unsigned> orders;
  for (std::size_t k = 0; k < r.rows.rows().size(); ++k)
    for (const auto& [symbol, value] : path["states"][k].items()) {
      const auto [name, order] = test::split_order(symbol);
      if (order > 1 || std::find(coordinates.begin(), coordinates.end(), name) == coordinates.end()) continue;
      const std::string column = derivative_name(name, order, Format::text);
      const double exact = std::stod(text(value)), mine = r.number(k, column);
      auto& [difference, most] = columns[column];
      difference = std::max(difference, std::abs(mine - exact)), most = std::max(most, std::abs(exact));
      orders[column] = order;
    }
  double error[2] = {0, 0};
  for (const auto& [column, seen] : columns)
    if (seen.second > 1e-6) error[orders[column]] = std::max(error[orders[column]], seen.first / seen.second);
  for (const unsigned order : {0U, 1U}) {
    const double claim = r.error(order ? ColumnKind::velocity : ColumnKind::coordinate);
    EXPECT_GE(claim, error[order] / 10) << order;
    EXPECT_LE(claim, 1000 * std::max(error[order], 1.2e-16)) << order;
  }
}

INSTANTIATE_TEST_SUITE_P(Model, Estimate, testing::ValuesIn(test::oracle_pairs()),
                         [](const auto& p) { return test::test_name(p.param.model); });

// Lorenz' equations beside a point that moves uniformly.
TEST(DigitsToTrust, StatesHaveTheirOwn) {
  const Result r =
      until(kPoint + "[state]\na = {rate = \"10*(b - a)\", initial = 1}\nb = {rate = \"a*(28 - c) - b\", initial = "
                     "1}\nc = {rate = \"a*b - 8*c/3\", initial = 1}\n[initial]\nx = 1\n\"x'\" = 1\n",
            60);
  EXPECT_LT(r.error(ColumnKind::coordinate), 1e-14);
  EXPECT_GT(r.error(ColumnKind::state), 0.1);
  ASSERT_TRUE(r.report.error->lost);
  EXPECT_GT(*r.report.error->lost, 20);
  EXPECT_LT(*r.report.error->lost, 50);
  EXPECT_TRUE(r.warned("can be trusted from t = "));
  EXPECT_TRUE(std::isnan(r.error(ColumnKind::reaction))) << "nothing constrains the motion";
}

// After seven periods the position at the shortest distance is known to 8e-10 (from a run with 30 digits); none of 16
// equidistant times is near a shortest distance.
TEST(DigitsToTrust, OfAKeplerEllipseCountWhereItIsFastest) {
  const Result r = until(kKepler, 46);
  EXPECT_GT(r.error(ColumnKind::coordinate), 1e-9);
  EXPECT_GT(r.error(ColumnKind::acceleration), 3 * r.error(ColumnKind::coordinate));
  EXPECT_GT(r.report.error->worst().t, 40);
}

TEST(DigitsToTrust, OfASmallMotionAreThoseOfItsSize) {
  const auto oscillator = [](const char* size) {
    return until(kPoint + "[[force]]\non = \"P\"\nvector = \"-x*ex\"\n[initial]\nx = " + size + "\n\"x'\" = 0\n", 20,
                 [] {
                   SimulationOptions o;
                   o.tolerance = Rational(1, 100'000'000);
                   return o;
                 }())
        .error(ColumnKind::coordinate);
  };
  EXPECT_GT(oscillator("1e-7"), 1e4 * oscillator("1"));
}

// The upright pendulum is at rest but for the last digit of pi: both runs round pi alike, and fall alike.
TEST(DigitsToTrust, OfAnEquilibriumThatIsLostAreThoseOfItsStart) {
  const std::string pendulum =
      "coordinates = [\"th\"]\n[[particle]]\nname = \"P\"\nmass = 1\nposition = [\"sin(th)\", \"-cos(th)\", "
      "\"0\"]\n[gravity]\nfield = \"-9.81*ey\"\n[initial]\nth = \"pi\"\n\"th'\" = 0\n";
  const Result r = until(pendulum, 10);
  // e^(10 sqrt(9.81)) is 4e13.
  EXPECT_GT(r.error(ColumnKind::coordinate), 1e-8);
}

TEST(DigitsToTrust, AColumnThatIsZeroButForRoundOffTakesNone) {
  const Result r = until(
      "coordinates = [\"x\", \"y\"]\n[[particle]]\nname = \"P\"\nmass = 1\nposition = \"x*ex + "
      "y*ey\"\n[[constraint]]\nname = \"rod\"\nequation = \"x^2 + y^2 = 1\"\n[initial]\nx = 1\ny = 0\n\"y'\" = 1\n"
      "[monitor]\nnothing = \"x^2 + y^2 - 1\"\n",
      20);
  EXPECT_LT(r.error(ColumnKind::monitor), 1e-12);
  EXPECT_LT(r.error(ColumnKind::multiplier), 1e-11);
  EXPECT_LT(r.error(ColumnKind::reaction), 1e-11);
}

// A velocity jumps at the same place in both runs, or on either side of a row.
TEST(DigitsToTrust, RowsAtEventsAreComparedOnTheirSide) {
  const Result r = until(kPoint + "[gravity]\nfield = \"-9.81*ex\"\n[initial]\nx = 1\n\"x'\" = 0.3\n[[event]]\nname = "
                                  "\"floor\"\nwhen = \"x\"\ndirection = \"down\"\nset = {\"x'\" = \"-0.8*x'\"}\n",
                         3);
  EXPECT_GE(r.report.events.size(), 5U);
  EXPECT_LT(r.error(ColumnKind::velocity), 1e-14);
  EXPECT_LT(r.error(ColumnKind::event_time), 1e-14);
}

// The report of a continued run has all events, and its error estimate those of its part.
TEST(DigitsToTrust, OfARunThatGoesOnAfterEvents) {
  const std::string ball = kPoint + "[gravity]\nfield = \"-9.81*ex\"\n[initial]\nx = 1\n\"x'\" = 0.3\n[[event]]\nname "
                                    "= \"floor\"\nwhen = \"x\"\ndirection = \"down\"\nset = {\"x'\" = \"-0.8*x'\"}\n";
  SavedRun saved;
  SimulationOptions o;
  o.save = [&](const SavedRun& run) { saved = run; };
  until(ball, 1, o);
  o.save = nullptr;
  o.resume = &saved;
  const Result r = until(ball, Rational(17, 10), o);
  EXPECT_EQ(r.report.events.size(), 2U);
  EXPECT_LT(r.error(ColumnKind::velocity), 1e-14);
}

// Saturated friction looks constant at the start of a step, but not at its end.
TEST(DigitsToTrust, OfAMotionThatSteppedOverItsRestAreNone) {
  const Result r =
      until(kPoint + "[[force]]\non = \"P\"\nvector = \"-tanh(x'/0.01)*ex\"\n[initial]\nx = 0\n\"x'\" = 2\n", 5);
  const std::size_t last = r.rows.rows().size() - 1;
  const double error = std::abs(r.number(last, "x'")) / 2;  // it has come to rest
  EXPECT_GE(r.error(ColumnKind::velocity), error / 10);
}

// At the kinks of a force accelerations have kinks or jumps; steps end there.
TEST(DigitsToTrust, RowsAtKinksAreComparedOnTheirSide) {
  const Result r = until(
      kPoint +
          "[[force]]\non = \"P\"\nvector = \"(3*sin(3*t) - 0.2*sign(x') - x)*ex\"\n[initial]\nx = 1\n\"x'\" = 0.5\n",
      10);
  EXPECT_LT(r.error(ColumnKind::acceleration), 1e-9);
}

// A kick is so short that no step notices it; the rows do.
TEST(DigitsToTrust, OfAMotionThatSteppedOverAKickAreNone) {
  const std::string kicked =
      kPoint + "[[force]]\non = \"P\"\nvector = \"exp(-((t - 2.5)/0.01)^2)*ex\"\n[initial]\nx = 1\n\"x'\" = 0.01\n";
  SimulationOptions o;
  o.every = Rational(1, 10);
  const Result r = until(kicked, 5, o);
  const double gained = 0.01 * std::sqrt(std::acos(-1.0)),
               error = std::abs(r.number(r.rows.rows().size() - 1, "x'") - 0.01 - gained) / (0.01 + gained);
  EXPECT_GE(r.error(ColumnKind::velocity), error / 10);
  EXPECT_EQ(r.report.error->lost.has_value(), error > 0.1);
}

TEST(DigitsToTrust, AMotionThatEndsWithoutAValueHasNone) {
  SimulationOptions o;
  o.to = 5;
  Result r;
  run(kPoint + "[[force]]\non = \"P\"\nvector = \"-ex\"\n[[event]]\nname = \"half\"\nwhen = \"x - 1/2\"\nset = {\"x'\" "
               "= \"sqrt(-x)\"}\n[initial]\nx = 1\n\"x'\" = 0\n",
      o, r);
  ASSERT_EQ(r.report.outcome.kind, OutcomeKind::not_a_number);
  EXPECT_FALSE(r.report.error);
  EXPECT_NE(r.report.no_error, "");
}

TEST(DigitsToTrust, OfAnotherIntegratorByTheMotionBesideIt) {
  SimulationOptions o;
  o.integrator = Method::cvode;
  o.tolerance = Rational(1, 1'000'000);
  const Result by_cvode = until(kKepler, 10, o);
  EXPECT_GT(by_cvode.error(ColumnKind::velocity), 1e-6);
  o.integrator = Method::taylor;
  EXPECT_LT(until(kKepler, 10, o).error(ColumnKind::velocity), by_cvode.error(ColumnKind::velocity));
}

TEST(DigitsToTrust, OneRowIsEnough) {
  SimulationOptions o;
  o.at = {Rational(1)};
  Result r;
  run(kKepler, o, r);
  ASSERT_TRUE(r.report.error) << r.report.no_error;
}

TEST(DigitsToTrust, LongDoubleIsJudgedInQuadruplePrecision) {
  SimulationOptions o;
  o.precision = Precision::long_real;
  o.tolerance = Rational(1, mpz_class("1000000000000000000"));
  const Result r = until(kKepler, 3, o);
  EXPECT_NE(r.report.error->means.find("quadruple"), std::string::npos);
  EXPECT_GT(r.report.error->worst().digits, 14);
}

// Both runs round R + x alike if they compute in the same numbers: both lose the same digits by cancellation, so no
// second run in these numbers shows the loss.
constexpr const char* kFarCentre = R"toml(coordinates = ["x"]
parameters = {R = 1e6}
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "(1/(R + x)^2 - 1/R^2)*1e12*ex"}]
initial = {x = 1}
monitor = {F = "(1/(R + x)^2 - 1/R^2)*1e12"}
)toml";

TEST(DigitsToTrust, OfLongDoubleCountWhatCancelsInBothRuns) {
  SimulationOptions o;
  o.precision = Precision::long_real;
  o.every = Rational(1);
  const Result r = until(kFarCentre, 5, o);
  // In quadruple precision x''(5) is -1.9999470004373289187e-06.
  const double error = std::abs(r.last("x''") + 1.9999470004373289187e-06) / 2e-06;
  EXPECT_GT(error, 1e-15);
  EXPECT_LT(error, 10 * r.error(ColumnKind::acceleration));
  EXPECT_LT(error, 10 * r.error(ColumnKind::monitor));
  EXPECT_GT(r.error(ColumnKind::velocity), 1e-16);
  EXPECT_LT(r.report.error->worst().error, 1e-12) << "no more than that is lost";
}

TEST(DigitsToTrust, AChaoticMotionLosesThem) {
  // With six times the velocities of the file, the pendulum turns over.
  const std::string text = test::shipped_text("zoo/double-pendulum-cartesian");
  SimulationOptions o;
  o.tolerance = Rational(1, 100'000'000);
  o.state.overrides = {
      {1, 0, Rational(24, 5)}, {1, 1, Rational(18, 5)}, {1, 2, Rational(48, 5)}, {1, 3, Rational(36, 5)}};
  int before = 16;
  double error = 0;
  for (const int to : {1, 15, 45}) {
    o.at = {Rational(to)};
    Result r;
    ASSERT_NO_FATAL_FAILURE(run(text, o, r));
    ASSERT_TRUE(r.report.error) << r.report.no_error;
    const KindError& worst = r.report.error->worst();
    // Digits are whole numbers; the error itself grows every time.
    EXPECT_LT(worst.digits, before + (to > 15 ? 1 : 0)) << to;
    EXPECT_GT(worst.error, 2 * error) << to;
    before = worst.digits;
    error = worst.error;
  }
  EXPECT_LE(before, 6);
}

TEST(DigitsToTrust, InManyDigitsAndNotOfLongRuns) {
  const std::string pendulum = "coordinates = [\"th\"]\n[[particle]]\nname = \"P\"\nmass = 1\nposition = [\"sin(th)\", "
                               "\"-cos(th)\", \"0\"]\n[gravity]\nfield = \"-10*ey\"\n[initial]\nth = 1\n";
  SimulationOptions o;
  o.at = {Rational(1)};
  o.tolerance = Rational(1, mpz_class("10000000000000000000000"));
  o.precision = Precision::multi;
  o.digits = 20;
  Result many;
  ASSERT_NO_FATAL_FAILURE(run(pendulum, o, many));
  ASSERT_TRUE(many.report.error);
  EXPECT_GE(many.report.error->worst().digits, 19);
  EXPECT_LE(many.report.error->worst().digits, 26);
  Scenario s;
  SimulationOptions p;
  p.at = {Rational(1500)};
  p.estimate = ErrorEstimate::short_runs;
  ASSERT_TRUE(make_scenario(test::model_of(pendulum), *find_formulation("routh"), p.state, s).ok());
  test::TextRows rows;
  const SimulationReport lengthy = simulate(s, p, rows);
  ASSERT_GT(lengthy.steps, kShortRun);
  EXPECT_FALSE(lengthy.error);
  EXPECT_NE(lengthy.no_error.find("--error-estimate"), std::string::npos);
}

RowComparison of_two(double roundoff = 1e-16) {
  return {{{"x", ColumnKind::coordinate, 0, 0, ""}, {"y", ColumnKind::coordinate, 1, 0, ""}}, roundoff, 1e-12};
}

TEST(RowComparison, MeasuresAColumnByItsLargestValue) {
  RowComparison c = of_two();
  c.see({0, {0, 0}, {1e-6, 4}, {0, 0}});
  c.see({1, {1e-9, 1e-7}, {1e-9, 2}, {0, 0}});
  const ErrorReport r = c.report(2, 0);
  ASSERT_EQ(r.kinds.size(), 1U);
  EXPECT_DOUBLE_EQ(r.kinds[0].error, 2e-3);
  EXPECT_EQ(r.kinds[0].digits, 2);
  EXPECT_EQ(r.kinds[0].of, "x");
  EXPECT_EQ(r.kinds[0].t, 1);
}

TEST(RowComparison, TakesZeroButForNoiseByTheGreatestOfItsKind) {
  RowComparison c = of_two();
  c.see({0, {3e-13, 1e-12}, {1e-13, 5}, {0, 0}});
  EXPECT_LT(c.report(1, 0).worst().error, 3e-13);
  // The column has lost its digits; its error is no noise.
  RowComparison lost = of_two();
  lost.see({0, {0, 0}, {1e-4, 5}, {0, 0}});
  lost.see({1, {1e-4, 1e-12}, {1e-4, 5}, {0, 0}});
  const ErrorReport r = lost.report(2, 0);
  EXPECT_EQ(r.worst().digits, 0);
  EXPECT_EQ(*r.lost, 1);
  EXPECT_EQ(r.lost_of, "x");
}

TEST(RowComparison, NeverClaimsMoreThanIsWritten) {
  RowComparison c = of_two();
  c.see({0, {0, 0}, {1, 5}, {0, 0}});
  EXPECT_EQ(c.report(2, 1e-16).worst().error, 1e-16);
  c.see({1, {std::nan(""), 0}, {1, 5}, {0, 0}});
  EXPECT_EQ(c.report(2, 1e-16).worst().digits, 0);
}

TEST(SampledRows, KeepTheFastPhaseOfALongRun) {
  SampledRows<long double> rows;
  for (int k = 0; k <= 100'000; ++k) {
    const long double t = k,
                      x = 1 / (1 + (t - 77'001) * (t - 77'001));  // narrower than what one of many rows would see
    rows.add(t, {x}, 0);
  }
  const std::vector<SampledRow<long double>> kept = rows.take();
  EXPECT_LE(kept.size(), 257U);
  EXPECT_GE(kept.size(), 128U);
  EXPECT_EQ(kept.front().t, 0);
  EXPECT_EQ(kept.back().t, 100'000);
  EXPECT_TRUE(std::any_of(kept.begin(), kept.end(), [](const auto& r) { return std::abs(r.t - 77'001) <= 1; }));
  EXPECT_TRUE(std::is_sorted(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.t < b.t; }));
}

// Steps and walls have no error but round-off, and the motion depends on its last digits: a second run with the same
// roundings would be the same run.
const std::string kBilliard = R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
event = [
  {name = "side", when = "1 - x^2", direction = "down", set = {"x'" = "-x'"}},
  {name = "end", when = "1 - y^2", direction = "down", set = {"y'" = "-y'"}},
  {name = "disc", when = "x^2 + y^2 - 0.16", direction = "down", set = {"x'" = "x' - 2*(x*x' + y*y')*x/0.16", "y'" = "y' - 2*(x*x' + y*y')*y/0.16"}},
]
[initial]
x = 0.7
y = 0.1
"x'" = 0.6
"y'" = 0.8
)toml";

TEST(DigitsToTrust, OfABilliardAreThoseThatItsWallsLeave) {
  for (const Precision precision : {Precision::real, Precision::long_real}) {
    SimulationOptions o;
    o.at = {Rational(35)};
    o.precision = precision;
    const Result r = until(kBilliard, Rational(35), o);
    o.precision = Precision::multi;
    o.digits = 40;
    o.tolerance = Rational(1, mpz_class("10000000000000000000000000000000000"));
    const Result exact = until(kBilliard, Rational(35), o);
    double worst = 0;
    for (std::size_t k = 1; k <= 2; ++k)
      worst = std::max(worst, std::abs(std::stod(r.rows.rows().back()[k]) - std::stod(exact.rows.rows().back()[k])));
    ASSERT_GT(worst, precision == Precision::real ? 1e-10 : 1e-14) << "the billiard is chaotic";
    EXPECT_GT(10 * r.error(ColumnKind::coordinate), worst);
  }
}

// The times of impacts have the round-off of the growing time, which adds up.
TEST(DigitsToTrust, OfABallThatBouncesForLong) {
  const Result r = until("coordinates = [\"z\"]\ngravity.field = \"-10*ez\"\n"
                         "particle = [{name = \"p\", mass = 1, position = \"z*ez\"}]\n"
                         "event = [{name = \"b\", when = \"z\", direction = \"down\", set = {\"z'\" = \"-z'\"}}]\n"
                         "[initial]\nz = 1\n",
                         1000);
  // sqrt(1/5) from the start to the floor, twice that from impact to impact.
  const long double half = std::sqrt(0.2L), into = std::remainder(1000.0L, 2 * half);
  const double z = static_cast<double>(1 - 5 * into * into);
  const double miss = std::abs(std::stod(r.rows.rows().back()[1]) - z);
  ASSERT_GT(miss, 1e-13);
  EXPECT_GT(10 * r.error(ColumnKind::coordinate), miss);
}

}  // namespace
}  // namespace anholon::estimate_test

// The numbers of a run that a page keeps.
#include <cmath>

#include <gtest/gtest.h>

#include "report/bibliography.h"
#include "report/columns.h"
#include "report/observer_path.h"
#include "report/rows/frames.h"
#include "report/rows/page_rows.h"
#include "support/models.h"

namespace anholon::columns_test {
namespace {

TEST(Extremes, EveryPeakStaysHoweverNarrow) {
  std::vector<double> values(100000);
  for (std::size_t k = 0; k < values.size(); ++k) values[k] = std::sin(static_cast<double>(k) * 1e-3);
  values[31337] = 7, values[70001] = -9, values[50000] = std::nan("");
  const std::vector<std::size_t> rows = keep_extremes(values, 1000);
  EXPECT_LT(rows.size(), 1600U);
  EXPECT_TRUE(std::is_sorted(rows.begin(), rows.end()));
  EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end()), rows.end());
  for (std::size_t kept :
       {std::size_t{0}, std::size_t{31337}, std::size_t{70001}, std::size_t{50000}, values.size() - 1})
    EXPECT_TRUE(std::binary_search(rows.begin(), rows.end(), kept)) << kept;
}

TEST(Extremes, FewRowsAreKeptWhole) {
  EXPECT_EQ(keep_extremes({3, 1, 2}, 3), (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_TRUE(keep_extremes({}, 10).empty());
}

TEST(Packed, HoldsTheBitsOfTheNumbers) {
  EXPECT_EQ(packed({}), "");
  EXPECT_EQ(packed({1.0}), "AAAAAAAA8D8=");  // 00 00 00 00 00 00 f0 3f
  EXPECT_EQ(packed({-2.5, 0.0}), "AAAAAAAABMAAAAAAAAAAAA==");
  EXPECT_EQ(packed({0, 0, 0}), std::string(32, 'A'));
}

// The mass doubles at an event: the kinetic energy of the later rows is that of the new mass.
TEST(Plots, KnowWhatEventsHaveSet) {
  Scenario prepared;
  ASSERT_TRUE(
      make_scenario(
          test::model_of(
              "coordinates = [\"x\"]\n[mode]\nn = 1\n[[particle]]\nname = \"p\"\nmass = \"n\"\nposition = \"x*ex\"\n"
              "[[event]]\nname = \"catch\"\nwhen = \"x - 1\"\nset = {n = \"2*n\"}\n[initial]\n\"x'\" = 2\n"),
          *find_formulation("routh"), {}, prepared)
          .ok());
  Workspace s(prepared);
  RunFile run;
  run.table.set_columns({"t", "x", "x'"});
  for (const char* t : {"0", "0.25", "0.5", "0.75", "1"}) {
    const std::vector<std::string> row = {t, std::to_string(2 * std::stod(t)), "2"};
    for (std::size_t k = 0; k < 3; ++k) run.table.add(k, row[k]);
  }
  const auto kinetic = [&] {
    for (const PlotColumn& c : plot_data(s, {}, run, scene(*s.mechanics)).columns)
      if (c.name == "T") return c.values;
    return std::vector<double>{};
  };
  EXPECT_EQ(kinetic(), (std::vector<double>{2, 2, 2, 2, 2}));
  run.report =
      R"({"outcome": "finished", "events": [{"name": "catch", "t": 0.5, "set": {"n": {"before": 1, "after": 2}}}]})";
  // An event has a row before it and one after it.
  EXPECT_EQ(kinetic(), (std::vector<double>{2, 2, 2, 4, 4, 4}));
}

// The frame of a table that turns at a constant rate, and a frame whose origin moves in a circle.
TEST(ObserverPath, TurnsAsTheSpinSays) {
  const auto model = test::shipped("zoo/ball-on-turntable-rotating");  // spin 3 about z
  const std::vector<double> parameters = parameter_values<double>(*model);
  const std::vector<ObserverPose> poses = observer_path(*model, parameters, {0, 0.5, 2});
  for (std::size_t k = 0; k < 3; ++k) {
    const double t = std::vector<double>{0, 0.5, 2}[k];
    // Runge-Kutta's own error: (0.02)^5 / 120 a step, 300 steps.
    EXPECT_NEAR(poses[k].quaternion[0], std::cos(1.5 * t), 1e-8);
    EXPECT_NEAR(poses[k].quaternion[3], std::sin(1.5 * t), 1e-8);
    EXPECT_EQ(poses[k].origin[0], 0);
  }
}

TEST(ObserverPath, FollowsTheVelocityOfTheOrigin) {
  const auto model =
      test::shipped("papers/luo-zhao-example-2");  // inertial velocity (0.2 cos t, 0.1 sin t), spin 0.1 sin t
  const std::vector<ObserverPose> poses = observer_path(*model, parameter_values<double>(*model), {4});
  EXPECT_NEAR(poses[0].origin[0], 0.2 * std::sin(4.0), 1e-8);
  EXPECT_NEAR(poses[0].origin[1], 0.1 * (1 - std::cos(4.0)), 1e-8);
  EXPECT_NEAR(2 * std::atan2(poses[0].quaternion[3], poses[0].quaternion[0]), 0.1 * (1 - std::cos(4.0)), 1e-8);
}

TEST(Bibliography, NamesWhatRefsBibHolds) {
  EXPECT_EQ(reference("JorbaZou2005"),
            "Jorba, À.; Zou, M.: A software package for the numerical integration of ODEs by means of high-order "
            "Taylor methods. Experimental Mathematics 14 (1), 99–117, 2005.");
  EXPECT_EQ(reference("nobody"), "");
  Bibliography b;
  b.source("Appell 1911; Somebody: A Book");
  b.source("Somebody: A Book");
  ASSERT_EQ(b.entries().size(), 2U);
  EXPECT_EQ(b.entries()[1], "Somebody: A Book.");
  EXPECT_EQ(b.entries()[0], reference("Appell1911"));
}

}  // namespace
}  // namespace anholon::columns_test

// The rows of a page: its own rows if the motion is computed for it, pairs of rows at jumps, and enough rows that the
// animation is right between them.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "report/columns.h"
#include "report/rows/frames.h"
#include "report/rows/page_rows.h"
#include "simulation/report_json.h"
#include "simulation/simulate.h"
#include "support/models.h"

namespace anholon::page_rows_test {
namespace {

constexpr const char* kBall =
    "coordinates = [\"z\"]\n[[particle]]\nname = \"p\"\nmass = 1\nposition = \"z*ez\"\n[gravity]\nfield = \"-10*ez\"\n"
    "[[event]]\nname = \"bounce\"\nwhen = \"z\"\ndirection = \"down\"\nset = {\"z'\" = \"-z'/2\"}\n[initial]\nz = 5\n";

Scenario scenario_of(const std::string& text) {
  Scenario s;
  EXPECT_TRUE(make_scenario(test::model_of(text), *find_formulation("routh"), {}, s).ok());
  return s;
}

// A table with columns t, x, x', x'' of a function with its derivatives.
template <class F>
RunTable table_of(const F& jet, int rows, double step) {
  RunTable table;
  table.set_columns({"t", "x", "x'", "x''"});
  for (int k = 0; k < rows; ++k) {
    const std::array<double, 3> x = jet(k * step);
    const std::vector<double> row = {k * step, x[0], x[1], x[2]};
    table.add_row({row});
  }
  return table;
}

std::array<double, 3> sine(double t) { return {std::sin(t), std::cos(t), -std::sin(t)}; }

std::vector<MovingColumn> moving(const RunTable& table) {
  return {{table.values[1], table.values[2], table.values[3]}};
}

TEST(PictureRows, LieInEachStepAndOnBothSidesOfAnEvent) {
  const Scenario s = scenario_of(kBall);
  SimulationOptions options;
  options.to = Rational(3, 2);
  options.picture = PictureRows{4, 0.1};
  RunFile run;
  RunSink sink(run);
  const SimulationReport r = simulate(s, options, sink);
  ASSERT_TRUE(r.outcome.ok());
  ASSERT_EQ(r.events.size(), 1U);
  const RunTable& table = run.table;
  const std::span<const double> t = table.values[0], speed = table.values[table.find("z'")];
  std::size_t pairs = 0;
  for (std::size_t k = 1; k < table.rows(); ++k) {
    EXPECT_LE(t[k] - t[k - 1], 0.1 * (1 + 1e-12));
    if (t[k] != t[k - 1]) continue;
    ++pairs;
    EXPECT_NEAR(t[k], 1, 1e-12);
    EXPECT_NEAR(speed[k - 1], -10, 1e-10);
    EXPECT_NEAR(speed[k], 5, 1e-10);
  }
  EXPECT_EQ(pairs, 1U);
  EXPECT_GE(table.rows(), 4 * run.steps.size());
}

// Free fall is a polynomial of degree 2, so its continuation to the event by derivatives is exact.
TEST(RowsForPage, ContinueRowsToTheEventBetweenThem) {
  const Scenario s = scenario_of(kBall);
  SimulationOptions options;
  options.to = Rational(3, 2);
  options.every = Rational(3, 10);
  RunFile run;
  RunSink sink(run);
  const SimulationReport r = simulate(s, options, sink);
  ASSERT_EQ(run.table.rows(), 6U);
  const RunTable table = rows_for_page(*s.model, run.table, r.events);
  ASSERT_EQ(table.rows(), 8U);
  const std::span<const double> t = table.values[0], z = table.values[table.find("z")],
                                speed = table.values[table.find("z'")];
  EXPECT_EQ(t[4], t[5]);
  EXPECT_NEAR(t[4], 1, 1e-12);
  EXPECT_NEAR(z[4], 0, 1e-10);
  EXPECT_EQ(z[4], z[5]);
  EXPECT_NEAR(speed[4], -10, 1e-10);
  EXPECT_NEAR(speed[5], 5, 1e-10);
}

// The row at the event repeats the row before it. A second event before the next row leaves the velocity between the
// events unknown.
TEST(RowsForPage, KnowWhatNoRowTells) {
  const Scenario s = scenario_of(kBall);
  RunTable table = table_of(sine, 3, 1);
  table.columns = {"t", "z", "z'", "z''"};
  EventReport first{"bounce", {1, ""}, {{"z'", {-1, ""}, {1, ""}}}, 0, false}, second = first;
  second.t.value = 1.5;
  const RunTable page = rows_for_page(*s.model, table, {first, second});
  ASSERT_EQ(page.rows(), 6U);
  const std::vector<double> t(page.values[0].begin(), page.values[0].end());
  EXPECT_EQ(t, (std::vector<double>{0, 1, 1, 1.5, 1.5, 2}));
  EXPECT_EQ(page.values[1][2], page.values[1][1]);
  EXPECT_TRUE(std::isnan(page.values[2][2]));
  EXPECT_TRUE(std::isnan(page.values[2][3]));
  EXPECT_TRUE(std::isfinite(page.values[2][4]));
}

TEST(RowsForPage, HaveTimesThatAscend) {
  const Scenario s = scenario_of(kBall);
  RunTable table = table_of(sine, 3, -1);
  const RunTable page = rows_for_page(*s.model, table, {});
  EXPECT_EQ(page.values[0][0], -2);
  EXPECT_EQ(page.values[0][2], 0);
  EXPECT_EQ(page.values[1][0], std::sin(-2.0));
}

TEST(PageSink, HalvesManyRowsButNoJump) {
  RunFile run;
  PageSink sink(run, 400);
  RunColumn column;
  column.name = "t";
  sink.columns({column});
  const auto row = [&](double t) { sink.row({{&t, 1}}); };
  for (int k = 0; k <= 1000; ++k) {
    row(k);
    if (k == 501) row(k);
  }
  sink.finish();
  const std::span<const double> t = run.table.values[0];
  EXPECT_LE(t.size(), 401U);
  EXPECT_GE(t.size(), 200U);
  EXPECT_TRUE(std::is_sorted(t.begin(), t.end()));
  EXPECT_EQ(t.front(), 0);
  EXPECT_EQ(t.back(), 1000);
  EXPECT_EQ(std::count(t.begin(), t.end(), 501), 2);
}

TEST(Frames, ReproduceTheRowsBetweenThem) {
  const RunTable table = table_of(sine, 20001, 0.01);
  const std::span<const double> t = table.values[0];
  const ChosenFrames frames = choose_frames(t, moving(table), 2000);
  ASSERT_TRUE(frames.enough);
  EXPECT_LE(frames.rows.size(), 2000U);
  EXPECT_EQ(frames.rows.back(), 20000U);
  for (std::size_t n = 1; n < frames.rows.size(); ++n)
    for (std::size_t k = frames.rows[n - 1] + 1; k < frames.rows[n]; ++k)
      ASSERT_NEAR(between_rows(moving(table)[0], t, frames.rows[n - 1], k, frames.rows[n]), std::sin(t[k]), 1e-7);
  // 200 s are 32 periods; 20 frames cannot show them.
  EXPECT_FALSE(choose_frames(t, moving(table), 20).enough);
}

TEST(Frames, TellWhereRowsAreTooFarApart) {
  for (const double step : {0.1, 0.5, 1.0}) {
    const RunTable table = table_of(sine, 200, step);
    EXPECT_EQ(doubtful_intervals(table.values[0], moving(table)), 0U) << step;
  }
  // The rows are 2.045 periods apart, as are 1.46 s with a period of 0.714 s.
  const RunTable table = table_of(sine, 200, 2 * std::numbers::pi * 2.045);
  EXPECT_GT(doubtful_intervals(table.values[0], moving(table)), 150U);
}

// The round-off of a column at rest is no motion beside a column that moves.
TEST(Frames, TakeRoundOffForNoMotion) {
  RunTable table = table_of(sine, 300, 0.1);
  const RunTable noise =
      table_of([](double t) { return std::array<double, 3>{1e-33 * std::sin(1e9 * t), 0, 0}; }, 300, 0.1);
  std::vector<MovingColumn> both = moving(table);
  both.push_back(moving(noise)[0]);
  EXPECT_EQ(doubtful_intervals(table.values[0], both), 0U);
  EXPECT_EQ(choose_frames(table.values[0], both, 300).rows, choose_frames(table.values[0], moving(table), 300).rows);
}

TEST(Frames, LeaveOutNoSideOfAJump) {
  RunTable table;
  table.set_columns({"t", "x", "x'", "x''"});
  for (int k = 0; k <= 100; ++k)
    for (int side = 0; side < (k == 50 ? 2 : 1); ++side) {
      const double t = k * 0.1, v = k < 50 || (k == 50 && side == 0) ? 1 : -1;
      const std::vector<double> row = {t, 5 - std::abs(t - 5), v, 0};
      table.add_row({row});
    }
  const ChosenFrames frames = choose_frames(table.values[0], moving(table), 60);
  EXPECT_TRUE(frames.enough);
  EXPECT_LT(frames.rows.size(), 20U);
  EXPECT_TRUE(std::binary_search(frames.rows.begin(), frames.rows.end(), 50U));
  EXPECT_TRUE(std::binary_search(frames.rows.begin(), frames.rows.end(), 51U));
}

TEST(RowsOfAFile, AreThoseOfAMotionOfTheModel) {
  const Scenario s = scenario_of(kBall);
  const auto table = [](std::vector<std::string> columns, const std::vector<double>& times) {
    RunTable t;
    t.set_columns(std::move(columns));
    for (const double x : times) {
      const std::vector<double> row = {x, 0};
      t.add_row({row});
    }
    return t;
  };
  EXPECT_EQ(obstacle_to_showing(*s.model, table({"t", "z"}, {0, 1, 1, 2}), true), "");
  EXPECT_EQ(obstacle_to_showing(*s.model, table({"t", "z"}, {0, -1}), true), "");
  EXPECT_EQ(obstacle_to_showing(*s.model, table({"t", "x"}, {0, 1}), true),
            "the rows have no column for coordinates of the model: z");
  EXPECT_EQ(obstacle_to_showing(*s.model, table({"t", "z"}, {0, 9, 8}), true),
            "the time turns round in line 4: 8 after 9");
  EXPECT_EQ(obstacle_to_showing(*s.model, table({"t", "z"}, {0, std::nan("")}), false),
            "the time in row 2 is no number");
}

TEST(Plots, SayWhichRowsAreTooFewAndWhichColumnsAreChosen) {
  Workspace s(scenario_of(kBall));
  RunFile run;
  run.table = table_of(sine, 100, 2 * std::numbers::pi * 2.045);
  run.table.columns = {"t", "z", "z'", "z''"};
  const Scene picture = scene(*s.mechanics);
  const PlotData rough = plot_data(s, {}, run, picture);
  EXPECT_TRUE(rough.rough);
  EXPECT_NE(rough.caution.find("of 99 intervals"), std::string::npos) << rough.caution;
  run.table = table_of(sine, 100, 0.1);
  run.table.columns = {"t", "z", "z'", "z''"};
  const PlotData fine = plot_data(s, {}, run, picture, {"z''"});
  EXPECT_FALSE(fine.rough);
  EXPECT_EQ(fine.caution, "");
  for (const PlotColumn& c : fine.columns)
    if (c.name.starts_with("z")) {
      EXPECT_EQ(c.group, c.name == "z''" ? "accelerations" : "") << c.name;
    }
  for (const PlotGroup& g : fine.groups)
    if (g.id == "accelerations") {
      EXPECT_EQ(g.columns, 1U);
    }
  EXPECT_FALSE(fine.frames.empty());
}

// The mode of a contact is 1 until the event at 0.25, and 2 after it.
TEST(Plots, DrawModesAsSteps) {
  Workspace s(scenario_of(kBall));
  RunFile run;
  run.table.set_columns({"t", "z", "floor.mode", "floor.gap", "floor.normal", "floor.friction"});
  for (const double t : {0.0, 1.0}) {
    const std::vector<double> row = {t, 0, t < 0.25 ? 1.0 : 2.0, 0, 0, 0};
    run.table.add_row({row});
  }
  run.report = R"({"outcome": "finished", "events": [{"name": "floor.sticks", "t": 0.25}]})";
  for (const PlotColumn& c : plot_data(s, {}, run, scene(*s.mechanics)).columns) {
    if (c.name != "floor.mode") continue;
    EXPECT_EQ(c.t, (std::vector<double>{0, 0.25, 0.25, 1}));
    EXPECT_EQ(c.values, (std::vector<double>{1, 1, 2, 2}));
  }
}

}  // namespace
}  // namespace anholon::page_rows_test

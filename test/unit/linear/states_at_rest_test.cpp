// Equilibria of models with states of their own, against closed forms.
#include <gtest/gtest.h>

#include "linear/study.h"
#include "support/models.h"

namespace anholon::states_at_rest_test {
namespace {

constexpr double kExact = 1e-15;

// An arm with a direct-current motor, whose current is a state, and an integral of the error: at rest k i = m g l sin ref,
// e = R i / 20. A clock and an odometer count beside it.
const char* const kArm = R"toml(
coordinates = ["th"]
parameters = {R = 2, k = 0.5, m = 0.3, g = 9.81, l = 0.4, ref = 0.6}
gravity.field = "-g*ey"
particle = [{name = "bob", mass = "m", position = "l*(sin(th)*ex - cos(th)*ey)"}]
force = [{generalized = {th = "k*i - 0.2*th'"}}]
[define]
U = "8*(ref - th) + 20*e - th'"
[state]
i = {rate = "(U - R*i - k*th')*100", initial = 0}
e = {rate = "ref - th", initial = 0}
clock = {rate = "1", initial = 0}
way = {rate = "th'^2 + 3", initial = 7}
)toml";

Linearization at_rest(const std::string& text, const std::string& values = "", int digits = 16) {
  const auto model = test::model_of(text);
  LinearRequest request;
  request.form = find_formulation("routh");
  request.equilibrium = true;
  request.digits = digits;
  if (!values.empty()) request.range = read_range(values, *model);
  const LinearStudy study(model, request);
  const PrecisionScope precision(study.working_digits());
  return study.compute();
}

double value(const LinearModel& m, const std::string& name) {
  for (std::size_t k = 0; k < m.states.size(); ++k)
    if (m.states[k] == name) return to_double(m.values[k]);
  ADD_FAILURE() << "no state " << name;
  return 0;
}

void expect_rest(const LinearResult& r, double ref) {
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_EQ(r.model.motion, LinearModel::Motion::steady) << r.model.why;  // the clock and the odometer go on
  const double i = 0.3 * 9.81 * 0.4 * std::sin(ref) / 0.5;
  EXPECT_NEAR(value(r.model, "th"), ref, kExact);
  EXPECT_NEAR(value(r.model, "i"), i, 4 * kExact);
  EXPECT_NEAR(value(r.model, "e"), 2 * i / 20, kExact);
  EXPECT_EQ(value(r.model, "clock"), 0);
  EXPECT_EQ(value(r.model, "way"), 7);
}

TEST(StatesAtRest, FollowFromTheLawsOfRest) { expect_rest(at_rest(kArm).results[0], 0.6); }

TEST(StatesAtRest, AreFoundForEachValueOfAParameter) {
  const Linearization l = at_rest(kArm, "ref=0.2,0.5,0.9");
  ASSERT_EQ(l.results.size(), 3U);
  expect_rest(l.results[0], 0.2), expect_rest(l.results[1], 0.5), expect_rest(l.results[2], 0.9);
}

TEST(StatesAtRest, HaveTheDigitsOfTheResult) {
  const PrecisionScope precision(80);  // copies of results keep their digits
  const LinearModel m = at_rest(kArm, "", 40).results[0].model;
  for (std::size_t k = 0; k < m.states.size(); ++k)
    if (m.states[k] == "e") {
      const Multi exact = Multi(3) * Multi(981) * Multi(4) * sin(Multi(6) / Multi(10)) / Multi(10000) / Multi(5);
      EXPECT_LT(to_double(abs(m.values[k] - exact)), 1e-41);
    }
}

// A state whose rate vanishes nowhere keeps its initial value, and the motion is not steady.
TEST(StatesAtRest, KeepTheirValuesWhereTheyCannotRest) {
  const LinearResult r = at_rest(R"toml(
coordinates = ["z"]
particle = [{name = "tank", mass = "m", position = "z*ez"}]
state.m = {rate = "-1/10", initial = 2}
force = [{on = "tank", vector = "-z*ez"}]
gravity.field = "-10*ez"
)toml")
                             .results[0];
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_EQ(r.model.motion, LinearModel::Motion::unsteady);
  EXPECT_EQ(value(r.model, "m"), 2);
  EXPECT_NEAR(value(r.model, "z"), -20, 1e-13);
}

// The search also moves positions that depend on states by a constraint.
TEST(StatesAtRest, MoveWhatConstraintsKeep) {
  const LinearModel m = at_rest(R"toml(
coordinates = ["x", "y"]
particle = [{name = "bead", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "wire", equation = "y = s*x"}]
state.s = {rate = "1/4 - s*x", initial = 1}
force = [{on = "bead", vector = "-(x - 1)*ex - y*ey"}]
initial = {x = 0.5, y = 0.5}
)toml")
                            .results[0]
                            .model;
  // (x - 1) + s y = 0 with y = s x = 1/4: x = 1 - s/4 and s x = 1/4, so s = 2 - sqrt 3 near 0.27 (the other is 3.73).
  const double s = value(m, "s");
  EXPECT_NEAR(s * s - 4 * s + 1, 0, 1e-14);
  EXPECT_NEAR(value(m, "x"), 1 - s / 4, kExact);
  EXPECT_EQ(m.motion, LinearModel::Motion::equilibrium) << m.why;
}

}  // namespace
}  // namespace anholon::states_at_rest_test

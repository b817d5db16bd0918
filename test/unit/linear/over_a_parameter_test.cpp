// Linear models over values of a parameter: the equations at each value, and the values at which eigenvalues cross the
// imaginary axis.
#include <gtest/gtest.h>

#include "linear/study.h"
#include "support/models.h"

namespace anholon::over_a_parameter_test {
namespace {

constexpr double kExact = 1e-14;  // of doubles
constexpr double kRoot = 1e-10;   // of a crossing, which false position finds

Linearization over(const std::string& text, const std::string& values, bool equilibrium = false) {
  const auto model = test::model_of(text);
  LinearRequest request;
  request.form = find_formulation("routh");
  request.equilibrium = equilibrium;
  if (!values.empty()) request.range = read_range(values, *model);
  const LinearStudy study(model, request);
  const PrecisionScope precision(study.working_digits());
  return study.compute();
}

// The frequencies of a model without damping, in increasing order.
std::vector<double> frequencies(const LinearResult& r) {
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  std::vector<double> list;
  for (const Eigenvalue& e : r.model.spectrum) {
    EXPECT_LT(std::abs(to_double(e.value.re)), kExact);
    if (e.value.im > Multi(0)) list.push_back(to_double(e.value.im));
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<double> places(const Linearization& l) {
  std::vector<double> list;
  for (const Crossing& c : l.crossings) list.push_back(to_double(c.value));
  return list;
}

void expect_near(const std::vector<double>& found, const std::vector<double>& expected, double by) {
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], by);
}

// x'' = y - x, J y'' = x - 2 y: without J it is x'' = -x/2; with J = 1 the squared frequencies are (3 -+ sqrt 5)/2.
std::string wheel(const std::string& inertia) {
  return "coordinates = [\"x\", \"y\"]\nparameters.J = " + inertia +
         "\nparticle = [{name = \"a\", mass = 1, position = \"x*ex\"}]\npotential.k = \"(x - y)^2/2 + y^2/2\"\n"
         "body = [{name = \"w\", inertia = \"J\", center = \"0\", angle = \"y\"}]\n";
}

TEST(OverAParameter, AValueOfTheFileThatIsZero) {
  const std::vector<double> without{std::sqrt(0.5)},
      with{std::sqrt((3 - std::sqrt(5)) / 2), std::sqrt((3 + std::sqrt(5)) / 2)};
  for (const char* in_file : {"0", "1", "7"})
    for (const char* values : {"J=0,1", "J=1,0,1,0"}) {
      const Linearization l = over(wheel(in_file), values);
      for (const LinearResult& r : l.results) expect_near(frequencies(r), r.value == "0" ? without : with, kExact);
      EXPECT_TRUE(l.crossings.empty() && l.notes.empty());
    }
}

// (1 - p) x'' = -3 x - x': at p = 1 the equations have another order.
TEST(OverAParameter, ACoefficientThatVanishes) {
  for (const char* in_file : {"1", "0"}) {
    const Linearization l = over(std::string("coordinates = [\"x\"]\nparameters.p = ") + in_file +
                                     "\nparticle = [{name = \"a\", mass = 1, position = \"x*ex\"}]\n"
                                     "force = [{on = \"a\", vector = \"(p*x'' - 3*x - x')*ex\"}]\n",
                                 "p=0,1,2");
    std::vector<std::vector<double>> real;
    for (const LinearResult& r : l.results) {
      ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
      real.emplace_back();
      for (const Eigenvalue& e : r.model.spectrum) real.back().push_back(to_double(e.value.re));
    }
    expect_near(real[0], {-0.5, -0.5}, kExact);
    expect_near(real[1], {-3}, kExact);
    expect_near(real[2], {(1 + std::sqrt(13)) / 2, (1 - std::sqrt(13)) / 2}, kExact);
  }
}

// The value of the file has no start or no equations; the values of the range have both.
TEST(OverAParameter, TheStartOfTheFileIsNotNeeded) {
  const Linearization rod = over(R"(coordinates = ["x", "y"]
parameters.L = 0.1
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "c", equation = "x^2 + y^2 = L^2"}]
gravity.field = "-4*ey"
initial = {x = 0.5, guess = {y = -1}}
)",
                                 "L=0.01,1,4");
  EXPECT_EQ(rod.results[0].outcome.kind, OutcomeKind::inconsistent);
  EXPECT_TRUE(rod.results[1].outcome.ok() && rod.results[2].outcome.ok());
  const Linearization spring = over(R"(coordinates = ["x"]
parameters.a = 0
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "-x/a*ex"}]
)",
                                    "a=1,0.25");
  expect_near(frequencies(spring.results[0]), {1}, kExact);
  expect_near(frequencies(spring.results[1]), {2}, kExact);
  const Linearization power = over(R"(coordinates = ["x"]
parameters.n = 2
particle = [{name = "p", mass = 1, position = "x*ex"}]
force = [{on = "p", vector = "-9*x^n*ex"}]
)",
                                   "n=1,3");
  expect_near(frequencies(power.results[0]), {3}, kExact);
  expect_near(frequencies(power.results[1]), {}, kExact);
}

std::string plane(const std::string& force, const std::string& initial = "x = 0") {
  return "coordinates = [\"x\", \"y\", \"z\"]\nparameters.p = 1\n"
         "particle = [{name = \"a\", mass = 1, position = \"x*ex + y*ey + z*ez\"}]\nforce = [{on = \"a\", vector = \"" +
         force + "\"}]\ninitial = {" + initial + "}\n";
}

// x has no effect to first order, and acts on y to the third.
TEST(Crossings, WhereACoordinateActsToHigherOrderOnly) {
  expect_near(places(over(plane("-x'*ex + (-(p - 1.1)*y - y' + x^3)*ey - z'*ez"), "p=0,3")), {1.1}, kRoot);
  expect_near(places(over(plane("(-x' - x^3)*ex - ((p - 1.1)*y + y')*ey - ((p - 2.2)*z + z')*ez"), "p=0,3")),
              {1.1, 2.2}, kRoot);
  expect_near(places(over(plane("(-x' - x^3)*ex - ((p - 1.1)*y + y')*ey - ((p - 2.2)*z + z')*ez"), "p=0..3:1")),
              {1.1, 2.2}, kRoot);
}

// A pair becomes stable at 1.2 and a real eigenvalue unstable at 1.5.
TEST(Crossings, ThatCancelEachOtherInPart) {
  const Linearization l = over(plane("(-3*x - (p - 1.2)*x')*ex - ((1.5 - p)*y + y')*ey - (z + z')*ez"), "p=0,3.1");
  expect_near(places(l), {1.2, 1.5}, kRoot);
  EXPECT_EQ(l.crossings[0].eigenvalues, 2);
  EXPECT_EQ(meaning(l.crossings[0]), "stable above");
  EXPECT_EQ(meaning(l.crossings[1]), "unstable above");
  EXPECT_TRUE(l.notes.empty());
}

// Between 0.7 and 1.2 the pair is still unstable. Values come in any order and twice.
TEST(Crossings, WhatIsStableAbove) {
  for (const char* values : {"p=0.5,2", "p=0.5,1,2", "p=2,0.5,1,0.5"}) {
    Linearization l = over(plane("(-3*x - (p - 1.2)*x')*ex - ((p - 0.7)*y + y')*ey - (z + z')*ez"), values);
    if (l.crossings.size() == 2 && l.crossings[1].value < l.crossings[0].value)
      std::swap(l.crossings[0], l.crossings[1]);
    expect_near(places(l), {0.7, 1.2}, kRoot);
    EXPECT_EQ(meaning(l.crossings[0]), "to the left above, where 2 eigenvalues are still unstable");
    EXPECT_EQ(meaning(l.crossings[1]), "stable above");
  }
}

// The crossings at 0.7 and 1.5 cancel each other between 0 and 3; above 1.2 all eigenvalues are stable nevertheless.
TEST(Crossings, StableAboveWhereOthersAreNotFound) {
  const Linearization l =
      over(plane("(-3*x - (p - 1.2)*x')*ex - ((1.5 - p)*y + y')*ey - ((p - 0.7)*z + z')*ez"), "p=0,3");
  expect_near(places(l), {1.2}, kRoot);
  EXPECT_EQ(meaning(l.crossings[0]), "stable above");
}

TEST(Crossings, OfStatesThatAreNotSteady) {
  const Linearization l = over(plane("(1 - 3*x - (p - 1.2)*x')*ex - (y + y')*ey - (z + z')*ez"), "p=0,2");
  expect_near(places(l), {1.2}, kRoot);
  EXPECT_EQ(meaning(l.crossings[0]), "to the left above");
}

// At p = 2 the branch of x < 0 ends, and the search finds the one of x > 0.
TEST(Crossings, NoneWhereTheMotionJumps) {
  const Linearization l =
      over(plane("(p + 3*x - x^3 - (0.1 - 0.2*max(x, 0))*x')*ex - (y + y')*ey - (z + z')*ez", "x = -2"), "p=1,3", true);
  EXPECT_TRUE(l.results[0].outcome.ok() && l.results[1].outcome.ok());
  EXPECT_TRUE(l.crossings.empty());
  ASSERT_EQ(l.notes.size(), 1U);
  EXPECT_NE(l.notes[0].find("jump"), std::string::npos);
}

// Two eigenvalues meet at 0 for p = 1/3: one of them is positive below, above they are a pair.
TEST(Crossings, WhereTwoMeetAtZero) {
  const Linearization l = over(plane("-(p - 1/3)*(x + x')*ex - (y + y')*ey - (z + z')*ez"), "p=0,3");
  expect_near(places(l), {1.0 / 3}, kRoot);
  EXPECT_TRUE(l.crossings[0].frequency == Multi(0));
  EXPECT_EQ(meaning(l.crossings[0]), "stable above");
  EXPECT_TRUE(l.notes.empty());
}

// A pair on the right meets at 0, and one of its eigenvalues stays unstable as a real one.
TEST(Crossings, WhereAPairPartsAtZero) {
  const Linearization l = over(plane("(p - 1/3)*(x - x')*ex - (y + y')*ey - (z + z')*ez"), "p=0,3");
  expect_near(places(l), {1.0 / 3}, kRoot);
  EXPECT_TRUE(l.crossings[0].frequency == Multi(0));
  EXPECT_EQ(meaning(l.crossings[0]), "to the left above, where 1 eigenvalue is still unstable");
  EXPECT_TRUE(l.notes.empty());
}

TEST(Crossings, OfATinyParameter) {
  const Linearization l = over(plane("(-x - (p/1.25e-24 - 1)*x')*ex - (y + y')*ey - (z + z')*ez"), "p=0,3.7e-24");
  ASSERT_EQ(l.crossings.size(), 1U);
  EXPECT_NEAR(to_double(l.crossings[0].value) / 1.25e-24, 1, kRoot);
}

}  // namespace
}  // namespace anholon::over_a_parameter_test

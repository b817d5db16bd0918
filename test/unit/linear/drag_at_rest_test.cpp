// Linear models at rest of forces with roots of squares of velocities.
#include <gtest/gtest.h>

#include "linear/study.h"
#include "support/models.h"

namespace anholon::drag_at_rest_test {
namespace {

constexpr double kExact = 1e-14;  // of doubles

Linearization linear(const std::string& text, bool equilibrium = false, const std::string& values = "",
                     std::vector<StateOverride> overrides = {}) {
  const auto model = test::model_of(text);
  LinearRequest request;
  request.form = find_formulation("routh");
  request.equilibrium = equilibrium;
  request.choice.overrides = std::move(overrides);
  if (!values.empty()) request.range = read_range(values, *model);
  const LinearStudy study(model, request);
  const PrecisionScope precision(study.working_digits());
  return study.compute();
}

std::string plane(const std::string& more) {
  return "coordinates = [\"x\", \"y\"]\nparameters.c = 0\n"
         "particle = [{name = \"p\", mass = 1, position = \"x*ex + y*ey\"}]\npotential.s = \"x^2 + 2*y^2\"\n" +
         more;
}
std::string drag(const std::string& vector) {
  return plane("force = [{name = \"drag\", on = \"p\", vector = \"" + vector + "\"}]\n");
}

// A = [[0, I], [-diag(2, 4), 0]]: the drag has no share.
void expect_undamped(const LinearResult& r) {
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  ASSERT_EQ(r.model.states, (std::vector<std::string>{"x", "y", "x'", "y'"}));
  const double A[4][4] = {{0, 0, 1, 0}, {0, 0, 0, 1}, {-2, 0, 0, 0}, {0, -4, 0, 0}};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(to_double(r.model.A(i, k)), A[i][k], kExact);
  for (const Multi& value : r.model.values) EXPECT_EQ(to_double(value), 0);
}

TEST(DragAtRest, HasNoShareInTheLinearModel) {
  for (const char* vector :
       {"-norm(vel(p))*vel(p)", "-sqrt(norm2(vel(p)))*vel(p)", "-norm2(vel(p))*unit(vel(p))", "-sqrt(x'^2)*x'*ex",
        "-abs(x')*x'*ex", "-(x'^2)^(3/2)*ex", "-norm(vel(p))^(1/2)*vel(p)", "-c*norm(vel(p))*vel(p)"})
    for (const bool equilibrium : {false, true}) {
      SCOPED_TRACE(vector);
      expect_undamped(linear(drag(vector), equilibrium).results[0]);
    }
  expect_undamped(linear(plane("dissipation.d = \"norm(vel(p))^3/3\"\n")).results[0]);
}

TEST(DragAtRest, LinearDragStaysBesideIt) {
  const LinearResult r = linear(drag("-3*vel(p) - norm(vel(p))*vel(p)")).results[0];
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_NEAR(to_double(r.model.A(2, 2)), -3, kExact);
  EXPECT_EQ(to_double(r.model.A(2, 3)), 0);
}

// In motion at x' = 3, y' = 4 the drag |v| v has the derivatives |v| + x'^2/|v|, x' y'/|v|, |v| + y'^2/|v|.
TEST(DragAtRest, InMotionItDamps) {
  const LinearResult r = linear(drag("-norm(vel(p))*vel(p)") + "initial = {\"x'\" = 3, \"y'\" = 4}\n").results[0];
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_NEAR(to_double(r.model.A(2, 2)), -6.8, kExact);
  EXPECT_NEAR(to_double(r.model.A(2, 3)), -2.4, kExact);
  EXPECT_NEAR(to_double(r.model.A(3, 2)), -2.4, kExact);
  EXPECT_NEAR(to_double(r.model.A(3, 3)), -8.2, kExact);
}

// th'' = -9 sin(th) - |th'| th': the square of the speed is th'^2 (cos^2 + sin^2).
TEST(DragAtRest, OfABobOnACircle) {
  const LinearResult r = linear(R"T(coordinates = ["th"]
particle = [{name = "bob", mass = 2, position = "sin(th)*ex - cos(th)*ez"}]
gravity.field = "-9*ez"
force = [{on = "bob", vector = "-2*norm(vel(bob))*vel(bob)"}]
initial.th = 0.5
)T")
                             .results[0];
  ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
  EXPECT_NEAR(to_double(r.model.A(1, 0)), -9 * std::cos(0.5), kExact);
  EXPECT_NEAR(to_double(r.model.A(1, 1)), 0, kExact);
}

TEST(DragAtRest, AnEquilibriumIsFoundFromElsewhere) {
  expect_undamped(linear(drag("-norm(vel(p))*vel(p)"), true, "", {{0, 0, Rational(1, 10)}}).results[0]);
}

TEST(DragAtRest, ValuesOfAParameter) {
  const Linearization l = linear(drag("-c*norm(vel(p))*vel(p)"), false, "c=0,1,2");
  ASSERT_EQ(l.results.size(), 3U);
  for (const LinearResult& r : l.results) expect_undamped(r);
  EXPECT_EQ(l.intervals, 2U);
  EXPECT_EQ(l.searched, 2U);
}

// Friction has a kink at rest. It does not act on an equilibrium, which is found, so the message is about the kink.
TEST(DragAtRest, AKinkIsRefusedWithItsFormula) {
  for (const bool equilibrium : {false, true}) {
    const Outcome o = linear(drag("-norm(vel(p))*ex"), equilibrium, "", {{0, 0, Rational(equilibrium ? 1 : 0, 10)}})
                          .results[0]
                          .outcome;
    EXPECT_EQ(o.kind, OutcomeKind::not_a_number);
    EXPECT_NE(o.message.find("the equation of x has no derivative by x' at this state"), std::string::npos)
        << o.message;
    EXPECT_NE(o.message.find("sqrt(x'^2 + y'^2) in the force 'drag'"), std::string::npos) << o.message;
    EXPECT_NE(o.message.find("x'^2 + y'^2 = 0"), std::string::npos) << o.message;
  }
  const Linearization l = linear(drag("-c*norm(vel(p))*ex"), false, "c=0,1,2");
  ASSERT_EQ(l.results.size(), 3U);
  expect_undamped(l.results[0]);
  EXPECT_EQ(l.results[1].outcome.kind, OutcomeKind::not_a_number);
  EXPECT_EQ(l.intervals, 2U);
  EXPECT_EQ(l.searched, 0U);
}

TEST(DragAtRest, AnOutputWithAKinkIsLeftOut) {
  const LinearResult r =
      linear(drag("-norm(vel(p))*vel(p)") + "output.speed = \"norm(vel(p))\"\noutput.place = \"3*x\"\n").results[0];
  expect_undamped(r);
  ASSERT_EQ(r.model.outputs, (std::vector<std::string>{"place"}));
  EXPECT_EQ(to_double(r.model.C(0, 0)), 3);
  ASSERT_EQ(r.model.notes.size(), 1U);
  EXPECT_EQ(r.model.notes[0].find(
                "the output 'speed' has no derivative by x' at this state: 1/sqrt(x'^2 + y'^2) has no value"),
            0U)
      << r.model.notes[0];
}

}  // namespace
}  // namespace anholon::drag_at_rest_test

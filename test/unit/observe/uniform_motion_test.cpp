// Residuals of motions whose accelerations are round-off: they are compared with the terms that cancel, and a larger
// error is noticed.
#include <algorithm>

#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "support/models.h"

namespace anholon::uniform_motion_test {
namespace {

// A sleigh that coasts: large terms cancel in the equation of th, and th'' is the remaining round-off.
Scenario sleigh(const char* form) {
  Scenario s;
  const Outcome o = make_scenario(test::model_of(R"toml(coordinates = ["x", "y", "th"]
body = [{name = "s", mass = 1, inertia = 0.3, center = "x*ex + y*ey", angle = "th"}]
constraint = [{name = "b", equation = "y'*cos(th) - x'*sin(th) = 0"}]
initial = {th = 0.3, "x'" = 0.1}
)toml"),
                                  *find_formulation(form), {}, s);
  EXPECT_TRUE(o.ok()) << o.message;
  return s;
}

double newton(const Scenario& s, const char* name) {
  StateReport report;
  EXPECT_TRUE(evaluate(s, {}, Precision::long_real, 16, report).ok());
  for (const auto& [which, value] : report.residuals)
    if (which == name) return std::stod(value);
  return -1;
}

TEST(UniformMotion, RoundOffIsComparedWithTheTermsThatCancel) {
  for (const char* form : {"routh", "chaplygin", "voronets", "maggi", "mac-millan", "nielsen-reduced"})
    for (const char* name : {"newton", "projected"}) EXPECT_LT(newton(sleigh(form), name), 1e-16) << form << name;
}

// A force in an equation that is in no law of the points is noticed even if it is far smaller than the terms that
// cancel.
TEST(UniformMotion, AnErrorIsSeen) {
  for (const char* form : {"routh", "chaplygin", "voronets"})
    for (const char* size : {"1", "1e-6", "1e-12"}) {
      Workspace s(sleigh(form));
      Graph& g = s.graph();
      const auto& names = s.system.equation_names;
      const auto th = std::find(names.begin(), names.end(), "th");
      ASSERT_NE(th, names.end());
      Expr& equation = s.system.equations[static_cast<std::size_t>(th - names.begin())];
      equation = equation + g.number(*parse_rational(size)) * g.jet(0, 1) * g.jet(0, 1);
      for (const char* name : {"newton", "projected"}) EXPECT_GT(newton(s, name), 0.1) << form << size << name;
    }
}

}  // namespace
}  // namespace anholon::uniform_motion_test

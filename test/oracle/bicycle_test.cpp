// The bicycle at a state of no symmetry: lean, steer, and all rates. Table 1 of Basu-Mandal, Chatterjee, Papadopoulos:
// Hands-free circular motions of a benchmark bicycle, Proc. R. Soc. A 463 (2007) 1983-2003, whose accelerations two
// independent derivations gave. Their x points back and z up: x, z, heading, pitch, steer and wheel angles have the
// other sign here, lean is counted from the vertical, and (x, y, z) is the centre of the rear wheel.
#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "setup/outputs/output_tape.h"
#include "support/models.h"

namespace anholon::test::bicycle_test {
namespace {

constexpr double kPrinted = 1e-12;  // 13 digits are printed, of the state as well

StateChoice table_1(const Model& model) {
  StateChoice c;
  const auto give = [&](unsigned order, const std::string& name, const std::string& value) {
    for (std::size_t a = 0; a < model.coordinates.size(); ++a)
      if (model.coordinates[a].name == name) c.overrides.push_back({order, a, *parse_rational(value)});
  };
  give(0, "phi", "0.62066704164769661923");  // pi/2 - 0.9501292851472
  give(0, "delta", "-0.2311385135743");
  give(1, "phi", "-0.6068425835418");
  give(1, "delta", "-0.4859824687093");
  give(1, "rear", "-8.9129896614890");
  return c;
}

double number(const StateReport::Named& list, const std::string& name) {
  for (const auto& [key, value] : list)
    if (key == name) return std::stod(value);
  throw std::runtime_error("the report has no " + name);
}

// The values that the constraints give for this lean, this steer and their rates.
const std::pair<const char*, double> kVelocities[] = {
    {"psi", -0.7830033527065}, {"pitch", 0.0119185528069}, {"front", -8.0133620584155}};
const std::pair<const char*, double> kAccelerations[] = {{"psi''", -0.8353281706379},   {"phi''", 7.8555281128244},
                                                         {"pitch''", -0.1205543897884}, {"delta''", 4.6198904039403},
                                                         {"rear''", -1.8472554144217},  {"front''", -2.4548072904550}};

TEST(Bicycle, BasuMandalsAccelerations) {
  const auto model = shipped("zoo/whipple");
  const StateChoice choice = table_1(*model);
  Scenario s;
  const Outcome ready = make_scenario(model, *find_formulation("routh"), choice, s);
  ASSERT_TRUE(ready.ok()) << ready.message;
  StateReport r;
  const Outcome done = evaluate(s, choice, 16, r);
  ASSERT_TRUE(done.ok()) << done.message;
  EXPECT_NEAR(number(r.q, "pitch"), 3.14159265358979323846 - 3.1257073014894, kPrinted);
  for (const auto& [name, value] : kVelocities)
    EXPECT_NEAR(number(r.qdot, name), value, kPrinted * std::max(1.0, std::abs(value))) << name;
  for (const auto& [name, value] : kAccelerations)
    EXPECT_NEAR(number(r.derivatives, name), value, 3 * kPrinted * std::max(1.0, std::abs(value))) << name;
}

// The centre of the rear wheel: the table gives its acceleration in its axes.
TEST(Bicycle, BasuMandalsRearWheel) {
  const auto model = shipped("zoo/whipple");
  const StateChoice choice = table_1(*model);
  Scenario prepared;
  ASSERT_TRUE(make_scenario(model, *find_formulation("routh"), choice, prepared).ok());
  Workspace s(prepared);
  const Program p = program(s.system, s.structure);
  const std::vector<long double> parameters = parameter_values<long double>(*model);
  Expansion<long double> point(p, parameters, 1);
  Start<long double> start;
  ASSERT_TRUE(initial_state(s, choice, start).ok());
  point.load(start.t, start.state, start.leading);
  ASSERT_TRUE(point.prepare().ok() && point.project().ok() && point.solve().ok());
  Column es;
  for (int i = 0; i < 3; ++i) es.push_back(total_derivative(s.model->bodies[0].center[i], 2));
  OutputTape<long double> out(s, es, parameters);
  out.evaluate(point);
  EXPECT_NEAR(static_cast<double>(out[0]), 0.5041626315047, 3 * kPrinted);
  EXPECT_NEAR(static_cast<double>(out[1]), -0.3449706619454, 3 * kPrinted);
  EXPECT_NEAR(static_cast<double>(out[2]), 1.4604528332980, 3 * kPrinted);
}

// The mutant: the mass of the front wheel lacks a tenth of a gram.
TEST(Bicycle, AnotherMassIsSeen) {
  const auto model = model_of(replaced(shipped_text("zoo/whipple"), "mF = 3", "mF = 2.9999"));
  const StateChoice choice = table_1(*model);
  Scenario s;
  ASSERT_TRUE(make_scenario(model, *find_formulation("routh"), choice, s).ok());
  StateReport r;
  ASSERT_TRUE(evaluate(s, choice, 16, r).ok());
  EXPECT_GT(std::abs(number(r.derivatives, "phi''") - 7.8555281128244), 1e-6);
}

}  // namespace
}  // namespace anholon::test::bicycle_test

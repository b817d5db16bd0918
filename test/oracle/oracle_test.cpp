// Every shipped model with a line `# oracle: NAME` is compared with data/NAME.json: each term at each stored state,
// each sample of the stored trajectory. Other methods computed the stored numbers, in 230-bit arithmetic
// (data/README.md).
#include <map>

#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "simulation/simulate.h"
#include "support/oracle.h"
#include "support/rows.h"

namespace anholon::oracle_test {
namespace {

using nlohmann::json;

// Largest error allowed, in units of the scale of the quantity.
constexpr double kEvaluate = 1e-13;    // long double, printed as double
constexpr double kSimulate = 1e-12;    // double, tolerance 1e-15
constexpr double kManyDigits = 1e-25;  // 30 digits
constexpr double kQuad = 1e-28;        // quad
constexpr double kUnstable = 1e-9;     // in double, where errors grow fast along the trajectory
const char* const kUnstableSystem = "s07_rattleback";

using Pair = test::OraclePair;

// The largest of many errors, each in units of its own scale, and its place.
class Worst {
 public:
  void compare(const std::string& value, const std::string& reference, double scale, const std::string& where) {
    Multi a, b;
    ++count_;
    if (mpfr_set_str(a.raw(), value.c_str(), 10, MPFR_RNDN) != 0 ||
        mpfr_set_str(b.raw(), reference.c_str(), 10, MPFR_RNDN) != 0) {
      error_ = std::numeric_limits<double>::infinity();
      where_ = where + ": '" + value + "'";
      return;
    }
    const double error = to_double(Multi(abs(Multi(a - b)) / Multi(std::max(scale, 1.0))));
    if (!(error <= error_)) error_ = error, where_ = where;
  }
  testing::AssertionResult within(double tolerance) const {
    if (count_ > 0 && error_ <= tolerance) return testing::AssertionSuccess();
    return testing::AssertionFailure() << where_ << ": error " << error_ << ", allowed " << tolerance << " (" << count_
                                       << " compared)";
  }

 private:
  double error_ = 0;
  int count_ = 0;
  std::string where_ = "nothing";
};

double magnitude(const std::string& digits) { return std::abs(std::strtod(digits.c_str(), nullptr)); }
Rational exact(const std::string& digits) { return parse_rational(digits).value(); }
std::string text(const json& j) { return j.get<std::string>(); }

const std::string& find(const StateReport::Named& list, const std::string& name) {
  for (const auto& [key, value] : list)
    if (key == name) return value;
  throw std::runtime_error("the report has no " + name);
}

class Oracle : public testing::TestWithParam<Pair> {
 protected:
  PrecisionScope precision{60};
  std::shared_ptr<const Model> model = test::shipped(GetParam().model);
  json data = test::oracle_data(GetParam().oracle);
  std::vector<std::string> coordinates = data["coords"].get<std::vector<std::string>>();

  // x_2 of the data -> x''; lam2 -> the second multiplier.
  std::string jet_name(const std::string& symbol) const {
    const std::size_t at = symbol.rfind('_');
    if (at != std::string::npos &&
        std::find(coordinates.begin(), coordinates.end(), symbol.substr(0, at)) != coordinates.end())
      return derivative_name(symbol.substr(0, at), static_cast<unsigned>(std::stoul(symbol.substr(at + 1))),
                             Format::text);
    return symbol;
  }
  bool is_multiplier(const std::string& symbol) const {
    return symbol.rfind("lam", 0) == 0 &&
           std::find(coordinates.begin(), coordinates.end(), test::split_order(symbol).first) == coordinates.end();
  }
  std::size_t multiplier_index(const std::string& symbol) const {
    return std::stoul(test::split_order(symbol).first.substr(3)) - 1;
  }
  std::string multiplier(const std::string& symbol) const {
    return derivative_name(model->constraints.at(multiplier_index(symbol)).name, test::split_order(symbol).second,
                           Format::text);
  }

  StateChoice choice(const json& state) const {
    StateChoice c;
    c.t = exact(text(state["t"]));
    for (const auto& [symbol, value] : state["state"].items()) {
      if (is_multiplier(symbol)) {
        c.overrides.push_back({test::split_order(symbol).second, multiplier_index(symbol), exact(text(value)), true});
        continue;
      }
      const bool whole = std::find(coordinates.begin(), coordinates.end(), symbol) != coordinates.end();
      const auto [name, order] = whole ? std::pair(symbol, 0U) : test::split_order(symbol);
      const auto at = std::find(coordinates.begin(), coordinates.end(), name);
      if (at == coordinates.end()) throw std::runtime_error("this test cannot prescribe " + symbol);
      c.overrides.push_back({order, static_cast<std::size_t>(at - coordinates.begin()), exact(text(value))});
    }
    return c;
  }

  void compare_state(Worst& worst, const StateReport& r, const json& stored, const std::string& at) const {
    const json& values = stored["values"];
    double force = 1, speed = 1;
    for (const auto& [name, column] : r.forces)
      for (const json& v : values[name]) force = std::max(force, magnitude(text(v)));
    for (const std::string& c : coordinates) speed = std::max(speed, magnitude(text(stored["state"][c + "_1"])));
    EXPECT_EQ(r.forces.size(), 8U);
    for (const auto& [name, column] : r.forces)
      for (std::size_t a = 0; a < coordinates.size(); ++a)
        worst.compare(column[a], text(values[name][a]), force, name + "." + coordinates[a] + at);
    for (const char* key : {"T_r", "S_r", "V_O", "V_omega", "h"})
      worst.compare(find(r.numbers, key), text(values[key][0]), magnitude(text(values[key][0])), key + at);
    for (const char* key : {"power_noncons", "power_constraint", "dh_dt"})
      worst.compare(find(r.numbers, key), text(values[key][0]), force * speed, key + at);
    double mass = 0;
    for (const json& v : values["M_upper"]) mass = std::max(mass, magnitude(text(v)));
    std::size_t k = 0;
    for (std::size_t i = 0; i < coordinates.size(); ++i)
      for (std::size_t j = i; j < coordinates.size(); ++j, ++k)
        worst.compare(r.mass_matrix[i][j], text(values["M_upper"].at(k)), mass,
                      "mass matrix " + std::to_string(i) + std::to_string(j) + at);
    compare_reactions(worst, r, values, force, at);
    for (const auto& [symbol, v] : stored["solution"].items()) {
      const bool lambda = is_multiplier(symbol);
      const std::string key = lambda ? "lambda." + multiplier(symbol) : jet_name(symbol);
      worst.compare(find(lambda ? r.lambda : r.derivatives, key), text(v), magnitude(text(v)), key + at);
    }
  }

  void compare_reactions(Worst& worst, const StateReport& r, const json& values, double scale,
                         const std::string& at) const {
    std::vector<std::size_t> bodies;  // those with a mass or an inertia, in the order of the file
    for (std::size_t b = 0; b < model->bodies.size(); ++b)
      if (!is_zero(model->bodies[b].mass) || !model->bodies[b].axes.empty()) bodies.push_back(b);
    for (const auto& [key, vector] : values.items()) {
      if (key.rfind("R_total_body", 0) != 0) continue;
      const StateReport::Reaction& reaction = r.reactions.at(bodies.at(std::stoul(key.substr(12))));
      for (std::size_t i = 0; i < 3; ++i)
        worst.compare(reaction.force[i], text(vector[i]), scale, "reaction of " + reaction.body + at);
    }
  }

  Worst evaluate_all(int digits) const {
    return evaluate_all(digits <= 16 ? Precision::long_real : Precision::multi, digits);
  }
  Worst evaluate_all(Precision numbers, int digits) const {
    Worst worst;
    int index = 0;
    for (const json& stored : data["states"]) {
      Scenario s;
      const StateChoice c = choice(stored);
      Outcome o = make_scenario(model, *find_formulation("routh"), c, s);
      StateReport r;
      if (o.ok()) o = evaluate(s, c, numbers, digits, r);
      if (!o.ok()) throw std::runtime_error(o.message);
      compare_state(worst, r, stored, " at state " + std::to_string(index++));
    }
    return worst;
  }

  Worst simulate_all(Precision numbers, double tolerance, int digits, Method method = Method::automatic) const {
    Worst worst;
    const json& path = data["trajectory"];
    Scenario s;
    const Outcome o = make_scenario(model, *find_formulation("routh"), {}, s);
    if (!o.ok()) throw std::runtime_error(o.message);
    SimulationOptions options;
    for (const json& t : path["times"]) options.at.push_back(exact(text(t))), options.at_text.push_back(text(t));
    options.tolerance = Rational(tolerance);
    options.precision = numbers;
    options.digits = digits;
    options.method = method;
    test::TextRows sink;
    const SimulationReport report = simulate(s, options, sink);
    EXPECT_EQ(report.outcome.kind, OutcomeKind::finished) << report.outcome.message;
    if (sink.rows().size() != path["times"].size())
      throw std::runtime_error("rows are missing: " + report.outcome.message);
    std::map<std::string, std::size_t> column;
    for (std::size_t i = 0; i < sink.names().size(); ++i) column[sink.names()[i]] = i;
    for (std::size_t k = 0; k < sink.rows().size(); ++k) {
      const std::string at = " at t = " + text(path["times"][k]);
      worst.compare(sink.rows()[k][0], text(path["times"][k]), 1, "t" + at);
      for (const char* part : {"states", "solution"})
        for (const auto& [symbol, v] : path[part][k].items()) {
          const std::string key = is_multiplier(symbol) ? "lambda." + multiplier(symbol) : jet_name(symbol);
          worst.compare(sink.rows()[k].at(column.at(key)), text(v), magnitude(text(v)), key + at);
        }
    }
    return worst;
  }
};

TEST_P(Oracle, TermsAtStates) {
  ASSERT_EQ(coordinates, model->names.coordinates);
  EXPECT_TRUE(evaluate_all(16).within(kEvaluate));
}

TEST_P(Oracle, TrajectoryInDouble) {
  EXPECT_TRUE(
      simulate_all(Precision::real, 1e-15, 16).within(GetParam().oracle == kUnstableSystem ? kUnstable : kSimulate));
}

INSTANTIATE_TEST_SUITE_P(Model, Oracle, testing::ValuesIn(test::oracle_pairs()),
                         [](const auto& p) { return test::test_name(p.param.model); });

class UnstableOracle : public Oracle {};
TEST_P(UnstableOracle, TrajectoryInLongDouble) {
  EXPECT_TRUE(simulate_all(Precision::long_real, 1e-18, 19).within(kSimulate));
}
INSTANTIATE_TEST_SUITE_P(Model, UnstableOracle, testing::Values(Pair{"zoo/rattleback", kUnstableSystem}),
                         [](const auto& p) { return test::test_name(p.param.model); });

// Other methods: the errors of their steps add up, and accelerations follow the state.
class OracleByMethod : public Oracle {};
TEST_P(OracleByMethod, Trajectory) {
  for (const double tolerance : {1e-6, 1e-9}) {
    EXPECT_TRUE(simulate_all(Precision::real, tolerance, 16, Method::runge_kutta).within(30 * tolerance)) << tolerance;
    EXPECT_FALSE(simulate_all(Precision::real, tolerance, 16, Method::runge_kutta).within(1e-6 * tolerance))
        << "that is another method";
    EXPECT_TRUE(simulate_all(Precision::real, tolerance, 16, Method::bdf).within(1000 * tolerance)) << tolerance;
  }
}
INSTANTIATE_TEST_SUITE_P(Model, OracleByMethod,
                         testing::Values(Pair{"zoo/chaplygin-sleigh", "s03_chaplygin_sleigh"},
                                         Pair{"zoo/double-pendulum-cartesian", "s15_double_pendulum_cartesian"},
                                         Pair{"zoo/second-order-linear", "s12b_second_order_linear"},
                                         Pair{"zoo/rocket", "s14_rocket"}),
                         [](const auto& p) { return test::test_name(p.param.model); });

// The quick systems in multiprecision; all of them under ANHOLON_LONG=1.
std::vector<Pair> quick_models() {
  if (std::getenv("ANHOLON_LONG")) return test::oracle_pairs();
  std::vector<Pair> quick;
  for (const Pair& p : test::oracle_pairs())
    for (const char* name :
         {"zoo/chaplygin-sleigh", "zoo/appell-hamel", "zoo/rocket", "zoo/falling-chain", "zoo/vertical-disc",
          "papers/luo-zhao-example-1", "papers/luo-zhao-example-2-plane-frame", "zoo/second-order-linear",
          "zoo/constant-acceleration", "zoo/third-order-linear", "zoo/constant-jerk-central"})
      if (p.model == name) quick.push_back(p);
  return quick;
}

class OracleInManyDigits : public Oracle {};
TEST_P(OracleInManyDigits, TermsAtStates) { EXPECT_TRUE(evaluate_all(30).within(kManyDigits)); }
TEST_P(OracleInManyDigits, Trajectory) { EXPECT_TRUE(simulate_all(Precision::multi, 1e-32, 30).within(kManyDigits)); }
INSTANTIATE_TEST_SUITE_P(Model, OracleInManyDigits, testing::ValuesIn(quick_models()),
                         [](const auto& p) { return test::test_name(p.param.model); });

// The trajectories claim 30 digits.
class OracleInQuad : public Oracle {};
TEST_P(OracleInQuad, TermsAtStates) { EXPECT_TRUE(evaluate_all(Precision::quad, 16).within(kQuad)); }
TEST_P(OracleInQuad, Trajectory) { EXPECT_TRUE(simulate_all(Precision::quad, 1e-32, 16).within(kQuad)); }
INSTANTIATE_TEST_SUITE_P(Model, OracleInQuad, testing::ValuesIn(quick_models()),
                         [](const auto& p) { return test::test_name(p.param.model); });

// Mutant: a change of the mass in the 11th digit must be seen by the comparison.
class OracleMutant : public Oracle {};
TEST_P(OracleMutant, IsRefuted) {
  EXPECT_TRUE(evaluate_all(16).within(kEvaluate));
  model = test::model_of(test::shipped_text(GetParam().model), {{"m", "2*(1 + 1e-11)"}});
  EXPECT_FALSE(evaluate_all(16).within(kEvaluate));
  EXPECT_FALSE(simulate_all(Precision::real, 1e-15, 16).within(kSimulate));
}
INSTANTIATE_TEST_SUITE_P(Model, OracleMutant,
                         testing::Values(Pair{"zoo/second-order-linear", "s12b_second_order_linear"}),
                         [](const auto& p) { return test::test_name(p.param.model); });

}  // namespace
}  // namespace anholon::oracle_test

// Reductions of formulas with a pole, another singularity or a sharp peak on the way, by their closed forms. The motion is
// y = t, alone in one step; beside an oscillator in many steps; backward; with an event; with a contact that hits.
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "ensemble/cases/ensemble.h"
#include "support/models.h"

namespace anholon::pole_reduction_test {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN(), kPi = 3.14159265358979323846;

struct Way {
  const char* name;
  const char* text;
  int direction = 1;
  bool kernel = true;
  bool all = false;  // all places and ends, also in the short test
};

const Way kWays[] = {{"alone", R"toml(
coordinates = ["y"]
particle = [{name = "p", mass = 1, position = "y*ey"}]
initial = {"y'" = 1}
)toml",
                      1, true, true},
                     {"alone, without a kernel", R"toml(
coordinates = ["y"]
particle = [{name = "p", mass = 1, position = "y*ey"}]
initial = {"y'" = 1}
)toml",
                      1, false},
                     {"backward", R"toml(
coordinates = ["y"]
particle = [{name = "p", mass = 1, position = "y*ey"}]
initial = {"y'" = -1}
)toml",
                      -1},
                     {"oscillator", R"toml(
coordinates = ["y", "x"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
potential.V = "x^2/2"
initial = {"y'" = 1, x = 1}
)toml"},
                     {"event", R"toml(
coordinates = ["y", "x"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
potential.V = "x^2/2"
initial = {"y'" = 1, x = 1}
event = [{name = "turned", when = "x'"}]
)toml"},
                     {"contact", R"toml(
coordinates = ["y", "z"]
particle = [{name = "p", mass = 1, position = "y*ey + z*ez"}]
gravity.field = "-ez"
contact = [{name = "floor", gap = "z", restitution = 1}]
initial = {"y'" = 1, z = 1}
)toml"}};

// The greatest, the least and the mean value for y from 0 to p + q, NaN where there is none; `mean_within`: the relative
// error of the mean. P stands for p in the formula.
struct Row {
  const char* formula;
  std::function<double(double p, double q)> most, least, mean;
  double mean_within = 1e-11;
  // The error of the extremes, which the round-off of the time makes at a root.
  double within = 1e-12;
};

const auto kNothing = [](double, double) { return kNone; };
template <int value>
double constant(double, double) {
  return value;
}
double farther(double p, double q) { return std::max(p, q); }

const std::vector<Row>& rows() {
  static const std::vector<Row> list = {
      {"1/(y-P)", kNothing, kNothing, kNothing},
      {"1+0.000001/(y-P)", kNothing, kNothing, kNothing},
      {"1/(P-y)^3", kNothing, kNothing, kNothing},
      {"1/sin(y-P)", kNothing, kNothing, kNothing},
      {"1/((y-P)*(y+P))", kNothing, kNothing, kNothing},
      {"1/(y-P)^2", kNothing, [](double p, double q) { return 1 / std::pow(farther(p, q), 2); }, kNothing},
      {"(y-P)^(-2)", kNothing, [](double p, double q) { return 1 / std::pow(farther(p, q), 2); }, kNothing},
      {"-1/abs(y-P)", [](double p, double q) { return -1 / farther(p, q); }, kNothing, kNothing},
      {"abs(y-P)^(-1/2)", kNothing, [](double p, double q) { return 1 / std::sqrt(farther(p, q)); }, kNothing},
      {"abs(y-P)^(-1/3)", kNothing, [](double p, double q) { return 1 / std::cbrt(farther(p, q)); },
       [](double p, double q) { return 1.5 * (std::pow(p, 2 / 3.) + std::pow(q, 2 / 3.)) / (p + q); }, 1e-8},
      {"log(abs(y-P))", [](double p, double q) { return std::log(farther(p, q)); }, kNothing,
       [](double p, double q) { return (p * std::log(p) + q * std::log(q)) / (p + q) - 1; }, 1e-8},
      {"1/((y-P)^2+0.000001)", constant<1'000'000>,
       [](double p, double q) { return 1 / (std::pow(farther(p, q), 2) + 1e-6); },
       [](double p, double q) { return 1e3 * (std::atan(1e3 * p) + std::atan(1e3 * q)) / (p + q); }},
      {"1/(1+(100000000*(y-P))^2)", constant<1>, {}, {}},
      {"exp(-1000000*(y-P)^2)", constant<1>, constant<0>,
       [](double p, double q) { return 1e-3 * std::sqrt(kPi) / (p + q); }},
      {"1/(0.001+abs(y-P))", constant<1000>, [](double p, double q) { return 1 / (1e-3 + farther(p, q)); },
       [](double p, double q) { return (std::log1p(1e3 * p) + std::log1p(1e3 * q)) / (p + q); }},
      {"abs(y-P)", farther, constant<0>, [](double p, double q) { return (p * p + q * q) / 2 / (p + q); }},
      {"sqrt(abs(y-P))", [](double p, double q) { return std::sqrt(farther(p, q)); }, constant<0>,
       [](double p, double q) { return (std::pow(p, 1.5) + std::pow(q, 1.5)) / 1.5 / (p + q); }, 1e-9, 1e-7},
      {"-(abs(y-P)^(1/4))", constant<0>, [](double p, double q) { return -std::pow(farther(p, q), 0.25); },
       [](double p, double q) { return -(std::pow(p, 1.25) + std::pow(q, 1.25)) / 1.25 / (p + q); }, 1e-9, 1e-3},
      {"sign(y-P)", constant<1>, constant<-1>, [](double p, double q) { return (q - p) / (p + q); }},
  };
  return list;
}

class Only final : public CaseSink {
 public:
  void result(const CaseResult& r) override { list.push_back(r); }
  std::vector<CaseResult> list;
};

// Returns the values of these reductions.
std::vector<double> reduce(const Way& way, const Rational& to, const std::vector<std::string>& words) {
  Diagnostics diagnostics;
  const std::optional<OpenModel> open = open_model({"model.toml", way.text}, diagnostics);
  if (!open) throw std::runtime_error(diagnostics.print({"model.toml", way.text}));
  EnsembleOptions options;
  for (const std::string& word : words) options.reductions.add(word, *open);
  Scenario scenario;
  EXPECT_TRUE(make_scenario(open->model, *find_formulation("routh"), {}, scenario).ok());
  options.to = way.direction > 0 ? to : Rational(-to);
  options.kernel = way.kernel;
  options.threads = 1;
  options.cases = 1;
  options.varied = {{Varied::Kind::initial, 0, 0, "y"}};
  options.numbers = [](std::size_t) { return EnsembleCase{{Rational(0)}, {}}; };
  Only results;
  ensemble(scenario, options, results);
  const CaseResult& r = results.list.at(0);
  EXPECT_TRUE(r.outcome.ok()) << r.outcome.message;
  return r.reduced;
}

void expect(double is, double wanted, double within, const std::string& where) {
  if (std::isnan(wanted))
    EXPECT_TRUE(std::isnan(is)) << where << " is " << is;
  else
    EXPECT_NEAR(is, wanted, within * (wanted == 0 ? 1 : std::abs(wanted))) << where;
}

class Poles : public testing::TestWithParam<Way> {};

TEST_P(Poles, ReductionsAreTheClosedForms) {
  const std::pair<const char*, Rational> places[] = {
      {"2", 2}, {"3", 3}, {"(10/3)", Rational(10, 3)}, {"5", 5}, {"7.1", Rational(71, 10)}};
  const bool all = std::getenv("ANHOLON_LONG") != nullptr || GetParam().all;
  for (const auto& [text, place] : places)
    for (const Rational& to : {Rational(10), Rational(83, 10)}) {
      if (!all && (to != 10 || place.get_den() == 10 || place == 2)) continue;
      const double p = place.get_d(), q = Rational(to - place).get_d();
      for (const Row& row : rows()) {
        std::string formula = row.formula;
        for (std::size_t at; (at = formula.find('P')) != std::string::npos;) formula.replace(at, 1, text);
        const std::vector<std::string> words{"max(" + formula + ")", "min(" + formula + ")", "mean(" + formula + ")"};
        const std::string where = " of " + std::string(GetParam().name) + " to " + to.get_str();
        const std::vector<double> values = reduce(GetParam(), to, words);
        ASSERT_EQ(values.size(), 3U);
        expect(values[0], row.most(p, q), row.within, words[0] + where);
        if (row.least) expect(values[1], row.least(p, q), row.within, words[1] + where);
        if (row.mean) expect(values[2], row.mean(p, q), row.mean_within, words[2] + where);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Of, Poles, testing::ValuesIn(kWays));

// One reduction beside others, which shorten the steps.
TEST(PolesTogether, OtherReductionsHaveNoInfluence) {
  const std::vector<std::string> words{"max(1/(x-0.5))",     "mean(1/(x-0.5))", "max(1/(2*x-1))", "max(1/(x+0.1))",
                                       "max((y-5)^(-2))",    "max(1/(y^2-25))", "max(1/(y-5))",   "mean(1/(y-5))",
                                       "min(log(abs(y-5)))", "max(1/x)",        "max(tan(y))",    "mean(1/(y-3)^2)"};
  for (const Way& way : {kWays[3], kWays[4]}) {
    const std::vector<double> all = reduce(way, 10, words);
    for (std::size_t k = 0; k < words.size(); ++k) {
      EXPECT_TRUE(std::isnan(all[k])) << words[k] << " is " << all[k];
      const double alone = reduce(way, 10, {words[k]})[0];
      EXPECT_TRUE(std::isnan(alone)) << words[k] << " alone is " << alone;
    }
  }
}

// x = cos t passes 0; the formulas are zero there, not less.
TEST(PolesTogether, AMinimumOfWhatIsNeverNegativeIsNotNegative) {
  for (const Way& way : {kWays[3], kWays[4]})
    for (const double v :
         reduce(way, 10, {"min(abs(x))", "min(abs(x'))", "min(x^2)", "min(sqrt(x^2))", "min(1-sin(y)^2)"})) {
      EXPECT_FALSE(std::signbit(v)) << v;
      EXPECT_LE(v, 1e-15);
    }
}

}  // namespace
}  // namespace anholon::pole_reduction_test

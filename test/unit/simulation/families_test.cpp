// Families are compared with the same systems written out by hand, and with published numbers.
#include <gtest/gtest.h>

#include "observe/evaluate.h"
#include "support/chain.h"
#include "support/models.h"

namespace anholon::families_test {
namespace {

constexpr double kRounded = 1e-12;  // long double, printed as double

std::string plain(std::string name) {
  std::erase_if(name, [](char c) { return c == '[' || c == ']'; });
  return name;
}

// Accelerations and multipliers at the start by name, in which th[1]'' is th1''.
std::map<std::string, double> motion_of(const std::shared_ptr<const Model>& model,
                                        const std::map<std::string, Rational>& start = {}) {
  StateChoice choice;
  for (std::size_t a = 0; a < model->coordinates.size(); ++a)
    if (const auto it = start.find(plain(model->coordinates[a].name)); it != start.end())
      choice.overrides.push_back({0, a, it->second});
  Scenario scenario;
  Outcome o = make_scenario(model, *find_formulation("routh"), choice, scenario);
  StateReport report;
  if (o.ok()) o = evaluate(scenario, choice, 16, report);
  EXPECT_TRUE(o.ok()) << o.message;
  std::map<std::string, double> out;
  for (const auto* list : {&report.derivatives, &report.lambda, &report.qdot})
    for (const auto& [name, value] : *list) out[plain(name)] = std::stod(value);
  return out;
}

double difference(const std::map<std::string, double>& a, const std::map<std::string, double>& b) {
  EXPECT_EQ(a.size(), b.size());
  double worst = 0, scale = 1;
  for (const auto& [name, value] : a) {
    EXPECT_EQ(b.count(name), 1U) << name;
    if (b.count(name)) worst = std::max(worst, std::abs(value - b.at(name)));
    scale = std::max(scale, std::abs(value));
  }
  return worst / scale;
}

TEST(Families, TrailersAreTheCarWithThreeTrailers) {
  const Overrides parameters = {{"M[1]", "4"},   {"M[3]", "2"}, {"J[1]", "1"},
                                {"J[3]", "0.5"}, {"d[1]", "1"}, {"d[3]", "0.8"}};
  const std::map<std::string, Rational> start = {{"ph", {1, 10}}, {"th1", {1, 10}}, {"th2", {-1, 10}}, {"th3", {1, 5}}};
  std::map<std::string, double> by_hand;
  for (const auto& [name, value] : motion_of(test::shipped("zoo/car-three-trailers")))
    by_hand[name == "lambda.front_axle"  ? "lambda.front_wheel"
            : name == "lambda.rear_axle" ? "lambda.axle0"
                                         : name] = value;
  EXPECT_LE(difference(by_hand, motion_of(test::model_of(test::shipped_text("zoo/trailers"), parameters), start)),
            kRounded);
  Overrides wrong = parameters;
  wrong["M[2]"] = "3.01";
  EXPECT_GT(difference(by_hand, motion_of(test::model_of(test::shipped_text("zoo/trailers"), wrong), start)), 1e-5);
}

TEST(Families, TheChainIsTheChainWrittenOut) {
  std::map<std::string, Rational> start;
  for (int i = 1; i <= 7; ++i) start["th" + std::to_string(i)] = Rational(30 + 2 * i, 100);
  std::map<std::string, double> by_hand;
  for (const auto& [name, value] : motion_of(test::model_of(test::chain_text(7))))
    by_hand["th" + name.substr(1)] = value;
  const std::string text = test::shipped_text("zoo/chain");
  EXPECT_LE(difference(by_hand, motion_of(test::model_of(text, {{"n", "7"}}), start)), kRounded);
  EXPECT_GT(difference(by_hand,
                       motion_of(test::model_of(test::replaced(text, "P[i-1] + l*", "P[i-1] + 1.01*l*"), {{"n", "7"}}),
                                 start)),
            1e-3);
}

// Beads at equal distances on a light string swing in modes of Laguerre's polynomials: the displacement of the j-th
// bead from below is L_j(k), where L_n(k) = 0 and k = omega^2 l/g. Zeros of L_4: Abramowitz and Stegun, table 25.9.
TEST(Families, TheChainSwingsInLaguerresModes) {
  constexpr int n = 4;
  const Rational small(1, 100'000'000);
  constexpr double kCubic = 1e-10;  // the higher terms of sin x and cos x
  for (const char* zero : {"0.322547689619392", "1.745761101158347", "4.536620296921128", "9.395070912301133"}) {
    const Rational k = parse_rational(zero).value();
    std::vector<Rational> l = {1, 1 - k};
    for (int j = 1; j < n; ++j)
      l.push_back(((2 * j + 1 - k) * l[static_cast<std::size_t>(j)] - j * l[static_cast<std::size_t>(j - 1)]) /
                  (j + 1));
    std::map<std::string, Rational> start;
    for (std::size_t i = 1; i <= n; ++i) start["th" + std::to_string(i)] = small * (l[n - i] - l[n - i + 1]);
    const auto at = motion_of(test::model_of(test::shipped_text("zoo/chain"), {{"n", std::to_string(n)}}), start);
    double scale = 0;
    for (const auto& [name, angle] : start) scale = std::max(scale, std::abs(49.05 * k.get_d() * angle.get_d()));
    for (const auto& [name, angle] : start)
      EXPECT_NEAR(at.at(name + "''"), -49.05 * k.get_d() * angle.get_d(), kCubic * scale) << zero << " " << name;
  }
}

TEST(Families, TheSnakeIsThatOfThreeSegmentsByHand) {
  const std::string by_hand = R"toml(coordinates = ["x", "y", "th1", "th2", "th3"]
[parameters]
m = 1
l = 0.5
[point]
A = "x*ex + y*ey"
B = "A - l/2*(cos(th1)*ex + sin(th1)*ey) - l/2*(cos(th2)*ex + sin(th2)*ey)"
C = "B - l/2*(cos(th2)*ex + sin(th2)*ey) - l/2*(cos(th3)*ex + sin(th3)*ey)"
[[body]]
name = "head"
mass = "m"
inertia = "m*l^2/12"
center = "A"
angle = "th1"
[[body]]
name = "trunk"
mass = "m"
inertia = "m*l^2/12"
center = "B"
angle = "th2"
[[body]]
name = "tail"
mass = "m"
inertia = "m*l^2/12"
center = "C"
angle = "th3"
[[force]]
generalized = {th1 = "-u", th2 = "u - w", th3 = "w"}
[define]
u = "-8*(th2 - th1 - 0.4*sin(3*t - 2*pi/3)) - th2' + th1'"
w = "-8*(th3 - th2 - 0.4*sin(3*t - 4*pi/3)) - th3' + th2'"
[[constraint]]
name = "wheels1"
equation = "cos(th1)*A.y' - sin(th1)*A.x' = 0"
[[constraint]]
name = "wheels2"
equation = "cos(th2)*B.y' - sin(th2)*B.x' = 0"
[[constraint]]
name = "wheels3"
equation = "cos(th3)*C.y' - sin(th3)*C.x' = 0"
[initial]
th1 = "0.3*sin(2)"
th2 = "0.3*sin(4)"
th3 = "0.3*sin(6)"
)toml";
  const std::string text = test::shipped_text("zoo/snake");
  const auto expected = motion_of(test::model_of(by_hand));
  EXPECT_LE(difference(expected, motion_of(test::model_of(text, {{"n", "3"}}))), kRounded);
  EXPECT_GT(difference(expected,
                       motion_of(test::model_of(test::replaced(text, "segment[k]\"", "segment[1]\""), {{"n", "3"}}))),
            1e-3);
}

}  // namespace
}  // namespace anholon::families_test

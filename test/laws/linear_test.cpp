// Linear models are compared with derivations by hand, published numbers, and each other.
#include <gtest/gtest.h>

#include "linear/linearize.h"
#include "support/models.h"

namespace anholon::test::linear_test {
namespace {

constexpr int kDigits = 40;
constexpr double kExact = 1e-28;  // two solutions of linear equations in 40 digits

std::unique_ptr<Scenario> scenario(std::shared_ptr<const Model> model, const StateChoice& choice = {},
                                   const char* form = "routh") {
  auto s = std::make_unique<Scenario>();
  const Outcome o = make_scenario(std::move(model), *find_formulation(form), choice, *s);
  EXPECT_TRUE(o.ok()) << o.message;
  return s;
}

LinearModel linear(const Scenario& s, const StateChoice& choice = {}) {
  const Linearization l = linearize(s, choice);
  EXPECT_TRUE(l.results[0].outcome.ok()) << l.results[0].outcome.message;
  return l.results[0].model;
}

LinearModel linear(const std::string& text) {
  const StateChoice choice;
  return linear(*scenario(model_of(text), choice), choice);
}

// The distance of the eigenvalue re + i im from the nearest one of the spectrum.
double miss(const LinearModel& m, const Multi& re, const Multi& im) {
  double best = 1e300;
  for (const Eigenvalue& e : m.spectrum) best = std::min(best, to_double(modulus({e.value.re - re, e.value.im - im})));
  return best;
}

int zeros(const LinearModel& m) {
  int count = 0;
  for (const Eigenvalue& e : m.spectrum) count += e.value.re == Multi(0) && e.value.im == Multi(0);
  return count;
}

const std::string kPendulum = R"(title = "pendulum in Cartesian coordinates"
coordinates = ["x", "y"]
particle = [{name = "bob", mass = 2, position = "x*ex + y*ey"}]
constraint = [{name = "rod", equation = "x^2 + y^2 = 9"}]
gravity.field = "-10*ey"
[initial]
x = 0
guess = {y = -3}
)";

// x'' = -(g/l) x comes from lambda d^2 phi/dq dq alone: nothing else in the equation of x depends on x.
TEST(LinearModels, PendulumSwingsByTheStiffnessOfItsRod) {
  const PrecisionScope scope(kDigits);
  const LinearModel m = linear(kPendulum);
  EXPECT_EQ(m.motion, LinearModel::Motion::equilibrium);
  EXPECT_EQ(m.states, (std::vector<std::string>{"x", "x'"}));
  EXPECT_LT(miss(m, Multi(0), sqrt(Multi(10) / Multi(3))), kExact);
  EXPECT_EQ(m.spectrum.size(), 2U);
}

// The mutant: the reaction keeps its direction while the bob moves.
TEST(LinearModels, WithoutThatStiffnessItDoesNot) {
  const PrecisionScope scope(kDigits);
  const StateChoice choice;
  const auto prepared = scenario(model_of(kPendulum), choice);
  Workspace s(*prepared);
  Graph& g = s.graph();
  const Expr lambda = g.multiplier(0, 0);
  const Column at_rest{g.zero(), g.number(-6)};  // Phi = 2 (x, y)
  for (std::size_t a = 0; a < 2; ++a)
    s.system.equations[a] = s.system.equations[a] + lambda * (s.mechanics->Phi[0][a] - at_rest[a]);
  const LinearModel m = linear(s, choice);
  EXPECT_GT(miss(m, Multi(0), sqrt(Multi(10) / Multi(3))), 0.1);
}

// The pendulum is upside down, since its y is guessed above the pivot.
TEST(LinearModels, PendulumFalls) {
  const PrecisionScope scope(kDigits);
  const LinearModel m = linear(replaced(kPendulum, "y = -3", "y = 3"));
  EXPECT_LT(miss(m, sqrt(Multi(10) / Multi(3)), Multi(0)), kExact);
}

// Two equal pendulums, one on the other: mu^2 = -(2 +- sqrt 2) g/l.
TEST(LinearModels, DoublePendulum) {
  const PrecisionScope scope(kDigits);
  const LinearModel m = linear(R"(title = "double pendulum"
coordinates = ["a", "b"]
particle = [{name = "p", mass = 3, position = "2*sin(a)*ex - 2*cos(a)*ey"}, {name = "q", mass = 3, position = "2*(sin(a) + sin(b))*ex - 2*(cos(a) + cos(b))*ey"}]
gravity.field = "-10*ey"
)");
  for (int sign : {1, -1})
    EXPECT_LT(miss(m, Multi(0), sqrt(Multi(5) * (Multi(2) + Multi(sign) * sqrt(Multi(2))))), kExact);
}

// Constraints of order 2 and 3 prescribe the motion of x; y is free of them.
TEST(LinearModels, OrdersTwoAndThree) {
  const PrecisionScope scope(kDigits);
  const auto text = [](const std::string& constraint) {
    return "title = \"t\"\ncoordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 2, position = \"x*ex + "
           "y*ey\"}]\npotential.spring = \"7*(x^2 + y^2)\"\n"
           "constraint = [{name = \"law\", equation = \"" +
           constraint + "\"}]\n";
  };
  const LinearModel two = linear(text("x'' + 2*x' + 5*x = 0"));
  EXPECT_EQ(two.states.size(), 4U);
  EXPECT_LT(miss(two, Multi(-1), Multi(2)), kExact);
  EXPECT_LT(miss(two, Multi(0), sqrt(Multi(7))), kExact);
  const LinearModel three = linear(text("D(x,3) + 3*x'' + 4*x' + 2*x = 0"));  // (s + 1)(s^2 + 2s + 2)
  EXPECT_EQ(three.states.size(), 5U);                                         // x, y, x', y' and the multiplier or x''
  EXPECT_LT(miss(three, Multi(-1), Multi(0)), kExact);
  EXPECT_LT(miss(three, Multi(-1), Multi(1)), kExact);
  EXPECT_LT(miss(three, Multi(0), sqrt(Multi(7))), kExact);
}

std::string disc(const std::string& parameters, const std::string& initial) {
  std::string text = shipped_text("zoo/disc");
  text = replaced(text, "R = \"1/2\", g = 9.81", parameters);
  return text.substr(0, text.find("[initial]")) + "[initial]\n" + initial;
}

// At phi'^2 = g/(3 R) the upright disc loses its stability, and all eigenvalues vanish.
TEST(LinearModels, UprightDiscAtItsCriticalSpeed) {
  const PrecisionScope scope(2 * kDigits);
  for (const int spin : {1, 2}) {
    const LinearModel m = linear(disc(
        "R = 1, g = 3", "theta = \"pi/2\"\n\"psi'\" = 0\n\"theta'\" = 0\n\"phi'\" = " + std::to_string(spin) + "\n"));
    EXPECT_EQ(m.motion, LinearModel::Motion::steady);
    EXPECT_EQ(m.states.size(), 8U);
    EXPECT_EQ(m.cyclic.size(), 4U);  // x, y, psi, phi
    EXPECT_EQ(zeros(m), spin == 1 ? 4 : 2);
    // (A + m R^2) mu^2 = m g R - (C + m R^2) C n^2/A with A = m R^2/4, C = m R^2/2.
    if (spin == 2) {
      EXPECT_LT(miss(m, Multi(0), sqrt(Multi(36) / Multi(5))), kExact);
    }
  }
}

// A disc that rolls in a circle, leaning. With w = psi' sin theta, n = phi' + psi' cos theta, from Euler's equations
// about the centre:
//   (A + m R^2) theta'' + (C + m R^2) n w - A w^2 cot theta + m g R cos theta = 0
//   A w' + (A w cot theta - C n) theta' = 0,   (C + m R^2) n' = m R^2 w theta'.
Multi turning_disc(const Multi& theta, const Multi& turn, const Multi& spin) {
  const Multi R = Multi(1) / Multi(2), g = Multi(Rational(981, 100)), A = R * R / Multi(4), C = R * R / Multi(2),
              mR2 = R * R;
  const Multi cot = cos(theta) / sin(theta), w = turn * sin(theta), n = spin + turn * cos(theta);
  return -(A * w * w / (sin(theta) * sin(theta)) - g * R * sin(theta) +
           ((C + mR2) * n - Multi(2) * A * w * cot) * (C * n / A - w * cot) + mR2 * w * w) /
         (A + mR2);
}

TEST(LinearModels, DiscThatTurnsSteadily) {
  const PrecisionScope scope(kDigits);
  const std::string text = shipped_text("zoo/disc");
  const StateChoice choice;
  const auto s = scenario(model_of(text.substr(0, text.find("[initial]")) +
                                   "[initial]\ntheta = 1.3\n\"psi'\" = 0.8\n\"theta'\" = "
                                   "0\nconditions = [\"theta'' = 0\"]\nguess = {\"phi'\" = -6}\n"),
                          choice);
  const LinearModel m = linear(*s, choice);
  EXPECT_EQ(m.motion, LinearModel::Motion::steady) << m.why;
  const Multi spin = [&] {
    for (std::size_t i = 0; i < m.states.size(); ++i)
      if (m.states[i] == "phi'") return m.values[i];
    return Multi(0);
  }();
  const Multi square = turning_disc(Multi(Rational(13, 10)), Multi(Rational(4, 5)), spin);
  ASSERT_TRUE(square < Multi(0));
  EXPECT_LT(miss(m, Multi(0), sqrt(-square)), 1e-25);
  EXPECT_EQ(zeros(m), 2);
  // The mutant: the term of gravity has the other sign.
  EXPECT_GT(miss(m, Multi(0),
                 sqrt(abs(Multi(square - Multi(2) * Multi(Rational(981, 100)) / Multi(2) *
                                             sin(Multi(Rational(13, 10))) / (Multi(5) / Multi(16)))))),
            0.1);
}

// All forms give the same linear model.
TEST(LinearModels, FormsAgree) {
  const PrecisionScope scope(kDigits);
  const auto model = shipped("zoo/disc");
  const StateChoice choice;
  const LinearModel routh = linear(*scenario(model, choice), choice);
  EXPECT_EQ(routh.motion, LinearModel::Motion::unsteady);  // it wobbles
  for (const char* form : {"maggi", "chaplygin", "appell", "kane", "udwadia-kalaba"}) {
    const LinearModel other = linear(*scenario(model, choice, form), choice);
    ASSERT_EQ(other.states, routh.states) << form;
    for (std::size_t i = 0; i < routh.A.data.size(); ++i)
      EXPECT_LT(std::abs(to_double(routh.A.data[i] - other.A.data[i])), 1e-24) << form;
  }
}

// A cart with a pendulum, pushed by u, whose rod is a holonomic constraint: A, B, C, D of a textbook. With M, m, l, g
// and the rod downwards,
//   x'' = (u + m g th)/M,  th'' = -((M + m) g th + u)/(M l),  pull of the rod (lambda in its direction) = m g to first
// order.
TEST(LinearModels, InputsAndOutputs) {
  const PrecisionScope scope(kDigits);
  const auto model = model_of(R"(title = "cart"
coordinates = ["x", "a", "b"]
particle = [{name = "cart", mass = 4, position = "x*ex"}, {name = "bob", mass = 3, position = "a*ex + b*ey"}]
constraint = [{name = "rod", equation = "(a - x)^2/2 + b^2/2 = 2"}]
gravity.field = "-10*ey"
force = [{on = "cart", vector = "u*ex"}]
parameters.u = 0
[initial]
q = {x = 0, a = 0}
guess = {b = -2}
)");
  Graph& g = *model->graph;
  const StateChoice choice;
  // The formulas of signals belong to the model, of which the system is a copy.
  const Expr x2 = g.jet(0, 2), b = g.jet(2, 0);
  const Signals signals{{"push"},
                        {"acceleration", "height", "pull", "jerk"},
                        {g.parameter(0)},
                        {x2, b, g.multiplier(0, 0), g.jet(0, 3)},
                        {}};
  const auto s = scenario(model, choice);
  const Linearization l = linearize(*s, choice, signals);
  ASSERT_TRUE(l.results[0].outcome.ok());
  const LinearModel& m = l.results[0].model;
  ASSERT_EQ(m.states, (std::vector<std::string>{"x", "a", "x'", "a'"}));
  // The angle is (a - x)/2, so x'' = (u + 15 (a - x))/4 and a'' = -5 (a - x).
  const double A[4][4] = {{0, 0, 1, 0}, {0, 0, 0, 1}, {-3.75, 3.75, 0, 0}, {5, -5, 0, 0}}, B[4] = {0, 0, 0.25, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t k = 0; k < 4; ++k) EXPECT_LT(std::abs(to_double(m.A(i, k)) - A[i][k]), kExact);
    EXPECT_LT(std::abs(to_double(m.B(i, 0)) - B[i]), kExact);
  }
  ASSERT_EQ(m.outputs.size(), 3U);  // the state does not give the jerk
  ASSERT_EQ(m.notes.size(), 1U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_LT(std::abs(to_double(m.C(0, k)) - A[2][k]), kExact);
    EXPECT_LT(std::abs(to_double(m.C(1, k))), kExact);  // height and pull are even in the angle
    EXPECT_LT(std::abs(to_double(m.C(2, k))), kExact);
  }
  EXPECT_LT(std::abs(to_double(m.D(0, 0)) - 0.25), kExact);
  EXPECT_LT(std::abs(to_double(m.D(1, 0))), kExact);
}

// An input in a constraint acts by its rate as well, which B cannot hold.
TEST(LinearModels, InputsInConstraintsAreLeftOut) {
  const PrecisionScope scope(kDigits);
  const auto model = model_of(
      "title = \"t\"\ncoordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + y*ey\"}]\n"
      "constraint = [{name = \"c\", equation = \"y' = u*x\"}]\nparameters.u = 2\n");
  const StateChoice choice;
  const auto s = scenario(model, choice);
  const Linearization l = linearize(*s, choice, Signals{{"u"}, {}, {model->graph->parameter(0)}, {}, {}});
  EXPECT_TRUE(l.results[0].model.inputs.empty());
  EXPECT_EQ(l.results[0].model.notes.size(), 1U);
}

// A coordinate has no influence at the point itself, but has one beside it.
TEST(LinearModels, InfluenceIsLookedForElsewhere) {
  const PrecisionScope scope(kDigits);
  const std::string text = R"(title = "t"
coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
potential.pull = "(2 + STEEP*sin(x))*y^2"
[initial]
"x'" = 1
)";
  const LinearModel level = linear(replaced(text, "STEEP", "0")), steep = linear(replaced(text, "STEEP", "1"));
  EXPECT_EQ(level.motion, LinearModel::Motion::steady);
  EXPECT_EQ(steep.motion, LinearModel::Motion::unsteady);
  EXPECT_NE(steep.why.find("vary"), std::string::npos) << steep.why;
  // x^4 has no stiffness at 0, but x is not cyclic.
  EXPECT_TRUE(linear(replaced(replaced(text, "(2 + STEEP*sin(x))*y^2", "x^4 + y^2"), "\"x'\" = 1", "")).cyclic.empty());
}

// A model that depends on time is not steady, even if nothing moves.
TEST(LinearModels, StiffnessThatSwings) {
  const PrecisionScope scope(kDigits);
  const LinearModel m = linear("title = \"t\"\ncoordinates = [\"x\"]\nparticle = [{name = \"p\", mass = 1, position = "
                               "\"x*ex\"}]\npotential.pull = \"(2 + cos(t))*x^2\"\n");
  EXPECT_EQ(m.motion, LinearModel::Motion::unsteady);
}

// ---- the bicycle -----------------------------------------------------------------------------------

struct Published {  // Meijaard et al. 2007, M q'' + v C1 q' + (g K0 + v^2 K2) q = 0 in lean and steer
  static constexpr const char *M[2][2] = {{"80.81722", "2.31941332208709"}, {"2.31941332208709", "0.29784188199686"}},
                              *C1[2][2] = {{"0", "33.86641391492494"}, {"-0.85035641456978", "1.68540397397560"}},
                              *K0[2][2] = {{"-80.95", "-2.59951685249872"}, {"-2.59951685249872", "-0.80329488458618"}},
                              *K2[2][2] = {{"0", "76.59734589573222"}, {"0", "2.65431523794604"}};
};

std::vector<Eigenvalue> published(const Multi& v) {
  const auto number = [](const char* text) { return Multi(*parse_rational(text)); };
  Matrix<Multi> mass(2, 2), a(4, 4);
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) mass(i, j) = number(Published::M[i][j]);
  Lu<Multi> lu;
  EXPECT_TRUE(lu.factor(mass));
  for (std::size_t j = 0; j < 2; ++j) {
    std::vector<Multi> stiffness, damping, x;
    for (std::size_t i = 0; i < 2; ++i) {
      stiffness.push_back(-(number("9.81") * number(Published::K0[i][j]) + v * v * number(Published::K2[i][j])));
      damping.push_back(-v * number(Published::C1[i][j]));
    }
    a(j, 2 + j) = Multi(1);
    lu.solve(stiffness, x);
    for (std::size_t i = 0; i < 2; ++i) a(2 + i, j) = x[i];
    lu.solve(damping, x);
    for (std::size_t i = 0; i < 2; ++i) a(2 + i, 2 + j) = x[i];
  }
  std::vector<Eigenvalue> e;
  EXPECT_TRUE(eigenvalues(a, e));
  return e;
}

ParameterRange speeds(const Model& model, int last) {
  ParameterRange r;
  while (model.parameters[r.parameter].name != "v") ++r.parameter;
  for (int v = 0; v <= last; ++v) r.values.emplace_back(v);
  return r;
}

TEST(LinearModels, WhippleBicycleAsPublished) {
  const PrecisionScope scope(kDigits);
  const auto model = shipped("zoo/whipple");
  const StateChoice choice;
  const auto s = scenario(model, choice);
  const Linearization l = linearize(*s, choice, speeds(*model, 10));
  for (int v = 0; v <= 10; ++v) {
    const LinearResult& r = l.results[static_cast<std::size_t>(v)];
    ASSERT_TRUE(r.outcome.ok()) << r.outcome.message;
    EXPECT_EQ(r.model.motion, v == 0 ? LinearModel::Motion::equilibrium : LinearModel::Motion::steady);
    EXPECT_EQ(r.model.spectrum.size(), 5U);  // the fifth, of the speed, is 0
    EXPECT_EQ(zeros(r.model), 1);
    for (const Eigenvalue& e : published(Multi(v)))
      EXPECT_LT(miss(r.model, e.value.re, e.value.im), 1e-12 * std::max(1.0, to_double(modulus(e.value))))
          << "v = " << v;
  }
  // Table 2 itself gives these at 5 m/s.
  for (const auto& [re, im] :
       {std::pair{"-0.77534188219585", "4.46486771378823"}, {"-0.32286642900409", "0"}, {"-14.0783896927982", "0"}})
    EXPECT_LT(miss(l.results[5].model, Multi(*parse_rational(re)), Multi(*parse_rational(im))), 1e-12);
  ASSERT_EQ(l.crossings.size(), 2U);
  EXPECT_LT(std::abs(to_double(l.crossings[0].value - Multi(*parse_rational("4.29238253634111")))), 1e-13);
  EXPECT_EQ(l.crossings[0].eigenvalues, 2);
  EXPECT_FALSE(l.crossings[0].destabilizes);
  EXPECT_LT(std::abs(to_double(l.crossings[1].value - Multi(*parse_rational("6.02426201538837")))), 1e-13);
  EXPECT_TRUE(l.crossings[1].frequency == Multi(0));
  EXPECT_TRUE(l.crossings[1].destabilizes);
}

// The mutant: the trail is a hundredth of a millimetre longer.
TEST(LinearModels, AnotherBicycleHasOtherEigenvalues) {
  const PrecisionScope scope(kDigits);
  const LinearModel m = linear(replaced(shipped_text("zoo/whipple"), "c = 0.08 ", "c = 0.08001 "));
  EXPECT_GT(miss(m, Multi(*parse_rational("-0.77534188219585")), Multi(*parse_rational("4.46486771378823"))), 1e-5);
}

}  // namespace
}  // namespace anholon::test::linear_test

#include "support/published.h"

namespace anholon::compare_test {
namespace {

const char* const kPendulum = R"toml(coordinates = ["x", "y"]
parameters = {m = 2, l = 3, g = 9.81}
gravity.field = "-g*ey"
[[particle]]
name = "bob"
mass = "m"
position = ["x", "y", "0"]
[[constraint]]
name = "rod"
equation = "x^2 + y^2 = l^2"
)toml";

class Compared : public test::Published {
 public:
  using Published::Published;
  std::string what(const std::string& equation) {
    const Comparison c = compare(equation);
    return c.verdict == Verdict::proved ? c.what : std::string(name(c.verdict)) + " " + c.detail;
  }
  std::string difference(const std::string& equation) {
    const Comparison c = compare(equation);
    return c.difference ? print(*c.difference, names(), Format::text) : "";
  }
};

TEST(Compare, SaysWhatATrueEquationIs) {
  Compared s(test::kSleigh);
  EXPECT_EQ(s.what("m*x'' = -lambda*sin(th)"), "the equation of x");
  EXPECT_EQ(s.what("lambda*sin(th)/m = -x''"), "the equation of x, times 1/m");
  EXPECT_EQ(s.what("J*th'' = 0"), "the equation of th");
  EXPECT_EQ(s.what("y'*cos(th) - x'*sin(th) = 0"), "the constraint blade");
  EXPECT_EQ(s.what("y''*cos(th) - y'*th'*sin(th) = x''*sin(th) + x'*th'*cos(th)"),
            "the constraint blade, differentiated once");
  EXPECT_EQ(s.what("y' = x'*tan(th)"), "the constraint blade, times 1/cos(th)");
  EXPECT_EQ(s.what("x''*cos(th) + y''*sin(th) = 0"),
            "a combination without multipliers: cos(th)/m times the equation of x + sin(th)/m times the equation of y");
  EXPECT_EQ(s.what("lambda = m*th'*(x'*cos(th) + y'*sin(th))").find("a combination: "), 0U);
  EXPECT_EQ(s.what("x'' = -y'*th'").find("a combination without multipliers: "), 0U);
  EXPECT_NE(s.what("x'' = -y'*th'").find("with blade put in"), std::string::npos);
  EXPECT_EQ(s.what("x*y = y*x"), "an identity: it holds whatever the motion");
  EXPECT_EQ(s.what("J*th''' = 0"), "the equation of th, differentiated once");
}

TEST(Compare, HolonomicConstraintsAndTheirConsequences) {
  Compared s(kPendulum);
  EXPECT_EQ(s.what("m*x'' = 2*lambda*x"), "the equation of x");
  EXPECT_EQ(s.what("x*x' = -y*y'"), "the constraint rod, differentiated once, times 1/2");
  EXPECT_EQ(s.what("x^4 = (l^2 - y^2)^2"), "a consequence of the constraint rod alone");
  // x x'' + y y'' + x'^2 + y'^2 = 0 with the equations of motion put in.
  EXPECT_NE(s.what("2*lambda*l^2 = m*g*y - m*(x'^2 + y'^2)").find("with rod put in"), std::string::npos);
}

// A rocket that burns its fuel, which is a state: the formula of its rate replaces its derivatives.
TEST(Compare, RatesOfStatesBelongToTheDerivedEquations) {
  Compared s(R"toml(coordinates = ["x"]
parameters = {m0 = 2, c = 3, q = 0.1}
state.fuel = {rate = "-q*(1 + x)", initial = 2}
particle = [{name = "r", mass = "m0 + fuel", position = "x*ex", expelled_velocity = "-c*ex"}]
)toml");
  EXPECT_EQ(s.what("(m0 + fuel)*x'' = q*(1 + x)*c"), "the equation of x");
  EXPECT_EQ(s.what("(m0 + fuel)*x'' = -fuel'*c"), "the equation of x");
  EXPECT_EQ(s.what("fuel' = -q*(1 + x)"), "a consequence of the rates of the states alone");
  EXPECT_EQ(s.what("fuel'' = -q*x'"), "a consequence of the rates of the states alone");
  EXPECT_EQ(s.what("fuel' + x = fuel' + x"), "an identity: it holds whatever the motion");
  EXPECT_EQ(s.what("(m0 + fuel)*x''' - q*(1 + x)*x'' = q*x'*c"), "the equation of x, differentiated once");
  EXPECT_EQ(s.compare("fuel' = q*(1 + x)").verdict, Verdict::refuted);
  EXPECT_EQ(s.compare("(m0 + fuel)*x'' = fuel'*c").verdict, Verdict::refuted);
}

// An equation with a number in place of a parameter is true only for the values of the file.
TEST(Compare, NumbersOfTheFile) {
  Compared s(R"toml(coordinates = ["th"]
parameters = {J = 0.5, c = 0.7, k = 2}
body = [{name = "rod", inertia = "J", center = "0*ex", angle = "th"}]
dissipation.R = "c*th'^2/2"
)toml");
  EXPECT_EQ(s.compare("J*th'' = -0.7*th'").with_numbers, "c = 0.7");
  const Comparison both = s.compare("0.5*th'' = -0.7*th'");
  EXPECT_EQ(both.verdict, Verdict::refuted);
  EXPECT_EQ(both.with_numbers, "J = 0.5, c = 0.7");
  EXPECT_EQ(s.compare("0.5*th'' = -0.8*th'").with_numbers, "");
}

// An input whose formula is a number may be any function of time.
TEST(Compare, InputsAreFree) {
  const auto cart = [](const std::string& input) {
    return "coordinates = [\"x\"]\nparameters = {m = 2}\ninput.u = \"" + input +
           "\"\nparticle = [{name = \"p\", mass = \"m\", position = \"x*ex\"}]\n"
           "force = [{on = \"p\", vector = \"u*ex\"}]\n";
  };
  Compared s(cart("0"));
  EXPECT_EQ(s.what("m*x'' = u"), "the equation of x");
  EXPECT_EQ(s.what("m*D(x, 3) = u'"), "the equation of x, differentiated once");
  EXPECT_EQ(s.change("m*x'' = -u"), "-u -> u");
  for (const char* const wrong : {"m*x'' = 0", "m*x'' = 7*u*x", "u = 0"}) {
    EXPECT_EQ(s.compare(wrong).verdict, Verdict::refuted) << wrong;
    EXPECT_EQ(s.compare(wrong).with_numbers, "u = 0") << wrong;
  }
  // The formula of a controller belongs to the model.
  Compared feedback(cart("-3*x"));
  EXPECT_EQ(feedback.what("m*x'' = u"), "the equation of x");
  EXPECT_EQ(feedback.what("m*x'' = -3*x"), "the equation of x");
  EXPECT_EQ(feedback.compare("m*x'' = -u").verdict, Verdict::refuted);
}

// Free inputs have no value at the start of the motion, near which the constraints are solved.
TEST(Compare, FreeInputsBesideConstraints) {
  const auto model = [](const std::string& constraint) {
    return "coordinates = [\"x\", \"y\"]\ninput = {u = {}, k = \"3\"}\n"
           "particle = [{name = \"p\", mass = 1, position = \"x*ex + y*ey\"}]\n"
           "force = [{on = \"p\", vector = \"(u + k)*ex\"}]\nconstraint = [" +
           constraint + "]\n";
  };
  Compared servo(model(R"({name = "hold", equation = "x'' = 1", by = "u"})"));
  EXPECT_EQ(servo.what("x'' = 1"), "the constraint hold");
  EXPECT_EQ(servo.what("x'' = u + k"), "the equation of x");
  EXPECT_EQ(servo.compare("x'' = u").verdict, Verdict::refuted);
  EXPECT_EQ(servo.compare("u = -2").with_numbers, "k = 3");
  Compared rolling(model(R"({name = "hold", equation = "y' = k*x'"}, {name = "push", equation = "x = t", by = "u"})"));
  EXPECT_EQ(rolling.what("y' = k*x'"), "the constraint hold");
  EXPECT_EQ(rolling.what("y'' = lambda.hold"), "the equation of y");
  EXPECT_EQ(rolling.compare("y' = 3*x'").with_numbers, "k = 3");
}

// No generic point is on these constraints, and for most values of one coordinate there is no value of the other one.
TEST(Compare, PointsOfConstraintsFarFromGenericOnes) {
  const std::pair<const char*, const char*> cases[] = {{"x^2 + y^2 = 0.01", "x"},
                                                       {"(x - 5)^2 + (y - 7)^2 = 1", "x"},
                                                       {"exp(x) + exp(y) = 1/10", "x"},
                                                       {"sin(x) + sin(y) = 199/100", "x"},
                                                       {"x'^2 + y'^2 = 0.0001", "x'"}};
  for (const auto& [constraint, top] : cases) {
    Compared s(std::string("coordinates = [\"x\", \"y\"]\nparticle = [{name = \"p\", mass = 1, position = \"x*ex + "
                           "y*ey\"}]\ngravity.field = \"-9.81*ey\"\n[[constraint]]\nname = \"c\"\nequation = \"") +
               constraint + "\"\n");
    const std::string reaction = std::string("lambda*partial(phi, ") + top + ")";
    EXPECT_EQ(s.what("x'' = " + reaction), "the equation of x") << constraint;
    EXPECT_EQ(s.compare("phi = 0").verdict, Verdict::proved) << constraint;
    EXPECT_EQ(s.compare("x'' = 2*" + reaction).verdict, Verdict::refuted) << constraint;
    EXPECT_EQ(s.compare("x = y").verdict, Verdict::refuted) << constraint;
  }
  // This constraint has values near the start alone.
  Compared s(R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "c", equation = "sqrt(x - 100) + sqrt(y - 100) = 1"}]
initial = {x = 100.25, guess = {y = 100.25}}
)toml");
  EXPECT_EQ(s.compare("2*x''*sqrt(x - 100) = lambda").verdict, Verdict::proved);
  EXPECT_EQ(s.compare("x''*sqrt(x - 100) = lambda").verdict, Verdict::refuted);
}

// The redundant constraint holds at a single point, where it depends on the other one.
TEST(Compare, ASingularPointRefutesNothing) {
  Compared s(R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "a", equation = "y = 0"}, {name = "b", equation = "y + x^2 = 0"}]
)toml");
  for (const char* const equation : {"x = 0", "y = 0", "x^2 = 0", "x' = 0"})
    EXPECT_NE(s.compare(equation).verdict, Verdict::refuted) << equation;
  EXPECT_EQ(s.compare("x' = 1").verdict, Verdict::unknown);
}

// The second constraint follows from the first one: solving both for x' and y' divides by zero.
TEST(Compare, ConstraintsThatDependOnEachOtherOnTheManifold) {
  Compared s(R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "a", equation = "x^2 + y^2 = 1"}, {name = "b", equation = "(x^2 + y^2 - 1)*(x - 3) = 0"}]
initial = {x = 0.6, guess = {y = 0.8}}
)toml");
  EXPECT_EQ(s.compare("x' = 0").verdict, Verdict::unknown);
}

TEST(Compare, NoPointOfAMotion) {
  Compared s(R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
constraint = [{name = "c", equation = "x^2 + y^2 = -1"}]
)toml");
  EXPECT_EQ(s.what("x'' = lambda*y"), "unknown no point of a motion was found");
}

// Numbers of the file are printed as they are written.
TEST(Compare, NumbersOfTheFileAreExact) {
  Compared s(R"toml(coordinates = ["th"]
parameters = {g = "9.81 m/s^2", m = "200 g", v = "1 km/h", l = 0.12345678901234567891}
particle = [{name = "p", mass = "m", position = "l*(sin(th)*ex - cos(th)*ey)"}]
gravity.field = "-g*ey"
dissipation.R = "v*th'^2/2"
)toml");
  EXPECT_EQ(s.compare("0.2*(l^2*th'' + 9.81*l*sin(th)) = -5/18*th'").with_numbers, "g = 9.81, m = 0.2, v = 5/18");
  EXPECT_EQ(s.compare("m*l^2*th'' + m*g*0.12345678901234567891*sin(th) = -v*th'").with_numbers,
            "l = 0.12345678901234567891");
}

TEST(Compare, ParametersFollowOthers) {
  Compared s(R"toml(coordinates = ["th"]
parameters = {m = 2, R = 0.3, J = "m*R^2/2", k = "4*m", c = 8}
body = [{name = "disc", mass = "m", inertia = "J", center = "R*(cos(th)*ex + sin(th)*ey)", angle = "th"}]
potential.spring = "k*th^2/2"
)toml");
  EXPECT_EQ(s.what("(J + m*R^2)*th'' = -k*th"), "the equation of th");
  EXPECT_EQ(s.what("3/2*m*R^2*th'' = -k*th"), "the equation of th, with J = R^2*m/2 put in");
  EXPECT_EQ(s.what("3/2*R^2*th'' = -4*th"), "the equation of th, times 1/m, with J = R^2*m/2, k = 4*m put in");
  EXPECT_EQ(s.compare("3/2*R^2*th'' = -5*th").verdict, Verdict::refuted);
  EXPECT_EQ(s.compare("3/2*m*R^2*th'' = -c*th").verdict, Verdict::refuted);
  EXPECT_FALSE(s.compare("3/2*m*R^2*th'' = -c*th").with_numbers.empty());
}

// A root of the constraint has either sign, so that no proof may take it for an absolute value.
TEST(Compare, HoldsAtSomePointsAlone) {
  Compared p(kPendulum);
  for (const char* const wrong :
       {"abs(y) = y", "y = sqrt(l^2 - x^2)", "abs(x) = x", "x = sqrt(l^2 - y^2)", "asin(y/l) = atan(y/x)"}) {
    const Comparison c = p.compare(wrong);
    EXPECT_EQ(c.verdict, Verdict::refuted) << wrong;
    EXPECT_TRUE(c.in_places) << wrong;
    EXPECT_TRUE(c.what.empty() && c.changes.empty()) << wrong;
    EXPECT_TRUE(c.witness) << wrong;
  }
  EXPECT_EQ(p.what("abs(x)^2 = l^2 - y^2"), "the constraint rod");
  EXPECT_FALSE(p.compare("x = 2*sqrt(l^2 - y^2)").in_places);
}

TEST(Compare, AnEquationWithoutAValueIsUnknown) {
  Compared s(test::kSleigh);
  const Comparison c = s.compare("1/(y'*cos(th) - x'*sin(th)) = 5");
  EXPECT_EQ(c.verdict, Verdict::unknown);
  EXPECT_EQ(c.detail, "line 1: division by zero where the derived equations hold");
  EXPECT_EQ(s.what("J*th'' = 0"), "the equation of th");
}

TEST(Compare, NamesTheMisprint) {
  Compared s(test::kSleigh);
  EXPECT_EQ(s.change("m*x'' = lambda*sin(th)"),
            "lambda*sin(th) -> -lambda*sin(th)");  // the equal left side is not named
  EXPECT_EQ(s.change("m*x'' = -lambda*cos(th)"), "-lambda*cos(th) -> -lambda*sin(th)");
  Compared p(kPendulum);
  EXPECT_EQ(p.change("m*y'' = 2*lambda*y + m*g"), "+ m*g -> - m*g");
  EXPECT_EQ(p.change("m*y' = 2*lambda*y - m*g"), "m*y' -> m*y''");
  EXPECT_EQ(p.change("m*y'' = 2*lambda*x - m*g"), "2*lambda*x -> 2*lambda*y");
  EXPECT_EQ(p.change("m*y'' = 2*lambda^2*y - m*g"), "2*lambda^2*y -> 2*lambda*y");
  EXPECT_EQ(p.change("m*y'' = lambda*y - m*g"), "lambda*y -> 2*lambda*y");
  EXPECT_EQ(p.change("m*y = 2*lambda*y - m*g"), "m*y -> m*y''");  // two primes in one term
  EXPECT_EQ(p.change("m*y'' = 2*lambda*x' + m"), "0");
  EXPECT_EQ(p.difference("m*y'' = 2*lambda*y + m*g"), "-2*m*g");
}

TEST(Compare, TheSamePlaceInTheFile) {
  Compared p(kPendulum);
  const Comparison c = p.compare("m*y'' = 2*lambda*y + m*g");
  ASSERT_EQ(c.changes.size(), 1U);
  EXPECT_EQ(c.changes[0].span.line, 1U);
  EXPECT_EQ(c.changes[0].span.column, 25U);
  EXPECT_EQ(c.changes[0].span.length, 3U);
  ASSERT_TRUE(c.witness);
}

// Constraints that are nonlinear in their highest derivatives make Routh's equations nonlinear.
TEST(Compare, NonlinearConstraintsOfHigherOrder) {
  for (const int m : {2, 3}) {
    const std::string order = std::to_string(m);
    Compared s(R"toml(coordinates = ["x", "y", "z"]
parameters = {m = 2, k = 3}
particle = [{name = "p", mass = "m", position = ["x", "y", "z"]}]
potential.V = "k*y + x*z"
[[constraint]]
name = "c"
equation = "D(z,)toml" +
               order + ") = D(x," + order + ")^2 + y*D(y," + order + ")^2\"\n");
    const std::string slope = "2*D(x," + order + ")";
    EXPECT_EQ(s.compare("m*x'' + m*z''*" + slope + " = -z - x*" + slope).verdict, Verdict::proved) << m;
    EXPECT_EQ(s.compare("maggi.y = 0").verdict, Verdict::proved) << m;
    EXPECT_EQ(s.compare("along(inertia_term, x) = along(G, x)").verdict, Verdict::proved) << m;
    EXPECT_EQ(s.compare("m*x'' + m*z''*" + slope + " = z - x*" + slope).verdict, Verdict::refuted) << m;
    EXPECT_EQ(s.compare("m*x'' + m*z'' = -z - x").verdict, Verdict::refuted) << m;
    EXPECT_EQ(s.compare("f.z = 0").verdict, Verdict::refuted) << m;
    EXPECT_EQ(s.compare("f.z = D(z," + order + ")").verdict, Verdict::proved) << m;
  }
}

// A constraint of lower order is lifted for the elimination and holds itself on the motion: an equation that is true by
// this constraint is not refuted.
TEST(Compare, ALowerConstraintBesideANonlinearOneHolds) {
  Compared s(R"toml(coordinates = ["x", "y", "z", "w"]
parameters = {m = 2, k = 3}
particle = [{name = "p", mass = "m", position = ["x", "y", "z"]}, {name = "q", mass = "m", position = "w*ex"}]
[[constraint]]
name = "low"
equation = "y' = x"
[[constraint]]
name = "high"
equation = "D(z,3) = D(x,3)^2 + D(w,3)^2"
)toml");
  EXPECT_EQ(s.compare("along(inertia_term, x) = along(G, x)").verdict, Verdict::proved);
  EXPECT_NE(s.compare("along(inertia_term, x) + k*(y' - x) = along(G, x)").verdict, Verdict::refuted);
}

// The multiplier is eliminated with third derivatives, which the constraint relates.
TEST(Compare, ConstraintOfThirdOrderThatIsNonlinear) {
  Compared s(R"toml(coordinates = ["x", "y"]
parameters = {m = 2, g = 9}
particle = [{name = "p", mass = "m", position = "x*ex + y*ey"}]
gravity.field = "-g*ey"
constraint = [{name = "jerk", equation = "D(x,3)^2 + D(y,3)^2 = 9"}]
)toml");
  EXPECT_EQ(s.what("x''*D(y,3) = (y'' + g)*D(x,3)"), "a combination of the equations of motion");
  EXPECT_EQ(s.what("m^2*(x''^2 + (y'' + g)^2) = 36*lambda^2"),
            "a combination of the equations of motion, with the constraints put in");
  EXPECT_EQ(s.compare("x''*D(y,3) = -(y'' + g)*D(x,3)").verdict, Verdict::refuted);
  EXPECT_EQ(s.compare("m^2*(x''^2 + (y'' + g)^2) = 9*lambda^2").verdict, Verdict::refuted);
  EXPECT_EQ(s.compare("3*x'' = sqrt(x''^2 + (y'' + g)^2)*D(x,3)").verdict, Verdict::refuted);  // of one sign of lambda
  EXPECT_EQ(s.compare("D(x,4) = D(y,3)").verdict, Verdict::refuted);
}

// Products of accelerations are no combination of equations that are linear in these.
TEST(Compare, PolynomialConsequences) {
  Compared s(R"toml(coordinates = ["x", "y"]
parameters = {m = 2, b = -3, s = "1/2"}
particle = [{name = "p", mass = "m", position = "x*ex + y*ey"}]
constraint = [{name = "c", equation = "x''' + s*y''' = b*x'"}]
)toml");
  const std::string consequence = "a consequence of the equations of motion and the constraints";
  EXPECT_EQ(s.compare("y'' = s*x''").verdict, Verdict::proved);
  EXPECT_EQ(s.what("y''*x''' = x''*y'''"), consequence);
  EXPECT_EQ(s.compare("y''*x''' = 2*x''*y'''").verdict, Verdict::refuted);
  Compared z(R"toml(coordinates = ["x", "y", "z"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey + z*ez"}]
constraint = [{name = "a", equation = "x''' = y"}, {name = "b", equation = "z = y^2"}]
)toml");
  EXPECT_EQ(z.what("x'''^2 = z"), consequence);
  EXPECT_EQ(z.compare("x'''^2 = 2*z").verdict, Verdict::refuted);
}

}  // namespace
}  // namespace anholon::compare_test

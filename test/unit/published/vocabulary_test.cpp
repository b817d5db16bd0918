// The words of published equations: quantities, derivatives, eliminations, definitions, vectors, and the messages on
// wrong ones.
#include "support/published.h"

namespace anholon::vocabulary_test {
namespace {

// A rocket on a plane that turns with an unknown angle; a blade; the model defines the names C and Q itself.
const char* const kRocket = R"toml(coordinates = ["x", "y", "th"]
parameters = {M = 3, J = 2, u = 2, Q = 5}
[functions]
m = {}
w = {}
[frame]
blade = "rotz(th)"
[point]
C = "x*ex + y*ey"
[observer]
spin = "w*ez"
[[body]]
name = "sleigh"
mass = "M"
inertia = "J"
center = "C"
orientation = "blade"
[[particle]]
name = "rocket"
mass = "m"
position = "C + blade.x"
expelled_velocity = "-u*blade.x"
[[constraint]]
name = "edge"
equation = "y' = x'*tan(th)"
)toml";
// The constraint of a bounded speed is not solved as a formula.
const char* const kSpeed = R"toml(coordinates = ["r", "psi"]
parameters = {c = 2, k = 3}
[functions]
m = {}
[[particle]]
name = "p"
mass = "m"
position = ["r*cos(psi)", "r*sin(psi)", "0"]
[[force]]
on = "p"
vector = "-k*ex"
[[constraint]]
name = "speed"
equation = "r'^2 + r^2*psi'^2 + r^4*psi'^4 = c^2"
[initial]
r = 1
"r'" = 1
)toml";
const char* const kQuasi = R"toml(coordinates = ["x", "y", "z"]
parameters = {m = 2, k = 3}
particle = [{name = "p", mass = "m", position = "x*ex + y*ey + z*ez"}]
potential.V = "k*z"
[[constraint]]
name = "c"
equation = "z' = y*x'"
[quasi]
u1 = "x'"
u2 = "y' + x*x'"
)toml";

class Words : public test::Published {
 public:
  using Published::Published;
  // The verdict on the last equation of the text: "true", "false" or "unknown".
  std::string verdict(const std::string& text) {
    const auto list = read(text + "\n");
    if (list.empty()) return "not read";
    const Comparison c = subject().judge(list.back());
    return c.verdict == Verdict::proved ? "true" : c.verdict == Verdict::refuted ? "false" : "unknown: " + c.detail;
  }
  std::string error(const std::string& text) {
    const Diagnostics said = errors(text + "\n");
    return said.has_errors() ? said.list().front().message : "";
  }
};

TEST(Vocabulary, QuantitiesOfTheDerivation) {
  Words w(kRocket);
  for (const char* right :
       {"e: inertia_term.x = G.x + N.x",
        "e: derived.Q.x + QR.x + Qomega.x + minus_dVO.x + minus_dVomega.x + Gamma.x = G.x", "e: QR.x = -m'*u*cos(th)",
        "e: QR(x) = QR.x", "e: N.th = 0", "e: N.x = lambda*partial(phi.edge, x')", "e: V_O = 0",
        "e: Gamma.x = 2*w*(M*y' + m*(y' + th'*cos(th)))", "e: mu.rocket = m", "e: m_rocket = m", "e: C.x = x",
        "e: lambda.edge = lambda", "e: 2*Q = Q + derived.Q.x + Q"})
    EXPECT_EQ(w.verdict(right), "true") << right;
  for (const char* wrong : {"e: inertia_term.x = G.x - N.x", "e: QR.x = -m*u*cos(th)",
                            "e: N.x = lambda*partial(phi.edge, y')", "e: Gamma.x = 2*w*(M*y' + m*(x' + th'*cos(th)))"})
    EXPECT_EQ(w.verdict(wrong), "false") << wrong;
}

TEST(Vocabulary, FrozenAndTotalDerivatives) {
  Words w(kRocket);
  for (const char* right :
       {"e: Dt(partial(T_r, x')) = (M + m)*x'' - m*(th''*sin(th) + th'^2*cos(th))",
        "e: D(partial(T_r, x'), 1) = Dt(partial(T_r, x')) + m'*(x' - th'*sin(th))",
        "e: partial(T_r, x')' = Dt(partial(T_r, x')) + m'*(x' - th'*sin(th))", "e: Dt(m*x') = m*x''",
        "e: (m*x')' = m*x'' + m'*x'", "e: Dt(T_r, 2) = Dt(Dt(T_r))", "e: partial(m*x'^2, t) = m'*x'^2",
        "e: partial(frozen(m*x'^2), t) = 0", "e: partial(T_r, mu.rocket) = norm2(vel(rocket))/2",
        "e: partial(vel(rocket), th') = partial(rocket, th)"})
    EXPECT_EQ(w.verdict(right), "true") << right;
  for (const char* wrong :
       {"e: Dt(m*x') = m*x'' + m'*x'", "e: (m*x')' = m*x''", "e: partial(T_r, x')' = Dt(partial(T_r, x'))"})
    EXPECT_EQ(w.verdict(wrong), "false") << wrong;
}

TEST(Vocabulary, ConstraintsPutIn) {
  Words w(kRocket);
  for (const char* right :
       {"e: f.y = x'*tan(th)", "e: derived.C.y.x = tan(th)", "e: reduced(y') = f.y",
        "e: reduced(y'') = D(x'*tan(th), 1)",
        "e: partial(reduced(T_r), x') = partial(T_r, x') + tan(th)*partial(T_r, y')",
        "e: along(G, x) = G.x + tan(th)*G.y", "e: along(inertia_term, th) = along(G, th)",
        "e: maggi.x = along(inertia_term, x) - along(G, x)", "e: chaplygin.left.th - chaplygin.right.th = 0"})
    EXPECT_EQ(w.verdict(right), "true") << right;
  EXPECT_EQ(w.verdict("e: partial(reduced(T_r), x') = partial(T_r, x')"), "false");
  EXPECT_EQ(w.verdict("e: maggi.left.x = maggi.right.th"), "false");
}

TEST(Vocabulary, ConstraintsThatAreNotSolved) {
  Words w(kSpeed);
  const bool for_r = w.error("e: f.r = 0").empty();
  const std::string y = for_r ? "r" : "psi", x = for_r ? "psi" : "r";
  EXPECT_EQ(w.error("e: f." + x + " = 0"),
            "'" + x + "' is an independent coordinate here: the constraints are not solved for it");
  EXPECT_EQ(w.verdict("e: partial(f." + y + ", " + x + "') = -partial(phi, " + x + "')/partial(phi, " + y + "')"),
            "true");
  EXPECT_EQ(w.verdict("let S = reduced(T_r)\ne: partial(S, " + x + "') = partial(T_r, " + x + "') + partial(T_r, " + y +
                      "')*partial(f." + y + ", " + x + "')"),
            "true");
  EXPECT_EQ(w.verdict("e: partial(reduced(T_r), " + x + "') = partial(T_r, " + x + "') - partial(T_r, " + y +
                      "')*partial(f." + y + ", " + x + "')"),
            "false");
  EXPECT_EQ(w.verdict("e: partial(reduced(T_r), " + x + ") = partial(T_r, " + x + ") + partial(T_r, " + y +
                      "')*partial(f." + y + ", " + x + ")"),
            "true");
  // A sum with another term has no derivative along the manifold that differs visibly from an ordinary one.
  EXPECT_EQ(w.error("e: partial(reduced(T_r) + " + x + "', " + x + "') = 0")
                .find("the constraints are not solved as formulas here"),
            0U);
  EXPECT_EQ(w.error("let twice = 2*reduced(T_r)\ne: partial(twice, " + x + "') = 0")
                .find("the constraints are not solved as formulas here"),
            0U);
  EXPECT_EQ(
      w.error("e: partial(D(f." + y + ", 1), " + x + "') = 0").find("the constraints are not solved as formulas here"),
      0U);
}

TEST(Vocabulary, QuasiVelocities) {
  Words w(kQuasi);
  for (const char* right :
       {"e: g.y = y'", "e: B.y.u1 = -x", "e: B.z.u1 = y", "e: partial(g.y, u2) = 1", "e: u1 = x'", "e: u2 = y' + x*x'",
        "e: partial(star(T_r), u2) = m*y'", "e: along(Q, u1) = Q.x*B.x.u1 + Q.y*B.y.u1 + Q.z*B.z.u1",
        "e: micevic_rusov_quasi.u1 = along(inertia_term, u1) - along(G, u1)"}) {
    EXPECT_EQ(w.verdict(right), "true") << right;
  }
  EXPECT_EQ(w.verdict("e: partial(star(T_r), u2) = m*z'"), "false");
  EXPECT_EQ(w.error("e: partial(T_r, u2) = 0"),
            "what is differentiated by a quasi-velocity is not expressed in quasi-velocities");
}

// The names that `derive` prints for the polynomials of a table.
TEST(Vocabulary, PiecesOfTables) {
  Words w(R"toml(coordinates = ["x"]
parameters = {m = 2}
particle = [{name = "p", mass = "m", position = "x*ex"}]
potential.V = "c(x)"
[[table]]
name = "c"
x = [0, 1, 2, 4]
y = [0, 1, 4, 3]
fit = "spline"
[initial]
x = 1
)toml");
  EXPECT_EQ(w.verdict("e: m*x'' = c.knot(x)*(2*c.c2(x) + 3*c.c3(x)*(2*x - c.knot(x))) - c.c1(x) - 3*x^2*c.c3(x) - "
                      "2*x*c.c2(x)"),
            "true");
  EXPECT_EQ(w.verdict("let d = x - c.knot(x)\ne: c(x) = c.c0(x) + d*(c.c1(x) + d*(c.c2(x) + d*c.c3(x)))"), "true");
  EXPECT_EQ(w.verdict("e: m*x'' = c.c1(x)"), "false");
  EXPECT_EQ(w.error("e: c.c4(x) = 0"), "an operator is missing before '('");
  EXPECT_EQ(w.error("e: d.c1(x) = 0"), "unknown function 'd.c1'");
  EXPECT_EQ(w.error("e: c.c1(x, x) = 0"), "c.c1 takes 1 argument, 2 are given");
}

TEST(Vocabulary, OldNamesOfForms) {
  EXPECT_EQ(find_formulation("misevic-rusov-quasi"), find_formulation("micevic-rusov-quasi"));
}

TEST(Vocabulary, DefinitionsAndVectors) {
  Words w(kRocket);
  EXPECT_EQ(w.verdict("let v = vel(C)\nlet s = dot(v, blade.x)\ne: s = x'*cos(th) + y'*sin(th)"), "true");
  EXPECT_EQ(w.read("e: vel(C) = x'*ex + y'*ey\n").size(), 3U);
  EXPECT_EQ(w.read("e: vel(C) = 0\n").size(), 3U);
  EXPECT_EQ(w.verdict("e: reaction(sleigh) + reaction(rocket) = lambda/cos(th)*blade.y"), "true");
}

TEST(Vocabulary, WrongWordsAreErrors) {
  Words w(kRocket);
  EXPECT_EQ(w.error("e: QR.z = 0"), "there is no coordinate 'z'");
  EXPECT_EQ(w.error("e: QR = 0"), "'QR' has an entry for each coordinate");
  EXPECT_EQ(w.error("e: f.x = 0"), "'x' is an independent coordinate here: the constraints are not solved for it");
  EXPECT_EQ(w.error("e: phi.edg = 0"), "there is no 'phi.edg'; did you mean 'phi.edge'?");
  EXPECT_EQ(w.error("e: partial(T_r, 2*x) = 0"),
            "a partial derivative is taken by a derivative of a coordinate, by t, or by another symbol");
  EXPECT_EQ(w.error("e: maggi.y = 0"), "the form maggi has no equation 'y'");
  EXPECT_EQ(w.error("e: vel(C) = 1"), "one side is a vector, this one is a number");
  EXPECT_EQ(w.error("let T_r = x\ne: x = 0"), "the name 'T_r' has a meaning in equations");
  EXPECT_EQ(w.error("let M = x\ne: x = 0"), "'M' is a name of the model");
  EXPECT_EQ(w.error("let s = x\nlet s = y\ne: s = 0"), "'s' is already defined in this file");
  EXPECT_EQ(w.error("e: Dt(x, 99) = 0"), "a whole number between 0 and 20 is expected here");
  EXPECT_NE(w.error("e: alon(QR, x) = 0").find("did you mean 'along'?"), std::string::npos);
}

}  // namespace
}  // namespace anholon::vocabulary_test

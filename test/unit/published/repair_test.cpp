#include <cmath>

#include <gtest/gtest.h>

#include "proof/equations_of_motion.h"
#include "published/misprints/trial.h"
#include "support/published.h"

namespace anholon::repair_test {
namespace {

// All varying quantities are unknown functions: the mass, the spin of the observer, a force p' e_x.
const char* const kRocket = R"toml(coordinates = ["x", "y"]
parameters = {k = 2, u = 1.5}
functions = {m = {}, w = {}, p = {}}
observer.spin = "w*ez"
point.P = "x*ex + y*ey"
[[particle]]
name = "rocket"
mass = "m"
position = "P"
expelled_velocity = "-u*ex"
[[force]]
on = "rocket"
vector = "p'*ex - k*P"
)toml";
const std::string kOfX = "m*x'' = p' - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)";

// In polar coordinates, with a constraint.
const char* const kPolar = R"toml(coordinates = ["r", "psi"]
parameters = {m = 2, k = 3, c = 1.5}
[[particle]]
name = "bob"
mass = "m"
position = "r*rotz(psi).x"
[[force]]
on = "bob"
vector = "-k*r*rotz(psi).x"
[[constraint]]
name = "speed"
equation = "r'^2 + r^2*psi'^2 = c^2"
)toml";

// Two constraints, with a multiplier each.
const char* const kTwo = R"toml(coordinates = ["x", "y", "z"]
parameters = {m = 2}
[[particle]]
name = "bead"
mass = "m"
position = ["x", "y", "z"]
[[constraint]]
name = "a"
equation = "y' = z*x'"
[[constraint]]
name = "b"
equation = "z' = x*y'"
)toml";

class Repaired : public test::Published {
 public:
  using Published::Published;
  // "from -> to" of all places of the only change, or the number of changes if there are several.
  std::string change(const std::string& equation) {
    const Comparison c = compare(equation);
    if (c.verdict != Verdict::refuted) return name(c.verdict);
    if (c.changes.size() != 1) return std::to_string(c.changes.size());
    std::string text;
    for (const ChangedPlace& p : c.changes[0].places) text += (text.empty() ? "" : ", ") + p.from + " -> " + p.to;
    return text;
  }
  std::vector<std::string> readings(const std::string& equation) {
    std::vector<std::string> list;
    for (const Change& c : compare(equation).changes) list.push_back(c.equation);
    return list;
  }
};

using Texts = std::vector<std::string>;

TEST(Repair, LostDotsOfSeveralSymbols) {
  Repaired r(kRocket);
  ASSERT_EQ(r.compare(kOfX).verdict, Verdict::proved);
  EXPECT_EQ(r.change("m*x = p' - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)"), "m*x -> m*x''");
  EXPECT_EQ(r.change("m*x = p - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)"), "x -> x'', p -> p'");
  EXPECT_EQ(r.change("m*x' = p - k*x - m*u + m*(2*w*y' + w'*y + w^2*x)"), "x' -> x'', p -> p', m -> m'");
  EXPECT_EQ(r.change("m*x = p' - k*x - m*u + m*(2*w*y + w*y + w^2*x)"), "x -> x'', m -> m', y -> y', w -> w'");
  EXPECT_EQ(r.readings("m*x = p' - k*x - m*u + m*(2*w*y + w*y + w^2*x)"), Texts{kOfX});
}

TEST(Repair, EachPlaceOfAChange) {
  Repaired r(kRocket);
  const Comparison c = r.compare("m*x = p - k*x - m'*u\n + m*(2*w*y + w'*y + w^2*x)");
  ASSERT_EQ(c.changes.size(), 1U);
  const std::vector<ChangedPlace>& places = c.changes[0].places;
  ASSERT_EQ(places.size(), 3U);
  const auto at = [](const ChangedPlace& p) {
    return std::vector<std::size_t>{p.span.line, p.span.column, p.span.length, static_cast<std::size_t>(p.side),
                                    p.term};
  };
  EXPECT_EQ(at(places[0]), (std::vector<std::size_t>{1, 6, 1, 0, 0}));
  EXPECT_EQ(at(places[1]), (std::vector<std::size_t>{1, 10, 1, 1, 0}));
  EXPECT_EQ(at(places[2]), (std::vector<std::size_t>{2, 11, 1, 1, 3}));
  EXPECT_EQ(c.changes[0].from, "x");
  EXPECT_EQ(c.changes[0].to, "x''");
  EXPECT_EQ(c.changes[0].span.column, 6U);
  EXPECT_EQ(c.changes[0].what, "the equation of x");
  EXPECT_EQ(c.what, "the equation of x");
  EXPECT_TRUE(c.changes[0].proved);
}

// The changes of one product do not add.
TEST(Repair, LostDotsInFactorsOfOneProduct) {
  Repaired p(kPolar);
  ASSERT_EQ(p.compare("m*(r^2*psi'' + 2*r*r'*psi') = 2*lambda*r^2*psi'").verdict, Verdict::proved);
  EXPECT_EQ(p.change("m*(r^2*psi'' + 2*r*r*psi) = 2*lambda*r^2*psi'"), "2*r*r*psi -> 2*r*r'*psi'");
  EXPECT_EQ(p.change("m*(r^2*psi + 2*r*r*psi) = 2*lambda*r^2*psi"),
            "psi -> psi'', 2*r*r*psi -> 2*r*r'*psi', psi -> psi'");
  Repaired r(kRocket);
  const std::string derived = "m*(m*x'')*(w + w') = m*(p' - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x))*(w + w')";
  ASSERT_EQ(r.compare(derived).verdict, Verdict::proved);
  EXPECT_EQ(r.readings("m*(m*x)*(w + w') = m*(p - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x))*(w + w)"), Texts{derived});
}

TEST(Repair, FactorsThatATermHasLost) {
  Repaired p(kPolar);
  ASSERT_EQ(p.compare("m*(r^2*psi'' + 2*r*r'*psi') = 2*lambda*r^2*psi'").verdict, Verdict::proved);
  EXPECT_EQ(p.change("m*(r^2*psi'' + 2*r*r') = 2*lambda*r^2*psi'"), "2*r*r' -> 2*psi'*r*r'");
  EXPECT_EQ(p.change("m*(r^2*psi'' + 2*r*psi') = 2*lambda*r^2*psi'"), "2*r*psi' -> 2*r'*r*psi'");
  Repaired r(kRocket);
  EXPECT_EQ(r.change("m*x'' = p' - k*x - m'*u + m*(2*w + w'*y + w^2*x)"), "2*w -> 2*y'*w");
}

TEST(Repair, ASymbolThatLostItsDotsEverywhere) {
  Repaired r(kRocket);
  const std::string wrong =
      "m*x'' = p*cos(x)^2 + p*sin(x)^2*cos(y)^2 + p*sin(x)^2*sin(y)^2*cos(w)^2 + p*sin(x)^2*sin(y)^2*sin(w)^2*sin(k)^2"
      " + p*sin(x)^2*sin(y)^2*sin(w)^2*cos(k)^2 - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)";
  const Comparison c = r.compare(wrong);
  ASSERT_EQ(c.changes.size(), 1U);
  ASSERT_EQ(c.changes[0].places.size(), 5U);
  for (const ChangedPlace& p : c.changes[0].places) EXPECT_EQ(p.from + " -> " + p.to, "p -> p'");
  // A dot is lost besides.
  const std::size_t at = wrong.find("m'");
  const Comparison two = r.compare(std::string(wrong).replace(at, 2, "m"));
  ASSERT_EQ(two.changes.size(), 1U);
  EXPECT_EQ(two.changes[0].places.size(), 6U);
}

TEST(Repair, LostDotsBesideAnotherMisprint) {
  Repaired r(kRocket);
  EXPECT_EQ(r.change("m*x'' = p - k*x - m*u - m*(2*w*y' + w'*y + w^2*x)"),
            "p -> p', m -> m', - m*(2*w*y' + w'*y + w^2*x) -> + m*(2*w*y' + w'*y + w^2*x)");
  EXPECT_EQ(r.change("m*x = p' - k*x - m*u + m*(w*y' + w'*y + w^2*x)"), "x -> x'', m -> m', w*y' -> 2*w*y'");
  EXPECT_EQ(r.change("m*x'' = p - k*y - m'*u + m*(2*w*y' + w'*y + w^2*x)"), "p -> p', y -> x");
  // An exponent stands at the neighbouring factor.
  Repaired p(kPolar);
  EXPECT_EQ(p.change("m*(r^2*psi'' + 2*r*r'*psi') = 2*lambda*r*psi'^2"), "2*lambda*r*psi'^2 -> 2*lambda*r^2*psi'");
  EXPECT_EQ(p.change("m*(r^2*psi'' + 2*r*r*psi') = 2*lambda*r*psi'^2"),
            "r -> r', 2*lambda*r*psi'^2 -> 2*lambda*r^2*psi'");
}

TEST(Repair, OneIndexOneSignOneDot) {
  Repaired t(kTwo);
  const std::string right = "m*x'' = -lambda.a*z + 0*lambda.b";
  ASSERT_EQ(t.compare(right).verdict, Verdict::proved);
  EXPECT_EQ(t.change("m*x'' = -lambda.b*z + 0*lambda.b"), "-lambda.b*z -> -lambda.a*z");
  EXPECT_EQ(t.change("m*x'' = lambda.a*z + 0*lambda.b"), "lambda.a*z -> -lambda.a*z");
  EXPECT_EQ(t.change("m*x' = -lambda.a*z"), "m*x' -> m*x''");
  EXPECT_EQ(t.change("m*y'' = -lambda.a*z"), "m*y'' -> m*x''");
  EXPECT_EQ(t.change("m*z'' = lambda.a"), "lambda.a -> lambda.b");
}

TEST(Repair, IndicesInDerivedWords) {
  Repaired r(kRocket);
  EXPECT_EQ(r.change("inertia_term.y = G.x"), "2");  // either
  EXPECT_EQ(r.change("inertia_term.x = Q.x + QR.x + Qomega.x + minus_dVomega.y + Gamma.x"),
            "minus_dVomega.y -> minus_dVomega.x");
  EXPECT_EQ(r.change("inertia_term.x = Q.x + QR.x + QR.x + minus_dVomega.x + Gamma.x"), "QR.x -> Qomega.x");
  EXPECT_EQ(r.change("Dt(partial(T_r, y')) = QR.x + Q.x + Qomega.x + minus_dVomega.x + Gamma.x"),
            "Dt(partial(T_r, y')) -> Dt(partial(T_r, x'))");
  EXPECT_EQ(r.readings("Dt(partial(T_r, y')) = G.x"),
            (Texts{"Dt(partial(T_r, x')) = G.x", "Dt(partial(T_r, y')) = G.y"}));
  EXPECT_EQ(r.change("Dt(partial(T_r, x)) = G.x"), "Dt(partial(T_r, x)) -> Dt(partial(T_r, x'))");
  EXPECT_EQ(r.change("Dt(partial(T_r, x')) + partial(V_O, x) = -G.x"), "-G.x -> G.x");
  Repaired p(kPolar);
  EXPECT_EQ(p.change("partial(reduced(T_r), psi') = 0*r"), "proved");  // T_r is m c^2/2 on the constraint
  EXPECT_EQ(p.change("inertia_term.psi = Q.psi + N.r"), "N.r -> N.psi");
  EXPECT_EQ(p.change("N.psi = 2*lambda*r^2*psi"), "2*lambda*r^2*psi -> 2*lambda*r^2*psi'");
}

// Equations that define a quantity are identities, no equations of motion.
TEST(Repair, Identities) {
  Repaired r(kRocket);
  const Comparison c = r.compare("QR.x = -m*u");
  EXPECT_EQ(c.verdict, Verdict::refuted);
  EXPECT_TRUE(c.identity);
  EXPECT_EQ(c.what, "an identity, no equation of motion");
  ASSERT_TRUE(c.difference);
  EXPECT_EQ(print(*c.difference, r.subject().names(), Format::text), "u*m - u*m'");
  ASSERT_EQ(c.changes.size(), 1U);
  EXPECT_EQ(c.changes[0].to, "-m'*u");
  EXPECT_TRUE(c.changes[0].identity);
  EXPECT_TRUE(c.changes[0].proved);
  EXPECT_EQ(r.change("dot(m'*(-u*ex), ex) = m'*u"), "m'*u -> -m'*u");
  EXPECT_EQ(r.readings("acc(P).x = x'"), (Texts{"acc(P).x = x''", "vel(P).x = x'"}));
  EXPECT_EQ(r.change("vel(P, inertial).x = x' + w*y"), "+ w*y -> - w*y");
  EXPECT_EQ(r.change("acc(P, inertial).x = x - 2*w*y - w*y - w^2*x"), "x -> x'', y -> y', w -> w'");
  EXPECT_EQ(r.change("partial(T_r, y') = m*x'"), "2");  // by x', or m*y'
  // Equations without such quantities are identities if no acceleration occurs.
  EXPECT_EQ(r.change("(x*y)' = x'*y + x*y"), "x*y -> x*y'");
  EXPECT_EQ(r.change("cos(2*x) = 1 - 2*sin(y)^2"), "2");
  // This identity cannot be repaired.
  const Comparison none = r.compare("QR.x = k*w*p*cos(x)");
  EXPECT_TRUE(none.identity);
  EXPECT_TRUE(none.changes.empty());
}

// No repair of an equation of motion makes it trivial.
TEST(Repair, NothingIsMadeTrivial) {
  Repaired t(kTwo);
  for (const char* wrong : {"m*x'' = m*y''", "x' = y'", "lambda.a = lambda.b", "x'' = z''", "m*x'' = m*z''*x"})
    for (const Change& c : t.compare(wrong).changes) EXPECT_FALSE(c.identity) << wrong << " -> " << c.equation;
  Repaired r(kRocket);
  EXPECT_EQ(r.change("m*x'' = m*y''"), "0");
  EXPECT_EQ(r.change("QR.x = QR.y"), "0");  // and not 0 = 0
}

// The derivatives by psi and by psi'' both vanish, the former by sin^2 + cos^2 = 1: no repair equates them.
TEST(Repair, SidesThatVanishAreNoIdentity) {
  Repaired r("coordinates = [\"r\", \"psi\"]\nparticle = [{name = \"p\", mass = 2, position = [\"r*cos(psi)\", "
             "\"r*sin(psi)\", \"0\"]}]\n");
  ASSERT_EQ(r.compare("partial(T_r, psi) = 0").verdict, Verdict::proved);
  for (const std::string& reading : r.readings("partial(T_r, psi') = partial(T_r, psi)"))
    EXPECT_EQ(reading.find("psi''"), std::string::npos) << reading;
}

TEST(Repair, NoFactorIsZero) {
  Repaired p(kPolar);
  for (const char* wrong : {"m/2*norm2(vel(bob.center)) = m/2*(r'^2 + r^2*psi^2)*k*psi", "r = k*psi", "T_r = k*psi*r",
                            "r' = psi*sin(k)", "lambda = k*psi"}) {
    const Comparison c = p.compare(wrong);
    ASSERT_EQ(c.verdict, Verdict::refuted) << wrong;
    EXPECT_EQ(c.what.find("times 0"), std::string::npos) << wrong << ": " << c.what;
  }
}

TEST(Repair, AVectorEquationByComponents) {
  Repaired r(kRocket);
  const std::vector<PublishedEquation> list = r.read("e: m*acc(P, inertial) = p*ex - k*P - m*u*ex\n");
  ASSERT_EQ(list.size(), 3U);
  const Comparison x = r.subject().compare(list[0]);
  ASSERT_EQ(x.changes.size(), 1U);
  EXPECT_EQ(x.changes[0].places.size(), 2U);
  EXPECT_EQ(x.changes[0].places[1].from, "m");
  EXPECT_EQ(x.changes[0].places[1].term, 2U);
  EXPECT_EQ(r.subject().compare(list[1]).verdict, Verdict::proved);
}

// ---- in numbers --------------------------------------------------------------------------------

// Numbers computed by a trial agree with the changed formula, for all changes of one place and of two.
TEST(Trial, AgreesWithTheChangedFormula) {
  Repaired r(kRocket);
  EquationsOfMotion motion(r.subject().mechanics(), 2, {});
  const Alphabet alphabet{{"x", "y"}, {"k", "u", "m", "w", "p"}, {}, {}, {}};
  std::size_t pairs = 0, adding = 0, multiplied = 0;
  for (const char* text : {"m*x'' = p' - k*x/m - (m + w)*(2*w*y' + sin(x*y)^2)",
                           "dot(m'*(P - u*ex), [x, w, 1]) = D(x^2*y', 1) - 2*Q.x*partial(T_r, x')",
                           "(cross(w*ez, P) + vel(P)*m).y = 3*(x*y')'"}) {
    Vocabulary& words = r.subject().words();
    const Syntax syntax = difference_of(r.read(std::string("e: ") + text + "\n").at(0));
    Trial trial(syntax, words, motion.on_motion());
    for (Edit& e : edits_of(syntax, words, alphabet, 2)) trial.add(std::move(e));
    const Expr whole = words.number(syntax);
    const auto expect = [&](const std::vector<std::uint32_t>& edits, const Numbers& change) {
      std::vector<const Edit*> list;
      for (std::uint32_t i : edits) list.push_back(&trial.edit(i));
      const Syntax changed = edited(syntax, 0, list);
      const Expr now = words.number(changed);
      for (std::size_t k = 0; k < kTrialPoints; ++k) {
        const double expected = motion.on_motion()[k](now) - motion.on_motion()[k](whole);
        if (!std::isfinite(expected)) continue;
        EXPECT_NEAR(change[k], expected, 1e-9 * (1 + std::abs(expected))) << print(changed);
      }
    };
    ASSERT_GT(trial.size(), 100U);
    for (std::uint32_t i = 0; i < trial.size(); ++i) expect({i}, trial.change_of(i));
    for (std::uint32_t i = 0; i < trial.size(); i += 3)
      for (std::uint32_t j = i + 1; j < trial.size(); j += 7) {
        if (!trial.possible(i, j)) continue;
        const Numbers both = trial.change({i, j});
        if (!std::isfinite(both[0])) continue;
        expect({i, j}, both);
        ++pairs;
        Numbers sum;
        for (std::size_t k = 0; k < kTrialPoints; ++k) sum[k] = trial.change_of(i)[k] + trial.change_of(j)[k];
        const bool adds = std::abs(both[0] - sum[0]) <= 1e-9 * (1 + std::abs(both[0]));
        if (trial.independent(i, j)) {
          ++adding;
          EXPECT_TRUE(adds) << print(edited(syntax, 0, {&trial.edit(i), &trial.edit(j)}));
        }
        multiplied += !adds;
      }
  }
  EXPECT_GT(pairs, 1000U);
  EXPECT_GT(adding, 300U);
  EXPECT_GT(multiplied, 300U);
}

// One term is wrong, missing or superfluous; the changed equation is true when it is read again.
TEST(Repair, WrongTerm) {
  Repaired r(kRocket);
  const std::pair<const char*, const char*> cases[] = {
      {"m*x'' = - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)", "right: lacks + p'"},
      {"m*x'' - p' = - m'*u + m*(2*w*y' + w'*y + w^2*x)", "left: lacks + k*x"},
      {"0 = p' - m*x'' - k*x + m*(2*w*y' + w'*y + w^2*x)", "left: 0 -> u*m'"},
      {"3*m*x''/7 = p' - k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)", "left: 3*m*x''/7 -> m*x''"},
      {"m*x'' = p' + 2/7*k*x - m'*u + m*(2*w*y' + w'*y + w^2*x)", "right: + 2/7*k*x -> - k*x"},
      {"5*m' - m*x'' = 2*u*m' - p' + k*x + m'*u - m*(2*w*y' + w'*y + w^2*x) - 2*u*m'", "left: 5*m' -> "},
      {"m*x'' = p' - k*x - 7*m' - m'*u + m*(2*w*y' + w'*y + w^2*x)", "right: - 7*m' -> "},
  };
  for (const auto& [equation, change] : cases) {
    const Comparison c = r.compare(equation);
    ASSERT_EQ(c.verdict, Verdict::refuted) << equation;
    EXPECT_TRUE(c.changes.empty()) << equation << ": " << c.changes[0].equation;
    ASSERT_TRUE(c.wrong_term) << equation;
    const Change& k = *c.wrong_term;
    EXPECT_EQ((k.side == 0 ? "left: " : "right: ") + (k.from.empty() ? "lacks " : k.from + " -> ") + k.to, change);
    EXPECT_EQ(r.compare(k.equation).verdict, Verdict::proved) << k.equation;
  }
  EXPECT_FALSE(r.compare("m*x'' = m*(2*w*y' + w'*y + w^2*x)").wrong_term);
}

// Factors that make any two sides equal are no correction, and an equation without common terms is not near.
TEST(Repair, NoFactorsForAnyTwoSides) {
  Repaired r(R"toml(coordinates = ["x", "y", "th"]
input = {u = {}}
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}, {name = "q", mass = 1, position = "th*ez"}]
force = [{on = "p", vector = "u*ex"}]
constraint = [{name = "hold", equation = "x = 1", by = "u"}]
)toml");
  for (const char* const wrong : {"y*th = 1", "1 = 2"}) {
    const Comparison c = r.compare(wrong);
    EXPECT_EQ(c.verdict, Verdict::refuted) << wrong;
    EXPECT_TRUE(c.changes.empty()) << wrong << ": " << c.changes[0].equation;
  }
  EXPECT_EQ(r.readings("y = th"), Texts{"y'' = th''"});
  EXPECT_EQ(r.readings("y = 0"), Texts{"y'' = 0"});
  EXPECT_EQ(r.compare("1 = 2").what, "");
  EXPECT_FALSE(r.compare("1 = 2").difference);
  EXPECT_FALSE(r.compare("1 = 2").wrong_term);
  Repaired pendulum(R"toml(coordinates = ["x", "th"]
parameters = {M = 2, m = 1, l = 0.5, g = 9.81}
gravity.field = "-g*ey"
particle = [{name = "a", mass = "M", position = "x*ex"}, {name = "b", mass = "m", position = "x*ex + l*rotz(th).x"}]
)toml");
  for (const char* const wrong : {"x = th", "x = 1", "x' = th'", "x*th = 1", "x = x^2"})
    EXPECT_TRUE(pendulum.compare(wrong).changes.empty()) << pendulum.compare(wrong).changes[0].equation;
}

}  // namespace
}  // namespace anholon::repair_test

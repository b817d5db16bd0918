// Keys of bodies, constraints and names beside formulas: along, unit quaternions, [notation], Greek letters.
#include <gtest/gtest.h>

#include "expr/normal.h"
#include "modelfile/names/notation.h"
#include "support/models.h"

namespace anholon::bodies_test {
namespace {

std::vector<std::string> names(const Model& m) { return m.names.multipliers; }

const std::string kSkate = R"toml(coordinates = ["x", "y", "z", "th"]
[frame]
T = "rotz(th)"
[[body]]
name = "skate"
mass = 1
inertia = [1, 1, 1]
center = "x*ex + y*ey"
orientation = "T"
[[constraint]]
name = "hold"
equation = "vel(skate.center) = z'*T.x"
)toml";

TEST(Along, TakesComponentsOfTheEquation) {
  const auto plain = test::model_of(kSkate);
  EXPECT_EQ(names(*plain), (std::vector<std::string>{"hold.x", "hold.y"}));
  const auto frame = test::model_of(kSkate + "along = \"T\"\n");
  EXPECT_EQ(names(*frame), (std::vector<std::string>{"hold.x", "hold.y"}));
  const auto body = test::model_of(kSkate + "along = \"skate\"\n");
  const auto list = test::model_of(kSkate + "along = [\"T.x\", \"2*T.y\"]\n");
  EXPECT_EQ(names(*list), (std::vector<std::string>{"hold.1", "hold.2"}));
  const Graph& g = *frame->graph;
  const auto along = [](const Model& m, int axis) {
    Graph& h = *m.graph;
    const Expr c = cos(h.jet(3, 0)), s = sin(h.jet(3, 0)), x = h.jet(0, 1), y = h.jet(1, 1);
    return axis == 0 ? c * x + s * y - h.jet(2, 1) : c * y - s * x;
  };
  for (int k = 0; k < 2; ++k) {
    const auto i = static_cast<std::size_t>(k);
    EXPECT_TRUE(proved_zero(frame->constraints[i].phi - along(*frame, k)));
    EXPECT_TRUE(proved_zero(body->constraints[i].phi - along(*body, k)));
    EXPECT_TRUE(proved_zero(list->constraints[i].phi - (k + 1) * along(*list, k)));
    EXPECT_FALSE(proved_zero(plain->constraints[i].phi - along(*plain, k))) << "mutant: along the observer's axes";
  }
  EXPECT_GT(g.size(), 0U);
  ASSERT_EQ(frame->notes.size(), 1U);
  EXPECT_EQ(frame->notes[0].text, "constraint 'hold': hold.z vanishes identically and is dropped");
}

std::string stone(const std::string& orientation, const std::string& more = "") {
  return "coordinates = [\"e0\", \"e1\", \"e2\", \"e3\", \"a\"]\n[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 2, "
         "2]\ncenter = [0, 0, \"a\"]\norientation = \"" +
         orientation + "\"\n" + more;
}

TEST(Quaternion, BringsItsUnitNormOnce) {
  const auto one =
      test::model_of(stone("quat(e0, e1, e2, e3)", "[frame]\nother = \"rotz(a)*quat(e0, -e1, -e2, -e3)\"\n"));
  ASSERT_EQ(names(*one), std::vector<std::string>{"norm.e0"});
  Graph& g = *one->graph;
  Expr norm = g.number(-1);
  for (std::uint32_t k = 0; k < 4; ++k) norm += pow(g.jet(k, 0), 2);
  EXPECT_TRUE(is_zero(one->constraints[0].phi - norm));
  EXPECT_EQ(one->constraints[0].order, 0);
  ASSERT_EQ(one->initial.guess.size(), 1U) << "nothing is given: it starts at the identity";
  EXPECT_EQ(one->initial.guess[0].symbol, g.jet(0, 0));
  EXPECT_EQ(test::model_of(stone("quat(e0, e1, e2, e3)", "[initial]\ne1 = 0.1\n"))->initial.guess.size(), 1U);
  EXPECT_TRUE(test::model_of(stone("quat(e0, e1, e2, e3)", "[initial]\ne1 = 1\n"))->initial.guess.empty())
      << "half a turn";
  EXPECT_TRUE(test::model_of(stone("quat(e0, e1, e2, e3)", "[initial]\ne0 = 0\ne2 = 0.3\n"))->initial.guess.empty());
}

TEST(Quaternion, OfNormOneAddsNothing) {
  EXPECT_TRUE(names(*test::model_of(stone("quat(cos(a/2), 0, 0, sin(a/2))"))).empty());
  EXPECT_TRUE(names(*test::model_of(stone("quat(3/5, 0, 4/5, 0)"))).empty());
  EXPECT_EQ(
      names(*test::model_of(stone("quat(e0, e1, e2, e3)",
                                  "[[constraint]]\nname = \"unit\"\nequation = \"e0^2 + e1^2 + e2^2 + e3^2 = 1\"\n"))),
      std::vector<std::string>{"unit"});
}

TEST(Notation, IsReadAsMathML) {
  const auto mathml = [](const char* text) { return mathml_of(FormulaText(text, Span{1, 1, 1})); };
  EXPECT_EQ(mathml("\\vartheta"), "<mi>ϑ</mi>");
  EXPECT_EQ(mathml("x_{12}"), "<msub><mi>x</mi><mn>12</mn></msub>");
  EXPECT_EQ(mathml("\\bar{q}_1^2"),
            "<msubsup><mover accent=\"true\"><mi>q</mi><mo>¯</mo></mover><mn>1</mn><mn>2</mn></msubsup>");
  EXPECT_EQ(mathml("v_\\mathrm{in}"), "<msub><mi>v</mi><mi mathvariant=\"normal\">in</mi></msub>");
  for (const char* wrong : {"", "\\foo", "x_", "{x", "x}", "x_1_2", "<b>", "\\mathrm{<}"})
    EXPECT_THROW(mathml(wrong), Failure) << wrong;
}

TEST(Notation, IsHowANameIsPrinted) {
  const auto model = test::model_of("coordinates = [\"theta\"]\n[[particle]]\nname = \"p\"\nmass = \"m0\"\nposition = "
                                    "\"l1*sin(theta)*ex\"\n[parameters]\nm0 = 1\nl1 = 2\n"
                                    "[notation]\n\"θ\" = '\\vartheta'\nm0 = \"M\"\n");
  Graph& g = *model->graph;
  const Expr e = g.parameter(0) * g.jet(0, 1);
  EXPECT_EQ(print(e, model->names, Format::text), "m0*theta'");
  EXPECT_EQ(print(e, model->names, Format::latex), "M \\, \\dot{\\vartheta}");
  EXPECT_NE(print(e, model->names, Format::mathml).find("<mi>ϑ</mi>"), std::string::npos);
}

TEST(GreekLetters, AreTheirNamesEverywhere) {
  const std::string greek =
      "coordinates = [\"θ\"]\n[[particle]]\nname = \"ψ\"\nmass = \"μ\"\nposition = "
      "\"Λ*sin(θ)*ex\"\n[parameters]\n\"μ\" = 1\n\"Λ\" = 2\n"
      "\"Ω\" = 3\n[define]\n\"Ω2\" = \"2*Omega\"\n[potential]\nV = \"Ω2*theta\"\n[initial]\n\"θ'\" = \"Ω\"\n";
  std::string latin = greek;
  for (const auto& [letter, name] :
       {std::pair{"θ", "theta"}, {"ψ", "psi"}, {"μ", "mu"}, {"Λ", "Lambda"}, {"Ω", "Omega"}})
    for (std::size_t at; (at = latin.find(letter)) != std::string::npos;)
      latin.replace(at, std::string(letter).size(), name);
  const Overrides set = {{"mu", "5"}};
  const auto a = test::model_of(greek, set), b = test::model_of(latin, set);
  EXPECT_EQ(a->names.coordinates, b->names.coordinates);
  EXPECT_EQ(a->names.parameters, (std::vector<std::string>{"mu", "Lambda", "Omega"}));
  EXPECT_EQ(number_value(a->parameters[0].value), 5);
  EXPECT_EQ(a->bodies[0].name, "psi");
  EXPECT_EQ(print(a->potentials[0].value, a->names, Format::text),
            print(b->potentials[0].value, b->names, Format::text));
  EXPECT_EQ(a->initial.given[0].symbol, a->graph->jet(0, 1));
}

}  // namespace
}  // namespace anholon::bodies_test

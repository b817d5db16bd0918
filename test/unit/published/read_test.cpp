#include "support/published.h"

namespace anholon::read_test {
namespace {

const char* const kModel = R"toml(coordinates = ["x", "y", "theta"]
parameters = {M = 3, flow = 0.1}
functions.m = "2 - flow*t"
define.v = "x'*cos(theta) + y'*sin(theta)"
[[particle]]
name = "cart"
mass = "M"
position = ["x", "y", "0"]
[[particle]]
name = "rocket"
mass = "m"
position = ["x + cos(theta)", "y + sin(theta)", "0"]
)toml";
const char* const kBlade = "[[constraint]]\nname = \"blade\"\nequation = \"y'*cos(theta) = x'*sin(theta)\"\n";
const char* const kSpeed = "[[constraint]]\nname = \"speed\"\nequation = \"x'^2 + y'^2 = 1\"\n";

std::vector<PublishedEquation> read(const std::string& text, const OpenModel& model) {
  Diagnostics diagnostics;
  const SourceText source{"paper.eq", text};
  Subject subject(model);
  std::vector<PublishedEquation> list = subject.read(source, diagnostics);
  EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.print(source);
  return list;
}

std::string errors(const std::string& text, const OpenModel& model) {
  Diagnostics diagnostics;
  const SourceText source{"paper.eq", text};
  Subject(model).read(source, diagnostics);
  return diagnostics.print(source);
}

TEST(Equations, LabelsCommentsAndContinuedLines) {
  const OpenModel model = test::open_text(std::string(kModel) + kBlade);
  const auto list = read(
      "# a paper\n\n4.7: M*x'' = # the first\n    -lambda*sin(theta)\n# between\n\t+ m'*v\n4.8.y : y = x\r\n", model);
  ASSERT_EQ(list.size(), 2U);
  EXPECT_EQ(list[0].label, "4.7");
  EXPECT_EQ(list[0].text(), "M*x'' = -lambda*sin(theta) + m'*v");
  EXPECT_EQ(list[1].label, "4.8.y");
  // lambda in the fourth line
  const Span place = list[0].source.span(list[0].right.args[0].offset, 1);
  EXPECT_EQ(place.line, 4U);
  EXPECT_EQ(place.column, 5U);
}

TEST(Equations, NamesOfTheDerivedEquations) {
  const OpenModel one = test::open_text(std::string(kModel) + kBlade),
                  two = test::open_text(std::string(kModel) + kBlade + kSpeed);
  Graph& g = *two.model->graph;
  const auto list = read("a: lambda.blade = 2*lambda.speed'\nb: m_rocket = m\n", two);
  EXPECT_EQ(evaluate_number(list[0].left, *two.names), g.multiplier(0, 0));
  EXPECT_EQ(evaluate_number(list[0].right, *two.names), 2 * g.multiplier(1, 1));
  EXPECT_EQ(evaluate_number(list[1].left, *two.names), evaluate_number(list[1].right, *two.names));
  EXPECT_EQ(evaluate_number(read("a: lambda = 0\n", one)[0].left, *one.names), one.model->graph->multiplier(0, 0));
  EXPECT_NE(errors("a: lambda = 0\n", two).find("paper.eq:1:4: error: there are 2 multipliers"), std::string::npos);
  EXPECT_NE(errors("a: lambda.blad = 0\n", two)
                .find("paper.eq:1:4: error: there is no constraint 'blad'; did you mean 'blade'?"),
            std::string::npos);
  EXPECT_NE(errors("a: lambda = 0\n", test::open_text(kModel)).find("no constraints"), std::string::npos);
}

TEST(Equations, EveryErrorWithItsPlace) {
  const OpenModel model = test::open_text(std::string(kModel) + kBlade);
  const std::string text = errors(
      "  x = 1\na: M*x'' = thetta\nb: x''\na: x = y\nx = y\nc: x'' = (y\n    + 1\nd: vel(x) = 0\n: x = y\n", model);
  for (const char* expected :
       {"paper.eq:1:3: error: an indented line", "paper.eq:2:12: error: unknown name 'thetta'; did you mean 'theta'?",
        "paper.eq:3:1: error: the equation 'b' has no '='",
        "paper.eq:4:1: error: the label 'a' is already used in line 2",
        "paper.eq:5:1: error: an equation starts with a label", "error: ')' is missing",
        "paper.eq:8:8: error:", "paper.eq:9:1: error: the label is empty"})
    EXPECT_NE(text.find(expected), std::string::npos) << expected << "\n" << text;
  EXPECT_NE(errors("# nothing\n", model).find("there is no equation"), std::string::npos);
}

}  // namespace
}  // namespace anholon::read_test

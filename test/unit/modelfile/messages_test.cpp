// The messages of the reader of model files and their places; all errors are reported at once.
#include <gtest/gtest.h>

#include "support/models.h"

namespace anholon::messages_test {
namespace {

const std::string kGood = R"toml(coordinates = ["x", "theta"]
[parameters]
m = 2
g = 9.81
[[particle]]
name = "bob"
mass = "m"
position = ["x", "sin(theta)", "0"]
[gravity]
field = "-g*ey"
[[constraint]]
name = "slide"
equation = "x' = 0"
[initial]
x = 1
)toml";

std::vector<Diagnostic> diagnostics_of(const std::string& text, const Overrides& overrides = {}) {
  Diagnostics d;
  read_model(SourceText{"test.toml", text}, d, overrides);
  return d.list();
}

struct Mistake {
  const char* from;
  const char* to;
  unsigned line, column;
  const char* message;
};

TEST(Messages, TypicalMistakesHaveTheirPlaceAndTheirWords) {
  ASSERT_TRUE(diagnostics_of(kGood).empty());
  const Mistake mistakes[] = {
      {"sin(theta)", "sin(theata)", 8, 23, "unknown name 'theata'; did you mean 'theta'?"},
      {"mass = \"m\"", "mas = \"m\"", 7, 1, "unknown key 'mas' in particle 'bob'; did you mean 'mass'?"},
      {"m = 2", "m = -2", 7, 8, "the mass is -2: a mass is not negative"},
      {"x' = 0", "x'", 13, 13, "an equation needs '='"},
      {"x' = 0", "x' = x'", 13, 13, "this equation always holds: it constrains nothing"},
      {"x' = 0", "m = 2", 13, 13, "no coordinate or derivative occurs in this equation"},
      {"x = 1", "y = 1", 15, 1, "there is no coordinate 'y'"},
      {"x = 1", "x = \"theta\"", 15, 5, "an initial value is a number or a formula of parameters"},
      {"\"x\", \"theta\"", "\"x\", \"x\"", 1, 22, "'x' is already declared in line 1"},
      {"[\"x\", \"theta\"]", "[]", 1, 15, "the list of coordinates is empty"},
      {"position = [\"x\", \"sin(theta)\", \"0\"]", "position = [\"x\", \"y'\"]", 8, 12,
       "a vector has three components, 2 are given"},
      {"[\"x\", \"sin(theta)\", \"0\"]", "[\"x'\", \"0\", \"0\"]", 8, 12,
       "the position of particle 'bob' depends on a velocity (x')"},
      {"g = 9.81", "g = \"2*h\"\nh = \"g\"", 5, 6, "'g' is defined through itself: g -> h -> g"},
      {"m = 2", "m = \"2*t\"", 3, 1, "the parameter 'm' is not constant"},
      {"name = \"bob\"", "name = \"t\"", 6, 9, "the name 't' is reserved"},
      {"-g*ey", "-g*", 10, 13, "the formula ends where a number, a name or '(' should follow"},
      {"-g*ey", "-g", 10, 10, "a vector is expected, this is a number"},
  };
  for (const Mistake& m : mistakes) {
    const std::vector<Diagnostic> list = diagnostics_of(test::replaced(kGood, m.from, m.to));
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const Diagnostic& d) { return d.message == m.message; });
    if (found == list.end()) {
      ADD_FAILURE() << "expected: " << m.message << "\nfound: " << (list.empty() ? "nothing" : list[0].message);
      continue;
    }
    EXPECT_EQ(found->span.line, m.line) << m.message;
    EXPECT_EQ(found->span.column, m.column) << m.message;
  }
}

TEST(Messages, AllErrorsAreReportedAtOnceInOrder) {
  std::string text = test::replaced(kGood, "sin(theta)", "sin(tetha)");
  text = test::replaced(text, "x' = 0", "x' = z");
  text = test::replaced(text, "x = 1", "w = 1");
  const SourceText source{"test.toml", text};
  Diagnostics d;
  EXPECT_FALSE(read_model(source, d));
  EXPECT_EQ(d.list().size(), 3U);
  const std::string printed = d.print(source);
  const std::size_t a = printed.find("test.toml:8:"), b = printed.find("test.toml:13:"),
                    c = printed.find("test.toml:15:");
  ASSERT_NE(c, std::string::npos);
  EXPECT_TRUE(a < b && b < c);
  EXPECT_NE(printed.find("^~~~~"), std::string::npos) << "the place is underlined";
}

TEST(Messages, ABrokenDefinitionIsReportedOnceNotAtEveryUse) {
  const std::string text = "coordinates = [\"x\"]\n[define]\nh = \"q + 1\"\n[[particle]]\nname = \"p\"\nmass = "
                           "1\nposition = [\"h\", \"h\", \"h\"]\n";
  const std::vector<Diagnostic> list = diagnostics_of(text);
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].message, "unknown name 'q'");
}

TEST(Messages, ASyntaxErrorOfTomlHasItsPlace) {
  const std::vector<Diagnostic> list = diagnostics_of("coordinates = [\"x\"]\nmass = = 2\n");
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].span.line, 2U);
}

// An element of [view] that draws nothing is reported.
TEST(View, IsReadAndItsElementsMustShowSomething) {
  const auto model = test::model_of(kGood + "[view]\npath = {trace = \"0*ex\"}\n");
  ASSERT_EQ(model->view.elements.size(), 1U);
  EXPECT_EQ(model->view.elements[0].kind, View::Kind::trace);
  const std::vector<Diagnostic> nothing = diagnostics_of(kGood + "[view]\nanything = {at = \"0*ex\"}\n");
  ASSERT_EQ(nothing.size(), 1U);
  EXPECT_EQ(nothing[0].message, "'anything' in [view] shows nothing");
  const std::vector<Diagnostic> list = diagnostics_of(kGood + "[[view]]\n");
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].message, "'view' is a section");
}

TEST(Overrides, ReplaceParametersExactlyAndKnowTheirNames) {
  const auto model = test::model_of(kGood, {{"m", "1/3"}});
  EXPECT_EQ(number_value(model->parameters[0].value), Rational(1, 3));
  const std::vector<Diagnostic> list = diagnostics_of(kGood, {{"mm", "1"}});
  ASSERT_EQ(list.size(), 1U);
  EXPECT_EQ(list[0].message, "--set: there is no parameter 'mm'; did you mean 'm'?");
  EXPECT_FALSE(diagnostics_of(kGood, {{"m", "1 +"}}).empty());
}

// ---- the reader never takes a user's mistake for a fault of its own
// ------------------------------------------------------

int read_and_leave(const std::string& text) {
  const std::vector<Diagnostic> list = diagnostics_of(text);
  std::_Exit(list.empty() ? 0 : 10);
}

TEST(Robust, DivisionByAParameterThatIsZeroIsTheUsersError) {
  EXPECT_EXIT(read_and_leave(test::replaced(kGood, "m = 2", "z = 0\nm = \"1/z\"")), testing::ExitedWithCode(10), "");
}

TEST(Robust, AnInertiaOverAParameterThatIsZeroIsTheUsersError) {
  EXPECT_EXIT(read_and_leave(test::replaced(kGood, "mass = \"m\"", "mass = \"1/(m - 2)\"")),
              testing::ExitedWithCode(10), "");
}

// (x''^2 + x'')/x'' - x'' is 1: the constraint has order 1, and the search for it must not divide by zero.
TEST(Robust, AHighestDerivativeThatCancelsUnderAFraction) {
  const std::string text = test::replaced(kGood, "x' = 0", "(x''^2 + x'')/x'' - x'' + x' = 1");
  EXPECT_EXIT(read_and_leave(text), testing::ExitedWithCode(0), "");
}

TEST(Robust, AFunctionAtAnArgumentThatDividesByZeroIsTheUsersError) {
  const std::string text =
      test::replaced(kGood, "[[particle]]", "[functions]\nf = \"1/t\"\n[define]\nd = \"f(0)\"\n[[particle]]");
  EXPECT_EXIT(read_and_leave(text), testing::ExitedWithCode(10), "");
}

TEST(Robust, AFractionalPowerOfANegativeNumberIsTheUsersErrorOrNotANumber) {
  for (const char* mass : {"(-2)^(1/2)", "(0)^(-1/2)", "0^0", "log(-1)", "1/0"})
    EXPECT_EXIT(
        read_and_leave(test::replaced(kGood, "mass = \"m\"", std::string("mass = \"") + mass + "\"")),
        [](int status) { return WIFEXITED(status) && WEXITSTATUS(status) != 3; }, "")
        << mass;
}

}  // namespace
}  // namespace anholon::messages_test

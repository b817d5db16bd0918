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

std::vector<std::string> messages_of(const std::string& text, const Overrides& overrides = {}) {
  std::vector<std::string> list;
  for (const Diagnostic& d : diagnostics_of(text, overrides)) list.push_back(d.message);
  return list;
}

// The names of formulas are looked at apart from their evaluation if a file has an error. A file without other mistakes
// gets no further error: all its names are known.
TEST(Messages, AnErrorInAGoodFileIsTheOnlyOne) {
  for (const std::string& name : test::shipped_models()) {
    Diagnostics d;
    const std::string path = (test::source_dir() / "models" / (name + ".toml")).string();
    read_model(SourceText{path, "no_such_key = 1\n" + test::file_text(path)}, d);
    std::vector<std::string> errors;
    for (const Diagnostic& one : d.list())
      if (one.severity == Severity::error) errors.push_back(one.message);
    ASSERT_EQ(errors.size(), 1U) << name << ": " << errors.back();
    EXPECT_EQ(errors[0], "unknown key 'no_such_key' in the model file") << name;
  }
}

TEST(Messages, AllUnknownNamesOfAFormulaAreReported) {
  EXPECT_EQ(messages_of(test::replaced(kGood, "sin(theta)", "sin(th1)*cos(th2) + th1 + foo(th3)")),
            (std::vector<std::string>{"unknown name 'th1'", "unknown name 'th2'", "unknown function 'foo'",
                                      "unknown name 'th3'"}));
  // Each element, also behind the mistake at which its reader stops.
  EXPECT_EQ(messages_of(test::replaced(kGood, "mass = \"m\"", "mass = \"m1\"\nexpelled_velocity = \"w1*ex\"")),
            (std::vector<std::string>{"unknown name 'm1'; did you mean 'm'?", "unknown name 'w1'"}));
  // The arguments of a function are names in it; a name whose declaration has an error is no unknown name.
  EXPECT_EQ(messages_of(test::replaced(kGood, "g = 9.81",
                                       "g = 9.81\nk = {unit = \"m\"}\n[define]\nd = \"k*f(x)\"\n"
                                       "[functions]\n\"f(h)\" = \"h + h0\"")),
            (std::vector<std::string>{"the parameter 'k' has no value", "unknown name 'h0'"}));
  // A value that is replaced is not looked at.
  EXPECT_EQ(messages_of(test::replaced(kGood, "m = 2", "m = \"m1\"\nno = \"lost\""), {{"m", "3"}}),
            (std::vector<std::string>{"unknown name 'lost'"}));
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

// Tables of claims: the spellings of a tag, mistakes in a table, and the decision of a claim.
#include <gtest/gtest.h>

#include "published/decide.h"
#include "support/published.h"

namespace anholon::claims_test {
namespace {

const char* const kTable = R"toml(key = "L"
title = "t"
english = "Routh's equations"
authors = ["A", "B"]
reference = "L"
[[claim]]
tag = "2.6"
title = "generalized reactions"
kind = "definition"
formula = "N = sum lambda dphi/dq"
  [[claim.check]]
  model = "m"
  equation = "N.x = lambda*partial(phi, x')"
  is = "true"
  mutant = "N.x = lambda*partial(phi, y')"
  [[claim.check]]
  model = "m"
  forms = ["maggi", "kane"]
  is = "true"
[[claim]]
tag = "3.18'"
title = "Appell, with multipliers"
kind = "equation of motion"
formula = "dS/dq'' = Q + N"
difference = "dots are lost"
class = "reading"
  [[claim.check]]
  model = "m"
  says = "as read"
  equation = "partial(S_r, x') = N.x"
  is = "false"
[[claim]]
tag = "Gamma"
unnumbered = true
title = "Coriolis force"
kind = "definition"
formula = "Gamma"
  [[claim.check]]
  model = "m"
  equation = "Gamma.x = 0"
  is = "true"
  mutant = "Gamma.x = x'"
)toml";
// The acceleration is 1 or -1; the equations leave the sign open.
const char* const kTwoWays = R"toml(coordinates = ["x", "y"]
particle = [{name = "p", mass = 1, position = "x*ex + y*ey"}]
[[constraint]]
name = "c"
equation = "x''^2 = 1"
)toml";

Paper table(const std::string& text = kTable) {
  Diagnostics diagnostics;
  const SourceText source{"paper.toml", text};
  std::optional<Paper> paper = read_paper(source, diagnostics);
  EXPECT_TRUE(paper) << diagnostics.print(source);
  return *paper;
}

std::string error(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  Diagnostics diagnostics;
  read_paper({"paper.toml", text}, diagnostics);
  return diagnostics.has_errors() ? diagnostics.list().front().message : "";
}

OpenModel load(const std::string& name) {
  if (name != "m" && name != "two ways") throw Failure({}, "there is no model '" + name + "'");
  return test::open_text(name == "m" ? test::kSleigh : kTwoWays);
}

TEST(Claims, ATagInAnySpelling) {
  Paper other = table();
  other.key = "Q";
  other.claims[0].tag = "13";
  const std::vector<Paper> papers = {table(), other};
  for (const char* spelling : {"L2.6", "l2.6", "L 2.6", "[L 2.6]", "L(2.6)", "Luo-Zhao 2.6", "Luo & Zhao (2.6)",
                               "luo_zhao-2.6", "2.6", "(2.6)"}) {
    const auto found = find_claims(papers, spelling);
    ASSERT_EQ(found.size(), 1U) << spelling;
    EXPECT_EQ(found[0].claim->tag, "2.6") << spelling;
  }
  for (const char* spelling : {"L3.18'", "L3.18’", "l 3.18′", "Luo 3.18'"}) {
    const auto found = find_claims(papers, spelling);
    ASSERT_EQ(found.size(), 1U) << spelling;
    EXPECT_EQ(found[0].claim->tag, "3.18'") << spelling;
  }
  EXPECT_EQ(find_claims(papers, "Q13").size(), 1U);
  EXPECT_EQ(find_claims(papers, "Qiu (13)").size(), 1U);
  EXPECT_EQ(find_claims(papers, "3.18'").size(), 2U);  // of both papers
  EXPECT_EQ(find_claims(papers, "gamma").size(), 2U);
  EXPECT_EQ(find_claims(papers, "generalized reactions").size(), 2U);  // by the title
  EXPECT_TRUE(find_claims(papers, "L9.9").empty());
  EXPECT_TRUE(find_claims(papers, "").empty());
  EXPECT_EQ(nearest_tag(papers, "L2.7"), "L2.6");
}

TEST(Claims, ErrorsOfATable) {
  EXPECT_EQ(error(kTable, "kind = \"definition\"", "kind = \"guess\""), "unknown kind 'guess'");
  EXPECT_EQ(error(kTable, "formula =", "formla ="), "unknown key 'formla'; did you mean 'formula'?");
  EXPECT_EQ(error(kTable, "class = \"reading\"", "class = \"typo\""), "unknown class 'typo'");
  EXPECT_EQ(error(kTable, "class = \"reading\"\n", ""), "'difference' and 'class' stand together");
  EXPECT_EQ(error(kTable, "is = \"true\"", "is = \"yes\""), "'is' is \"true\" or \"false\"");
  EXPECT_EQ(error(kTable, "  mutant = \"N.x = lambda*partial(phi, y')\"\n", ""),
            "'mutant' is missing: a change of the equation that must be false");
  EXPECT_EQ(error(kTable, "tag = \"3.18'\"", "tag = \"2.6\""), "the tag '2.6' is used twice");
}

TEST(Claims, AreDecided) {
  const Paper paper = table();
  Decider decider(load);
  for (const Claim& c : paper.claims)
    for (const ClaimCheck& k : c.checks) {
      const Decision d = decider.decide(k);
      EXPECT_TRUE(d.as_expected()) << c.tag << ": " << d.detail;
    }
  EXPECT_TRUE(paper.claims[1].holds());  // the reading is false
}

// A wrong table, or a mutant that is as true as the claim, is noticed.
TEST(Claims, MutantsMustFail) {
  Decider decider(load);
  ClaimCheck k = table().claims[0].checks[0];
  k.mutant = "2*N.x = 2*lambda*partial(phi, x')";
  EXPECT_FALSE(decider.decide(k).as_expected());
  k = table().claims[0].checks[0];
  k.expected = false;
  EXPECT_FALSE(decider.decide(k).as_expected());
  k.equation = k.mutant;
  k.mutant.clear();
  EXPECT_TRUE(decider.decide(k).as_expected());
  k.equation = "N.q = 0";
  EXPECT_EQ(decider.decide(k).verdict, Verdict::unknown);
  k.model = "none";
  EXPECT_FALSE(decider.decide(k).as_expected());
}

TEST(Claims, AMotionThatIsNotUnique) {
  Decider decider(load);
  ClaimCheck k;
  k.kind = ClaimCheck::Kind::points;
  k.model = "two ways";
  k.points = {{{"x", "0"}, {"y", "0"}, {"x'", "0"}, {"y'", "0"}, {"x''", "1"}, {"y''", "0"}, {"lambda", "1/2"}},
              {{"x", "0"}, {"y", "0"}, {"x'", "0"}, {"y'", "0"}, {"x''", "-1"}, {"y''", "0"}, {"lambda", "1/2"}}};
  EXPECT_TRUE(decider.decide(k).as_expected()) << decider.decide(k).detail;
  k.points[1].back().second = "1";  // no solution of Routh's equations
  EXPECT_FALSE(decider.decide(k).as_expected());
  k.points[1] = k.points[0];  // the same state twice
  EXPECT_FALSE(decider.decide(k).as_expected());
  k.points[1][2].second = "1";  // another state
  EXPECT_EQ(decider.decide(k).verdict, Verdict::unknown);
}

}  // namespace
}  // namespace anholon::claims_test

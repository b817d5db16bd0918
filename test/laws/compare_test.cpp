// Published equations: the gallery of papers, derived equations as they are printed, multiples and combinations of them, and
// misprints of each kind, which must be named.
#include <gtest/gtest.h>

#include "expr/arrange.h"
#include "formulation/formulation.h"
#include "published/subject.h"
#include "support/models.h"

namespace anholon::test {
namespace {

// A shipped model, ready to be compared with.
struct Shipped {
  std::optional<Subject> subject;

  explicit Shipped(const std::string& name) {
    Diagnostics diagnostics;
    const SourceText source{name + ".toml", shipped_text(name)};
    subject.emplace(open_model(source, diagnostics).value());
  }

  std::vector<PublishedEquation> read(const std::string& text) {
    Diagnostics diagnostics;
    const SourceText source{"test.eq", text};
    std::vector<PublishedEquation> list = subject->read(source, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.print(source);
    return list;
  }
  Comparison judged(const PublishedEquation& e) { return subject->judge(e); }
  Comparison compared(const PublishedEquation& e) { return subject->compare(e); }

  // Routh's equations as `derive` prints them.
  std::vector<std::string> derived() {
    const Mechanics& m = subject->mechanics();
    const Column left = put_masses(subject->model(), lagrange_operator(m)), right = put_masses(subject->model(), right_side(m));
    const SymbolNames& names = subject->names();
    std::vector<std::string> list;
    for (std::size_t a = 0; a < left.size(); ++a)
      list.push_back(print(arranged(left[a], names), names, Format::text) + " = " + print(arranged(right[a], names), names, Format::text));
    return list;
  }
};

// What a misprint does to a text.
struct Misprint {
  const char* kind;
  const char *right, *wrong;
};
constexpr Misprint kMisprints[] = {
    {"sign", " + ", " - "}, {"sign", " - ", " + "},    {"prime", "''", "'"},   {"prime", "'*", "''*"}, {"exponent", "^2", "^3"},
    {"exponent", "^2", ""}, {"function", "sin(", "cos("}, {"function", "cos(", "sin("}, {"coefficient", "2*", ""}, {"coefficient", "/2", ""},
};

// The first place where it can happen: not inside a name, a number or an exponent.
std::size_t place_of(const Misprint& m, const std::string& text) {
  for (std::size_t at = text.find(m.right); at != std::string::npos; at = text.find(m.right, at + 1)) {
    const std::size_t end = at + std::string(m.right).size();
    const bool number = m.right[0] == '2' || m.right[0] == '/';
    if (!number || ((at == 0 || std::string(" (-").find(text[at - 1]) != std::string::npos || m.right[0] == '/') &&
                    (end == text.size() || !std::isdigit(static_cast<unsigned char>(text[end])))))
      return at;
  }
  return std::string::npos;
}

class Gallery : public testing::TestWithParam<const char*> {};

TEST_P(Gallery, CorrectedEquationsAreTrue) {
  const std::string name = GetParam();
  Shipped s("papers/" + name);
  for (const PublishedEquation& e : s.read(file_text(source_dir() / "models" / "papers" / (name + ".corrected.eq"))))
    EXPECT_EQ(s.judged(e).verdict, Verdict::proved) << e.label << ": " << s.judged(e).detail;
}

INSTANTIATE_TEST_SUITE_P(Papers, Gallery, testing::Values("luo-zhao-example-1", "luo-zhao-example-2"), [](const auto& p) { return test_name(p.param); });

TEST(GalleryMisprints, AreNamed) {
  Shipped one("papers/luo-zhao-example-1");
  std::map<std::string, std::string> right;
  for (const PublishedEquation& e : one.read(file_text(source_dir() / "models/papers/luo-zhao-example-1.as-printed.eq"))) {
    const Comparison c = one.compared(e);
    right[e.label] = c.verdict == Verdict::proved ? "true" : c.changes.size() == 1 ? c.changes[0].from + " -> " + c.changes[0].to : "?";
  }
  EXPECT_EQ(right["4.1"], "r^2*c^2*phi'^2 -> r^2*cos(psi)^2*phi'^2");
  EXPECT_EQ(right["4.3.r"], "true");
  EXPECT_EQ(right["4.3.psi"], "2*r*psi'^2*lambda -> 2*r^2*psi'*lambda");
  EXPECT_EQ(right["4.3.phi"], "true");
}

class Derived : public testing::TestWithParam<std::string> {};

TEST_P(Derived, TrueAsPrintedScaledAndCombined) {
  Shipped s(GetParam());
  const std::vector<std::string> derived = s.derived();
  std::string text;
  for (std::size_t a = 0; a < derived.size(); ++a) {
    const std::string label = "e" + std::to_string(a), side = derived[a].substr(0, derived[a].find(" = ")), other = derived[a].substr(derived[a].find(" = ") + 3);
    text += label + ": " + derived[a] + "\n";
    text += label + ".scaled: -3*(" + side + ")/(2 + sin(t)) = -3*(" + other + ")/(2 + sin(t))\n";
    if (a > 0) {
      const std::string before = derived[a - 1].substr(0, derived[a - 1].find(" = ")), before_other = derived[a - 1].substr(derived[a - 1].find(" = ") + 3);
      text += label + ".combined: sin(t)*(" + side + ") - (" + before + ") = sin(t)*(" + other + ") - (" + before_other + ")\n";
    }
  }
  for (const PublishedEquation& e : s.read(text)) {
    const Comparison c = s.judged(e);
    EXPECT_EQ(c.verdict, Verdict::proved) << e.label << ": " << e.text().substr(0, 300) << "\n" << c.detail;
  }
}

TEST_P(Derived, MisprintsAreNamed) {
  Shipped s(GetParam());
  std::size_t tried = 0, exactly = 0;
  for (const std::string& right : s.derived()) {
    if (right.size() > 400) continue;
    const std::string original = s.read("e: " + right)[0].text();
    for (const Misprint& m : kMisprints) {
      const std::size_t at = place_of(m, original);
      if (at == std::string::npos) continue;
      std::string wrong = original;
      wrong.replace(at, std::string(m.right).size(), m.wrong);
      const PublishedEquation e = s.read("e: " + wrong)[0];
      const Comparison c = s.compared(e);
      if (c.verdict == Verdict::proved) continue;  // sin^2 for cos^2 where both are possible, …
      EXPECT_EQ(c.verdict, Verdict::refuted) << wrong << "\n" << c.detail;
      ASSERT_FALSE(c.changes.empty()) << m.kind << "\n" << wrong << "\n" << original;
      const std::string printed = e.text();
      bool named = false;
      for (const Change& change : c.changes) {
        EXPECT_TRUE(change.proved) << change.from << " -> " << change.to << "\n" << wrong;
        EXPECT_GE(change.span.column, 4U);
        EXPECT_LT(change.span.column, wrong.size() + 4);
        EXPECT_NE(printed.find(change.from), std::string::npos) << change.from;
        named = named || original.find(change.to) != std::string::npos;
      }
      ++tried;
      exactly += named;
    }
  }
  // Others name a change with the same meaning: an equation has two sides.
  EXPECT_GE(10 * exactly, 7 * tried);
}

INSTANTIATE_TEST_SUITE_P(Models, Derived,
                         testing::Values("papers/luo-zhao-example-1", "papers/luo-zhao-example-2", "zoo/appell-hamel", "zoo/chaplygin-sleigh",
                                         "zoo/double-pendulum-cartesian", "zoo/vertical-disc", "zoo/variable-mass-pendulum", "zoo/second-order-linear"),
                         [](const auto& p) { return test_name(p.param); });

}  // namespace
}  // namespace anholon::test

// Published equations: the gallery of papers; derived equations as they are printed, with multiples and combinations of
// them; and misprints of each kind, which must be named. Dots may be lost at up to four places.
#include <cstdlib>

#include <gtest/gtest.h>

#include "formulation/formulation.h"
#include "print/arrange.h"
#include "published/subject.h"
#include "support/models.h"

namespace anholon::test::compare_test {
namespace {

// A shipped model with which equations are compared.
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
    const Column left = put_masses(subject->model(), lagrange_operator(m)),
                 right = put_masses(subject->model(), right_side(m));
    const SymbolNames& names = subject->names();
    std::vector<std::string> list;
    for (std::size_t a = 0; a < left.size(); ++a)
      list.push_back(print(arranged(left[a], names), names, Format::text) + " = " +
                     print(arranged(right[a], names), names, Format::text));
    return list;
  }
};

// A misprint: its kind, and the text that it replaces by another.
struct Misprint {
  const char* kind;
  const char *right, *wrong;
};
constexpr Misprint kMisprints[] = {
    {"sign", " + ", " - "},    {"sign", " - ", " + "},    {"prime", "''", "'"},         {"prime", "'*", "''*"},
    {"exponent", "^2", "^3"},  {"exponent", "^2", ""},    {"function", "sin(", "cos("}, {"function", "cos(", "sin("},
    {"coefficient", "2*", ""}, {"coefficient", "/2", ""},
};

// The first place where the misprint can happen: not inside a name, a number or an exponent.
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

TEST_P(Gallery, RestoredEquationsAreTrue) {
  const std::string name = GetParam();
  Shipped s("papers/" + name + "-symbolic");
  for (const PublishedEquation& e : s.read(file_text(source_dir() / "models" / "papers" / (name + ".restored.eq"))))
    EXPECT_EQ(s.judged(e).verdict, Verdict::proved) << e.label << ": " << s.judged(e).detail;
}

// An equation as read from the scan is refuted if it differs from the restored one, else proved.
TEST_P(Gallery, WhatIsReadOtherwiseIsFalse) {
  const std::string name = GetParam();
  Shipped s("papers/" + name + "-symbolic");
  const auto folder = source_dir() / "models" / "papers";
  std::map<std::string, std::string> restored;
  for (const PublishedEquation& e : s.read(file_text(folder / (name + ".restored.eq")))) restored[e.label] = e.text();
  const auto as_read = s.read(file_text(folder / (name + ".as-read.eq")));
  EXPECT_EQ(as_read.size(), restored.size());
  for (const PublishedEquation& e : as_read)
    EXPECT_EQ(s.judged(e).verdict, restored[e.label] == e.text() ? Verdict::proved : Verdict::refuted) << e.label;
}

INSTANTIATE_TEST_SUITE_P(Papers, Gallery, testing::Values("luo-zhao-example-1", "luo-zhao-example-2"),
                         [](const auto& p) { return test_name(p.param); });

TEST(GalleryMisprints, AreNamed) {
  Shipped one("papers/luo-zhao-example-1-symbolic");
  std::map<std::string, std::string> right;
  for (const PublishedEquation& e : one.read(file_text(source_dir() / "models/papers/luo-zhao-example-1.as-read.eq"))) {
    if (e.label[0] != '4') continue;
    const Comparison c = one.compared(e);
    right[e.label] = c.verdict == Verdict::proved ? "true"
                     : c.changes.size() == 1      ? c.changes[0].from + " -> " + c.changes[0].to
                                                  : "?";
  }
  EXPECT_EQ(right["4.1"], "r^2*c^2*phi'^2 -> r^2*cos(psi)^2*phi'^2");
  EXPECT_EQ(right["4.3.r"], "m*ur -> m'*ur");
  EXPECT_EQ(right["4.3.phi"], "m*r*uf*cos(psi) -> m'*r*uf*cos(psi)");
  EXPECT_EQ(right["4.4.psi"], "m*r*up -> m'*r*up");
  // The equation has one of the two differences of (4.3.psi).
  const auto psi = one.read("e: m*D(r^2*psi', 1) + m*r^2*phi'^2*sin(psi)*cos(psi) = m'*r*up + 2*r*psi'^2*lambda - "
                            "2*m*w*r^2*phi'*sin(psi)*cos(psi) - m*r^2*w^2*sin(psi)*cos(psi)\n");
  const Comparison c = one.compared(psi[0]);
  ASSERT_EQ(c.changes.size(), 1U);
  EXPECT_EQ(c.changes[0].from + " -> " + c.changes[0].to, "2*r*psi'^2*lambda -> 2*r^2*psi'*lambda");
}

class Derived : public testing::TestWithParam<std::string> {};

TEST_P(Derived, TrueAsPrintedScaledAndCombined) {
  Shipped s(GetParam());
  const std::vector<std::string> derived = s.derived();
  std::string text;
  for (std::size_t a = 0; a < derived.size(); ++a) {
    const std::string label = "e" + std::to_string(a), side = derived[a].substr(0, derived[a].find(" = ")),
                      other = derived[a].substr(derived[a].find(" = ") + 3);
    text += label + ": " + derived[a] + "\n";
    text += label + ".scaled: -3*(" + side + ")/(2 + sin(t)) = -3*(" + other + ")/(2 + sin(t))\n";
    if (a > 0) {
      const std::string before = derived[a - 1].substr(0, derived[a - 1].find(" = ")),
                        before_other = derived[a - 1].substr(derived[a - 1].find(" = ") + 3);
      text += label + ".combined: sin(t)*(" + side + ") - (" + before + ") = sin(t)*(" + other + ") - (" +
              before_other + ")\n";
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
      if (c.verdict == Verdict::proved) continue;  // another true equation: sin^2 for cos^2, perhaps
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
  // The others are named by a change with the same meaning: an equation has two sides.
  EXPECT_GE(10 * exactly, 7 * tried);
}

// A symbol in a printed equation: the length of its name, and its dots.
struct Symbol {
  std::size_t at, length, dots;
};

std::vector<Symbol> symbols_of(const std::string& text) {
  std::vector<Symbol> list;
  const auto letter = [&](std::size_t i) {
    return i < text.size() && (std::isalnum(static_cast<unsigned char>(text[i])) || text[i] == '_' || text[i] == '.');
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (!letter(i) || std::isdigit(static_cast<unsigned char>(text[i])) || (i > 0 && letter(i - 1))) continue;
    Symbol s{i, 0, 0};
    while (letter(i + s.length)) ++s.length;
    while (i + s.length + s.dots < text.size() && text[i + s.length + s.dots] == '\'') ++s.dots;
    list.push_back(s);
  }
  return list;
}

// Pseudo-random numbers that are the same everywhere.
struct Dice {
  std::uint64_t state;
  std::size_t roll(std::size_t sides) {
    state = state * 6364136223846793005ULL + 1442695040888963407ULL;
    return static_cast<std::size_t>(state >> 33) % sides;
  }
};

// Erases some dots of `count` symbols of the equation. Returns an empty text if fewer symbols have dots.
std::string without_dots(const std::string& text, std::size_t count, Dice& dice) {
  std::vector<Symbol> dotted;
  for (const Symbol& s : symbols_of(text))
    if (s.dots > 0) dotted.push_back(s);
  if (dotted.size() < count) return {};
  while (dotted.size() > count) dotted.erase(dotted.begin() + static_cast<std::ptrdiff_t>(dice.roll(dotted.size())));
  std::string wrong = text;
  for (std::size_t k = dotted.size(); k-- > 0;)
    wrong.erase(dotted[k].at + dotted[k].length, 1 + dice.roll(dotted[k].dots));
  return wrong;
}

std::string with_other_sign(const std::string& text, Dice& dice) {
  std::vector<std::size_t> signs;
  for (std::size_t i = 1; i + 1 < text.size(); ++i)
    if ((text[i] == '+' || text[i] == '-') && text[i - 1] == ' ' && text[i + 1] == ' ') signs.push_back(i);
  if (signs.empty()) return {};
  std::string wrong = text;
  char& sign = wrong[signs[dice.roll(signs.size())]];
  sign = sign == '+' ? '-' : '+';
  return wrong;
}

std::string with_other_index(const std::string& text, const std::vector<std::string>& coordinates, Dice& dice) {
  std::vector<Symbol> places;
  for (const Symbol& s : symbols_of(text))
    if (std::find(coordinates.begin(), coordinates.end(), text.substr(s.at, s.length)) != coordinates.end())
      places.push_back(s);
  if (places.empty() || coordinates.size() < 2) return {};
  const Symbol s = places[dice.roll(places.size())];
  std::string other = text.substr(s.at, s.length);
  while (other == text.substr(s.at, s.length)) other = coordinates[dice.roll(coordinates.size())];
  std::string wrong = text;
  wrong.replace(s.at, s.length, other);
  return wrong;
}

TEST_P(Derived, LostDotsWrongSignsAndOtherIndicesAreNamed) {
  Shipped s(GetParam());
  const std::vector<std::string>& coordinates = s.subject->model().names.coordinates;
  const int rounds = std::getenv("ANHOLON_LONG") ? 20 : 2;
  std::size_t tried = 0, named = 0;
  for (const std::string& right : s.derived()) {
    if (right.size() > 400) continue;
    const PublishedEquation original = s.read("e: " + right)[0];
    const Expr meant = s.subject->difference(original);
    Dice dice{right.size()};
    const auto check = [&](const std::string& wrong, std::size_t places) {
      if (wrong.empty()) return;
      const PublishedEquation e = s.read("e: " + wrong)[0];
      const Comparison c = s.compared(e);
      if (c.verdict == Verdict::proved) return;  // the change has no effect, or the other equation is true as well
      ASSERT_EQ(c.verdict, Verdict::refuted) << wrong << "\n" << c.detail;
      EXPECT_EQ(c.what.find("times 0"), std::string::npos) << c.what;
      ++tried;
      const bool found = std::any_of(c.changes.begin(), c.changes.end(), [&](const Change& change) {
        return change.places.size() <= places &&
               proved_zero(s.subject->difference(s.read("e: " + change.equation)[0]) - meant);
      });
      named += found;
      EXPECT_TRUE(found) << "meant: " << right << "\nread: " << wrong
                         << "\nnamed: " << (c.changes.empty() ? "nothing" : c.changes[0].equation);
    };
    for (std::size_t count = 1; count <= 4; ++count)
      for (int k = 0; k < rounds; ++k) check(without_dots(original.text(), count, dice), count);
    for (int k = 0; k < rounds; k += 2) {
      check(with_other_sign(original.text(), dice), 1);
      check(with_other_index(original.text(), coordinates, dice), 1);
    }
  }
  EXPECT_EQ(named, tried);
  EXPECT_GE(tried, 3U);
}

INSTANTIATE_TEST_SUITE_P(Models, Derived,
                         testing::Values("papers/luo-zhao-example-1", "papers/luo-zhao-example-2", "zoo/appell-hamel",
                                         "zoo/chaplygin-sleigh", "zoo/double-pendulum-cartesian", "zoo/vertical-disc",
                                         "zoo/variable-mass-pendulum", "zoo/second-order-linear"),
                         [](const auto& p) { return test_name(p.param); });

}  // namespace
}  // namespace anholon::test::compare_test

// The table of the language and the reader agree. (tools/reference.py tests the page of the table.)
#include <set>

#include <gtest/gtest.h>

#include "formula/units.h"
#include "modelfile/language/language.h"
#include "modelfile/language/reference.h"
#include "support/models.h"

namespace anholon::language_test {
namespace {

const std::string kPlate = R"toml(coordinates = ["x", "y", "theta"]
parameters = {m = 2, J = "1/2", R = 0.3, g = 9.81}
frame.B = "rotz(theta)"
point.P = "x*ex + y*ey"
body = [{name = "plate", mass = "m", inertia = "J", center = "P", orientation = "B"}]
)toml";

std::vector<Diagnostic> diagnostics_of(const std::string& text) {
  Diagnostics d;
  read_model(SourceText{"test.toml", text}, d);
  return d.list();
}

std::string first(const std::vector<Diagnostic>& list) { return list.empty() ? "" : list[0].message; }

TEST(Language, EveryFunctionIsReadAsItsExampleSays) {
  std::vector<FunctionRow> rows = function_table();
  rows.insert(rows.end(), kinematic_functions().begin(), kinematic_functions().end());
  for (const FunctionRow& r : rows) {
    EXPECT_FALSE(r.call.empty());
    if (r.example.empty()) continue;
    EXPECT_EQ(first(diagnostics_of(kPlate + "[define]\na = \"" + r.example + "\"\n")), "") << r.call;
    // The name with a slip is recognized; without arguments every function is an error.
    EXPECT_NE(first(diagnostics_of(kPlate + "[define]\na = \"" + r.name + "()\"\n")), "") << r.call;
    if (r.name.size() > 3) {
      EXPECT_NE(first(diagnostics_of(kPlate + "[define]\na = \"" + r.name + "q(x)\"\n"))
                    .find("'" + r.name + "q'; did you mean '" + r.name),
                std::string::npos)
          << r.call;
    }
  }
}

TEST(Language, ReservedNamesCannotBeDeclared) {
  for (const ReservedName& r : reserved_names())
    EXPECT_EQ(first(diagnostics_of(kPlate + "[define]\n" + r.name + " = 1\n")),
              std::string("the name '") + r.name + "' is reserved");
  EXPECT_EQ(first(diagnostics_of(kPlate + "[define]\nq = 1\n")), "");
}

TEST(Language, EverySectionIsKnownAtTheTopOfAFileAndNothingElse) {
  for (const LanguageSection& s : language()) {
    if (s.form == LanguageSection::Form::top || s.form == LanguageSection::Form::part) continue;
    const bool elements = s.form == LanguageSection::Form::elements;
    for (const Diagnostic& d : diagnostics_of(kPlate + (elements ? "[[" : "[") + s.name + (elements ? "]]\n" : "]\n")))
      EXPECT_EQ(d.message.find("unknown key"), std::string::npos) << s.name;
    EXPECT_EQ(first(diagnostics_of(kPlate + s.name + "q = 1\n")),
              std::string("unknown key '") + s.name + "q' in the model file; did you mean '" + s.name + "'?");
  }
}

// A section with fixed keys refuses others and names the keys of the table.
TEST(Language, KeysOfEachSectionAreThoseOfTheTable) {
  for (const LanguageSection& s : language()) {
    using Form = LanguageSection::Form;
    if (s.form != Form::keys && s.form != Form::elements) continue;
    const std::string open =
        s.form == Form::elements ? std::string("[[") + s.name + "]]\n" : std::string("[") + s.name + "]\n";
    const std::set<std::string> given = {"name", "center", "position"};
    const auto unknown = [&](const std::string& key) {
      const auto list = diagnostics_of(test::replaced(kPlate, "body = [", "other = [") + open +
                                       "name = \"p\"\ncenter = \"0\"\nposition = \"0\"\n" + key + " = 1\n");
      return std::any_of(list.begin(), list.end(), [&](const Diagnostic& d) {
        return d.message.find("unknown key '" + key + "'") != std::string::npos;
      });
    };
    EXPECT_TRUE(unknown("zzzzz")) << s.name;
    for (const LanguageKey& k : s.keys)
      if (!given.count(k.name)) {
        EXPECT_FALSE(unknown(k.name)) << s.name << "." << k.name;
      }
  }
}

const LanguageKey& key(const std::string& section, const std::string& name) {
  for (const LanguageKey& k : language_section(section).keys)
    if (name == k.name) return k;
  throw std::logic_error("no key " + name);
}

TEST(Language, ChoicesAreThoseOfTheReader) {
  const auto with = [&](const std::string& name, const std::string& value) {
    if (name == "direction") return kPlate + "[[event]]\nwhen = \"x\"\ndirection = \"" + value + "\"\n";
    if (name == "integrator") return kPlate + "[simulate]\nintegrator = \"" + value + "\"\n";
    return kPlate + "[[table]]\nname = \"T\"\nx = [0, 1]\ny = [0, 1]\n" + name + " = \"" + value + "\"\n";
  };
  for (const auto& [section, name] :
       {std::pair{"table", "fit"}, {"table", "outside"}, {"event", "direction"}, {"simulate", "integrator"}}) {
    const std::vector<Diagnostic> wrong = diagnostics_of(with(name, "neither"));
    ASSERT_EQ(wrong.size(), 1U) << name;
    const std::string said = wrong[0].message + wrong[0].hint;
    std::size_t listed = 0;
    for (const std::string& c : key(section, name).choices) {
      EXPECT_EQ(first(diagnostics_of(with(name, c))), "") << name << " = " << c;
      listed += said.find(c) != std::string::npos ? 1 : 0;
    }
    EXPECT_EQ(listed, key(section, name).choices.size()) << said;
  }
}

TEST(Language, ShapesAreThoseOfTheReader) {
  const auto wrong = diagnostics_of(test::replaced(kPlate, "inertia = \"J\"", "shape = \"lump(1)\""));
  ASSERT_EQ(wrong.size(), 1U);
  const std::string prefix = "the shapes are ", all = wrong[0].hint.substr(prefix.size()),
                    meaning = key("body", "shape").meaning;
  int count = 0;
  for (std::size_t from = 0; from < all.size(); ++count) {
    const std::size_t to = all.find(')', from) + 1;
    EXPECT_NE(meaning.find("`" + all.substr(from, to - from) + "`"), std::string::npos) << all.substr(from, to - from);
    from = to + 2;
  }
  EXPECT_EQ(count, std::count(meaning.begin(), meaning.end(), '('));
}

TEST(Language, UnitsOfThePageAreRead) {
  const std::string page = reference_page();
  for (const UnitRow& u : unit_table())
    EXPECT_NE(page.find(std::string("| `") + u.name + "`"), std::string::npos) << u.name;
}

}  // namespace
}  // namespace anholon::language_test

// A model with which a test compares published equations.
#pragma once
#include <gtest/gtest.h>

#include "published/subject.h"

namespace anholon::test {

// A sleigh without forces, with a blade below its centre of mass.
inline constexpr const char* kSleigh = R"toml(coordinates = ["x", "y", "th"]
parameters = {m = 2, J = 3}
[[body]]
name = "sleigh"
mass = "m"
inertia = "J"
center = ["x", "y", "0"]
angle = "th"
[[constraint]]
name = "blade"
equation = "y'*cos(th) = x'*sin(th)"
)toml";

inline OpenModel open_text(const std::string& text) {
  Diagnostics diagnostics;
  const SourceText source{"model.toml", text};
  std::optional<OpenModel> open = open_model(source, diagnostics);
  EXPECT_TRUE(open) << diagnostics.print(source);
  return std::move(open).value();
}

class Published {
 public:
  explicit Published(const std::string& text) : subject_(open_text(text)) {}
  Subject& subject() { return subject_; }
  const SymbolNames& names() const { return subject_.names(); }

  std::vector<PublishedEquation> read(const std::string& text) {
    Diagnostics diagnostics;
    const SourceText source{"test.eq", text};
    std::vector<PublishedEquation> list = subject_.read(source, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.print(source);
    return list;
  }
  // The messages about a text that cannot be read.
  Diagnostics errors(const std::string& text) {
    Diagnostics diagnostics;
    subject_.read({"test.eq", text}, diagnostics);
    return diagnostics;
  }
  // Compares one equation, given without its label.
  Comparison compare(const std::string& equation) {
    const auto list = read("e: " + equation + "\n");
    return list.empty() ? Comparison{} : subject_.compare(list[0]);
  }
  // "from -> to" if there is one change, else the number of changes; the verdict's name if the equation is not refuted.
  std::string change(const std::string& equation) {
    const Comparison c = compare(equation);
    if (c.verdict != Verdict::refuted) return name(c.verdict);
    return c.changes.size() == 1 ? c.changes[0].from + " -> " + c.changes[0].to : std::to_string(c.changes.size());
  }

 private:
  Subject subject_;
};

}  // namespace anholon::test

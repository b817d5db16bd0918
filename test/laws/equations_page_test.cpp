// The examples of doc/equations.md: examples whose label ends in `.wrong` are false, all others are true.
#include <gtest/gtest.h>

#include "published/subject.h"
#include "support/models.h"

namespace anholon::test::equations_page_test {
namespace {

struct Example {
  std::string model, text;
};

std::vector<Example> examples_of(const std::string& page) {
  std::vector<Example> list;
  std::istringstream lines(page);
  const std::string fence = "```";
  bool within = false;
  for (std::string line; std::getline(lines, line);) {
    if (!within && line.starts_with(fence + "eq ")) {
      list.push_back({line.substr(fence.size() + 3), {}});
      within = true;
    } else if (within && line == fence) {
      within = false;
    } else if (within) {
      list.back().text += line + "\n";
    }
  }
  return list;
}

TEST(EquationsPage, ExamplesAreWhatItSays) {
  const std::vector<Example> examples = examples_of(file_text(source_dir() / "doc/equations.md"));
  ASSERT_GE(examples.size(), 6U);
  std::size_t right = 0, wrong = 0;
  for (const Example& example : examples) {
    Diagnostics diagnostics;
    const SourceText model{"model.toml", shipped_text("zoo/" + example.model)};
    std::optional<OpenModel> open = open_model(model, diagnostics);
    ASSERT_TRUE(open) << example.model << "\n" << diagnostics.print(model);
    Subject subject(std::move(*open));
    const SourceText source{"equations.md", example.text};
    const std::vector<PublishedEquation> equations = subject.read(source, diagnostics);
    EXPECT_FALSE(diagnostics.has_errors()) << diagnostics.print(source);
    for (const PublishedEquation& e : equations) {
      const bool false_one = e.label.ends_with(".wrong");
      ++(false_one ? wrong : right);
      const Comparison c = subject.judge(e);
      EXPECT_EQ(c.verdict, false_one ? Verdict::refuted : Verdict::proved)
          << example.model << ", " << e.label << ": " << e.text() << "\n"
          << c.detail;
    }
  }
  EXPECT_GE(right, 20U);
  EXPECT_GE(wrong, 3U);
}

}  // namespace
}  // namespace anholon::test::equations_page_test

// The examples of Luo and Zhao with open functions of time: each equation as a machine has read it, and its correct
// reading.
#include <gtest/gtest.h>

#include "support/models.h"
#include "support/published.h"

namespace anholon::as_read_test {
namespace {

std::vector<PublishedEquation> shipped_equations(test::Published& p, const std::string& name) {
  return p.read(test::file_text(test::source_dir() / "models/papers" / (name + ".eq")));
}

// A false reading is repaired in exactly one way, which is the restored equation.
class AsRead : public testing::TestWithParam<const char*> {};

TEST_P(AsRead, EachLossIsNamed) {
  const std::string name = GetParam();
  test::Published p(test::shipped_text("papers/" + name + "-symbolic"));
  const auto read = shipped_equations(p, name + ".as-read"), restored = shipped_equations(p, name + ".restored");
  ASSERT_EQ(read.size(), restored.size());
  std::size_t lost = 0;
  for (std::size_t k = 0; k < read.size(); ++k) {
    ASSERT_EQ(read[k].label, restored[k].label);
    EXPECT_EQ(p.subject().judge(restored[k]).verdict, Verdict::proved) << restored[k].label;
    if (read[k].text() == restored[k].text()) continue;
    ++lost;
    const Comparison c = p.subject().compare(read[k]);
    EXPECT_EQ(c.verdict, Verdict::refuted) << read[k].label;
    ASSERT_EQ(c.changes.size(), 1U) << read[k].label;
    EXPECT_TRUE(c.changes[0].proved) << read[k].label;
    EXPECT_EQ(c.changes[0].equation, restored[k].text()) << read[k].label;
  }
  EXPECT_EQ(lost, 12U);
}

INSTANTIATE_TEST_SUITE_P(Of, AsRead, testing::Values("luo-zhao-example-1", "luo-zhao-example-2"),
                         [](const auto& p) { return test::test_name(p.param); });

}  // namespace
}  // namespace anholon::as_read_test

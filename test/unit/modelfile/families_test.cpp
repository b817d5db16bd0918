// The cost of families: nodes grow in proportion to the members, and recursions may have any depth.
#include <gtest/gtest.h>

#include "support/models.h"

namespace anholon::families_test {
namespace {

std::size_t nodes(int links) {
  return test::model_of(test::shipped_text("zoo/chain"), {{"n", std::to_string(links)}})->graph->size();
}

TEST(Families, TheGraphOfAChainIsLinearInItsLinks) {
  const std::size_t at100 = nodes(100), at200 = nodes(200), at400 = nodes(400);
  EXPECT_NEAR(static_cast<double>(at400 - at200) / static_cast<double>(at200 - at100), 2, 0.02)
      << at100 << ", " << at200 << ", " << at400;
  EXPECT_LE(at400, 400U * 60) << "sixty nodes per link are plenty";
}

// Long recursions that are used from their end, in either direction.
TEST(Families, RecursionsAreAsDeepAsTheyLike) {
  const std::string head = "coordinates = [\"x\"]\nparticle = [{name = \"a\", mass = 1, position = \"P\"}]\nindex = {i "
                           "= \"1..1500\", j = \"0..1500\"}\n[point]\n";
  for (const std::string chain : {"P = \"Q[1500]\"\n\"Q[0]\" = \"x*ex\"\n\"Q[i]\" = \"Q[i-1] + ey\"\n",
                                  "P = \"Q[0]\"\n\"Q[j]\" = \"Q[j+1] + ey\"\n\"Q[1500]\" = \"x*ex\"\n"}) {
    const auto model = test::model_of(head + chain);
    EXPECT_EQ(number_value(model->bodies[0].center.y), 1500) << chain;
  }
  // Bodies whose centres refer to each other.
  const auto bodies = test::model_of("coordinates = [\"x\"]\nparticle = [{name = \"b[j]\", mass = 1, position = "
                                     "\"b[j+1].center + ey\"}, {name = \"b[1500]\", mass = 1, position = \"x*ex\"}]\n"
                                     "index = {j = \"0..1500\"}\n");
  EXPECT_EQ(number_value(bodies->bodies[0].center.y), 1500);
}

TEST(Families, ALongCircleIsNamed) {
  Diagnostics diagnostics;
  const SourceText text{"circle.toml", "coordinates = [\"x\"]\nparticle = [{name = \"a\", mass = 1, position = "
                                       "\"Q[1]\"}]\nindex = {i = \"1..999\"}\n[point]\n"
                                       "\"Q[i]\" = \"Q[i+1] + ex\"\n\"Q[1000]\" = \"Q[1]\"\n"};
  EXPECT_FALSE(read_model(text, diagnostics));
  ASSERT_EQ(diagnostics.list().size(), 1U) << diagnostics.print(text);
  EXPECT_NE(diagnostics.list()[0].message.find("is defined through itself"), std::string::npos)
      << diagnostics.print(text);
}

}  // namespace
}  // namespace anholon::families_test

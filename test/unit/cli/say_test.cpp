#include <gtest/gtest.h>

#include "cli/say.h"

namespace anholon::cli::say_test {
namespace {

TEST(Say, IsPrintfForWhatIsOurs) {
  EXPECT_EQ(
      said("%d of %zu, %5.2f|%-6s|%6s|%3u|%llu|%lld|%%", -3, std::size_t{7}, 1.005, "ab", "cd", 5U, 1ULL << 40, -2LL),
      "-3 of 7,  1.00|ab    |    cd|  5|1099511627776|-2|%");
  EXPECT_EQ(said("%-*s|%*s|%.2s", 4, "x", -4, "y", "αβγ"), "x   |y   |αβ");
  EXPECT_EQ(said("%.3g %e %04d", 1234.5, 1.0, 7), "1.23e+03 1.000000e+00 0007");
}

TEST(Say, WidthsCountCharacters) { EXPECT_EQ(said("%-4s|%4s", "θ̈", "α"), "θ̈  |   α"); }

TEST(Say, ShowsWhatOthersWrote) {
  EXPECT_EQ(said("\033[K%s\n", "title\033[31m\nerror: x"), "\033[Ktitle␛[31m␊error: x\n") << "the format is ours";
}

}  // namespace
}  // namespace anholon::cli::say_test

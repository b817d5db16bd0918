#include <gtest/gtest.h>

#include "base/assert.h"
#include "result/number_columns.h"

namespace anholon::number_columns_test {
namespace {

// Three columns whose number in row i is 10 i + k; long ones use pages of the system.
NumberColumns grown(std::size_t rows) {
  NumberColumns c;
  c.reset(3);
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < 3; ++k) c.growing(k).push_back(static_cast<double>(10 * i + k));
  return c;
}

TEST(NumberColumns, AreTheSameBeforeAndAfterTheySettle) {
  for (const std::size_t rows : {std::size_t{0}, std::size_t{1}, std::size_t{5}, std::size_t{300'000}}) {
    const NumberColumns before = grown(rows);
    NumberColumns after = before;
    after.settle();
    ASSERT_EQ(after.size(), 3u);
    ASSERT_EQ(after.rows(), rows);
    ASSERT_EQ(after.block().size(), 3 * rows);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(after[k].size(), rows);
      EXPECT_TRUE(std::equal(after[k].begin(), after[k].end(), before[k].begin(), before[k].end()));
    }
  }
}

TEST(NumberColumns, LieSideBySideAndAreSharedByCopies) {
  NumberColumns c = grown(100);
  EXPECT_TRUE(c.block().empty());
  c.settle();
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(c[k].data(), c.block().data() + 100 * k);
  const NumberColumns copy = c;
  EXPECT_EQ(copy.block().data(), c.block().data());
  c.reset(1);
  EXPECT_EQ(c.rows(), 0u);
  EXPECT_EQ(copy[2][99], 992);
}

TEST(NumberColumns, WithoutColumnsStayEmpty) {
  NumberColumns c;
  c.settle();
  EXPECT_TRUE(c.empty());
  EXPECT_EQ(c.rows(), 0u);
  c.push_back({1, 2});
  EXPECT_EQ(c.size(), 1u);
}

TEST(NumberColumns, DoNotGrowOnceTheyAreSettled) {
  NumberColumns c = grown(2);
  c.settle();
  EXPECT_THROW(c.growing(0), InternalFault);
}

}  // namespace
}  // namespace anholon::number_columns_test

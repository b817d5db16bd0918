#include <numeric>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "base/stable_list.h"

namespace anholon::stable_list_test {
namespace {

TEST(StableList, KeepsItsElementsWhereTheyAre) {
  StableList<std::string> list;
  std::vector<const std::string*> where;
  for (int k = 0; k < 10'000; ++k) {
    list.push_back(std::to_string(k));
    where.push_back(&list[list.size() - 1]);
  }
  ASSERT_EQ(list.size(), 10'000U);
  for (std::size_t k = 0; k < list.size(); ++k) {
    EXPECT_EQ(&list[k], where[k]);
    EXPECT_EQ(list[k], std::to_string(k));
  }
}

// Parts have many lengths; some are longer than a block, some end exactly with it.
TEST(StableList, PutsPartsSideBySide) {
  StableList<int> list;
  struct Part {
    std::size_t first, count;
    std::span<const int> kept;
  };
  std::vector<Part> parts;
  int next = 0;
  for (std::size_t count : {0U, 63U, 1U, 1U, 5000U, 2U, 0U, 7U, 131U}) {
    std::vector<int> values(count);
    std::iota(values.begin(), values.end(), next);
    next += static_cast<int>(count);
    const std::size_t first = list.append(values);
    parts.push_back({first, count, list.part(first, count)});
  }
  StableList<int> whole, start;
  whole.assign(list, list.size());
  start.assign(list, parts[4].first + parts[4].count);
  whole.push_back(-1);
  EXPECT_EQ(whole[list.size()], -1);
  EXPECT_EQ(start.size(), parts[4].first + parts[4].count);
  next = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const auto [first, count, kept] = parts[k];
    EXPECT_EQ(kept.data(), list.part(first, count).data());
    for (std::size_t i = 0; i < count; ++i, ++next) {
      EXPECT_EQ(kept[i], next);
      EXPECT_EQ(list[first + i], next);
      EXPECT_EQ(whole.part(first, count)[i], next);
      if (k <= 4) {
        EXPECT_EQ(start.part(first, count)[i], next);
      }
    }
  }
}

}  // namespace
}  // namespace anholon::stable_list_test

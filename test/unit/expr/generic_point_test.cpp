#include <set>

#include <gtest/gtest.h>

#include "expr/generic_point.h"

namespace anholon::generic_point_test {
namespace {

Node symbol(Kind kind, std::uint32_t index, unsigned order) {
  Node n{kind};
  n.index = index;
  n.order = static_cast<std::uint8_t>(order);
  return n;
}

// Two symbols of equal value would make rows parallel, and so a constraint redundant by accident.
TEST(GenericValue, IsAnotherForEverySymbol) {
  std::set<double> seen;
  std::size_t symbols = 0;
  for (const Kind kind : {Kind::jet, Kind::parameter, Kind::multiplier, Kind::mass})
    for (std::uint32_t index = 0; index < 1000; ++index)
      for (unsigned order = 0; order < 4; ++order, ++symbols) seen.insert(generic_value(symbol(kind, index, order), 0));
  EXPECT_EQ(seen.size(), symbols);
  EXPECT_GT(*seen.begin(), 0.0);
  EXPECT_LT(*seen.rbegin(), 1.0);
}

TEST(GenericValue, FollowsFromSymbolAndSeed) {
  const Node x = symbol(Kind::jet, 3, 1);
  EXPECT_EQ(generic_value(x, 7), generic_value(x, 7));
  EXPECT_NE(generic_value(x, 7), generic_value(x, 8));
}

}  // namespace
}  // namespace anholon::generic_point_test

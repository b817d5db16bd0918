#include <vector>

#include <gtest/gtest.h>

#include "base/hash_index.h"

namespace anholon::hash_index_test {
namespace {

// An index in which id has the hash values[id], of which only the lowest `bits` bits are kept.
HashIndex index_of(const std::vector<std::uint64_t>& values, std::uint64_t bits) {
  HashIndex index;
  for (std::uint32_t id = 0; id < values.size(); ++id) index.insert(values[id] % (1ULL << bits), id);
  return index;
}

TEST(HashIndex, FindsEachIdAlsoWhereManyHaveOneHashValue) {
  std::vector<std::uint64_t> values;
  for (std::uint64_t k = 0; k < 1000; ++k) values.push_back(mixed(k, 7));
  for (std::uint64_t bits : {0ULL, 3ULL, 40ULL}) {
    const HashIndex index = index_of(values, bits), copy = index;
    for (std::uint32_t id = 0; id < values.size(); ++id)
      EXPECT_EQ(copy.find(values[id] % (1ULL << bits), [&](std::uint32_t k) { return values[k] == values[id]; }), id);
    EXPECT_EQ(copy.find(values[3] % (1ULL << bits), [](std::uint32_t) { return false; }), HashIndex::kNone);
  }
  EXPECT_EQ(HashIndex().find(0, [](std::uint32_t) { return true; }), HashIndex::kNone);
}

TEST(HashIndex, KeepsTheEntriesBeforeAnId) {
  std::vector<std::uint64_t> values;
  for (std::uint64_t k = 0; k < 300; ++k) values.push_back(mixed(k, 11));
  const HashIndex part = index_of(values, 50).before(100);
  for (std::uint32_t id = 0; id < values.size(); ++id)
    EXPECT_EQ(part.find(values[id] % (1ULL << 50), [&](std::uint32_t k) { return k == id; }),
              id < 100 ? id : HashIndex::kNone);
}

}  // namespace
}  // namespace anholon::hash_index_test

#include <gtest/gtest.h>

#include "base/hash.h"

namespace anholon::hash_test {
namespace {

TEST(Hash, Sha256OfTheStandard) {
  EXPECT_EQ(sha256_text(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(sha256_text("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256_text("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
  EXPECT_EQ(sha256_text(std::string(1'000'000, 'a')),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Hash, SipHashOfItsPaper) {
  const HashKey key{0x0706050403020100, 0x0f0e0d0c0b0a0908};
  const std::array<std::uint64_t, 1> eight{0x0706050403020100};
  EXPECT_EQ(siphash(key, eight), 0x93f5f5799a932462u);  // of the bytes 00 … 07
  EXPECT_EQ(siphash(key, {}), 0x726fdb47dd0e0e31u);
}

}  // namespace
}  // namespace anholon::hash_test

// Bytes as text and back.
#include <gtest/gtest.h>

#include "base/base64.h"

namespace anholon::base64_test {
namespace {

// The texts of RFC 4648, section 10, and bytes that are no text.
TEST(Base64, KnownTexts) {
  for (const auto& [bytes, text] : {std::pair{"f", "Zg=="},
                                    {"fo", "Zm8="},
                                    {"foo", "Zm9v"},
                                    {"foob", "Zm9vYg=="},
                                    {"fooba", "Zm9vYmE="},
                                    {"foobar", "Zm9vYmFy"},
                                    {"\xfb\xff\xbf", "+/+/"}}) {
    EXPECT_EQ(to_base64(bytes), text);
    EXPECT_EQ(from_base64(text), bytes);
  }
  EXPECT_EQ(to_base64(""), "");
  EXPECT_EQ(from_base64("AAAA"), std::string(3, '\0'));
}

TEST(Base64, WhatIsNone) {
  for (const char* none : {"", "TWF", "TWFu!", "TW u", "TQ=a", "===="}) EXPECT_EQ(from_base64(none), "") << none;
}

TEST(Base64, ThereAndBack) {
  std::string bytes;
  for (int k = 0; k < 300; ++k) {
    bytes += static_cast<char>(k * 37 + k / 7);
    ASSERT_EQ(from_base64(to_base64(bytes)), bytes) << k;
  }
}

}  // namespace
}  // namespace anholon::base64_test

// Hashes that do not depend on the machine: SHA-256 of texts, and SipHash-2-4, a keyed function of words that cannot be
// predicted without the key.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace anholon {

std::array<std::uint8_t, 32> sha256(std::string_view text);
std::string sha256_text(std::string_view text);  // 64 hexadecimal digits

struct HashKey {
  std::uint64_t low = 0, high = 0;
};
HashKey hash_key(std::string_view text);  // from its SHA-256
std::uint64_t siphash(const HashKey& key, std::span<const std::uint64_t> words);

}  // namespace anholon

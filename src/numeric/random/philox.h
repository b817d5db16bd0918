// Counter-based random numbers: the n-th draw of a stream is a function of n, so draws do not depend on their order.
//
// Philox4x32-10 (Salmon, Moraes, Dror, Shaw: Parallel random numbers: as easy as 1, 2, 3, SC 2011): ten rounds of two
// 32-bit products and Weyl keys on a counter of 128 bits.
#pragma once
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace anholon {

inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t kM0 = 0xD2511F53, kM1 = 0xCD9E8D57;
  constexpr std::uint32_t kW0 = 0x9E3779B9, kW1 = 0xBB67AE85;
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = kM0 * counter[0], b = kM1 * counter[2];
    counter = {static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
               static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += kW0;
    key[1] += kW1;
  }
  return counter;
}

// Draw `number` of stream `stream`.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t number, std::uint32_t stream)
      : bits_(philox({static_cast<std::uint32_t>(number), static_cast<std::uint32_t>(number >> 32), stream, 0},
                     {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)})) {}

  // Returns a number in (0, 1), all 53 bits random.
  double uniform() const { return open(0); }
  std::uint64_t bits() const { return (static_cast<std::uint64_t>(bits_[0]) << 32) | bits_[1]; }
  // Returns a standard normal number, by the transform of Box and Muller.
  double normal() const { return std::sqrt(-2 * std::log(open(0))) * std::cos(2 * std::numbers::pi * open(2)); }

 private:
  double open(std::size_t i) const {
    const std::uint64_t word = (static_cast<std::uint64_t>(bits_[i]) << 32) | bits_[i + 1];
    return (static_cast<double>(word >> 11) + 0.5) * 0x1p-53;
  }
  std::array<std::uint32_t, 4> bits_;
};

}  // namespace anholon

#include "base/base64.h"

#include <array>
#include <cstdint>

namespace anholon {

static constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

std::string to_base64(std::string_view bytes) {
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t k = 0; k < bytes.size(); k += 3) {
    std::uint32_t three = 0;
    for (std::size_t b = 0; b < 3; ++b)
      three = three << 8 | (k + b < bytes.size() ? static_cast<unsigned char>(bytes[k + b]) : 0U);
    for (std::size_t d = 0; d < 4; ++d) out += k + d > bytes.size() ? '=' : kDigits[three >> (18 - 6 * d) & 63];
  }
  return out;
}

std::string from_base64(std::string_view text) {
  static const auto values = [] {
    std::array<int, 256> v;
    v.fill(-1);
    for (std::size_t k = 0; k < kDigits.size(); ++k) v[static_cast<unsigned char>(kDigits[k])] = static_cast<int>(k);
    return v;
  }();
  if (text.empty() || text.size() % 4 != 0) return "";
  const std::size_t padding = text.ends_with("==") ? 2 : text.ends_with('=') ? 1 : 0;
  text.remove_suffix(padding);
  std::string out;
  out.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const int d = values[static_cast<unsigned char>(c)];
    if (d < 0) return "";
    bits = (bits << 6 | static_cast<std::uint32_t>(d)) & 0xffffff;
    held += 6;
    if (held >= 8) held -= 8, out += static_cast<char>(bits >> held & 0xff);
  }
  return out;
}

}  // namespace anholon

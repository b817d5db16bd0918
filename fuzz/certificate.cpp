// Certificates: any bytes are read or refused; what is read is written and read back the same.
#include "proof/checker/certificate.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "base/diagnostic.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const auto c = anholon::read_certificate({reinterpret_cast<const char*>(data), size});
    const std::string text = anholon::to_json(c);
    if (anholon::to_json(anholon::read_certificate(text)) != text) std::abort();
  } catch (const anholon::Failure&) {
  }
  return 0;
}

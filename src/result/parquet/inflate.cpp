#include "result/parquet/inflate.h"

#include <array>

#include "base/diagnostic.h"
#include "base/platform/shared_library.h"

namespace anholon::parquet {

namespace {

// The names of the other codecs, by their numbers.
constexpr std::array kCodecs = {"none", "Snappy", "gzip", "LZO", "Brotli", "LZ4", "Zstandard", "LZ4"};

[[noreturn]] void refuse(const std::string& message) {
  throw Failure({}, message, "with pandas: cases.to_parquet(\"cases.parquet\", compression=\"snappy\")");
}

std::string by_zstandard(std::string_view page, std::size_t size) {
  using Decompress = std::size_t (*)(void*, std::size_t, const void*, std::size_t);
  static SharedLibrary library("the library of Zstandard", "libzstd.so.1");
  const auto decompress = reinterpret_cast<Decompress>(library.find("ZSTD_decompress"));
  if (!decompress) refuse("the Parquet file is compressed by Zstandard, and " + library.trouble());
  std::string bytes(size, '\0');
  // An error is a number above all sizes.
  if (decompress(bytes.data(), size, page.data(), page.size()) != size)
    throw Failure({}, "a page of the Parquet file is damaged", "the file as it was written");
  return bytes;
}

}  // namespace

bool read_snappy(std::string_view block, std::size_t size, std::string& bytes) {
  std::size_t at = 0;
  bool good = true;
  const auto byte = [&]() -> std::size_t {
    if (at >= block.size()) good = false;
    return good ? static_cast<std::uint8_t>(block[at++]) : 0;
  };
  const auto number = [&](std::size_t count) {
    std::size_t value = 0;
    for (std::size_t k = 0; k < count; ++k) value |= byte() << (8 * k);
    return value;
  };
  std::size_t promised = 0;
  for (unsigned shift = 0; shift < 35; shift += 7) {
    const std::size_t b = byte();
    promised |= (b & 0x7f) << shift;
    if (b < 0x80) break;
  }
  if (!good || promised != size) return false;
  bytes.clear();
  while (at < block.size()) {
    const std::size_t tag = byte();
    if ((tag & 3) == 0) {
      std::size_t length = tag >> 2;
      if (length >= 60) length = number(length - 59);
      ++length;
      if (!good || length > block.size() - at || length > size - bytes.size()) return false;
      bytes.append(block.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = (tag >> 2) + 1, back = 0;
    if ((tag & 3) == 1)
      length = ((tag >> 2) & 7) + 4, back = (tag >> 5) << 8 | byte();
    else
      back = number((tag & 3) == 2 ? 2 : 4);
    if (!good || back == 0 || back > bytes.size() || length > size - bytes.size()) return false;
    // The copied bytes may include bytes of the copy.
    for (std::size_t k = 0; k < length; ++k) bytes.push_back(bytes[bytes.size() - back]);
  }
  return good && bytes.size() == size;
}

std::string inflated(std::string_view page, std::int64_t codec, std::size_t size) {
  switch (codec) {
  case uncompressed:
    return std::string(page);
  case snappy: {
    std::string bytes;
    if (!read_snappy(page, size, bytes))
      throw Failure({}, "a page of the Parquet file is damaged", "the file as it was written");
    return bytes;
  }
  case zstandard:
    return by_zstandard(page, size);
  default:
    break;
  }
  const bool known = codec > 0 && static_cast<std::size_t>(codec) < kCodecs.size();
  refuse(std::string("the Parquet file is compressed by ") +
         (known ? kCodecs[static_cast<std::size_t>(codec)] : "an unknown method") +
         "; tables of cases are uncompressed, or compressed by Snappy or Zstandard");
}

}  // namespace anholon::parquet

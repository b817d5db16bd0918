// Decompresses pages of Parquet files.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace anholon::parquet {

// The numbers of the codecs that can be read.
enum Codec : std::int32_t { uncompressed = 0, snappy = 1, zstandard = 6 };

// Returns the bytes of a page that has `size` of them. Throws Failure without a place if the codec is another one, if
// the library of Zstandard cannot be loaded, or if the page is damaged.
std::string inflated(std::string_view page, std::int64_t codec, std::size_t size);

// Reads a block of Snappy (Google, "Snappy compressed format description"). Returns false if it is damaged or has
// another size.
bool read_snappy(std::string_view block, std::size_t size, std::string& bytes);

}  // namespace anholon::parquet

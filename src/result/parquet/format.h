// Numbers of the Parquet format that its writer and its reader share.
#pragma once
#include <bit>
#include <cstddef>
#include <cstdint>

namespace anholon::parquet {

// Numbers are stored as they are in the memory of this machine.
static_assert(std::endian::native == std::endian::little);

inline constexpr char kMagic[] = "PAR1";
inline constexpr std::size_t kMagicSize = 4, kTail = 8;  // length of the metadata and the magic at the end
inline constexpr char kDataNote[] = "anholon.data";

enum PhysicalType : std::int32_t {
  truth = 0,
  int32 = 1,
  int64 = 2,
  old_time = 3,
  single = 4,
  real = 5,
  bytes_type = 6,
  fixed_bytes = 7
};
// The meanings of values of these types; for pairs, the first number.
enum Meaning : std::int32_t {
  kDecimal = 5,
  kDate = 6,
  kTimeOfDay = 7,
  kTimestamp = 9,
  kFirstUnsigned = 11,
  kInterval = 21
};
enum Encoding : std::int32_t { plain = 0, rle = 3, rle_dictionary = 8 };
enum PageType : std::int32_t { data_page = 0, dictionary_page = 2, data_page_2 = 3 };
inline constexpr std::int32_t kRequired = 0, kUtf8 = 0, kUncompressed = 0, kVersion = 1;

// The rows of a page, whose size has to fit into 32 bits.
inline constexpr std::size_t kPageRows = std::size_t{1} << 20;
// The rows of a row group, which a reader takes as one piece.
inline constexpr std::size_t kGroupRows = kPageRows;

}  // namespace anholon::parquet

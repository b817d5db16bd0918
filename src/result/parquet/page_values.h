// The values of a page of a Parquet file, as texts. (Apache Parquet, "Encodings")
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace anholon::parquet {

// The storage of the values of a column, and their meaning.
struct ColumnKind {
  std::int64_t type = -1;       // the physical type
  std::size_t width = 0;        // bytes of a value of fixed length
  bool optional = false;        // a value may be absent
  bool is_unsigned = false;     // of a whole number
  std::int64_t converted = -1;  // the meaning
  std::int64_t scale = 0;       // of a decimal: the number of digits behind the point
};

enum class Encoded : std::uint8_t {
  plain = 0,
  old_dictionary = 2,
  runs = 3,
  differences = 5,
  lengths = 6,
  dictionary = 8,
  split = 9
};

// Returns the values. Throws Failure without a place if the bytes are damaged or the encoding is another one.
std::vector<std::string> page_values(std::string_view bytes, std::int64_t encoding, const ColumnKind& kind,
                                     std::size_t count, const std::vector<std::string>& dictionary);

// Reads numbers of `bits` bits, in runs of equal ones and in groups of eight.
std::vector<std::uint32_t> run_lengths(std::string_view bytes, unsigned bits, std::size_t count);

[[noreturn]] void damaged_page();

}  // namespace anholon::parquet

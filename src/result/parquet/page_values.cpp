#include "result/parquet/page_values.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>

#include "base/diagnostic.h"
#include "numeric/number.h"
#include "result/parquet/format.h"

namespace anholon::parquet {

namespace {

__extension__ using Wide = unsigned __int128;

// Bytes that are read one after the other.
class Bytes {
 public:
  explicit Bytes(std::string_view bytes) : bytes_(bytes) {}

  std::string_view take(std::size_t count) {
    if (count > bytes_.size() - at_) damaged_page();
    at_ += count;
    return bytes_.substr(at_ - count, count);
  }
  std::uint64_t number(std::size_t count) {
    std::uint64_t value = 0;
    std::memcpy(&value, take(count).data(), count);
    return value;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const std::uint64_t b = number(1);
      value |= (b & 0x7f) << shift;
      if (b < 0x80) return value;
    }
    damaged_page();
  }
  std::uint64_t zigzag() {
    const std::uint64_t value = varint();
    return value >> 1 ^ (0 - (value & 1));
  }
  std::string_view rest() const { return bytes_.substr(at_); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
};

// The k-th number of `bits` bits.
std::uint64_t packed(std::string_view bytes, unsigned bits, std::size_t k) {
  std::uint64_t value = 0;
  for (unsigned b = 0; b < bits; ++b) {
    const std::size_t at = k * bits + b;
    value |= static_cast<std::uint64_t>(static_cast<std::uint8_t>(bytes[at / 8]) >> (at % 8) & 1) << b;
  }
  return value;
}

// Returns digits with a point before the last `scale` of them.
std::string decimal(bool negative, Wide digits, std::int64_t scale) {
  std::string text;
  for (; digits != 0; digits /= 10) text += static_cast<char>('0' + static_cast<int>(digits % 10));
  const auto behind = static_cast<std::size_t>(std::clamp<std::int64_t>(scale, 0, 40));
  while (text.size() <= behind) text += '0';
  if (behind > 0) text.insert(behind, 1, '.');
  if (negative) text += '-';
  std::reverse(text.begin(), text.end());
  return text;
}

std::string whole(std::uint64_t value, const ColumnKind& kind) {
  if (kind.type == int32) {
    const auto part = static_cast<std::uint32_t>(value);
    value = kind.is_unsigned ? part : static_cast<std::uint64_t>(std::int64_t{static_cast<std::int32_t>(part)});
  }
  if (kind.is_unsigned) return std::to_string(value);
  const auto number = static_cast<std::int64_t>(value);
  if (kind.converted == kDecimal) return decimal(number < 0, number < 0 ? 0 - value : value, kind.scale);
  return std::to_string(number);
}

// Reads a decimal, whose highest byte comes first.
std::string wide(std::string_view bytes, const ColumnKind& kind) {
  const bool negative = !bytes.empty() && (bytes[0] & 0x80) != 0;
  Wide value = negative ? ~Wide{0} : Wide{0};
  for (const char b : bytes) value = value << 8 | static_cast<std::uint8_t>(b);
  return decimal(negative, negative ? Wide{0} - value : value, kind.scale);
}

template <class T>
std::string shortest(std::string_view bytes) {
  T value = 0;
  std::memcpy(&value, bytes.data(), sizeof value);
  char text[64];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string fixed(std::string_view bytes, const ColumnKind& kind) {
  switch (kind.type) {
  case real:
    return shortest<double>(bytes);
  case single:
    return shortest<float>(bytes);
  case fixed_bytes:
    return wide(bytes, kind);
  default:
    return whole(Bytes(bytes).number(bytes.size()), kind);
  }
}

std::size_t width_of(const ColumnKind& kind) {
  if (kind.type == fixed_bytes) return kind.width;
  return kind.type == int32 || kind.type == single ? 4 : 8;
}

std::vector<std::string> plain_values(std::string_view bytes, const ColumnKind& kind, std::size_t count) {
  std::vector<std::string> values;
  Bytes from(bytes);
  if (kind.type == truth) {
    if (bytes.size() < (count + 7) / 8) damaged_page();
    for (std::size_t k = 0; k < count; ++k) values.emplace_back(packed(bytes, 1, k) ? "true" : "false");
    return values;
  }
  for (std::size_t k = 0; k < count; ++k)
    if (kind.type == bytes_type)
      values.emplace_back(from.take(from.number(4)));
    else
      values.push_back(fixed(from.take(width_of(kind)), kind));
  return values;
}

// Reads values whose first bytes come first, then their second bytes, and so on.
std::vector<std::string> split_values(std::string_view bytes, const ColumnKind& kind, std::size_t count) {
  const std::size_t width = width_of(kind);
  if (kind.type == bytes_type || kind.type == truth || bytes.size() / width < count) damaged_page();
  std::vector<std::string> values;
  std::string one(width, '\0');
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t b = 0; b < width; ++b) one[b] = bytes[b * count + k];
    values.push_back(fixed(one, kind));
  }
  return values;
}

// Reads blocks of differences from the number before, minus the least difference of the block (DELTA_BINARY_PACKED).
std::vector<std::uint64_t> numbers_by_differences(Bytes& from, std::size_t count) {
  const std::uint64_t block = from.varint(), parts = from.varint(), total = from.varint();
  if (total != count || block == 0 || parts == 0 || block % parts != 0 || block / parts % 8 != 0 || block > kPageRows)
    damaged_page();
  std::uint64_t last = from.zigzag();
  std::vector<std::uint64_t> numbers;
  if (count > 0) numbers.push_back(last);
  while (numbers.size() < count) {
    const std::uint64_t least = from.zigzag();
    const std::string_view widths = from.take(parts);
    for (std::size_t p = 0; p < parts && numbers.size() < count; ++p) {
      const auto bits = static_cast<std::uint8_t>(widths[p]);
      if (bits > 64) damaged_page();
      const std::string_view part = from.take(block / parts * bits / 8);
      for (std::size_t k = 0; k < block / parts && numbers.size() < count; ++k)
        numbers.push_back(last += least + packed(part, bits, k));
    }
  }
  return numbers;
}

std::vector<std::string> values_by_differences(std::string_view bytes, const ColumnKind& kind, std::size_t count) {
  if (kind.type != int32 && kind.type != int64) damaged_page();
  Bytes from(bytes);
  std::vector<std::string> values;
  for (const std::uint64_t n : numbers_by_differences(from, count)) values.push_back(whole(n, kind));
  return values;
}

// Reads the lengths of all words, then the words.
std::vector<std::string> words_by_lengths(std::string_view bytes, const ColumnKind& kind, std::size_t count) {
  if (kind.type != bytes_type) damaged_page();
  Bytes from(bytes);
  std::vector<std::string> values;
  for (const std::uint64_t n : numbers_by_differences(from, count)) values.emplace_back(from.take(n));
  return values;
}

std::vector<std::string> values_of_dictionary(std::string_view bytes, std::size_t count,
                                              const std::vector<std::string>& dictionary) {
  if (count == 0) return {};
  Bytes from(bytes);
  const auto bits = static_cast<unsigned>(from.number(1));
  std::vector<std::string> values;
  for (const std::uint32_t k : run_lengths(from.rest(), bits, count)) {
    if (k >= dictionary.size()) damaged_page();
    values.push_back(dictionary[k]);
  }
  return values;
}

}  // namespace

void damaged_page() { throw Failure({}, "a page of the Parquet file is damaged", "the file as it was written"); }

std::vector<std::uint32_t> run_lengths(std::string_view bytes, unsigned bits, std::size_t count) {
  if (bits > 32) damaged_page();
  Bytes from(bytes);
  std::vector<std::uint32_t> numbers;
  while (numbers.size() < count) {
    const std::uint64_t head = from.varint();
    const std::size_t left = count - numbers.size();
    if (head >> 1 == 0) damaged_page();
    if (head & 1) {
      // The last groups may be truncated.
      const std::size_t take = std::min<std::uint64_t>(left, (head >> 1) > left ? left : (head >> 1) * 8);
      const std::size_t size =
          std::min<std::uint64_t>((head >> 1) > left ? left * bits : (head >> 1) * bits, from.rest().size());
      const std::string_view group = from.take(size);
      if (size * 8 < take * bits) damaged_page();
      for (std::size_t k = 0; k < take; ++k) numbers.push_back(static_cast<std::uint32_t>(packed(group, bits, k)));
    } else {
      numbers.insert(numbers.end(), std::min<std::uint64_t>(left, head >> 1),
                     static_cast<std::uint32_t>(from.number((bits + 7) / 8)));
    }
  }
  return numbers;
}

std::vector<std::string> page_values(std::string_view bytes, std::int64_t encoding, const ColumnKind& kind,
                                     std::size_t count, const std::vector<std::string>& dictionary) {
  switch (static_cast<Encoded>(encoding)) {
  case Encoded::plain:
    return plain_values(bytes, kind, count);
  case Encoded::old_dictionary:
  case Encoded::dictionary:
    return values_of_dictionary(bytes, count, dictionary);
  case Encoded::runs: {
    if (kind.type != truth) damaged_page();
    Bytes from(bytes);
    std::vector<std::string> values;
    const std::string_view runs = from.take(from.number(4));
    for (const std::uint32_t v : run_lengths(runs, 1, count)) values.emplace_back(v ? "true" : "false");
    return values;
  }
  case Encoded::differences:
    return values_by_differences(bytes, kind, count);
  case Encoded::lengths:
    return words_by_lengths(bytes, kind, count);
  case Encoded::split:
    return split_values(bytes, kind, count);
  }
  throw Failure({}, "the encoding " + std::to_string(encoding) + " of a page of the Parquet file is not read here",
                "with pandas: cases.to_parquet(\"cases.parquet\"), or a CSV file");
}

}  // namespace anholon::parquet

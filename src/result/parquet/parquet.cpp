#include "result/parquet/parquet.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/assert.h"
#include "base/hash.h"
#include "base/stop.h"
#include "result/parquet/format.h"
#include "result/parquet/thrift.h"

namespace anholon {

using namespace parquet;
using thrift::Type;

void Words::add(std::string_view word) {
  // Words differ little from row to row, and there are few of them.
  if (rows.empty() || different[rows.back()] != word) {
    const auto at = std::find(different.begin(), different.end(), word);
    rows.push_back(static_cast<std::uint32_t>(at - different.begin()));
    if (at == different.end()) different.emplace_back(word);
  } else {
    rows.push_back(rows.back());
  }
}

std::size_t ParquetColumn::rows() const {
  if (const auto* words = std::get_if<Words>(&values)) return words->rows.size();
  if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&values)) return whole->size();
  return std::get<std::vector<double>>(values).size();
}

std::string_view ParquetTable::note(std::string_view name) const {
  for (const auto& [key, text] : notes)
    if (key == name) return text;
  return {};
}

namespace {

// The place of a column of a row group in the file.
struct Chunk {
  std::size_t begin = 0, data = 0, end = 0;
};

template <class T>
std::string memory_of(const std::vector<T>& numbers, std::size_t from, std::size_t to) {
  std::string out((to - from) * sizeof(T), '\0');
  if (!out.empty()) std::memcpy(out.data(), numbers.data() + from, out.size());
  return out;
}

std::string dictionary(const Words& words) {
  std::string out;
  for (const std::string& word : words.different) {
    const auto size = static_cast<std::uint32_t>(word.size());
    out.append(reinterpret_cast<const char*>(&size), sizeof size);
    out += word;
  }
  return out;
}

// Writes indices of words as runs: the bits of an index, then for each run its doubled length and the index.
std::string runs(const Words& words, std::size_t from, std::size_t to) {
  const std::size_t most = std::max<std::size_t>(words.different.size(), 2) - 1;
  const int bits = std::bit_width(most), index_bytes = (bits + 7) / 8;
  std::string out(1, static_cast<char>(bits));
  for (std::size_t k = from; k < to;) {
    std::size_t end = k + 1;
    while (end < to && words.rows[end] == words.rows[k]) ++end;
    std::uint64_t head = (end - k) << 1;
    for (; head >= 0x80; head >>= 7) out += static_cast<char>((head & 0x7f) | 0x80);
    out += static_cast<char>(head);
    out.append(reinterpret_cast<const char*>(&words.rows[k]), static_cast<std::size_t>(index_bytes));
    k = end;
  }
  return out;
}

void add_page(std::string& out, PageType type, std::size_t values, Encoding encoding, const std::string& page) {
  thrift::Writer head;
  const auto size = static_cast<std::int64_t>(page.size()), count = static_cast<std::int64_t>(values);
  head.i32(1, type).i32(2, size).i32(3, size);
  if (type == data_page)
    head.open(5).i32(1, count).i32(2, encoding).i32(3, rle).i32(4, rle).close();
  else
    head.open(7).i32(1, count).i32(2, encoding).close();
  head.close();
  out += head.text() + page;
}

Chunk add_column(std::string& out, const ParquetColumn& column, std::size_t from, std::size_t to) {
  Chunk at{out.size(), out.size(), 0};
  if (const auto* words = std::get_if<Words>(&column.values)) {
    add_page(out, dictionary_page, words->different.size(), plain, dictionary(*words));
    at.data = out.size();
    add_page(out, data_page, to - from, rle_dictionary, runs(*words, from, to));
  } else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&column.values)) {
    add_page(out, data_page, to - from, plain, memory_of(*whole, from, to));
  } else {
    add_page(out, data_page, to - from, plain, memory_of(std::get<std::vector<double>>(column.values), from, to));
  }
  at.end = out.size();
  return at;
}

PhysicalType type_of(const ParquetColumn& column) { return std::array{real, int64, bytes_type}[column.values.index()]; }

void write_schema(thrift::Writer& w, const ParquetTable& table) {
  w.list(2, Type::structure, table.columns.size() + 1);
  w.open_element().binary(4, "cases").i32(5, static_cast<std::int64_t>(table.columns.size())).close();
  for (const ParquetColumn& c : table.columns) {
    w.open_element().i32(1, type_of(c)).i32(3, kRequired).binary(4, c.name);
    if (type_of(c) == bytes_type) w.i32(6, kUtf8).open(10).open(1).close().close();
    w.close();
  }
}

void write_chunk(thrift::Writer& w, const ParquetColumn& column, const Chunk& at, std::size_t rows) {
  const auto size = static_cast<std::int64_t>(at.end - at.begin);
  w.open_element().i64(2, static_cast<std::int64_t>(at.begin)).open(3).i32(1, type_of(column));
  if (type_of(column) == bytes_type)
    w.list(2, Type::i32, 2).element(plain).element(rle_dictionary);
  else
    w.list(2, Type::i32, 1).element(plain);
  w.list(3, Type::binary, 1).element(column.name);
  w.i32(4, kUncompressed).i64(5, static_cast<std::int64_t>(rows)).i64(6, size).i64(7, size);
  w.i64(9, static_cast<std::int64_t>(at.data));
  if (at.data != at.begin) w.i64(11, static_cast<std::int64_t>(at.begin));
  w.close().close();
}

}  // namespace

std::string parquet_bytes(const ParquetTable& table) {
  const std::size_t rows = table.rows();
  for (const ParquetColumn& c : table.columns) ANHOLON_ASSERT(c.rows() == rows);
  std::string out(kMagic, kMagicSize);
  std::vector<std::size_t> begins;
  std::vector<std::vector<Chunk>> groups;
  for (std::size_t from = 0; from < rows; from += kGroupRows) {
    const std::size_t to = std::min(rows, from + kGroupRows);
    begins.push_back(from);
    groups.emplace_back();
    for (const ParquetColumn& c : table.columns) {
      look_for_stop();
      groups.back().push_back(add_column(out, c, from, to));
    }
  }
  begins.push_back(rows);

  thrift::Writer w;
  w.i32(1, kVersion);
  write_schema(w, table);
  w.i64(3, static_cast<std::int64_t>(rows)).list(4, Type::structure, groups.size());
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const std::size_t count = begins[g + 1] - begins[g];
    w.open_element().list(1, Type::structure, table.columns.size());
    for (std::size_t c = 0; c < table.columns.size(); ++c) write_chunk(w, table.columns[c], groups[g][c], count);
    w.i64(2, static_cast<std::int64_t>(groups[g].back().end - groups[g].front().begin));
    w.i64(3, static_cast<std::int64_t>(count)).close();
  }
  auto notes = table.notes;
  notes.emplace_back(kDataNote, sha256_text(out));
  w.list(5, Type::structure, notes.size());
  for (const auto& [key, text] : notes) w.open_element().binary(1, key).binary(2, text).close();
  w.binary(6, "anholon").close();

  const auto size = static_cast<std::uint32_t>(w.text().size());
  out += w.text();
  out.append(reinterpret_cast<const char*>(&size), sizeof size);
  return out.append(kMagic, kMagicSize);
}

}  // namespace anholon

#include <algorithm>
#include <cstring>

#include "base/diagnostic.h"
#include "base/hash.h"
#include "result/parquet/format.h"
#include "result/parquet/parquet.h"
#include "result/parquet/thrift.h"

namespace anholon {

using namespace parquet;
using thrift::elements;
using thrift::fields;
using thrift::Reader;
using thrift::Type;

namespace {

[[noreturn]] void damaged(const std::string& what) {
  throw Failure({Severity::error, {}, what, "the file is damaged, was changed, or was written by another program"});
}

struct Chunk {
  std::int64_t type = 0, values = 0, data = 0, dictionary = -1;
};

struct Metadata {
  std::vector<std::string> names;
  std::vector<std::int64_t> types;
  std::size_t rows = 0;
  std::vector<std::vector<Chunk>> groups;
  std::vector<std::pair<std::string, std::string>> notes;
  std::size_t begin = 0;  // in the file
};

Chunk chunk_of(Reader& r) {
  Chunk c;
  fields(r, [&](Reader::Field of_chunk) {
    if (of_chunk.number != 3 || of_chunk.type != Type::structure) return false;
    fields(r, [&](Reader::Field f) {
      switch (f.number) {
      case 1:
        c.type = r.integer();
        return true;
      case 4:
        if (r.integer() != kUncompressed) damaged("a page is compressed");
        return true;
      case 5:
        c.values = r.integer();
        return true;
      case 9:
        c.data = r.integer();
        return true;
      case 11:
        c.dictionary = r.integer();
        return true;
      default:
        return false;
      }
    });
    return true;
  });
  return c;
}

Metadata metadata_of(std::string_view bytes) {
  Metadata m;
  const std::size_t end = bytes.size() < kTail ? 0 : parquet_end(bytes.substr(bytes.size() - kTail));
  if (end == 0) damaged("this is no whole Parquet file");
  if (end > bytes.size()) damaged("the metadata of the Parquet file is damaged");
  m.begin = bytes.size() - end;
  Reader r(bytes.substr(m.begin, end - kTail));
  fields(r, [&](Reader::Field f) {
    switch (f.number) {
    case 2:
      elements(r, [&](std::size_t k) {
        std::string name;
        std::int64_t type = 0;
        fields(r, [&](Reader::Field of) {
          if (of.number == 1) return type = r.integer(), true;
          if (of.number == 4) return name = r.binary(), true;
          return false;
        });
        if (k > 0) m.names.push_back(name), m.types.push_back(type);
      });
      return true;
    case 3:
      m.rows = static_cast<std::size_t>(r.integer());
      return true;
    case 4:
      elements(r, [&](std::size_t) {
        m.groups.emplace_back();
        fields(r, [&](Reader::Field of) {
          if (of.number != 1) return false;
          elements(r, [&](std::size_t) { m.groups.back().push_back(chunk_of(r)); });
          return true;
        });
      });
      return true;
    case 5:
      elements(r, [&](std::size_t) {
        std::pair<std::string, std::string> note;
        fields(r, [&](Reader::Field of) {
          if (of.number == 1) return note.first = r.binary(), true;
          if (of.number == 2) return note.second = r.binary(), true;
          return false;
        });
        m.notes.push_back(std::move(note));
      });
      return true;
    default:
      return false;
    }
  });
  if (!r.good()) damaged("the metadata of the Parquet file is damaged");
  return m;
}

struct Page {
  std::int64_t type = 0, values = 0, encoding = 0;
  std::string_view content;
};

Page page_at(std::string_view bytes, std::int64_t at) {
  if (at < 0 || static_cast<std::size_t>(at) >= bytes.size()) damaged("a page lies outside of the Parquet file");
  const std::string_view rest = bytes.substr(static_cast<std::size_t>(at));
  Reader r(rest);
  Page page;
  std::int64_t size = 0;
  fields(r, [&](Reader::Field f) {
    if (f.number == 1) return page.type = r.integer(), true;
    if (f.number == 3) return size = r.integer(), true;
    if (f.number != 5 && f.number != 7) return false;
    fields(r, [&](Reader::Field of) {
      if (of.number == 1) return page.values = r.integer(), true;
      if (of.number == 2) return page.encoding = r.integer(), true;
      return false;
    });
    return true;
  });
  if (!r.good() || size < 0 || page.values < 0 || static_cast<std::size_t>(size) > rest.size() - r.at())
    damaged("a page of the Parquet file is damaged");
  page.content = rest.substr(r.at(), static_cast<std::size_t>(size));
  return page;
}

template <class T>
void read_numbers(std::string_view bytes, const Chunk& chunk, std::vector<T>& into) {
  const Page page = page_at(bytes, chunk.data);
  const auto count = static_cast<std::size_t>(page.values);
  if (page.type != data_page || page.encoding != plain || page.values != chunk.values ||
      page.content.size() != count * sizeof(T))
    damaged("a page of numbers is damaged");
  const std::size_t before = into.size();
  into.resize(before + count);
  if (count > 0) std::memcpy(into.data() + before, page.content.data(), page.content.size());
}

void read_dictionary(std::string_view text, std::vector<std::string>& into) {
  while (!text.empty()) {
    std::uint32_t size = 0;
    if (text.size() < sizeof size) damaged("a page of words is damaged");
    std::memcpy(&size, text.data(), sizeof size);
    text.remove_prefix(sizeof size);
    if (size > text.size()) damaged("a page of words is damaged");
    into.emplace_back(text.substr(0, size));
    text.remove_prefix(size);
  }
}

void read_words(std::string_view bytes, const Chunk& chunk, Words& into) {
  std::vector<std::string> own;
  read_dictionary(page_at(bytes, chunk.dictionary).content, own);
  const Page page = page_at(bytes, chunk.data);
  std::string_view text = page.content;
  if (page.encoding != rle_dictionary || page.values != chunk.values || text.empty())
    damaged("a page of words is damaged");
  const auto bits = static_cast<unsigned>(text[0]);
  if (bits == 0 || bits > 32) damaged("a page of words is damaged");
  const std::size_t index_bytes = (bits + 7) / 8, end = into.rows.size() + static_cast<std::size_t>(page.values);
  std::size_t at = 1;
  while (into.rows.size() < end) {
    std::uint64_t head = 0;
    for (unsigned shift = 0;; shift += 7) {
      if (at >= text.size() || shift > 56) damaged("a page of words is damaged");
      const auto b = static_cast<std::uint8_t>(text[at++]);
      head |= static_cast<std::uint64_t>(b & 0x7f) << shift;
      if (b < 0x80) break;
    }
    std::uint32_t index = 0;
    if (head & 1 || head >> 1 > end - into.rows.size() || at + index_bytes > text.size())
      damaged("a page of words is damaged");
    std::memcpy(&index, text.data() + at, index_bytes);
    at += index_bytes;
    if (index >= own.size()) damaged("a page of words is damaged");
    for (std::uint64_t k = 0; k < head >> 1; ++k) into.add(own[index]);
  }
}

}  // namespace

std::size_t parquet_end(std::string_view last) {
  std::uint32_t size = 0;
  if (last.size() != kTail || last.substr(kTail - kMagicSize) != kMagic) return 0;
  std::memcpy(&size, last.data(), sizeof size);
  return std::size_t{size} + kTail;
}

ParquetSummary parquet_summary(std::string_view end) {
  Metadata m = metadata_of(end);
  return {m.rows, std::move(m.notes)};
}

ParquetTable read_parquet(std::string_view bytes) {
  if (!bytes.starts_with(kMagic)) damaged("this is no whole Parquet file");
  Metadata m = metadata_of(bytes);
  ParquetTable table;
  table.notes = std::move(m.notes);
  if (table.note(kDataNote) != sha256_text(bytes.substr(0, m.begin)))
    damaged("the numbers of the file are not those that were written");
  std::erase_if(table.notes, [](const auto& note) { return note.first == kDataNote; });
  for (std::size_t c = 0; c < m.names.size(); ++c) {
    ParquetColumn column{m.names[c], {}};
    if (m.types[c] == int64)
      column.values = std::vector<std::int64_t>();
    else if (m.types[c] == bytes_type)
      column.values = Words();
    else if (m.types[c] != real)
      damaged("the column '" + m.names[c] + "' has another type");
    for (const std::vector<Chunk>& group : m.groups) {
      if (c >= group.size() || group[c].type != m.types[c]) damaged("a group of rows lacks a column");
      if (auto* words = std::get_if<Words>(&column.values))
        read_words(bytes, group[c], *words);
      else if (auto* whole = std::get_if<std::vector<std::int64_t>>(&column.values))
        read_numbers(bytes, group[c], *whole);
      else
        read_numbers(bytes, group[c], std::get<std::vector<double>>(column.values));
    }
    if (column.rows() != m.rows) damaged("the column '" + column.name + "' has another number of rows");
    table.columns.push_back(std::move(column));
  }
  return table;
}

}  // namespace anholon

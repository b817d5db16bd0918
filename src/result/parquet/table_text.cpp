#include "result/parquet/table_text.h"

#include <algorithm>

#include "base/diagnostic.h"
#include "base/escape.h"
#include "result/parquet/format.h"
#include "result/parquet/inflate.h"
#include "result/parquet/page_values.h"
#include "result/parquet/parquet.h"
#include "result/parquet/thrift.h"

namespace anholon {

using namespace parquet;
using thrift::elements;
using thrift::fields;
using thrift::Reader;
using thrift::Type;

namespace {

constexpr std::size_t kMostCells = 100'000'000;
constexpr std::int64_t kLargestPage = std::int64_t{1} << 30;
constexpr int kLogicalTime = 7, kLogicalTimestamp = 8, kLogicalInteger = 10;  // numbers of members of a logical type

[[noreturn]] void damaged() { throw Failure({}, "the Parquet file is damaged", "the file as it was written"); }

struct TextColumn {
  std::string name;
  ColumnKind kind;
  std::int64_t repetition = 0, children = 0;
};

struct StoredChunk {
  std::int64_t codec = 0, values = 0, begin = -1, dictionary = -1;
};

struct StoredTable {
  std::vector<TextColumn> columns;
  std::int64_t rows = 0;
  std::vector<std::vector<StoredChunk>> groups;
};

// Reads the logical type of a column, as far as it tells more than the older `converted` type.
void read_meaning(Reader& r, ColumnKind& kind) {
  fields(r, [&](Reader::Field meaning) {
    if (meaning.type != Type::structure) return false;
    // Times in nanoseconds have a logical type only.
    if (meaning.number == kLogicalTime && kind.converted < 0) kind.converted = kTimeOfDay;
    if (meaning.number == kLogicalTimestamp && kind.converted < 0) kind.converted = kTimestamp;
    if (meaning.number != kLogicalInteger) return false;
    fields(r, [&](Reader::Field f) {
      if (f.number == 2) kind.is_unsigned = f.type == Type::no;
      return f.number == 2 && (f.type == Type::no || f.type == Type::yes);
    });
    return true;
  });
}

TextColumn column_of(Reader& r) {
  TextColumn c;
  fields(r, [&](Reader::Field f) {
    switch (f.number) {
    case 1:
      return c.kind.type = r.integer(), true;
    case 2:
      return c.kind.width = static_cast<std::size_t>(std::clamp<std::int64_t>(r.integer(), 0, 1 << 20)), true;
    case 3:
      return c.repetition = r.integer(), true;
    case 4:
      return c.name = r.binary(), true;
    case 5:
      return c.children = r.integer(), true;
    case 6:
      return c.kind.converted = r.integer(), true;
    case 7:
      return c.kind.scale = r.integer(), true;
    case 10:
      return read_meaning(r, c.kind), true;
    default:
      return false;
    }
  });
  if (c.kind.converted >= kFirstUnsigned && c.kind.converted < kFirstUnsigned + 4) c.kind.is_unsigned = true;
  c.kind.optional = c.repetition == 1;
  return c;
}

StoredChunk stored_chunk(Reader& r) {
  StoredChunk c;
  fields(r, [&](Reader::Field of_chunk) {
    if (of_chunk.number != 3 || of_chunk.type != Type::structure) return false;
    fields(r, [&](Reader::Field f) {
      switch (f.number) {
      case 4:
        return c.codec = r.integer(), true;
      case 5:
        return c.values = r.integer(), true;
      case 9:
        return c.begin = r.integer(), true;
      case 11:
        return c.dictionary = r.integer(), true;
      default:
        return false;
      }
    });
    return true;
  });
  return c;
}

StoredTable stored_table(std::string_view bytes) {
  const std::size_t end = bytes.size() < kTail ? 0 : parquet_end(bytes.substr(bytes.size() - kTail));
  if (end == 0 || end > bytes.size()) damaged();
  StoredTable table;
  std::size_t more = 0;  // elements of the schema before the first one
  Reader r(bytes.substr(bytes.size() - end, end - kTail));
  fields(r, [&](Reader::Field f) {
    switch (f.number) {
    case 2:
      elements(r, [&](std::size_t) {
        TextColumn c = column_of(r);
        if (more++ > 0) table.columns.push_back(std::move(c));
      });
      return true;
    case 3:
      return table.rows = r.integer(), true;
    case 4:
      elements(r, [&](std::size_t) {
        table.groups.emplace_back();
        fields(r, [&](Reader::Field of) {
          if (of.number != 1) return false;
          elements(r, [&](std::size_t) { table.groups.back().push_back(stored_chunk(r)); });
          return true;
        });
      });
      return true;
    default:
      return false;
    }
  });
  if (!r.good() || table.rows < 0) damaged();
  return table;
}

// Names the content of a column that is neither numbers nor words; empty if it is one of these.
std::string strange(const TextColumn& c) {
  if (c.children > 0 || c.repetition > 1) return "lists or structures";
  switch (c.kind.converted) {
  case kDate:
    return "dates";
  case kTimeOfDay:
  case kTimeOfDay + 1:
    return "times of day";
  case kTimestamp:
  case kTimestamp + 1:
    return "times of the calendar";
  case kInterval:
    return "intervals of the calendar";
  default:
    break;
  }
  const bool is_decimal = c.kind.converted == kDecimal;
  if (c.kind.type == fixed_bytes) return is_decimal && c.kind.width <= 16 ? "" : "bytes";
  if (c.kind.type == bytes_type && is_decimal) return "decimals of any length";
  if (c.kind.type == old_time) return "times of the calendar";
  return c.kind.type < 0 || c.kind.type > fixed_bytes ? "values of an unknown type" : "";
}

struct StoredPage {
  std::int64_t type = 0, size = 0, stored = 0, values = 0, encoding = 0, levels = 0, repetitions = 0;
  bool compressed = true;
  std::size_t begin = 0;  // behind the header
};

StoredPage stored_page(std::string_view bytes, std::size_t at) {
  if (at >= bytes.size()) damaged();
  Reader r(bytes.substr(at));
  StoredPage page;
  fields(r, [&](Reader::Field f) {
    if (f.number == 1) return page.type = r.integer(), true;
    if (f.number == 2) return page.size = r.integer(), true;
    if (f.number == 3) return page.stored = r.integer(), true;
    if (f.number != 5 && f.number != 7 && f.number != 8) return false;
    const bool second = f.number == 8;
    fields(r, [&](Reader::Field of) {
      if (of.number == 1) return page.values = r.integer(), true;
      if (of.number == (second ? 4 : 2)) return page.encoding = r.integer(), true;
      if (!second) return false;
      if (of.number == 5) return page.levels = r.integer(), true;
      if (of.number == 6) return page.repetitions = r.integer(), true;
      if (of.number == 7) page.compressed = of.type == Type::yes;
      return of.number == 7;
    });
    return true;
  });
  page.begin = at + r.at();
  const auto left = static_cast<std::int64_t>(bytes.size() - page.begin);
  if (!r.good() || page.values < 0 || page.size < 0 || page.size > kLargestPage || page.stored < 0 ||
      page.stored > left || page.levels < 0 || page.repetitions != 0 || page.levels > std::min(page.stored, page.size))
    damaged();
  return page;
}

// Adds the cells of a page of data.
void add_cells(const StoredPage& page, std::string_view stored, const StoredChunk& chunk, const ColumnKind& kind,
               const std::vector<std::string>& dictionary, std::vector<std::string>& cells) {
  const auto count = static_cast<std::size_t>(page.values), ahead = static_cast<std::size_t>(page.levels);
  const std::string inner = inflated(stored.substr(ahead), page.compressed ? chunk.codec : std::int64_t{uncompressed},
                                     static_cast<std::size_t>(page.size) - ahead);
  std::string_view values = inner;
  std::vector<std::uint32_t> there;  // 1 for each value that is not absent
  if (kind.optional && page.type == data_page_2) {
    there = run_lengths(stored.substr(0, ahead), 1, count);
  } else if (kind.optional) {
    if (values.size() < 4) damaged();
    const std::size_t size = static_cast<std::uint8_t>(values[0]) |
                             static_cast<std::size_t>(static_cast<std::uint8_t>(values[1])) << 8 |
                             static_cast<std::size_t>(static_cast<std::uint8_t>(values[2])) << 16 |
                             static_cast<std::size_t>(static_cast<std::uint8_t>(values[3])) << 24;
    if (size > values.size() - 4) damaged();
    there = run_lengths(values.substr(4, size), 1, count);
    values.remove_prefix(4 + size);
  }
  const auto present = there.empty() ? count : static_cast<std::size_t>(std::count(there.begin(), there.end(), 1U));
  std::vector<std::string> texts = page_values(values, page.encoding, kind, present, dictionary);
  for (std::size_t k = 0, next = 0; k < count; ++k)
    cells.push_back(there.empty() || there[k] == 1 ? std::move(texts[next++]) : std::string());
}

std::vector<std::string> cells_of(std::string_view bytes, const StoredTable& table, std::size_t column) {
  const ColumnKind& kind = table.columns[column].kind;
  std::vector<std::string> cells;
  for (const std::vector<StoredChunk>& group : table.groups) {
    if (column >= group.size()) damaged();
    const StoredChunk& chunk = group[column];
    const bool has_dictionary = chunk.dictionary > 0 && chunk.dictionary < chunk.begin;
    auto at = static_cast<std::size_t>(has_dictionary ? chunk.dictionary : chunk.begin);
    if (chunk.values < 0 || chunk.values > table.rows) damaged();
    const std::size_t end = cells.size() + static_cast<std::size_t>(chunk.values);
    for (std::vector<std::string> dictionary; cells.size() < end;) {
      const StoredPage page = stored_page(bytes, at);
      const std::string_view stored = bytes.substr(page.begin, static_cast<std::size_t>(page.stored));
      at = page.begin + stored.size();
      if (page.type != data_page && page.type != data_page_2 && page.type != dictionary_page) continue;
      if (page.values > table.rows ||
          static_cast<std::size_t>(page.values) > (page.type == dictionary_page ? kMostCells : end - cells.size()))
        damaged();
      if (page.type == dictionary_page)
        dictionary = page_values(inflated(stored, chunk.codec, static_cast<std::size_t>(page.size)), 0, kind,
                                 static_cast<std::size_t>(page.values), {});
      else
        add_cells(page, stored, chunk, kind, dictionary, cells);
    }
  }
  if (cells.size() != static_cast<std::size_t>(table.rows)) damaged();
  return cells;
}

bool is_index_of_pandas(const std::string& name) { return name.starts_with("__index_level_") && name.ends_with("__"); }

}  // namespace

bool is_parquet(std::string_view bytes) { return bytes.starts_with(kMagic); }

std::string table_text_of_parquet(std::string_view bytes) {
  if (!is_parquet(bytes)) damaged();
  const StoredTable table = stored_table(bytes);
  if (table.columns.size() > 0 && static_cast<std::size_t>(table.rows) > kMostCells / table.columns.size())
    throw Failure({}, "the table has more than " + std::to_string(kMostCells) + " cells", "several tables");
  std::vector<std::vector<std::string>> columns;
  std::string text;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const std::string& name = table.columns[c].name;
    if (is_index_of_pandas(name)) continue;
    if (const std::string what = strange(table.columns[c]); !what.empty())
      throw Failure({}, "the column '" + name + "' of the table holds " + what + ", and a case takes numbers",
                    "a table without this column");
    text += (columns.empty() ? "" : ",") + csv_cell(name);
    columns.push_back(cells_of(bytes, table, c));
    for (const std::string& cell : columns.back())
      if (cell.find_first_of("\r\n") != std::string::npos)
        throw Failure({}, "a cell of the column '" + name + "' of the table has several lines",
                      "a number in each cell");
  }
  text += '\n';
  const bool lonely = columns.size() == 1;  // an absent value must not make an empty line, which is not a row
  for (std::size_t row = 0; row < static_cast<std::size_t>(table.rows) && !columns.empty(); ++row)
    for (std::size_t c = 0; c < columns.size(); ++c)
      text += (lonely && columns[c][row].empty() ? "\"\"" : csv_cell(columns[c][row])) +
              (c + 1 < columns.size() ? ',' : '\n');
  return text;
}

}  // namespace anholon

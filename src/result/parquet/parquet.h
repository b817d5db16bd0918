// Flat tables as Parquet files, and back.
//
// Columns hold doubles, whole numbers or words; none has gaps (a number that is missing is NaN). Pages are not
// compressed; numbers are stored as they are (PLAIN), words by a dictionary and runs of equal ones (RLE_DICTIONARY).
// (Apache Parquet, "File format", format version 1)
//
// The file of a table is determined by the table alone: the same numbers give the same bytes.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace anholon {

// A column of words: each row has the index of its word.
struct Words {
  std::vector<std::string> different;
  std::vector<std::uint32_t> rows;
  void add(std::string_view word);
};

struct ParquetColumn {
  std::string name;
  std::variant<std::vector<double>, std::vector<std::int64_t>, Words> values;
  std::size_t rows() const;
};

struct ParquetTable {
  std::vector<ParquetColumn> columns;  // of the same length
  // Texts by name that belong to the file. "anholon.data" is added: the SHA-256 of everything before the metadata.
  std::vector<std::pair<std::string, std::string>> notes;
  std::size_t rows() const { return columns.empty() ? 0 : columns[0].rows(); }
  // The text of a note; empty if there is none.
  std::string_view note(std::string_view name) const;
};

// The bytes of a file.
std::string parquet_bytes(const ParquetTable& table);

// Reads a file that parquet_bytes wrote. Throws Failure without a place if the text is no such file, is damaged or was
// changed.
ParquetTable read_parquet(std::string_view bytes);

// The number of rows and the notes, which are in the end of a file.
struct ParquetSummary {
  std::size_t rows = 0;
  std::vector<std::pair<std::string, std::string>> notes;
};
// The size of the end of a file, by the file's last eight bytes; 0 if the file is incomplete.
std::size_t parquet_end(std::string_view last);
// Reads the end of a file. Throws Failure as read_parquet() does.
ParquetSummary parquet_summary(std::string_view end);

}  // namespace anholon

// Reads flat tables that any program wrote as a Parquet file, as the text of a CSV file with the same cells.
//
// These are the files of pandas, pyarrow, polars, DuckDB and this program: columns of numbers, truth values and words,
// whose pages have version 1 or 2 and are plain, by a dictionary, split by bytes, or by differences. A float is written
// with the fewest digits that read back to it, an absent value as an empty cell. The unnamed index of a table of pandas
// is left out. (Apache Parquet, "File format", "Encodings")
#pragma once
#include <string>
#include <string_view>

namespace anholon {

// Throws Failure without a place if the bytes are not a whole Parquet file, if the file is damaged, or if a column has
// another kind of content, which the message names.
std::string table_text_of_parquet(std::string_view bytes);

// True if the bytes begin as Parquet files do.
bool is_parquet(std::string_view bytes);

}  // namespace anholon

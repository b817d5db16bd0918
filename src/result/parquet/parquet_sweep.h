// The cases of a sweep as a table of Parquet (doc/sweeps.md).
#pragma once
#include "result/parquet/parquet.h"
#include "result/writer.h"

namespace anholon {

// Takes the cases of a sweep into a table.
class SweepRows {
 public:
  explicit SweepRows(const std::vector<SweepColumn>& columns);
  void row(std::span<const SweepCell> cells);
  // Returns the rows so far, and empties the table.
  ParquetTable take();

 private:
  ParquetTable empty_, table_;
};

// The columns of a table that SweepRows made.
std::vector<SweepColumn> columns_of(const ParquetTable& table);

// Writes the rows of a table that SweepRows made, one by one. Throws Failure without a place if the columns differ.
void give_rows(const ParquetTable& table, const std::vector<SweepColumn>& columns, SweepWriter& to);

}  // namespace anholon

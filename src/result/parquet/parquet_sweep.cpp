#include "result/parquet/parquet_sweep.h"

#include <array>

#include "base/diagnostic.h"

namespace anholon {

using Kind = SweepColumn::Holds;

SweepRows::SweepRows(const std::vector<SweepColumn>& columns) {
  for (const SweepColumn& c : columns) {
    ParquetColumn column{c.name, {}};
    if (c.holds == Kind::whole_numbers) column.values = std::vector<std::int64_t>();
    if (c.holds == Kind::words) column.values = Words();
    empty_.columns.push_back(std::move(column));
  }
  table_ = empty_;
}

void SweepRows::row(std::span<const SweepCell> cells) {
  for (std::size_t k = 0; k < cells.size(); ++k) {
    auto& values = table_.columns[k].values;
    if (auto* numbers = std::get_if<std::vector<double>>(&values))
      numbers->push_back(cells[k].number);
    else if (auto* whole = std::get_if<std::vector<std::int64_t>>(&values))
      whole->push_back(static_cast<std::int64_t>(cells[k].number));
    else
      std::get<Words>(values).add(cells[k].word);
  }
}

ParquetTable SweepRows::take() {
  ParquetTable out = std::move(table_);
  table_ = empty_;
  return out;
}

std::vector<SweepColumn> columns_of(const ParquetTable& table) {
  std::vector<SweepColumn> list;
  for (const ParquetColumn& c : table.columns)
    list.push_back({c.name, std::array{Kind::numbers, Kind::whole_numbers, Kind::words}[c.values.index()]});
  return list;
}

void give_rows(const ParquetTable& table, const std::vector<SweepColumn>& columns, SweepWriter& to) {
  if (table.columns.size() != columns.size()) throw Failure({}, "the file has other columns than the sweep");
  std::vector<SweepCell> cells(columns.size());
  for (std::size_t row = 0; row < table.rows(); ++row) {
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const auto& values = table.columns[k].values;
      if (const auto* numbers = std::get_if<std::vector<double>>(&values))
        cells[k].number = (*numbers)[row];
      else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&values))
        cells[k].number = static_cast<double>((*whole)[row]);
      else if (const Words& w = std::get<Words>(values); true)
        cells[k].word = w.different[w.rows[row]];
    }
    to.row(cells);
  }
}

}  // namespace anholon

// Rows of a simulation as text, and sinks fed with text.
#pragma once
#include <string>
#include <vector>

#include "result/table.h"

namespace anholon::test {

// Keeps every row in its written form.
class TextRows final : public RowSink {
 public:
  void columns(const std::vector<RunColumn>& columns) override { names_ = names_of(columns); }
  void row(const Row& row) override {
    std::vector<std::string>& texts = rows_.emplace_back(row.values.size());
    for (std::size_t k = 0; k < row.values.size(); ++k) append_number(texts[k], row, k);
  }
  const std::vector<std::string>& names() const { return names_; }
  const std::vector<std::vector<std::string>>& rows() const { return rows_; }

 private:
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> rows_;
};

inline void set_columns(RowSink& sink, const std::vector<std::string>& names) {
  std::vector<RunColumn> columns(names.size());
  for (std::size_t k = 0; k < names.size(); ++k) columns[k].name = names[k];
  sink.columns(columns);
}

// Adds a row of written numbers.
inline void add_row(RowSink& sink, const std::vector<std::string>& texts) {
  std::vector<double> values(texts.size());
  for (std::size_t k = 0; k < texts.size(); ++k) parse_number(texts[k], values[k]);
  sink.row({values, texts});
}

}  // namespace anholon::test

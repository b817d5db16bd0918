// A format that is added by a file of its own and a name in the table: numbers between tabs.
#include <cstdio>

#include "base/diagnostic.h"
#include "result/file.h"
#include "result/format.h"
#include "result/table.h"

namespace anholon {

namespace {

bool looks_like_tsv(std::string_view beginning) {
  return beginning.substr(0, beginning.find('\n')).find('\t') != std::string_view::npos;
}

RunFile read_tsv(std::string_view text) {
  RunFile run;
  std::vector<std::string> cells;
  std::string cell;
  for (const char c : text) {
    if (c != '\t' && c != '\n') {
      cell += c;
      continue;
    }
    cells.push_back(std::move(cell));
    cell.clear();
    if (c == '\t') continue;
    if (run.table.columns.empty())
      run.table.set_columns(cells);
    else if (cells.size() == run.table.columns.size())
      for (std::size_t k = 0; k < cells.size(); ++k) run.table.add(k, cells[k]);
    else
      throw Failure(Span{}, "a line of another length");
    cells.clear();
  }
  return run;
}

std::string tsv(const RunTable& table) {
  std::string out;
  for (std::size_t k = 0; k < table.columns.size(); ++k) out += (k ? "\t" : "") + table.columns[k];
  for (std::size_t i = 0; i < table.rows(); ++i)
    for (std::size_t k = 0; k < table.columns.size(); ++k) out += (k ? '\t' : '\n') + table.text(i, k);
  return out + '\n';
}

std::string write_tsv(const std::string& path, const RunFile& run) {
  const std::string text = tsv(run.table);
  return write_stream(path, [&](std::FILE* to) { return std::fwrite(text.data(), 1, text.size(), to) == text.size(); });
}

class TsvWriter final : public RunWriter {
 public:
  explicit TsvWriter(const std::string& path) : path_(path) {}
  const std::string& error() const override { return error_; }
  void columns(const std::vector<RunColumn>& columns) override { rows_.columns(columns); }
  void row(const Row& row) override { rows_.row(row); }
  void flush() override {}
  std::string close(const std::string&) override { return error_ = write_tsv(path_, run_); }

 private:
  std::string path_, error_;
  RunFile run_;
  RunSink rows_{run_};
};

}  // namespace

extern const ResultFormat tsv_format;
const ResultFormat tsv_format = {
    .name = "TSV",
    .endings = {".tsv"},
    .holds = Holds::rows,
    .recognizes = looks_like_tsv,
    .read_text = read_tsv,
    .write = write_tsv,
    .open = [](const std::string& path, const RunInfo&) -> std::unique_ptr<RunWriter> {
      return std::make_unique<TsvWriter>(path);
    },
};

}  // namespace anholon

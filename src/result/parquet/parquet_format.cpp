// The row of Parquet in the table of formats.
#include <optional>

#include "base/stop.h"
#include "result/file.h"
#include "result/format.h"
#include "result/parquet/parquet_sweep.h"

namespace anholon {

namespace {

constexpr const char* kReportNote = "anholon.report";

std::string write_table(const std::string& path, const ParquetTable& table) {
  return write_whole(path, parquet_bytes(table));
}

// Makes words of numbers whose digits contain more than a double.
ParquetTable table_of(const RunFile& run) {
  ParquetTable out;
  const RunTable& t = run.table;
  for (std::size_t c = 0; c < t.columns.size(); ++c) {
    look_for_stop();
    if (t.texts[c].empty() && !t.holds_words(c)) {
      out.columns.push_back({t.columns[c], std::vector<double>(t.values[c].begin(), t.values[c].end())});
      continue;
    }
    Words words;
    for (std::size_t r = 0; r < t.rows(); ++r) words.add(t.text(r, c));
    out.columns.push_back({t.columns[c], std::move(words)});
  }
  if (!run.report.empty()) out.notes.emplace_back(kReportNote, run.report);
  return out;
}

RunFile read_run_of_parquet(std::string_view bytes) {
  const ParquetTable table = read_parquet(bytes);
  RunFile run;
  std::vector<std::string> names;
  for (const ParquetColumn& c : table.columns) names.push_back(c.name);
  run.table.set_columns(names);
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    if (const auto* numbers = std::get_if<std::vector<double>>(&table.columns[c].values))
      run.table.values.growing(c).assign(numbers->begin(), numbers->end());
    else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&table.columns[c].values))
      run.table.values.growing(c).assign(whole->begin(), whole->end());
    else
      for (const Words& w = std::get<Words>(table.columns[c].values); const std::uint32_t k : w.rows)
        run.table.add(c, w.different[k]);
  }
  run.report = table.note(kReportNote);
  return run;
}

// Keeps the rows until the end: a Parquet file has its columns one after the other.
class ParquetRunWriter final : public RunWriter {
 public:
  explicit ParquetRunWriter(const std::string& path) : path_(path), sink_(run_), error_(obstacle_to_writing(path)) {
    if (error_.empty()) error_ = claim_.emplace(path).error();
  }
  const std::string& error() const override { return error_; }
  void columns(const std::vector<RunColumn>& columns) override { sink_.columns(columns); }
  void row(const Row& row) override { sink_.row(row); }
  void flush() override {}
  std::string close(const std::string& report) override {
    if (!error_.empty()) return error_;
    run_.report = report;
    claim_.reset();  // because the function that writes takes a claim itself
    return error_ = write_table(path_, table_of(run_));
  }

 private:
  std::string path_;
  std::optional<WritingClaim> claim_;
  RunFile run_;
  RunSink sink_;
  std::string error_;
};

class ParquetSweepWriter final : public SweepWriter {
 public:
  ParquetSweepWriter(const std::string& path, const SweepInfo& info)
      : path_(path), rows_(info.columns), error_(obstacle_to_writing(path)) {
    if (error_.empty()) error_ = claim_.emplace(path).error();
  }
  const std::string& error() const override { return error_; }
  void row(std::span<const SweepCell> cells) override { rows_.row(cells); }
  std::string close(const std::string& report) override {
    if (!error_.empty()) return error_;
    ParquetTable table = rows_.take();
    table.notes.emplace_back(kReportNote, report);
    claim_.reset();
    return error_ = write_table(path_, table);
  }

 private:
  std::string path_;
  std::optional<WritingClaim> claim_;
  SweepRows rows_;
  std::string error_;
};

}  // namespace

extern const ResultFormat parquet_format;
const ResultFormat parquet_format = {
    .name = "Parquet",
    .endings = {".parquet"},
    .holds = Holds::report,
    .streams = false,
    .recognizes = [](std::string_view beginning) { return beginning.starts_with("PAR1"); },
    .read_text = read_run_of_parquet,
    .write = [](const std::string& path, const RunFile& run) { return write_table(path, table_of(run)); },
    .open = [](const std::string& path, const RunInfo&) -> std::unique_ptr<RunWriter> {
      return std::make_unique<ParquetRunWriter>(path);
    },
    .open_sweep = [](const std::string& path, const SweepInfo& info) -> std::unique_ptr<SweepWriter> {
      return std::make_unique<ParquetSweepWriter>(path, info);
    },
};

}  // namespace anholon

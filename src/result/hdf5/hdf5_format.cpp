// The row of HDF5 in the table of formats.
#include <limits>

#include "base/stop.h"
#include "result/format.h"
#include "result/hdf5/hdf5_sink.h"

namespace anholon {

namespace {

bool looks_like_hdf5(std::string_view beginning) { return beginning.substr(0, 8) == "\x89HDF\r\n\x1A\n"; }

std::string write_beside(const std::string& path, const std::string& beside, const RunFile& run) {
  const auto failed = [&](const std::string& why) { return "cannot write " + path + ": " + why; };
  if (const std::string why = create_hdf5(beside, run, run.table.columns); !why.empty()) return failed(why);
  constexpr std::size_t kBlockRows = 100'000;
  RowBlock block;
  block.columns = run.table.columns.size();
  block.steps = run.steps;
  if (!run.report.empty()) block.report = run.report;
  for (std::size_t i = 0; i == 0 || i < run.table.rows(); i += kBlockRows) {
    look_for_stop();
    const std::size_t end = std::min(run.table.rows(), i + kBlockRows);
    block.add(run.table, i, end);
    if (const std::string why = extend_hdf5(beside, block); !why.empty()) return failed(why);
    block.clear();
  }
  return {};
}

// A sweep is a file like that of a run: a cell that holds a word is NaN in /rows and stands in /text.
class Hdf5SweepWriter final : public SweepWriter {
 public:
  Hdf5SweepWriter(const std::string& path, const SweepInfo& info) : file_(path, info.origin), columns_(info.columns) {
    std::vector<RunColumn> names;
    for (const SweepColumn& c : columns_) {
      names.emplace_back().name = c.name;
      if (c.holds == SweepColumn::Holds::words) texts_.resize(names.size());
    }
    if (error().empty()) file_.columns(names);
  }
  const std::string& error() const override { return file_.error(); }
  void row(std::span<const SweepCell> cells) override {
    numbers_.resize(cells.size());
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const bool word = columns_[k].holds == SweepColumn::Holds::words;
      numbers_[k] = word ? std::numeric_limits<double>::quiet_NaN() : cells[k].number;
      if (word) texts_[k] = cells[k].word;
    }
    file_.row({numbers_, texts_});
  }
  std::string close(const std::string& report) override { return file_.close(report); }

 private:
  Hdf5Sink file_;
  std::vector<SweepColumn> columns_;
  std::vector<double> numbers_;
  std::vector<std::string> texts_;  // up to the last column of words
};

}  // namespace

extern const ResultFormat hdf5_format;
const ResultFormat hdf5_format = {
    .name = "HDF5",
    .endings = {".h5", ".hdf5"},
    .holds = Holds::everything,
    .streams = false,
    .missing = has_hdf5() ? nullptr : kNoHdf5,
    .missing_hint = "-o run.csv, or build it where libhdf5-dev is installed",
    .recognizes = looks_like_hdf5,
    .read_file = read_hdf5,
    .write =
        [](const std::string& path, const RunFile& run) {
          return write_whole_by_name(path, [&](const std::string& beside) { return write_beside(path, beside, run); });
        },
    .open = [](const std::string& path, const RunInfo& info) -> std::unique_ptr<RunWriter> {
      return std::make_unique<Hdf5Sink>(path, info);
    },
    .open_sweep = [](const std::string& path, const SweepInfo& info) -> std::unique_ptr<SweepWriter> {
      return std::make_unique<Hdf5SweepWriter>(path, info);
    },
};

}  // namespace anholon

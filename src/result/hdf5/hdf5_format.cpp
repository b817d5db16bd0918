// The row of HDF5 in the table of formats.
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
    const std::size_t end = std::min(run.table.rows(), i + kBlockRows);
    block.add(run.table, i, end);
    if (const std::string why = extend_hdf5(beside, block); !why.empty()) return failed(why);
    block.clear();
  }
  return {};
}

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
};

}  // namespace anholon

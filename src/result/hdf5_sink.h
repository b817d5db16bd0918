// Rows on their way into an HDF5 file that can be read at any moment, also after the program was killed.
//
// What has a name is never changed. A checkpoint copies the last complete file, extends the copy and renames it;
// between checkpoints rows wait in memory. The first one comes before the first row, the last with `close`.
//
// Checkpoints cost a copy of the file: they wait 20 times as long as the last one took, and at least two seconds; or
// until the rows in memory are 32 MB, and a quarter of what was written, so that all copies together stay within a few
// times the size of the result.
#pragma once
#include <chrono>
#include <optional>

#include "result/file.h"
#include "result/hdf5.h"
#include "result/rows.h"

namespace anholon {

struct CheckpointPace {
  std::size_t bytes = 32u << 20;
  double seconds = 2;
  double share = 20;  // of the time of the last checkpoint
};

class Hdf5Sink final : public RowSink {
 public:
  using Pace = CheckpointPace;
  // Check `error` before use: whether the folder can be written to is tried at once.
  Hdf5Sink(std::string path, RunInfo info, Pace pace = Pace());
  ~Hdf5Sink() override;
  Hdf5Sink(const Hdf5Sink&) = delete;
  Hdf5Sink& operator=(const Hdf5Sink&) = delete;

  // Before `columns`: the first rows and steps of a run, which the rows to come follow; left out where that has other
  // columns.
  void go_on(const RunFile& before, std::size_t rows, std::size_t steps);
  void columns(const std::vector<RunColumn>& columns) override;
  void row(const Row& row) override;
  void step(double t) override;
  // The JSON of the whole run; with it the file is complete.
  void report(std::string json) { block_.report = std::move(json); }

  // The rows so far are in the file, whatever happens to the program.
  void flush();
  // Empty, or why the file could not be written: then the last one that could be is there.
  std::string close();
  const std::string& error() const { return error_; }
  // Rows in the file that is there.
  std::size_t written() const { return written_; }

 private:
  void checkpoint();
  bool fail(const std::string& why);
  bool copy_last(const std::string& to, std::size_t room);

  std::string path_, target_, beside_, error_;
  std::optional<WritingClaim> claim_;
  RunInfo info_;
  Pace pace_;
  std::vector<std::string> names_;
  RowBlock block_;
  std::vector<std::string> names_before_;
  std::size_t written_ = 0, steps_ = 0, size_ = 0;
  int last_ = -1;  // the last complete file, also where its name was taken away
  bool begun_ = false, closed_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace anholon

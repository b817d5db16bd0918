// Writes rows to an HDF5 file that can be read at any moment, also after the program was killed.
//
// A complete file is never changed. A checkpoint copies the last complete file, extends the copy and renames it;
// between checkpoints rows wait in memory, or in the copy, which is extended before the checkpoint if there are many
// rows. The first checkpoint is before the first row, the last in `close`.
//
// Checkpoints cost a copy of the file: a checkpoint waits 20 times as long as the last one took, and at least two
// seconds; or until the rows in memory are 32 MB, and a quarter of the data written, so that all copies together stay
// within a few times the size of the result.
#pragma once
#include <chrono>
#include <optional>

#include "result/file.h"
#include "result/hdf5/hdf5.h"
#include "result/writer.h"

namespace anholon {

struct CheckpointPace {
  std::size_t bytes = 32u << 20;
  double seconds = 2;
  double share = 20;  // multiple of the time of the last checkpoint
};

class Hdf5Sink final : public RunWriter {
 public:
  using Pace = CheckpointPace;
  // Check `error` before use: the constructor tries at once to write to the folder.
  Hdf5Sink(std::string path, RunInfo info, Pace pace = Pace());
  ~Hdf5Sink() override;
  Hdf5Sink(const Hdf5Sink&) = delete;
  Hdf5Sink& operator=(const Hdf5Sink&) = delete;

  // The earlier part is omitted if it has other columns.
  void go_on(const RunFile& before, std::size_t rows, std::size_t steps) override;
  void columns(const std::vector<RunColumn>& columns) override;
  void row(const Row& row) override;
  void step(double t) override;
  void flush() override;
  // A file without a report is that of a run that was not finished. If the file cannot be written, the last complete
  // one is kept.
  std::string close(const std::string& report) override;
  const std::string& error() const override { return error_; }
  // Number of rows in the complete file.
  std::size_t written() const { return written_; }

 private:
  void checkpoint();
  bool extend();
  bool make_room(std::size_t room);
  bool fail(const std::string& why);
  bool copy_last(const std::string& to, std::size_t room);

  std::string path_, target_, beside_, error_;
  std::optional<WritingClaim> claim_;
  RunInfo info_;
  Pace pace_;
  std::vector<std::string> names_;
  RowBlock block_;
  std::vector<std::string> names_before_;
  struct {
    bool begun = false;               // the copy is made
    std::size_t rows = 0, bytes = 0;  // the rows and bytes that were added to it
  } ahead_;
  std::size_t written_ = 0, steps_ = 0, size_ = 0;
  int last_ = -1;  // the last complete file, even if its name was removed
  bool begun_ = false, closed_ = false;
  std::chrono::steady_clock::time_point next_;
};

}  // namespace anholon

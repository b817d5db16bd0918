// The rows of a run as a page needs them: in bounds of memory, in ascending times, and in pairs at jumps.
#pragma once
#include <optional>

#include "model/model.h"
#include "observe/report.h"
#include "result/run_file.h"

namespace anholon {

// Keeps a run of many steps for a page: where the rows become more numbers than a page needs, every second one is left
// out, but for the sides of jumps.
class PageSink final : public RowSink {
 public:
  static constexpr std::size_t kMostNumbers = 16'000'000;
  explicit PageSink(RunFile& run, std::size_t most_numbers = kMostNumbers) : run_(run), most_(most_numbers) {}
  void columns(const std::vector<RunColumn>& columns) override { run_.table.set_columns(names_of(columns)); }
  void row(const Row& row) override;
  void step(double t) override { run_.steps.push_back(t); }
  // After the last row, which stays.
  void finish() { keep_skipped(); }

 private:
  void keep_skipped();
  void halve();

  RunFile& run_;
  std::size_t most_;
  std::size_t every_ = 1, since_ = 0;  // one row of so many stays; rows since the last that stayed
  double last_ = 0;                    // the time of the last row
  struct Skipped {
    std::vector<double> values;
    std::vector<std::string> texts;
  };
  std::optional<Skipped> skipped_;  // the last row, if it does not stay
};

// The rows of a run with times that ascend, and with two rows at each event that changes something: where the run has none
// at the time of an event, the sides are continued from the rows before and after it. Velocities between events that
// follow each other without a row are NaN. events: of the run, in turn.
RunTable rows_for_page(const Model& model, const RunTable& table, const std::vector<EventReport>& events);

// Why rows from a file are not those of a motion of the model; empty if they may be. lines: the file has a line for each
// row, after a first one with the names.
std::string obstacle_to_showing(const Model& model, const RunTable& table, bool lines);

}  // namespace anholon

// The rows of a run as a page needs them: within bounds of memory, in ascending times, and in pairs at jumps.
#pragma once
#include <optional>

#include "model/model.h"
#include "observe/report.h"
#include "result/run_file.h"

namespace anholon {

// Keeps a run of many steps for a page: if the rows contain more numbers than a page needs, every second row is left
// out, except the sides of jumps.
class PageSink final : public RowSink {
 public:
  static constexpr std::size_t kMostNumbers = 16'000'000;
  explicit PageSink(RunFile& run, std::size_t most_numbers = kMostNumbers) : run_(run), most_(most_numbers) {}
  void columns(const std::vector<RunColumn>& columns) override { run_.table.set_columns(names_of(columns)); }
  void row(const Row& row) override;
  void step(double t) override { run_.steps.push_back(t); }
  // Call it after the last row, which stays.
  void finish() { keep_skipped(); }

 private:
  void keep_skipped();
  void halve();

  RunFile& run_;
  std::size_t most_;
  std::size_t every_ = 1, since_ = 0;  // one row of so many stays; the number of rows since the last one that stayed
  double last_ = 0;                    // the time of the last row
  struct Skipped {
    std::vector<double> values;
    std::vector<std::string> texts;
  };
  std::optional<Skipped> skipped_;  // the last row, if it does not stay
};

// Returns the rows of a run in ascending times, with two rows at each event that changes something: if the run has none
// at the time of an event, the sides are continued from the rows before and after it. Velocities between consecutive
// events without a row between them are NaN. `events`: of the run, in their order.
RunTable rows_for_page(const Model& model, const RunTable& table, const std::vector<EventReport>& events);

// Returns the reason why rows from a file cannot be those of a motion of the model; empty if they can. `lines`: the
// file has a line for each row, after a first one with the names.
std::string obstacle_to_showing(const Model& model, const RunTable& table, bool lines);

}  // namespace anholon

// Rows in doubles that a kernel computes side by side. The thread of the motion notes the times of the rows. They are
// computed, watched and written in their order; in a run with many rows, by a second thread beside the motion.
//
// The reference checks ever fewer of the rows, compares its numbers with those of the kernel, and computes the rows for
// which the kernel is not to be trusted.
#pragma once
#include <atomic>

#include "base/in_order.h"
#include "observe/floors/floor_watch.h"
#include "observe/judge.h"
#include "observe/rows/row_check.h"
#include "observe/rows/waiting_rows.h"
#include "observe/watch.h"
#include "simulation/row_writer.h"

namespace anholon {

// The objects that take the rows of a run. While rows are in work, these objects belong to the thread of the rows.
struct RowTakers {
  Watch<long double>& watch;
  Judge<double>& judge;
  std::optional<FloorWatch>& floors;
  RowWriter<double>& writer;
  SimulationReport& report;  // without its outcome
};

class KernelRows {
 public:
  // `stages`: orders beyond the leading derivatives in rows; `waiting`: computes the rows, for the parameters of the
  // motion.
  KernelRows(Workspace& scenario, const SimulationOptions& options, const Motion<double>& motion, int stages,
             std::shared_ptr<WaitingRows> waiting, const RowTakers& takers);

  // Notes a row in the last step. `judged`: it may count for the estimate of the error.
  void add(const Motion<double>& motion, long double t, const std::string& label, bool judged);
  // Notes a time of the last step at which the ranges of monitors are watched without a row.
  void look(const Motion<double>& motion, long double t);
  // Notes the end of a step, after the rows that were noted.
  void step(double end);
  // Passes on rows that have waited for too long.
  void look_at_the_time(std::chrono::steady_clock::time_point now) {
    if (work_.filling().rows.late(now)) pass_on();
  }
  // True if a row has no solution: the motion has to end.
  bool failed() const { return failed_; }
  // Waits until all noted rows are written. Returns once why a row has no solution.
  Outcome settle();
  // Sets the parameters of the motion for the rows that follow. Call it after settle().
  void set_parameters(const std::vector<long double>& parameters);
  // The kernel for the estimate of the error. Call it after settle().
  WaitingRows& waiting() { return *waiting_; }
  // Returns a warning if numbers of the kernel differ from those of the reference. Call it after settle().
  std::optional<Warning> warning() const;

 private:
  struct Block {
    explicit Block(std::size_t room) : rows(room) {}
    WaitingBlock rows;
    enum class Use : std::uint8_t { row, judged_row, look };
    std::vector<Use> uses;  // of each row
    struct StepEnd {
      double t;
      std::size_t rows;  // the rows before it in this block
    };
    std::vector<StepEnd> steps;
    std::size_t taken = 0, told = 0;  // the rows and steps that are done
  };

  void note(const Motion<double>& motion, long double t, const std::string& label, Block::Use use);
  void pass_on() { work_.pass_on(); }
  void work(Block& block);
  void tell_steps(Block& block);
  Outcome take(const WaitingRows::Computed& row, bool judged);
  void look(const WaitingRows::Computed& row);
  void compare(const WaitingRows::Computed& row);
  void count_doubtful();
  // Returns by how much each column changes with the round-off of the state.
  std::vector<double> of_round_off(const RowPlace& place, const std::vector<double>& numbers);

  const Scenario& s_;
  const SimulationOptions& o_;
  RowTakers takers_;
  std::shared_ptr<WaitingRows> waiting_;
  int stages_;
  Program program_;                // of the reference
  Expansion<long double> point_;   // the point of the reference
  std::vector<double> numbers_;    // of one row
  std::vector<long double> wide_;  // of one row by the reference
  RowCheck check_;
  RowTwice twice_;  // the row that the reference checked last
  struct Doubtful {
    RowPlace place;
    RowTwice row;
  };
  std::vector<Doubtful> doubtful_;  // rows of the block whose numbers differ
  std::size_t noted_ = 0;           // the number of rows noted
  Outcome trouble_;
  std::atomic<bool> failed_ = false;
  InOrder<Block> work_;  // the last member: its thread uses the others
};

}  // namespace anholon

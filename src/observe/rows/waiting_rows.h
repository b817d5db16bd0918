// Rows of a motion that wait in a block until they are computed side by side (row_kernel.h).
//
// The thread of the motion notes the times of rows; WaitingRows computes them, in the same thread or in another one.
#pragma once
#include <chrono>

#include "mechanics/conserved.h"
#include "motion/motion.h"
#include "observe/rows/row_kernel.h"
#include "observe/rows/row_values.h"

namespace anholon {

// Rows that wait together, in the order of time.
class WaitingBlock {
 public:
  struct Waiting {
    RowPlace place;                          // without the state if `own` has it
    std::vector<long double> own;            // the state in unknowns of the motion's kernel; may be empty
    std::shared_ptr<const KernelPlan> plan;  // the plan of that kernel
    std::string label;                       // the time as it is to be written; empty if its number is to be written
  };

  // `room`: the number of rows in a full block. Memory is allocated as rows come.
  explicit WaitingBlock(std::size_t room) : room_(room) {}

  // Adds a row at a time of the last step.
  void add(const Motion<double>& motion, long double t, const std::string& label);
  // Adds a place.
  void add(const RowPlace& place);
  bool full() const { return count_ == room_; }
  std::size_t size() const { return count_; }
  Waiting& operator[](std::size_t i) { return rows_[i]; }
  void clear() { count_ = 0; }
  // True if a row has waited for so long that a user who watches the output would miss it.
  bool late(std::chrono::steady_clock::time_point now) const {
    constexpr std::chrono::milliseconds kLate(100);
    return count_ > 0 && now - since_ > kLate;
  }

 private:
  Waiting& next() {
    if (count_ == 0) since_ = std::chrono::steady_clock::now();
    if (count_ == rows_.size()) rows_.emplace_back();
    return rows_[count_++];
  }

  std::size_t room_;
  std::vector<Waiting> rows_;  // the first count_ rows wait; the others keep their memory
  std::size_t count_ = 0;
  std::chrono::steady_clock::time_point since_;  // when the first waiting row came
};

class WaitingRows {
 public:
  // `stages`: the orders beyond the leading derivatives in rows; `rows`: about how many there will be, 0 if unknown.
  // Returns nullptr if rows need the reference.
  static std::unique_ptr<WaitingRows> make(Workspace& scenario, const std::vector<Conserved>& conserved, int stages,
                                           const std::vector<long double>& parameters, const RowPlace& start,
                                           double end, std::size_t rows = 0);

  // Sets the parameters of the motion, and its end, for the rows that follow.
  void set_parameters(const std::vector<long double>& parameters);
  void set_end(double end) { kernel_->set_end(end); }

  // A row that has been computed, in doubles; row_values() takes it as the point and as its outputs.
  class Computed {
   public:
    const RowPlace& place() const { return row_.place; }
    const std::string& label() const { return row_.label; }
    // False if the reference has to compute the row.
    bool good() const { return rows_.kernel_->good(lane_); }
    double derivative(std::size_t j, int k) const { return rows_.kernel_->derivative(j, k, lane_); }
    double multiplier(std::size_t constraint) const {
      const auto& j = rows_.multipliers_[constraint];
      return j ? derivative(*j, 0) : 0;
    }
    double reaction(std::size_t coordinate) const { return output(coordinate); }
    double monitor(std::size_t i) const { return output(rows_.expressions_.monitors[i].at); }
    double monitor_terms(std::size_t i) const { return terms(i); }
    // Sum k of the monitors and the terms of the integrals, and the magnitude of its terms, for Watch::track().
    double sum(std::size_t k) const { return output(rows_.sum(k).at); }
    double terms(std::size_t k) const {
      return RowExpressions::terms<double>(rows_.sum(k), [&](std::size_t i) { return output(i); });
    }
    // Computes the numbers of row_values(), but faster.
    void numbers(std::vector<double>& values) const;

   private:
    friend class WaitingRows;
    Computed(const WaitingRows& rows, const WaitingBlock::Waiting& row, std::size_t lane)
        : rows_(rows), row_(row), lane_(lane) {}
    double output(std::size_t i) const { return rows_.kernel_->output(i, lane_); }
    const WaitingRows& rows_;
    const WaitingBlock::Waiting& row_;
    std::size_t lane_;
  };

  std::size_t lanes() const { return kernel_->lanes(); }
  // Computes the rows of a block and calls take(computed) for each in order, until it returns false. Then the block is
  // empty.
  template <class F>
  void compute(WaitingBlock& block, F take) {
    for (std::size_t first = 0; first < block.size(); first += lanes()) {
      const std::size_t count = std::min(lanes(), block.size() - first);
      compute(block, first, count);
      for (std::size_t lane = 0; lane < count; ++lane)
        if (!take(Computed(*this, block[first + lane], lane))) return block.clear();
    }
    block.clear();
  }

 private:
  WaitingRows(const Scenario& scenario, RowExpressions expressions, std::unique_ptr<RowKernel> kernel,
              const std::vector<long double>& parameters);
  void compute(WaitingBlock& block, std::size_t first, std::size_t count);
  void convert(WaitingBlock::Waiting* rows, std::size_t count);
  const RowExpressions::Sum& sum(std::size_t k) const {
    const std::size_t monitors = expressions_.monitors.size();
    return k < monitors ? expressions_.monitors[k] : expressions_.further[k - monitors];
  }

  RowExpressions expressions_;
  std::unique_ptr<RowKernel> kernel_;
  std::vector<long double> parameters_;
  std::vector<std::optional<std::size_t>> multipliers_;  // the unknown of each constraint
  // The source of a number of a row: a derivative of an unknown, an output, or 0 for the multiplier of a redundant
  // constraint.
  struct Source {
    enum class From : std::uint8_t { derivative, output, zero } from;
    std::size_t index = 0;
    int order = 0;
  };
  std::vector<Source> sources_;
  // Converts the unknowns of the motion's kernel to the state.
  std::shared_ptr<const KernelPlan> mapped_;
  std::optional<StateReaders> readers_;
};

}  // namespace anholon

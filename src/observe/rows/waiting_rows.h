// Rows of a motion that wait until there are enough of them to be computed side by side (row_kernel.h).
#pragma once
#include <chrono>

#include "integrate/stepper.h"
#include "mechanics/conserved.h"
#include "observe/rows/row_kernel.h"
#include "observe/rows/row_values.h"

namespace anholon {

class WaitingRows {
 public:
  // `stages`: how many orders beyond the leading derivatives a row shows. Returns nullptr where rows need the reference.
  static std::unique_ptr<WaitingRows> make(Workspace& scenario, const std::vector<Conserved>& conserved, int stages,
                                           const std::vector<long double>& parameters, const RowPlace& start,
                                           double end);

  // Adds a time of the last step. `label`: the time as it is to be written.
  void add(const Stepper<double>& stepper, long double t, const std::string& label);
  bool full() const { return count_ == places_.size(); }
  // Whether a row waits for so long that somebody who looks at the output would miss it.
  bool late() const {
    constexpr std::chrono::milliseconds kLate(100);
    return count_ > 0 && std::chrono::steady_clock::now() - since_ > kLate;
  }

  // A row that has been computed, in the numbers of doubles; for row_values() a point and its outputs.
  class Computed {
   public:
    const RowPlace& place() const { return rows_.places_[lane_]; }
    const std::string& label() const { return rows_.labels_[lane_]; }
    // If not, the reference has to compute it.
    bool good() const { return rows_.kernel_->good(lane_); }
    double derivative(std::size_t j, int k) const { return rows_.kernel_->derivative(j, k, lane_); }
    double multiplier(std::size_t constraint) const {
      const auto& j = rows_.multipliers_[constraint];
      return j ? derivative(*j, 0) : 0;
    }
    double reaction(std::size_t coordinate) const { return output(coordinate); }
    double monitor(std::size_t i) const { return output(rows_.expressions_.monitors[i].at); }
    double monitor_terms(std::size_t i) const { return terms(i); }
    // Sum k of the monitors and the terms of the integrals, and the magnitude of its terms, as Watch::track() asks.
    double sum(std::size_t k) const { return output(rows_.sum(k).at); }
    double terms(std::size_t k) const {
      return RowExpressions::terms<double>(rows_.sum(k), [&](std::size_t i) { return output(i); });
    }

   private:
    friend class WaitingRows;
    Computed(const WaitingRows& rows, std::size_t lane) : rows_(rows), lane_(lane) {}
    double output(std::size_t i) const { return rows_.kernel_->output(i, lane_); }
    const WaitingRows& rows_;
    std::size_t lane_;
  };
  // Computes the rows that wait and hands them to take(computed), one after the other, until that returns false. None
  // waits afterwards.
  template <class F>
  void compute(F take) {
    if (count_ == 0) return;
    kernel_->compute({places_.data(), count_});
    const std::size_t count = std::exchange(count_, 0);
    for (std::size_t lane = 0; lane < count; ++lane)
      if (!take(Computed(*this, lane))) return;
  }

 private:
  WaitingRows(const Scenario& scenario, RowExpressions expressions, std::unique_ptr<RowKernel> kernel);
  const RowExpressions::Sum& sum(std::size_t k) const {
    const std::size_t monitors = expressions_.monitors.size();
    return k < monitors ? expressions_.monitors[k] : expressions_.further[k - monitors];
  }

  RowExpressions expressions_;
  std::unique_ptr<RowKernel> kernel_;
  std::vector<std::optional<std::size_t>> multipliers_;  // of each constraint: its unknown
  std::vector<RowPlace> places_;                         // one for each lane
  std::vector<std::string> labels_;
  std::size_t count_ = 0;                        // of rows that wait
  std::chrono::steady_clock::time_point since_;  // when the first of them came
};

}  // namespace anholon

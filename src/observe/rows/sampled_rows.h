// The rows of a run with which a second run is compared.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "numeric/number.h"

namespace anholon {

// A row of the run, and how often events had changed the state before it.
template <Number W>
struct SampledRow {
  W t{0};
  std::vector<W> values;
  std::size_t resets = 0;
  std::string label;  // the time as the user wrote it, if that is more exact
};

// The rows to be compared: all; or, if there are many, those between which the numbers change fastest, so that no short
// phase is left out.
template <Number W>
class SampledRows {
 public:
  // Adds a row. Rows that are not in the order of time are left out.
  void add(const W& t, const std::vector<W>& values, std::size_t resets, const std::string& label = {});
  void clear() { *this = {}; }
  bool empty() const { return !last_; }
  // Returns the first row, the last row and the kept rows between.
  std::vector<SampledRow<W>> take();

 private:
  static constexpr std::size_t kMost = 256;
  struct Candidate {
    SampledRow<W> row;
    double pace = 0;
  };
  double pace_to(const W& t, const std::vector<W>& values);

  std::vector<Candidate> kept_;
  std::optional<SampledRow<W>> last_;
  std::vector<double> magnitudes_;
  std::size_t stride_ = 1, in_group_ = 0;  // the number of rows of which one is kept
};

extern template class SampledRows<long double>;
extern template class SampledRows<Quad>;
extern template class SampledRows<Multi>;

}  // namespace anholon

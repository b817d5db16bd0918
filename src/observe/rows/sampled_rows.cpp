#include "observe/rows/sampled_rows.h"

#include <algorithm>
#include <cmath>

namespace anholon {

template <Number W>
void SampledRows<W>::add(const W& t, const std::vector<W>& values, std::size_t resets, const std::string& label) {
  if (last_ && kept_.size() > 1 && (kept_[1].row.t > kept_[0].row.t ? t < last_->t : t > last_->t)) return;
  const double pace = pace_to(t, values);
  last_ = SampledRow<W>{t, values, resets, label};
  if (in_group_ == 0)
    kept_.push_back({*last_, pace});
  else if (pace > kept_.back().pace)
    kept_.back() = {*last_, pace};
  in_group_ = (in_group_ + 1) % stride_;
  if (kept_.size() < kMost || in_group_ != 0) return;
  // The faster one of each two neighbours is kept, and the first row, which has no pace.
  std::vector<Candidate> fewer = {std::move(kept_[0])};
  for (std::size_t i = 1; i < kept_.size(); i += 2) {
    const std::size_t j = i + 1 < kept_.size() && kept_[i + 1].pace > kept_[i].pace ? i + 1 : i;
    fewer.push_back(std::move(kept_[j]));
  }
  kept_ = std::move(fewer);
  stride_ *= 2;
}

// The rate at which the numbers change from the last row to this one, each relative to its largest magnitude so far.
template <Number W>
double SampledRows<W>::pace_to(const W& t, const std::vector<W>& values) {
  magnitudes_.resize(values.size(), 0);
  double pace = 0;
  const double dt = last_ ? std::abs(to_double(W(t - last_->t))) : 0;
  for (std::size_t j = 0; j < values.size(); ++j) {
    magnitudes_[j] = std::max(magnitudes_[j], std::abs(to_double(values[j])));
    if (!(dt > 0) || !(magnitudes_[j] > 0)) continue;
    pace = std::max(pace, std::abs(to_double(W(values[j] - last_->values[j]))) / magnitudes_[j] / dt);
  }
  return pace;
}

template <Number W>
std::vector<SampledRow<W>> SampledRows<W>::take() {
  std::vector<SampledRow<W>> rows;
  for (Candidate& c : kept_) rows.push_back(std::move(c.row));
  if (last_ && !(rows.back().t == last_->t)) rows.push_back(std::move(*last_));
  clear();
  return rows;
}

template class SampledRows<long double>;
template class SampledRows<Quad>;
template class SampledRows<Multi>;

}  // namespace anholon

#include "observe/rows/row_check.h"

#include <algorithm>
#include <cmath>

namespace anholon {

// Half of the digits of a double: elimination in doubles may lose some digits, but with the large pivots of a trusted
// kernel not as many.
static constexpr double kNotRoundoff = 0x1p-26;
// Differences up to this many round-offs of 1, or of a number, are noise.
static constexpr double kNoiseOfDoubles = 64 * 0x1p-53;

// Differences up to this many times the effect of one round-off of the state come from a state in doubles.
static constexpr double kRoundoffsOfState = 64;

static ColumnKind group(ColumnKind kind) {
  switch (kind) {
  case ColumnKind::acceleration:
  case ColumnKind::higher_derivative:
  case ColumnKind::multiplier:
  case ColumnKind::multiplier_rate:
  case ColumnKind::input:
  case ColumnKind::reaction:
    return ColumnKind::acceleration;
  case ColumnKind::time:
  case ColumnKind::coordinate:
  case ColumnKind::velocity:
  case ColumnKind::state:
  case ColumnKind::monitor:
  case ColumnKind::event_time:
    return kind;
  }
  return kind;
}

// The difference relative to the measure of the column; 0 if it is noise of doubles.
double RowCheck::difference(const RowTwice& row, std::size_t column) const {
  const double written = row.written[column];
  const long double solved = row.solved[column];
  // A monitor may have no value.
  if (!std::isfinite(written) && !std::isfinite(solved)) return 0;
  const ColumnKind kind = group(columns_[column].kind);
  const double missed = static_cast<double>(std::abs(written - solved));
  const auto greatest = greatest_.find(kind);
  double scale = greatest == greatest_.end() ? 0 : greatest->second;
  if (columns_[column].kind == ColumnKind::monitor) scale = std::max(scale, row.made_of[columns_[column].index]);
  if (kind == ColumnKind::acceleration) scale *= std::max(1.0, row.cancellation);
  if (missed <= kNoiseOfDoubles * std::max(1.0, scale)) return 0;
  return scale > 0 ? missed / scale : std::numeric_limits<double>::infinity();
}

bool RowCheck::doubts(const RowTwice& row) {
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    double& greatest = greatest_[group(columns_[j].kind)];
    greatest = std::max(greatest, std::abs(static_cast<double>(row.solved[j])));
  }
  for (std::size_t j = 0; j < columns_.size(); ++j)
    // The condition is also true for NaN.
    if (!(difference(row, j) <= kNotRoundoff)) return true;
  return false;
}

void RowCheck::count(const RowTwice& row, const std::vector<double>& of_state) {
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    const double missed = static_cast<double>(std::abs(row.written[j] - row.solved[j]));
    if (!of_state.empty() && (std::isinf(of_state[j]) || missed <= kRoundoffsOfState * of_state[j])) continue;
    const double found = difference(row, j);
    if (!(found <= worst_.difference)) worst_ = {found, row.t, j};
  }
}

std::optional<RowDifference> RowCheck::found() const {
  if (worst_.difference <= kNotRoundoff) return std::nullopt;
  return RowDifference{columns_[worst_.column].name, worst_.difference, worst_.t};
}

}  // namespace anholon

#include "observe/rows/row_check.h"

#include <algorithm>
#include <cmath>

namespace anholon {

// Half of the digits of a double: elimination in doubles may lose some, a kernel whose pivots are large not as many.
static constexpr double kNotRoundoff = 0x1p-26;
// Differences up to this many round-offs of 1, or of a number, are noise.
static constexpr double kNoiseOfDoubles = 64 * 0x1p-53;

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

void RowCheck::learn(const std::vector<long double>& solved) {
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    double& greatest = greatest_[group(columns_[j].kind)];
    greatest = std::max(greatest, std::abs(static_cast<double>(solved[j])));
  }
}

void RowCheck::compare(double t, std::size_t column, double written, long double solved, double cancellation,
                       double own) {
  // A monitor may have no value.
  if (!std::isfinite(written) && !std::isfinite(solved)) return;
  const ColumnKind kind = group(columns_[column].kind);
  const double missed = static_cast<double>(std::abs(written - solved));
  double scale = std::max(greatest_[kind], own);
  if (kind == ColumnKind::acceleration) scale *= std::max(1.0, cancellation);
  if (missed <= kNoiseOfDoubles * std::max(1.0, scale)) return;
  const double difference = scale > 0 ? missed / scale : std::numeric_limits<double>::infinity();
  // So that a NaN is a difference, too.
  if (!(difference <= worst_.difference)) worst_ = {difference, t, column};
}

std::optional<RowDifference> RowCheck::found() const {
  if (worst_.difference <= kNotRoundoff) return std::nullopt;
  return RowDifference{columns_[worst_.column].name, worst_.difference, worst_.t};
}

}  // namespace anholon

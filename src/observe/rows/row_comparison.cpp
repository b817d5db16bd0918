#include "observe/rows/row_comparison.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace anholon {

namespace {

// A column whose relative difference is at least this may be zero up to round-off.
constexpr double kHardlyKnown = 0.1;
// Differences up to kNoise round-offs, and up to kLikeOthers times the error of other columns, are noise.
constexpr double kNoise = 64, kLikeOthers = 10;
// Numbers of two runs are the same if their relative difference is at most this.
constexpr double kSame = 0x1p-50;

double number(double x) { return std::isnan(x) ? std::numeric_limits<double>::infinity() : x; }

// The number of digits; it is also right for an error that is zero.
int digits_of(double error) {
  return error < 1 ? static_cast<int>(std::floor(-std::log10(std::max(error, std::numeric_limits<double>::min())))) : 0;
}

// These columns are all zero in a motion without constraints.
bool of_constraints(ColumnKind kind) {
  return kind == ColumnKind::multiplier || kind == ColumnKind::multiplier_rate || kind == ColumnKind::input ||
         kind == ColumnKind::reaction;
}

bool of_motion(ColumnKind kind) {
  return kind == ColumnKind::coordinate || kind == ColumnKind::velocity || kind == ColumnKind::state;
}

}  // namespace

const KindError& ErrorReport::worst() const {
  return *std::max_element(kinds.begin(), kinds.end(),
                           [](const KindError& a, const KindError& b) { return a.error < b.error; });
}

void ErrorReport::take_worse(const ErrorReport& other) {
  for (const KindError& e : other.kinds) {
    const auto mine = std::find_if(kinds.begin(), kinds.end(), [&](const KindError& k) { return k.kind == e.kind; });
    if (mine == kinds.end())
      kinds.push_back(e);
    else if (e.error > mine->error)
      *mine = e;
  }
  if (other.lost && (!lost || *other.lost < *lost)) lost = other.lost, lost_of = other.lost_of;
  if (other.until && (!until || *other.until < *until)) until = other.until, stopped = other.stopped;
}

void RowComparison::see(Row row) {
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    row.differences[j] = number(row.differences[j]);
    most_[j] = std::max(most_[j], row.magnitudes[j]);
    terms_[j] = std::max({terms_[j], row.magnitudes[j], row.terms[j]});
  }
  rows_.push_back(std::move(row));
}

void RowComparison::event(const std::string& name, double t, double difference) {
  events_.push_back({name, t, number(difference)});
}

void RowComparison::lose(double t) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  rows_.push_back({t, std::vector<double>(columns_.size(), kAll), {}, {}});
}

// True if the numbers of a kind are small from the start on, not zero up to round-off: both runs begin with the same
// numbers.
bool RowComparison::begins_small(ColumnKind kind) const {
  if (rows_.empty() || !of_motion(kind)) return false;
  const Row& first = rows_.front();
  for (std::size_t j = 0; j < columns_.size(); ++j)
    if (columns_[j].kind == kind && first.magnitudes[j] > 0 && first.differences[j] <= kSame * first.magnitudes[j])
      return true;
  return false;
}

// The measures of the columns' differences.
std::vector<double> RowComparison::scales() const {
  const std::size_t n = columns_.size();
  std::vector<double> difference(n, 0.0), scales = most_;
  for (const Row& r : rows_)
    for (std::size_t j = 0; j < n; ++j) difference[j] = std::max(difference[j], r.differences[j]);
  std::map<ColumnKind, double> greatest;
  double others = std::max(tolerance_, kNoise * roundoff_);
  for (std::size_t j = 0; j < n; ++j) {
    double& most = greatest[columns_[j].kind];
    most = std::max(most, most_[j]);
    if (difference[j] < kHardlyKnown * most_[j]) others = std::max(others, difference[j] / most_[j]);
  }
  for (std::size_t j = 0; j < n; ++j) {
    const bool monitor = columns_[j].kind == ColumnKind::monitor;
    const double like = monitor ? terms_[j] : greatest[columns_[j].kind],
                 noise = kNoise * roundoff_ * std::max(1.0, like);
    if (most_[j] <= noise && difference[j] <= noise)
      scales[j] = like > 0 && like <= noise && begins_small(columns_[j].kind) ? like : std::max(1.0, like);
    else if (difference[j] >= kHardlyKnown * most_[j] && difference[j] <= kLikeOthers * others * like)
      scales[j] = like;
  }
  return scales;
}

ErrorReport RowComparison::report(double safety, double written) const {
  ErrorReport r;
  const std::vector<double> scale = scales();
  const auto kind = [&](ColumnKind k) -> KindError& {
    for (KindError& e : r.kinds)
      if (e.kind == k) return e;
    r.kinds.push_back({k, 0, 0, {}, rows_.empty() ? 0 : rows_.back().t});
    return r.kinds.back();
  };
  const auto worse = [](KindError& e, double error, const std::string& of, double t) {
    if (e.of.empty() || error > e.error) e.error = error, e.of = of, e.t = t;
  };
  const auto relative = [](double difference, double by) {
    return difference == 0 ? 0 : by > 0 ? difference / by : std::numeric_limits<double>::infinity();
  };
  for (std::size_t j = 0; j < columns_.size(); ++j) {
    if (of_constraints(columns_[j].kind) && !(terms_[j] > 0) &&
        std::all_of(rows_.begin(), rows_.end(), [&](const Row& row) { return row.differences[j] == 0; }))
      continue;
    KindError& e = kind(columns_[j].kind);
    for (const Row& row : rows_) worse(e, relative(row.differences[j], scale[j]), columns_[j].name, row.t);
  }
  double latest = 0;
  for (const Moment& m : events_) latest = std::max(latest, std::abs(m.t));
  for (const Moment& m : events_) worse(kind(ColumnKind::event_time), relative(m.difference, latest), m.name, m.t);
  for (KindError& e : r.kinds) e.error = safety * e.error + written, e.digits = digits_of(e.error);
  for (const Row& row : rows_) {
    for (std::size_t j = 0; j < columns_.size() && !r.lost; ++j)
      if (of_motion(columns_[j].kind) && row.differences[j] > 0 && kind(columns_[j].kind).digits == 0 &&
          safety * relative(row.differences[j], scale[j]) >= kHardlyKnown)
        r.lost = row.t, r.lost_of = columns_[j].name;
  }
  return r;
}

}  // namespace anholon

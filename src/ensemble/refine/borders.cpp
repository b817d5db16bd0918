#include "ensemble/refine/borders.h"

#include <algorithm>

#include "base/assert.h"
#include "base/diagnostic.h"

namespace anholon {

Borders::Borders(const std::vector<std::size_t>& axes) : size_(axes.begin(), axes.end()) {
  for (std::size_t axis = 0; axis < axes.size(); ++axis)
    if (axes[axis] > 1) wide_.push_back(axis);
  count_keys();
  const std::size_t points = axes.empty() ? 0 : stride_[0] * axes[0];
  pending_.resize(points);
  for (std::size_t k = 0; k < points; ++k) pending_[k] = k;
  if (wide_.empty()) return;
  for (Key key = 0; key < points; ++key) {
    const std::vector<std::int64_t> at = places(key);
    if (std::any_of(wide_.begin(), wide_.end(),
                    [&](std::size_t axis) { return static_cast<std::uint64_t>(at[axis]) + 1 == size_[axis]; }))
      continue;
    // Axes of one point have the place 0.
    for (const std::size_t axis : wide_) cells_.push_back(at[axis]);
    cells_.push_back(1);
  }
}

void Borders::count_keys() {
  constexpr std::uint64_t kMost = std::uint64_t{1} << 62;
  stride_.assign(size_.size(), 1);
  std::uint64_t all = 1;
  for (std::size_t axis = size_.size(); axis-- > 0;) {
    stride_[axis] = all;
    if (size_[axis] > kMost / all)
      throw Failure({}, "the refined grid would have more than 2^62 points",
                    "fewer generations (--refine), or fewer values along an axis");
    all *= size_[axis];
  }
}

std::vector<std::int64_t> Borders::places(Key key) const {
  std::vector<std::int64_t> at(size_.size());
  for (std::size_t axis = 0; axis < size_.size(); ++axis)
    at[axis] = static_cast<std::int64_t>(key / stride_[axis]), key %= stride_[axis];
  return at;
}

void Borders::see(const std::vector<Sight>& sights) {
  ANHOLON_ASSERT(sights.size() == pending_.size());
  std::vector<Known> all;
  all.reserve(known_.size() + sights.size());
  auto before = known_.begin();
  for (std::size_t k = 0; k < sights.size(); ++k) {
    while (before != known_.end() && before->key < pending_[k]) all.push_back(*before++);
    all.push_back({pending_[k], sights[k]});
  }
  all.insert(all.end(), before, known_.end());
  known_ = std::move(all);
  pending_.clear();
}

// The order of the points does not change: all places are doubled.
void Borders::refine_units() {
  const std::vector<Key> before = stride_;
  for (const std::size_t axis : wide_) size_[axis] = 2 * size_[axis] - 1;
  count_keys();
  for (Known& k : known_) {
    Key rest = k.key, key = 0;
    for (std::size_t axis = 0; axis < size_.size(); ++axis)
      key += 2 * (rest / before[axis]) * stride_[axis], rest %= before[axis];
    k.key = key;
  }
  for (std::int64_t& place : cells_) place *= 2;
}

const Sight* Borders::find(Key key) const {
  const auto at = std::lower_bound(known_.begin(), known_.end(), key, [](const Known& k, Key v) { return k.key < v; });
  return at != known_.end() && at->key == key ? &at->sight : nullptr;
}

bool Borders::differ_along(Key from, Key step, std::int64_t length, const Differ& differ) const {
  const Key to = from + step * static_cast<Key>(length);
  if (differ(*find(from), *find(to))) return true;
  if (length < 2) return false;
  const std::int64_t half = length / 2;
  const Key middle = from + step * static_cast<Key>(half);
  return find(middle) && (differ_along(from, step, half, differ) || differ_along(middle, step, half, differ));
}

bool Borders::at_border(const std::int64_t* cell, const Differ& differ) const {
  const std::size_t d = wide_.size();
  const std::int64_t width = cell[d];
  for (std::size_t along = 0; along < d; ++along)
    // Each edge begins in a corner that has the least place along it.
    for (std::size_t corner = 0; corner < std::size_t{1} << d; ++corner) {
      if (corner >> along & 1U) continue;
      Key key = 0;
      for (std::size_t k = 0; k < d; ++k)
        key += static_cast<Key>(cell[k] + (corner >> k & 1U ? width : 0)) * stride_[wide_[k]];
      if (differ_along(key, stride_[wide_[along]], width, differ)) return true;
    }
  return false;
}

// Appends the halves of a cell, and the points at their corners.
void Borders::halve(const std::int64_t* cell, std::vector<std::int64_t>& cells, std::vector<Key>& points) const {
  const std::size_t d = wide_.size();
  const std::int64_t half = cell[d] / 2;
  std::size_t lattice = 1;
  for (std::size_t k = 0; k < d; ++k) lattice *= 3;
  for (std::size_t n = 0; n < lattice; ++n) {
    Key key = 0;
    bool least = true;  // a half begins here
    for (std::size_t k = 0, rest = n; k < d; ++k, rest /= 3) {
      key += static_cast<Key>(cell[k] + half * static_cast<std::int64_t>(rest % 3)) * stride_[wide_[k]];
      least = least && rest % 3 < 2;
    }
    points.push_back(key);
    if (!least) continue;
    for (std::size_t k = 0, rest = n; k < d; ++k, rest /= 3)
      cells.push_back(cell[k] + half * static_cast<std::int64_t>(rest % 3));
    cells.push_back(half);
  }
}

std::vector<std::int64_t> Borders::next(const Differ& differ) {
  ANHOLON_ASSERT(pending_.empty());
  refine_units();
  std::vector<std::int64_t> cells;
  std::vector<Key> points;
  const std::size_t entries = wide_.size() + 1;
  for (std::size_t k = 0; k < cells_.size(); k += entries) {
    const std::int64_t* cell = cells_.data() + k;
    if (at_border(cell, differ))
      halve(cell, cells, points);
    else
      cells.insert(cells.end(), cell, cell + entries);
  }
  cells_ = std::move(cells);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  std::erase_if(points, [&](Key key) { return find(key) != nullptr; });
  pending_ = std::move(points);
  std::vector<std::int64_t> all;
  for (const Key key : pending_) {
    const std::vector<std::int64_t> at = places(key);
    all.insert(all.end(), at.begin(), at.end());
  }
  return all;
}

}  // namespace anholon

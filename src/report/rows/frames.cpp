#include "report/rows/frames.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/stop.h"

namespace anholon {

namespace {

// A column that changes by less than the part kRest of its range is at rest. Round-off is the part kOwnRoundOff of the
// column's own magnitude, and the part kRoundOff of the greatest magnitude of all columns.
constexpr double kRest = 1e-3, kOwnRoundOff = 1e-14, kRoundOff = 1e-15;

// The degree of continuity of the interpolation: the number of derivatives that exist and are finite at both ends.
int derivatives(const MovingColumn& c, std::size_t i, std::size_t j) {
  const auto there = [&](std::span<const double> d) {
    return !d.empty() && std::isfinite(d[i]) && std::isfinite(d[j]);
  };
  return !there(c.first) ? 0 : there(c.second) ? 2 : 1;
}

// The changes of a column that are no motion: those at which it is at rest, and round-off.
struct Negligible {
  double change = 0, round_off = 0;
};

std::vector<Negligible> negligible(const std::vector<MovingColumn>& columns) {
  std::vector<Negligible> list;
  double greatest_of_all = 0;
  for (const MovingColumn& c : columns) {
    double least = INFINITY, greatest = -INFINITY;
    for (const double x : c.value)
      if (std::isfinite(x)) least = std::min(least, x), greatest = std::max(greatest, x);
    const bool any = least <= greatest;
    const double magnitude = any ? std::max(std::abs(least), std::abs(greatest)) : 0;
    list.push_back({any ? kRest * (greatest - least) : 0, kOwnRoundOff * magnitude});
    greatest_of_all = std::max(greatest_of_all, magnitude);
  }
  for (Negligible& n : list) n.round_off += kRoundOff * greatest_of_all;
  return list;
}

double change(std::span<const double> x, std::size_t i, std::size_t j) {
  const auto [least, greatest] =
      std::minmax_element(x.begin() + static_cast<std::ptrdiff_t>(i), x.begin() + static_cast<std::ptrdiff_t>(j) + 1);
  return *greatest - *least;
}

class Chooser {
 public:
  Chooser(std::span<const double> t, const std::vector<MovingColumn>& columns)
      : t_(t), columns_(columns), negligible_(negligible(columns)) {}

  // Returns the rows from which the others follow within `tolerance` of the columns' changes; stops at more than
  // `most`.
  std::vector<std::size_t> choose(double tolerance, std::size_t most) const {
    constexpr std::size_t kFurthest = 32;
    std::vector<std::size_t> rows = {0};
    for (std::size_t i = 0; i + 1 < t_.size() && rows.size() <= most;) {
      look_for_stop();
      std::size_t j = i + 1;
      while (j + 1 < t_.size() && j + 1 - i <= kFurthest && t_[j] < t_[j + 1] && t_[i] < t_[i + 1] &&
             come_out(i, j + 1, tolerance))
        ++j;
      rows.push_back(i = j);
    }
    return rows;
  }

 private:
  bool come_out(std::size_t i, std::size_t j, double tolerance) const {
    for (std::size_t n = 0; n < columns_.size(); ++n) {
      const MovingColumn& c = columns_[n];
      const double allowed =
          std::max(tolerance * std::max(change(c.value, i, j), negligible_[n].change), negligible_[n].round_off);
      for (std::size_t k = i + 1; k < j; ++k)
        if (!(std::abs(between_rows(c, t_, i, k, j) - c.value[k]) <= allowed)) return false;
    }
    return true;
  }

  std::span<const double> t_;
  const std::vector<MovingColumn>& columns_;
  std::vector<Negligible> negligible_;  // of each column
};

}  // namespace

double between_rows(const MovingColumn& c, std::span<const double> t, std::size_t i, std::size_t k, std::size_t j) {
  const double h = t[j] - t[i], s = (t[k] - t[i]) / h, a = c.value[i], b = c.value[j];
  const int known = derivatives(c, i, j);
  if (known == 0) return a + (b - a) * s;
  const double va = h * c.first[i], vb = h * c.first[j];
  if (known == 1) return a + s * s * (3 - 2 * s) * (b - a) + s * (1 - s) * ((1 - s) * va - s * vb);
  const double wa = h * h * c.second[i], wb = h * h * c.second[j];
  const double p = b - a - va - wa / 2, q = vb - va - wa, r = wb - wa;
  const double c3 = 10 * p - 4 * q + r / 2, c4 = -15 * p + 7 * q - r, c5 = 6 * p - 3 * q + r / 2;
  return a + s * (va + s * (wa / 2 + s * (c3 + s * (c4 + s * c5))));
}

ChosenFrames choose_frames(std::span<const double> t, const std::vector<MovingColumn>& columns, std::size_t most) {
  const Chooser chooser(t, columns);
  constexpr std::array kTolerances = {1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3};
  for (const double tolerance : kTolerances)
    if (std::vector<std::size_t> rows = chooser.choose(tolerance, most); rows.size() <= most)
      return {std::move(rows), true};
  ChosenFrames evenly{{}, false};
  for (std::size_t k = 0; k < most; ++k) evenly.rows.push_back(k * (t.size() - 1) / (most - 1));
  return evenly;
}

std::size_t doubtful_intervals(std::span<const double> t, const std::vector<MovingColumn>& columns) {
  constexpr double kWrong = 1e-2, kMostUneven = 8, kMuchRoundOff = 100;
  const std::vector<Negligible> nothing = negligible(columns);
  std::vector<bool> doubtful(t.size());
  for (std::size_t n = 0; n < columns.size(); ++n) {
    look_for_stop();
    const MovingColumn& c = columns[n];
    for (std::size_t k = 1; k + 1 < t.size(); ++k) {
      const double a = t[k] - t[k - 1], b = t[k + 1] - t[k], wide = std::max(a, b);
      const int known = derivatives(c, k - 1, k + 1);
      // A run without velocities offers only straight lines between positions.
      if (!(std::min(a, b) > wide / kMostUneven) || known == 0) continue;
      // The error at row k is a multiple of (a b)^(known + 1), the error in the middle of an interval one of
      // (wide/2)^(2 known + 2).
      const double there = std::abs(between_rows(c, t, k - 1, k, k + 1) - c.value[k]);
      const double here = there * std::pow(wide * wide / (4 * a * b), known + 1);
      const double moves = std::max(change(c.value, k - 1, k + 1), nothing[n].change);
      if (here > std::max(kWrong * moves, kMuchRoundOff * nothing[n].round_off)) doubtful[a > b ? k - 1 : k] = true;
    }
  }
  return static_cast<std::size_t>(std::count(doubtful.begin(), doubtful.end(), true));
}

std::vector<std::size_t> keep_extremes(const std::vector<double>& values, std::size_t most) {
  std::vector<std::size_t> rows;
  const std::size_t n = values.size();
  if (n <= most) {
    rows.resize(n);
    std::iota(rows.begin(), rows.end(), std::size_t{0});
    return rows;
  }
  const std::size_t stretches = std::max<std::size_t>(most / 2, 1);
  const auto add = [&](std::size_t r) {
    if (rows.empty() || rows.back() < r) rows.push_back(r);
  };
  add(0);
  for (std::size_t s = 0; s < stretches; ++s) {
    const std::size_t begin = s * n / stretches, end = (s + 1) * n / stretches;
    std::size_t least = n, greatest = n, gap = n;
    for (std::size_t r = begin; r < end; ++r) {
      if (std::isnan(values[r])) {
        gap = r;
        continue;
      }
      if (least == n || values[r] < values[least]) least = r;
      if (greatest == n || values[r] > values[greatest]) greatest = r;
    }
    std::vector<std::size_t> here;
    for (std::size_t r : {least, greatest, gap})
      if (r < n) here.push_back(r);
    std::sort(here.begin(), here.end());
    for (std::size_t r : here) add(r);
  }
  add(n - 1);
  return rows;
}

}  // namespace anholon

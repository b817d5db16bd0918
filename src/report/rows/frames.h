// Chooses the rows of a run that a page keeps: for plots the extremes; for the animation enough rows to reproduce the
// others by its interpolation (viewer/src/interpolate.ts).
#pragma once
#include <cstddef>
#include <span>
#include <vector>

namespace anholon {

// A column of the picture with its derivatives by time, at the same rows; empty if the run does not have them.
struct MovingColumn {
  std::span<const double> value, first, second;
};

// The value at row k as the animation computes it from rows i < k < j.
double between_rows(const MovingColumn& c, std::span<const double> t, std::size_t i, std::size_t k, std::size_t j);

struct ChosenFrames {
  std::vector<std::size_t> rows;  // ascending
  bool enough = true;             // the others follow from them
};
// Returns as few rows as reproduce the others, at most about `most`. Rows of equal times, the two sides of a jump, all
// stay as far as there is room.
ChosenFrames choose_frames(std::span<const double> t, const std::vector<MovingColumn>& columns, std::size_t most);

// Returns the number of intervals between neighbouring rows in which the interpolation is wrong by more than a
// hundredth of the column's change there, as far as the rows show: each row is compared with the interpolation of its
// neighbours.
std::size_t doubtful_intervals(std::span<const double> t, const std::vector<MovingColumn>& columns);

// Keeps at most about `most` of the rows: the least and the greatest of each interval, the first and the last of all,
// and every gap.
std::vector<std::size_t> keep_extremes(const std::vector<double>& values, std::size_t most);

}  // namespace anholon

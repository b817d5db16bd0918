// Ticks of an axis at round numbers.
#pragma once
#include <string>
#include <vector>

namespace anholon::plot {

struct Axis {
  double from = 0, to = 1;
  bool log = false;
  // The position of a number on the axis: 0 at the beginning, 1 at the end.
  double place(double x) const;
};

struct Ticks {
  std::vector<double> at;
  std::vector<std::string> labels;
  // Factor and offset of the labels: "×10⁻⁶ + 11.598", or empty.
  std::string note;
};

// Returns at most about `most` ticks, at least two if the axis has a length.
Ticks ticks(const Axis& axis, int most);

// Returns the axis for numbers in this range, with some margin; the numbers are finite, and positive for `log`.
Axis axis_for(double least, double greatest, bool log, bool tight);

std::string power_of_ten(int exponent);

}  // namespace anholon::plot

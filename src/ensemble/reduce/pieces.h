// A formula on a piece of a motion as a polynomial: its extremes, and interpolation of its values.
#pragma once
#include <array>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

namespace anholon {

// Returns the greatest value of sum c_k x^k, k <= degree, for x from 0 to h, h of either sign; `known` if no value is
// greater. All points where the derivative changes its sign are considered.
double greatest_on(const double* c, int degree, double h, double known);
// Returns where this polynomial has its greatest value; nullopt if no value is greater than `known`.
std::optional<double> place_above(const double* c, int degree, double h, double known);

// The value of a formula at a moment, NaN if it has none; and the magnitude of everything that the value is made of, -1
// if the motion has no solution at this moment.
struct FormulaValue {
  double value = std::numeric_limits<double>::quiet_NaN(), made_of = 0;
  bool beyond_motion() const { return made_of < 0; }
};

// Chebyshev's interpolation of a formula on [from, to], at points inside.
class Interpolation {
 public:
  static constexpr int kPoints = 13;

  Interpolation(const std::function<FormulaValue(double)>& f, double from, double to);
  // Returns the point j.
  static double point(int j, double from, double to);
  const std::array<double, kPoints>& values() const { return values_; }
  // The numbers of points without a value, and of those where the motion has no solution.
  int without_value() const { return without_value_; }
  int beyond_motion() const { return beyond_motion_; }
  double size() const { return size_; }    // the greatest magnitude of a value
  double noise() const { return noise_; }  // the round-off of the values
  double mean() const { return terms_[0]; }
  // The greatest of the last terms.
  double error() const;
  // True if the last terms are the round-off of what the formula is made of: they are much smaller than its variation, and
  // as large as those over a piece of twice the length.
  bool is_noisy(double error_of_twice) const;
  // True if the last terms are below the allowed error, or below the round-off of the values.
  bool good(double allowed) const { return without_value_ == 0 && error() <= allowed + noise_; }
  // Computes the coefficients of u^k for u from 0 to 1.
  void polynomial(std::vector<double>& c) const;

 private:
  std::array<double, kPoints> values_{}, terms_{};
  double noise_ = 0, size_ = 0;
  int without_value_ = 0, beyond_motion_ = 0;
};

}  // namespace anholon

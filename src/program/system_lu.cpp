#include "program/system_lu.h"

#include <cmath>

namespace anholon {

namespace {
// From this number of unknowns on, factors in double save more than the further passes cost.
constexpr std::size_t kMany = 128;
// The least singular value, with rows divided by their largest entry, for factors in double: a pass then gains at least
// five digits, also if the estimate is a hundred times too large and the factors have lost a digit.
constexpr double kLeastSigma = 1e-8;
// A smaller entry would lose digits in double.
constexpr double kSmallest = 1e-290;

template <Number N>
void narrow(const std::vector<N>& from, std::vector<double>& to) {
  to.resize(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) to[k] = to_double(from[k]);
}

template <Number N>
void widen(const std::vector<double>& from, std::vector<N>& to) {
  to.resize(from.size());
  for (std::size_t k = 0; k < from.size(); ++k) to[k] = N(from[k]);
}
}  // namespace

template <Number N>
bool SystemLu<N>::factor_in_double(const Matrix<N>& wide) {
  if (wide.rows < kMany) return false;
  Matrix<double> a(wide.rows, wide.cols);
  for (std::size_t k = 0; k < a.data.size(); ++k) {
    a.data[k] = to_double(wide.data[k]);
    if (wide.data[k] != N(0) && !(std::abs(a.data[k]) > kSmallest)) return false;
  }
  std::vector<double> direction;
  if (!narrow_.factor(a) || !(narrow_.smallest_singular_value(direction) > kLeastSigma)) return false;
  original_ = wide;
  return true;
}

template <Number N>
bool SystemLu<N>::factor(const Matrix<N>& a) {
  in_double_ = false;
  if constexpr (std::same_as<N, long double>) in_double_ = factor_in_double(a);
  return in_double_ || lu_.factor(a);
}

template <Number N>
void SystemLu<N>::solve_once(const std::vector<N>& b, std::vector<N>& x) const {
  if (!in_double_) return lu_.solve_once(b, x);
  narrow(b, narrow_side_);
  narrow_.solve_once(narrow_side_, narrow_solution_);
  widen(narrow_solution_, x);
}

template <Number N>
void SystemLu<N>::solve(const std::vector<N>& b, std::vector<N>& x) const {
  if (!in_double_) return lu_.solve(b, x);
  solve_once(b, x);
  const std::size_t n = b.size();
  for (int pass = 1; pass < passes(); ++pass) {
    residual_ = b;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) addmul(residual_[i], N(-original_(i, j)), x[j]);
    solve_once(residual_, correction_);
    bool changes = false;
    for (std::size_t i = 0; i < n; ++i) {
      changes = changes || !(abs(correction_[i]) <= unit_roundoff<N>() * abs(x[i]));
      x[i] += correction_[i];
    }
    if (!changes) break;
  }
}

template <Number N>
N SystemLu<N>::smallest_singular_value(std::vector<N>& direction, const Scales<N>& scales) const {
  if (!in_double_) return lu_.smallest_singular_value(direction, scales);
  narrow(direction, narrow_side_);
  Scales<double> narrow_scales;
  narrow(scales.row, narrow_scales.row), narrow(scales.column, narrow_scales.column);
  const double sigma = narrow_.smallest_singular_value(narrow_side_, narrow_scales);
  widen(narrow_side_, direction);
  return N(sigma);
}

template class SystemLu<double>;
template class SystemLu<long double>;
template class SystemLu<Quad>;
template class SystemLu<Multi>;

}  // namespace anholon

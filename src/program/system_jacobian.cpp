#include "program/system_jacobian.h"

#include <algorithm>
#include <cmath>

namespace anholon {

template <Number N>
void SystemJacobian<N>::compute(const Machine<N>& machine) {
  sensitivity_.take(machine);
  balance_.reset();
  is_sparse_ = sparse_.take(machine, sensitivity_);
  if (is_sparse_) return;
  make_room();
  sensitivity_.jacobian(machine, j_);
}

template <Number N>
bool SystemJacobian<N>::finite() const {
  return is_sparse_ || std::all_of(j_.data.begin(), j_.data.end(), [](const N& v) { return is_finite(v); });
}

template <Number N>
bool SystemJacobian<N>::factor() {
  if (!is_sparse_) return lu_.factor(j_);
  return sparse_.factor() || factor_written();
}

template <Number N>
bool SystemJacobian<N>::factor_written() {
  if (is_sparse_) {
    j_ = sparse_.matrix();
    sparse_.refuse();
    is_sparse_ = false;
    balance_.reset();
  }
  return lu_.factor(j_);
}

template <Number N>
void SystemJacobian<N>::multiply(const std::vector<N>& x, std::vector<N>& y) const {
  if (is_sparse_) return sparse_.multiply(x, y);
  y.assign(j_.rows, N(0));
  for (std::size_t i = 0; i < j_.rows; ++i)
    for (std::size_t j = 0; j < j_.cols; ++j) addmul(y[i], j_(i, j), x[j]);
}

template <Number N>
N SystemJacobian<N>::largest(std::size_t i, int level) const {
  if (is_sparse_) return N(sparse_.largest(i, level));
  N most(0);
  for (std::size_t j = 0; j < j_.cols; ++j)
    if (N v = abs(j_(i, j)); program_->d[j] >= level && v > most) most = v;
  return most;
}

namespace {

double power_of_two_near(double x) { return std::exp2(std::round(std::log2(x))); }

// Returns the median of the largest inertia in each equation, because moments of inertia can be further from 1 than
// masses. Returns 1 if there is no inertia.
template <Number N>
double unit_of_mass(const Matrix<N>& j, std::size_t coordinates) {
  std::vector<double> inertias;
  for (std::size_t i = 0; i < coordinates; ++i) {
    double largest = 0;
    for (std::size_t k = 0; k < coordinates; ++k) largest = std::max(largest, std::abs(to_double(j(i, k))));
    if (largest > 0 && std::isfinite(largest)) inertias.push_back(largest);
  }
  if (inertias.empty()) return 1;
  const auto median = inertias.begin() + static_cast<std::ptrdiff_t>(inertias.size() / 2);
  std::nth_element(inertias.begin(), median, inertias.end());
  return *median;
}

}  // namespace

// Removes units in which a multiplier or a rate is far from 1, because they say nothing about the regularity of J. A
// constraint whose coefficients are small may be about to become singular, so its multiplier keeps its unit.
template <Number N>
Scales<N> SystemJacobian<N>::scales_of_far_units() const {
  constexpr double kFar = 0x1p20, kFarther = 0x1p30;
  const std::size_t n = program_->system->coordinates, mechanical = program_->system->mechanical();
  if (is_sparse_) return {};
  const double mass = unit_of_mass(j_, n);
  const bool far_masses = n < mechanical && !(mass < kFar && mass * kFar > 1);
  std::vector<N> column(j_.cols, N(1));
  bool far = far_masses;
  for (std::size_t k = n; k < mechanical; ++k) {
    if (far_masses) column[k] = N(power_of_two_near(mass));
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i) largest = std::max(largest, std::abs(to_double(j_(i, k))));
    if (!(largest > kFarther * std::max(1.0, mass)) || !std::isfinite(largest)) continue;
    column[k] = N(power_of_two_near(mass / largest));
    far = true;
  }
  for (std::size_t z = mechanical; z < j_.cols; ++z) {
    double largest = 0;
    for (std::size_t k = 0; k < mechanical; ++k) largest = std::max(largest, std::abs(to_double(j_(z, k))));
    const double own = std::abs(to_double(j_(z, z)));
    if (!(own > 0) || !(largest > kFarther * own) || !std::isfinite(largest)) continue;
    column[z] = N(power_of_two_near(largest / own));
    far = true;
  }
  if (!far) return {};
  Scales<N> scales{std::vector<N>(j_.rows, N(0)), std::move(column)};
  for (std::size_t i = 0; i < j_.rows; ++i)
    for (std::size_t j = 0; j < j_.cols; ++j)
      scales.row[i] = std::max(scales.row[i], N(abs(N(j_(i, j) * scales.column[j]))));
  for (std::size_t j = 0; j < j_.cols; ++j) {
    N largest(0);
    for (std::size_t i = 0; i < j_.rows; ++i)
      if (scales.row[i] > N(0)) largest = std::max(largest, N(abs(N(j_(i, j) * scales.column[j] / scales.row[i]))));
    if (largest > N(0)) scales.column[j] = scales.column[j] / largest;
  }
  return scales;
}

template <Number N>
const Balance& SystemJacobian<N>::balance() const {
  if (is_sparse_) return sparse_.balance();
  if (!balance_) balance_ = balance_of(j_);
  return *balance_;
}

template class SystemJacobian<double>;
template class SystemJacobian<long double>;
template class SystemJacobian<Quad>;
template class SystemJacobian<Multi>;

}  // namespace anholon

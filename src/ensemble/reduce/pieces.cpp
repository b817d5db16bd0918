#include "ensemble/reduce/pieces.h"

#include <algorithm>
#include <cmath>

#include "integrate/series/sign_change.h"

namespace anholon {

// ---- extremes of a polynomial -----------------------------------------------------------------------------------------

namespace {

// Finds the greatest value of a polynomial on [0, 1], whose pieces are in Bernstein form.
class Highest {
 public:
  Highest(const std::vector<double>& c, double known) : c_(c), best_(known) {}

  double best() const { return best_; }
  // Returns where the greatest value is; nullopt if no value is greater than the known one.
  std::optional<double> find() {
    see(0);
    see(1);
    // The bound is the sum of what each term adds at most.
    double bound = c_[0];
    for (std::size_t k = 1; k < c_.size(); ++k) bound += std::max(c_[k], 0.0);
    if (bound > best_ && !monotonic()) search(bernstein(c_), 0, 1, kDeepest);
    return at_;
  }

 private:
  static constexpr int kDeepest = 40, kBisections = 60;

  int degree() const { return static_cast<int>(c_.size()) - 1; }
  void see(double x) {
    if (const double v = value_at(c_.data(), degree(), x); v > best_) best_ = v, at_ = x;
  }
  double slope(double x) const {
    double s = 0;
    for (int k = degree(); k >= 1; --k) s = s * x + k * c_[static_cast<std::size_t>(k)];
    return s;
  }
  // True if the first term of the derivative is larger than the sum of the others.
  bool monotonic() const {
    double others = 0;
    for (std::size_t k = 2; k < c_.size(); ++k) others += static_cast<double>(k) * std::abs(c_[k]);
    return c_.size() < 2 || std::abs(c_[1]) > others;
  }

  // The piece [from, to] lies below the greatest of its Bernstein coefficients, and its derivative has at most as many
  // zeros as their differences have changes of sign.
  void search(std::vector<double> b, double from, double to, int depth) {
    if (!(*std::max_element(b.begin(), b.end()) > best_)) return;
    int changes = 0, first = 0, sign = 0;
    for (std::size_t j = 0; j + 1 < b.size(); ++j) {
      const double d = b[j + 1] - b[j];
      const int now = (d > 0) - (d < 0);
      if (now != 0 && sign != 0 && now != sign) ++changes;
      if (now != 0) sign = now;
      if (first == 0) first = now;
    }
    see(from);
    see(to);
    if (changes == 0 || depth == 0) return;
    if (changes == 1 && first < 0) return;  // the zero of the slope is a minimum
    if (changes == 1) return see(end_of_rise(from, to));
    std::vector<double> left = b;
    for (std::size_t k = 1; k < b.size(); ++k) {
      for (std::size_t j = 0; j + k < b.size(); ++j) b[j] = (b[j] + b[j + 1]) / 2;
      left[k] = b[0];
    }
    const double middle = (from + to) / 2;
    search(std::move(left), from, middle, depth - 1);
    search(std::move(b), middle, to, depth - 1);
  }

  // Returns where the polynomial, which rises at the beginning of the piece, stops rising.
  double end_of_rise(double from, double to) const {
    for (int k = 0; k < kBisections; ++k) {
      const double middle = (from + to) / 2;
      if (middle == from || middle == to) break;
      (slope(middle) > 0 ? from : to) = middle;
    }
    return from;
  }

  const std::vector<double>& c_;
  double best_;
  std::optional<double> at_;
};

// Returns the coefficients of u^k, x = u h; none if one is not finite.
std::vector<double> over_unit(const double* c, int degree, double h) {
  std::vector<double> scaled;
  double power = 1;
  for (int k = 0; k <= degree; ++k, power *= h) {
    scaled.push_back(c[k] * power);
    if (!std::isfinite(scaled.back())) return {};
  }
  return scaled;
}

}  // namespace

double greatest_on(const double* c, int degree, double h, double known) {
  const std::vector<double> scaled = over_unit(c, degree, h);
  if (scaled.empty()) return known;
  Highest highest(scaled, known);
  (void)highest.find();
  return highest.best();
}

std::optional<double> place_above(const double* c, int degree, double h, double known) {
  const std::vector<double> scaled = over_unit(c, degree, h);
  if (scaled.empty()) return std::nullopt;
  const std::optional<double> u = Highest(scaled, known).find();
  return u ? std::optional(*u * h) : std::nullopt;
}

// ---- interpolation --------------------------------------------------------------------------------------------------

namespace {

constexpr auto kCount = static_cast<std::size_t>(Interpolation::kPoints);

// cos(k a) at the angles a of the points, by k and point.
const std::array<std::array<double, kCount>, kCount>& cosines() {
  static const auto table = [] {
    std::array<std::array<double, kCount>, kCount> all{};
    for (int k = 0; k < Interpolation::kPoints; ++k)
      for (int j = 0; j < Interpolation::kPoints; ++j)
        all[static_cast<std::size_t>(k)][static_cast<std::size_t>(j)] =
            std::cos(k * (3.14159265358979323846 * (j + 0.5) / Interpolation::kPoints));
    return all;
  }();
  return table;
}

}  // namespace

double Interpolation::point(int j, double from, double to) {
  return from + (to - from) * (1 - cosines()[1][static_cast<std::size_t>(j)]) / 2;
}

Interpolation::Interpolation(const std::function<FormulaValue(double)>& f, double from, double to) {
  constexpr int kNoise = 64;
  for (int j = 0; j < kPoints; ++j) {
    const FormulaValue v = f(point(j, from, to));
    values_[static_cast<std::size_t>(j)] = v.value;
    if (!std::isfinite(v.value)) ++without_value_;
    if (v.beyond_motion()) ++beyond_motion_;
    size_ = std::max(size_, std::abs(v.value));
    noise_ = std::max(noise_, kNoise * std::numeric_limits<double>::epsilon() * v.made_of);
  }
  for (std::size_t k = 0; k < kCount; ++k) {
    double sum = 0;
    for (std::size_t j = 0; j < kCount; ++j) sum += values_[j] * cosines()[k][j];
    terms_[k] = sum * (k == 0 ? 1 : k % 2 == 0 ? 2 : -2) / kPoints;
  }
}

double Interpolation::error() const {
  constexpr int kLast = 3;
  double most = 0;
  for (auto x = terms_.end() - kLast; x != terms_.end(); ++x) most = std::max(most, std::abs(*x));
  return most;
}

bool Interpolation::is_noisy(double error_of_twice) const {
  constexpr double kSmall = 1e-5, kFalls = 3;
  if (without_value_ > 0 || !(error_of_twice > 0)) return false;
  const auto [lowest, highest] = std::minmax_element(values_.begin(), values_.end());
  return error() < kSmall * (*highest - *lowest) && kFalls * error() > error_of_twice;
}

void Interpolation::polynomial(std::vector<double>& c) const {
  c.assign(kPoints, 0);
  std::array<double, kPoints> before{}, now{}, next{};  // T_k(2 u - 1)
  before[0] = 1, now[0] = -1, now[1] = 2;
  for (std::size_t i = 0; i < kPoints; ++i) c[i] = terms_[0] * before[i] + terms_[1] * now[i];
  for (std::size_t k = 2; k < kPoints; ++k) {
    for (std::size_t i = 0; i < kPoints; ++i)
      next[i] = 4 * (i > 0 ? now[i - 1] : 0) - 2 * now[i] - before[i], c[i] += terms_[k] * next[i];
    before = now, now = next;
  }
}

}  // namespace anholon

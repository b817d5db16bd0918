#include "numeric/enclosure.h"

#include <algorithm>

namespace anholon {

namespace {

// Gives floating-point numbers the precision of the balls.
struct SamePrecision : PrecisionScope {
  SamePrecision() : PrecisionScope(static_cast<int>(static_cast<double>(Ball::working_bits()) * 0.30103) + 1) {}
};

// Returns f'(x)^-1 at the center of the Jacobian, to the accuracy of floating point.
std::optional<Matrix<Multi>> inverse(std::size_t n, const std::vector<Ball>& jacobian) {
  Matrix<Multi> a(n, n);
  for (std::size_t i = 0; i < n * n; ++i) {
    if (!jacobian[i].is_finite()) return std::nullopt;
    a.data[i] = jacobian[i].midpoint_multi();
    if (!a.data[i].finite()) return std::nullopt;
  }
  Lu<Multi> lu;
  if (!lu.factor(a)) return std::nullopt;
  Matrix<Multi> y(n, n);
  std::vector<Multi> unit(n), column;
  for (std::size_t j = 0; j < n; ++j) {
    std::fill(unit.begin(), unit.end(), Multi(0));
    unit[j] = Multi(1);
    lu.solve(unit, column);
    for (std::size_t i = 0; i < n; ++i) {
      if (!column[i].finite()) return std::nullopt;
      y(i, j) = column[i];
    }
  }
  return y;
}

bool inside(const Box& inner, const Box& outer) {
  for (std::size_t i = 0; i < inner.size(); ++i)
    if (!inner[i].is_finite() || !outer[i].contains_inside(inner[i])) return false;
  return true;
}

Ball around(const Multi& x, const Multi& radius) {
  Ball b(x);
  const Ball r(radius);
  arb_add_error(b.raw(), r.raw());
  return b;
}

}  // namespace

std::optional<Box> krawczyk(const SquareSystem& f, const Box& box) {
  const SamePrecision precision;
  const std::size_t n = f.size;
  Box center;
  for (const Ball& x : box) center.push_back(x.center());
  const std::vector<Ball> value = f.value(center), jacobian = f.jacobian(box);
  const auto y = inverse(n, jacobian);
  if (!y) return std::nullopt;
  Box result;
  for (std::size_t i = 0; i < n; ++i) {
    Ball x = center[i];
    for (std::size_t j = 0; j < n; ++j) x -= Ball((*y)(i, j)) * value[j];
    for (std::size_t j = 0; j < n; ++j) {
      Ball entry(i == j ? 1 : 0);
      for (std::size_t k = 0; k < n; ++k) entry -= Ball((*y)(i, k)) * jacobian[k * n + j];
      x += entry * box[j].spread();
    }
    if (!x.is_finite()) return std::nullopt;
    result.push_back(std::move(x));
  }
  return result;
}

std::optional<Box> prove_root(const SquareSystem& f, const Box& box) {
  std::optional<Box> inner = krawczyk(f, box);
  if (!inner || !inside(*inner, box)) return std::nullopt;
  // A root in K(X) lies in K(K(X)) as well, and so on as long as the boxes shrink.
  for (int sweep = 0; sweep < 60; ++sweep) {
    const std::optional<Box> next = krawczyk(f, *inner);
    if (!next || !inside(*next, *inner)) break;
    inner = next;
  }
  return inner;
}

std::optional<Box> enclose_root(const SquareSystem& f, const std::vector<Multi>& approximate) {
  const SamePrecision precision;
  const std::size_t n = f.size;
  std::vector<Multi> x = approximate, step(n);
  // Newton's iteration on the centers; the last correction gives the size of the box to try.
  for (int sweep = 0; sweep < 60; ++sweep) {
    Box center;
    for (const Multi& v : x) center.emplace_back(v);
    const auto y = inverse(n, f.jacobian(center));
    if (!y) return std::nullopt;
    const std::vector<Ball> value = f.value(center);
    Multi before(0), now(0), size(0);
    for (const Multi& d : step) before = std::max(before, abs(d));
    for (std::size_t i = 0; i < n; ++i) {
      step[i] = Multi(0);
      for (std::size_t j = 0; j < n; ++j) addmul(step[i], (*y)(i, j), value[j].midpoint_multi());
      if (!step[i].finite()) return std::nullopt;
      x[i] -= step[i];
      now = std::max(now, abs(step[i]));
      size = std::max(size, abs(x[i]));
    }
    if (now <= unit_roundoff<Multi>() * (size + Multi(1)) * Multi(16)) break;
    if (sweep > 8 && now >= before) break;
  }
  Multi radius(0);
  for (std::size_t i = 0; i < n; ++i) radius = std::max({radius, abs(step[i]), abs(x[i]) * unit_roundoff<Multi>()});
  radius = std::max(radius, unit_roundoff<Multi>()) * Multi(64);
  for (int attempt = 0; attempt < 40; ++attempt, radius *= Multi(16)) {
    Box box;
    for (const Multi& v : x) box.push_back(around(v, radius));
    if (auto root = prove_root(f, box)) return root;
  }
  return std::nullopt;
}

std::optional<Box> enclose_root(const SquareSystem& f, const std::vector<long double>& approximate) {
  const SamePrecision precision;
  std::vector<Multi> x;
  for (long double v : approximate) x.emplace_back(v);
  return enclose_root(f, x);
}

}  // namespace anholon

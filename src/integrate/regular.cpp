#include "integrate/regular.h"

#include <cmath>

namespace anholon {

// A diagonal similarity by powers of 2 that brings rows and columns to like sizes (Osborne 1960): the norm of a matrix
// in badly scaled unknowns says nothing about its spectral radius.
template <Number N>
static void balance(Matrix<N>& a) {
  constexpr int kSweeps = 4;
  const std::size_t n = a.rows;
  for (int sweep = 0; sweep < kSweeps; ++sweep)
    for (std::size_t i = 0; i < n; ++i) {
      double row = 0, column = 0;
      for (std::size_t j = 0; j < n; ++j)
        if (j != i) row += std::abs(to_double(a(i, j))), column += std::abs(to_double(a(j, i)));
      if (!(row > 0) || !(column > 0) || !std::isfinite(row) || !std::isfinite(column)) continue;
      const N factor(std::exp2(std::round(0.5 * std::log2(row / column))));
      for (std::size_t j = 0; j < n; ++j) a(j, i) = a(j, i) * factor;
      for (std::size_t j = 0; j < n; ++j) a(i, j) = a(i, j) / factor;
    }
}

template <Number N>
bool near(const Expansion<N>& p0, const Expansion<N>& p1) {
  constexpr double kNear = 0.5;
  const std::size_t n = p0.program().unknowns();
  Matrix<N> a(n, n);
  std::vector<N> column(n), y;
  for (std::size_t j = 0; j < n; ++j) {
    for (std::size_t i = 0; i < n; ++i) column[i] = p1.system_jacobian()(i, j) - p0.system_jacobian()(i, j);
    p0.lu().solve_once(column, y);
    for (std::size_t i = 0; i < n; ++i) a(i, j) = y[i];
  }
  balance(a);
  for (int doubling = 0; doubling < 3; ++doubling) {
    Matrix<N> square(n, n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < n; ++k)
        for (std::size_t j = 0; j < n; ++j) addmul(square(i, j), a(i, k), a(k, j));
    a = std::move(square);
  }
  double norm2 = 0;
  for (const N& v : a.data) norm2 += to_double(v) * to_double(v);
  return norm2 <= std::pow(kNear, 16);  // false for what is not a number
}

template <Number N>
Mode<N> weakest_mode(const Expansion<N>& at, const N& sigma) {
  const Matrix<N>& J = at.system_jacobian();
  const std::size_t size = J.rows, n = at.program().system->coordinates;
  Mode<N> m;
  m.sigma = sigma;
  m.v = at.weakest_direction();
  m.image.assign(size, N(0));
  m.reaction.assign(n, N(0));
  for (std::size_t i = 0; i < size; ++i) {
    N largest(0);
    for (std::size_t j = 0; j < size; ++j) {
      addmul(m.image[i], J(i, j), m.v[j]);
      if (i < n && j >= n) addmul(m.reaction[i], J(i, j), m.v[j]);
      if (N x = abs(J(i, j)); x > largest) largest = x;
    }
    if (largest > N(0)) m.image[i] = m.image[i] / largest;
  }
  return m;
}

// The cosine of the angle between parts of two vectors.
template <Number N>
static double cosine(const std::vector<N>& a, const std::vector<N>& b, std::size_t from = 0) {
  double dot = 0, aa = 0, bb = 0;
  for (std::size_t i = from; i < a.size(); ++i) {
    const double x = to_double(a[i]), y = to_double(b[i]);
    dot += x * y, aa += x * x, bb += y * y;
  }
  return aa > 0 && bb > 0 ? dot / std::sqrt(aa * bb) : 0;
}

template <Number N>
bool crossed(const Mode<N>& a, const Mode<N>& b, std::size_t coordinates) {
  constexpr double kSameDirection = 0.5;
  const auto flipped = [](double x, double y) {
    return std::abs(x) > kSameDirection && std::abs(y) > kSameDirection && x * y < 0;
  };
  return flipped(cosine(a.v, b.v), cosine(a.image, b.image)) ||
         flipped(cosine(a.v, b.v, coordinates), cosine(a.reaction, b.reaction));
}

template bool near(const Expansion<double>&, const Expansion<double>&);
template Mode<double> weakest_mode(const Expansion<double>&, const double&);
template bool crossed(const Mode<double>&, const Mode<double>&, std::size_t);
template bool near(const Expansion<long double>&, const Expansion<long double>&);
template Mode<long double> weakest_mode(const Expansion<long double>&, const long double&);
template bool crossed(const Mode<long double>&, const Mode<long double>&, std::size_t);
template bool near(const Expansion<Quad>&, const Expansion<Quad>&);
template Mode<Quad> weakest_mode(const Expansion<Quad>&, const Quad&);
template bool crossed(const Mode<Quad>&, const Mode<Quad>&, std::size_t);
template bool near(const Expansion<Multi>&, const Expansion<Multi>&);
template Mode<Multi> weakest_mode(const Expansion<Multi>&, const Multi&);
template bool crossed(const Mode<Multi>&, const Mode<Multi>&, std::size_t);

}  // namespace anholon

#include "numeric/eigen.h"

#include <algorithm>

#include <acb_mat.h>

namespace anholon {

namespace {

constexpr long kGuardBits = 40;  // bits of the working precision that the entries of A have lost
constexpr int kSpread = 64;      // eigenvalues closer together than this many times their motion count as one

Multi multi_of(const arb_t x) {
  Multi m;
  arf_get_mpfr(m.raw(), arb_midref(x), MPFR_RNDN);
  return m;
}

Multi least_change_of(const Multi& largest) {
  Multi u = largest;
  mpfr_div_2ui(u.raw(), u.raw(),
               static_cast<unsigned long>(std::max(1L, static_cast<long>(Multi::working_bits()) - kGuardBits)),
               MPFR_RNDN);
  return u;
}

Complex minus(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }

// Computes eigenvalues, and eigenvectors if `vectors` is given, in the order of the iteration.
bool solve(const Matrix<Multi>& a, std::vector<Complex>& values, std::vector<std::vector<Complex>>* vectors) {
  const auto n = static_cast<slong>(a.rows);
  const slong bits = Multi::working_bits() + 16;
  acb_mat_t m, right;
  acb_mat_init(m, n, n);
  acb_mat_init(right, n, n);
  acb_ptr e = _acb_vec_init(n);
  for (slong i = 0; i < n; ++i)
    for (slong j = 0; j < n; ++j)
      arf_set_mpfr(arb_midref(acb_realref(acb_mat_entry(m, i, j))),
                   a(static_cast<std::size_t>(i), static_cast<std::size_t>(j)).raw());
  const bool found = acb_mat_approx_eig_qr(e, nullptr, vectors ? right : nullptr, m, nullptr, 0, bits) != 0;
  values.clear();
  for (slong i = 0; i < n; ++i) values.push_back({multi_of(acb_realref(e + i)), multi_of(acb_imagref(e + i))});
  if (vectors) {
    vectors->assign(a.rows, std::vector<Complex>(a.rows));
    for (slong i = 0; i < n; ++i)
      for (slong j = 0; j < n; ++j)
        (*vectors)[static_cast<std::size_t>(j)][static_cast<std::size_t>(i)] = {
            multi_of(acb_realref(acb_mat_entry(right, i, j))), multi_of(acb_imagref(acb_mat_entry(right, i, j)))};
  }
  _acb_vec_clear(e, n);
  acb_mat_clear(right);
  acb_mat_clear(m);
  return found;
}

// Scales the vector to largest entry 1; among equally large entries the first counts.
void normalise(std::vector<Complex>& x) {
  Multi largest(0);
  for (const Complex& z : x)
    if (Multi size = modulus(z); size > largest) largest = size;
  if (!(largest > Multi(0))) return;
  for (const Complex& z : x) {
    if (modulus(z) < largest * Multi(1 - 1e-9)) continue;
    const Complex by = z;
    const Multi square = by.re * by.re + by.im * by.im;
    for (Complex& y : x) {
      const Multi re = (y.re * by.re + y.im * by.im) / square;
      y.im = (y.im * by.re - y.re * by.im) / square;
      y.re = re;
    }
    return;
  }
}

// Replaces the members of each cluster by their mean.
void gather(std::vector<Eigenvalue>& list) {
  std::vector<std::size_t> cluster(list.size());
  std::iota(cluster.begin(), cluster.end(), std::size_t{0});
  for (std::size_t i = 0; i < list.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const Multi apart = modulus(minus(list[i].value, list[j].value));
      if (apart > Multi(kSpread) * std::max(list[i].radius, list[j].radius)) continue;
      const std::size_t from = cluster[i], to = cluster[j];
      for (std::size_t& c : cluster)
        if (c == from) c = to;
    }
  for (std::size_t c = 0; c < list.size(); ++c) {
    Complex mean;
    int count = 0;
    for (std::size_t i = 0; i < list.size(); ++i)
      if (cluster[i] == c) mean.re += list[i].value.re, mean.im += list[i].value.im, ++count;
    if (count < 2) continue;
    mean.re /= Multi(count);
    mean.im /= Multi(count);
    Multi spread(0);
    for (std::size_t i = 0; i < list.size(); ++i)
      if (cluster[i] == c) spread = std::max({spread, list[i].radius, modulus(minus(list[i].value, mean))});
    for (std::size_t i = 0; i < list.size(); ++i)
      if (cluster[i] == c) list[i].value = mean, list[i].multiplicity = count, list[i].radius = spread;
  }
}

}  // namespace

Multi modulus(const Complex& z) {
  Multi r;
  mpfr_hypot(r.raw(), z.re.raw(), z.im.raw(), MPFR_RNDN);
  return r;
}

bool eigenvalues(const Matrix<Multi>& a, std::vector<Eigenvalue>& out) {
  out.clear();
  if (a.rows == 0) return true;
  Multi largest(0);
  for (const Multi& x : a.data) {
    if (!x.finite()) return false;
    if (abs(x) > largest) largest = abs(x);
  }
  const Multi change = least_change_of(largest);
  Matrix<Multi> moved = a;
  for (std::size_t i = 0; i < a.rows; ++i)
    for (std::size_t j = 0; j < a.cols; ++j)
      moved(i, j) += change * Multi(2 * static_cast<int>((i * 37 + j * 53 + 11) % 17) - 17) / Multi(16);  // all nonzero
  std::vector<Complex> values, others;
  std::vector<std::vector<Complex>> vectors;
  if (!solve(a, values, &vectors) || !solve(moved, others, nullptr)) return false;
  for (std::size_t i = 0; i < values.size(); ++i) {
    // Finds the nearest of the other eigenvalues that is not taken yet.
    std::size_t nearest = 0;
    Multi distance(-1);
    for (std::size_t k = 0; k < others.size(); ++k)
      if (Multi d = modulus(minus(values[i], others[k])); distance < Multi(0) || d < distance)
        distance = d, nearest = k;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(nearest));
    normalise(vectors[i]);
    out.push_back({values[i], 1, std::max(distance, change), std::move(vectors[i])});
  }
  gather(out);
  for (Eigenvalue& e : out)
    for (Multi* part : {&e.value.re, &e.value.im})
      if (!(abs(*part) > Multi(kSpread) * change) || (e.multiplicity == 1 && !(abs(*part) > Multi(kSpread) * e.radius)))
        *part = Multi(0);
  for (Eigenvalue& e : out)
    for (Complex& z : e.vector)
      for (Multi* part : {&z.re, &z.im})
        if (!(abs(*part) > Multi(kSpread) * e.radius)) *part = Multi(0);
  // A is real: its non-real eigenvalues come in pairs, and a pair has one real part.
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (!(out[i].value.im > Multi(0))) continue;
    for (Eigenvalue& e : out)
      if (modulus(minus({e.value.re, -e.value.im}, out[i].value)) <= Multi(kSpread) * std::max(e.radius, out[i].radius))
        e.value = {out[i].value.re, -out[i].value.im};
  }
  std::stable_sort(out.begin(), out.end(), [](const Eigenvalue& x, const Eigenvalue& y) {
    if (!(x.value.re == y.value.re)) return x.value.re > y.value.re;
    const Multi fx = abs(x.value.im), fy = abs(y.value.im);
    if (!(fx == fy)) return fx < fy;
    return x.value.im > y.value.im;
  });
  return true;
}

}  // namespace anholon

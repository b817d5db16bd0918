#include "observe/floors/triple.h"

#include <algorithm>

namespace anholon {

namespace {

// A remainder of a direction smaller than this part is round-off.
constexpr double kDependent = 1e-9;

// Orthogonalizes the directions in the order of their lengths. `pivots`: the directions from which the vectors of the
// basis come.
std::vector<Triple> orthonormal(const std::vector<Triple>& directions, std::vector<std::size_t>& pivots) {
  std::vector<Triple> es, left = directions;
  const auto longer = [](const Triple& a, const Triple& b) { return norm(a) < norm(b); };
  double largest = 0;
  for (const Triple& d : directions) largest = std::max(largest, norm(d));
  while (es.size() < 3) {
    const auto next = std::max_element(left.begin(), left.end(), longer);
    if (next == left.end() || !(norm(*next) > kDependent * largest)) break;
    const Triple e = (1 / norm(*next)) * *next;
    pivots.push_back(static_cast<std::size_t>(next - left.begin()));
    es.push_back(e);
    for (Triple& d : left) d = d - dot(d, e) * e;
  }
  return es;
}

}  // namespace

std::vector<Triple> basis(const std::vector<Triple>& directions) {
  std::vector<std::size_t> pivots;
  return orthonormal(directions, pivots);
}

std::optional<Triple> gradient_in_space(const std::vector<Triple>& directions, const std::vector<double>& rates) {
  std::vector<std::size_t> pivots;
  const std::vector<Triple> es = orthonormal(directions, pivots);
  Triple n;
  // Direction pivots[k] lies in the span of the first k + 1 vectors of the basis.
  for (std::size_t k = 0; k < es.size(); ++k)
    n = n - ((dot(directions[pivots[k]], n) - rates[pivots[k]]) / dot(directions[pivots[k]], es[k])) * es[k];
  double size = 0;
  for (const double rate : rates) size = std::max(size, std::abs(rate));
  for (std::size_t a = 0; a < rates.size(); ++a) {
    const double told = dot(directions[a], n);
    if (!(std::abs(told - rates[a]) <= kDependent * (size + norm(directions[a]) * norm(n)))) return std::nullopt;
  }
  return n;
}

}  // namespace anholon

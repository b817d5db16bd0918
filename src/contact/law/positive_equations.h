// Linear equations with a positive semidefinite symmetric matrix.
#pragma once
#include "contact/law/rows.h"

namespace anholon {

// Returns the solution of H x = g whose components are zero in the directions in which H is zero up to round-off.
inline ContactNumbers solve_positive(std::vector<ContactNumbers> H, ContactNumbers g) {
  const std::size_t n = g.size();
  std::vector<std::size_t> order;
  std::vector<bool> done(n, false);
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t best = n;
    for (std::size_t i = 0; i < n; ++i)
      if (!done[i] && (best == n || H[i][i] > H[best][best])) best = i;
    constexpr long double kNone = 1e-17L;
    if (!order.empty() && !(H[best][best] > kNone * H[order[0]][order[0]])) break;
    if (!(H[best][best] > 0)) break;
    done[best] = true;
    order.push_back(best);
    for (std::size_t i = 0; i < n; ++i) {
      if (done[i]) continue;
      const long double factor = H[i][best] / H[best][best];
      for (std::size_t j = 0; j < n; ++j) H[i][j] -= factor * H[best][j];
      g[i] -= factor * g[best];
    }
  }
  ContactNumbers x(n, 0);
  for (std::size_t k = order.size(); k-- > 0;) {
    const std::size_t i = order[k];
    long double sum = g[i];
    for (std::size_t later = k + 1; later < order.size(); ++later) sum -= H[i][order[later]] * x[order[later]];
    x[i] = sum / H[i][i];
  }
  return x;
}

}  // namespace anholon
